/// The records a world's state is made of, and the one list of their fields.
///
/// A record is trivially copyable, little-endian and free of padding, so the bytes in memory are
/// the bytes that are hashed and saved. `fieldsOf<Record>` names every field with its place; a
/// static assertion makes sure the list covers the record to the last byte. Hash, save, load and
/// diff all go over this list, so they cannot disagree (design, "State").
///
/// Nothing here may hold −0, a NaN or an infinity: see `canonicalZero` and quarantine.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace huestep {

static_assert(std::endian::native == std::endian::little, "state bytes are little-endian");

enum class FieldType : std::uint8_t { F32, U32, I32, U64, U16, U8, I8 };

constexpr std::uint32_t sizeOf(FieldType type) {
    switch (type) {
        case FieldType::U64:
            return 8;
        case FieldType::U16:
            return 2;
        case FieldType::U8:
        case FieldType::I8:
            return 1;
        default:
            return 4;
    }
}

/// A run of `count` values of one type in a record; the name is for people.
struct Field {
    const char* name;
    FieldType type;
    std::uint32_t offset;
    std::uint32_t count = 1;
};

template <class Record>
inline constexpr auto fieldsOf = nullptr;

/// Whether the fields tile the record: each starts where the last ended, the last ends at the end.
template <class Record>
constexpr bool fieldsTile() {
    std::uint32_t at = 0;
    for (const Field& f : fieldsOf<Record>) {
        if (f.offset != at) return false;
        at += f.count * sizeOf(f.type);
    }
    return at == sizeof(Record) && std::is_trivially_copyable_v<Record>;
}

/// What moves: 32 bytes a body, the state every tick's motion root is taken over.
struct BodyMotion {
    Vec2 position;          ///< m, of the centre of mass
    Rotation rotation;      ///< unit vector
    Vec2 velocity;          ///< m/s, of the centre of mass
    float angularVelocity;  ///< rad/s
    std::uint16_t rest;     ///< quiet ticks so far; `asleepBit` set while asleep
    std::uint8_t effort;    ///< that the next step takes, see `EffortPlan::packed`
    std::int8_t calm;       ///< steps for which a lower level would have done; < 0: a higher one

    static constexpr std::uint16_t asleepBit = 0x8000u;
    [[nodiscard]] bool asleep() const { return (rest & asleepBit) != 0; }
    [[nodiscard]] Pose pose() const { return {position, rotation}; }
};
template <>
inline constexpr auto fieldsOf<BodyMotion> = std::to_array<Field>({
    {"position.x", FieldType::F32, 0},
    {"position.y", FieldType::F32, 4},
    {"rotation.c", FieldType::F32, 8},
    {"rotation.s", FieldType::F32, 12},
    {"velocity.x", FieldType::F32, 16},
    {"velocity.y", FieldType::F32, 20},
    {"angularVelocity", FieldType::F32, 24},
    {"rest", FieldType::U16, 28},
    {"effort", FieldType::U8, 30},
    {"calm", FieldType::I8, 31},
});
static_assert(fieldsTile<BodyMotion>());

/// What a body is: changes only by command.
struct BodyInfo {
    BodyId id;
    std::uint32_t flags;   ///< BodyType in bits 0 and 1; `fixedRotation`, `maySleep`
    PlayerId owner;        ///< who spawned it; 0: the host
    float mass;            ///< kg; 0 unless dynamic
    float inverseMass;     ///< 1/kg; 0 unless dynamic
    float inertia;         ///< kg·m² about the centre of mass; 0 unless dynamic and free to turn
    float inverseInertia;  ///< 1/(kg·m²); 0 where `inertia` is
    Vec2 localCenter;      ///< m, centre of mass in the frame of the body's origin
    float linearDamping;   ///< 1/s
    float angularDamping;  ///< 1/s
    float gravityScale;    ///< of the world's gravity

    static constexpr std::uint32_t typeMask = 3u;
    static constexpr std::uint32_t fixedRotation = 4u;
    static constexpr std::uint32_t maySleep = 8u;
    [[nodiscard]] BodyType type() const { return static_cast<BodyType>(flags & typeMask); }
    [[nodiscard]] bool dynamic() const { return type() == BodyType::Dynamic; }
};
template <>
inline constexpr auto fieldsOf<BodyInfo> = std::to_array<Field>({
    {"id", FieldType::U32, 0},
    {"flags", FieldType::U32, 4},
    {"owner", FieldType::U32, 8},
    {"mass", FieldType::F32, 12},
    {"inverseMass", FieldType::F32, 16},
    {"inertia", FieldType::F32, 20},
    {"inverseInertia", FieldType::F32, 24},
    {"localCenter.x", FieldType::F32, 28},
    {"localCenter.y", FieldType::F32, 32},
    {"linearDamping", FieldType::F32, 36},
    {"angularDamping", FieldType::F32, 40},
    {"gravityScale", FieldType::F32, 44},
});
static_assert(fieldsTile<BodyInfo>());

/// A shape, its vertices in the frame of its body's centre of mass. Sorted by (body, id).
struct ShapeInfo {
    ShapeId id;
    BodyId body;
    std::uint32_t kind;  ///< ShapeKind in bits 0 to 7, vertex count in bits 8 to 15
    float radius;        ///< m
    std::array<Vec2, maxPolygonVertices> vertices;  ///< m; unused ones are zero
    float density;                                  ///< kg/m²
    float friction;                                 ///< Coulomb coefficient
    float restitution;                              ///< [0, 1]
    float rollingResistance;                        ///< coefficient: of the radius
    float tangentSpeed;                             ///< m/s, of the surface, as of a conveyor
    std::uint32_t category;
    std::uint32_t mask;
    std::int32_t group;

    [[nodiscard]] ShapeKind shapeKind() const { return static_cast<ShapeKind>(kind & 0xffu); }
    [[nodiscard]] int vertexCount() const { return static_cast<int>((kind >> 8) & 0xffu); }
    [[nodiscard]] Filter filter() const { return {category, mask, group}; }
};
template <>
inline constexpr auto fieldsOf<ShapeInfo> = std::to_array<Field>({
    {"id", FieldType::U32, 0},
    {"body", FieldType::U32, 4},
    {"kind", FieldType::U32, 8},
    {"radius", FieldType::F32, 12},
    {"vertices", FieldType::F32, 16, 16},
    {"density", FieldType::F32, 80},
    {"friction", FieldType::F32, 84},
    {"restitution", FieldType::F32, 88},
    {"rollingResistance", FieldType::F32, 92},
    {"tangentSpeed", FieldType::F32, 96},
    {"category", FieldType::U32, 100},
    {"mask", FieldType::U32, 104},
    {"group", FieldType::I32, 108},
});
static_assert(fieldsTile<ShapeInfo>());

/// What a joint is: changes only by command.
struct JointInfo {
    JointId id;
    std::uint32_t flags;  ///< JointKind in bits 0 to 7; the bits below
    BodyId bodyA;
    BodyId bodyB;
    PlayerId owner;  ///< whose grab it is; 0: the host's
    Vec2 anchorA;    ///< m, from body A's centre of mass, in its frame
    Vec2 anchorB;
    Rotation reference;
    float length;          ///< m
    Vec2 target;           ///< mouse: m, where body B's anchor is drawn to; prismatic: `axis()`
    float maxForce;        ///< N
    float springHertz;     ///< Hz
    float springDamping;   ///< damping ratio
    float lower;           ///< rad; distance, prismatic: m
    float upper;           ///< the same
    float motorSpeed;      ///< rad/s; distance, prismatic: m/s
    float motorMaxEffort;  ///< N·m; distance, prismatic: N

    static constexpr std::uint32_t collideConnected = 0x100u;
    static constexpr std::uint32_t spring = 0x200u;
    static constexpr std::uint32_t limit = 0x400u;
    static constexpr std::uint32_t motor = 0x800u;      ///< the motor runs
    static constexpr std::uint32_t hasMotor = 0x1000u;  ///< the scene gave it a motor
    [[nodiscard]] JointKind kind() const { return static_cast<JointKind>(flags & 0xffu); }
    [[nodiscard]] bool has(std::uint32_t bit) const { return (flags & bit) != 0; }
    /// Prismatic: unit vector in the frame of body A.
    [[nodiscard]] Vec2 axis() const { return target; }
};
template <>
inline constexpr auto fieldsOf<JointInfo> = std::to_array<Field>({
    {"id", FieldType::U32, 0},
    {"flags", FieldType::U32, 4},
    {"bodyA", FieldType::U32, 8},
    {"bodyB", FieldType::U32, 12},
    {"owner", FieldType::U32, 16},
    {"anchorA", FieldType::F32, 20, 2},
    {"anchorB", FieldType::F32, 28, 2},
    {"reference", FieldType::F32, 36, 2},
    {"length", FieldType::F32, 44},
    {"target", FieldType::F32, 48, 2},
    {"maxForce", FieldType::F32, 56},
    {"springHertz", FieldType::F32, 60},
    {"springDamping", FieldType::F32, 64},
    {"lower", FieldType::F32, 68},
    {"upper", FieldType::F32, 72},
    {"motorSpeed", FieldType::F32, 76},
    {"motorMaxEffort", FieldType::F32, 80},
});
static_assert(fieldsTile<JointInfo>());

/// Accumulated impulses of a joint's parts, from which the next step starts warm. Place i belongs
/// to joint i.
struct JointImpulses {
    /// N·s, point part; x alone for the rigid part of a distance joint; prismatic: x across the
    /// axis, y of the angle (N·m·s).
    Vec2 point;
    float spring;  ///< N·s or N·m·s; weld: of the angle, with a spring or rigid
    float motor;
    float lower;
    float upper;
};
template <>
inline constexpr auto fieldsOf<JointImpulses> = std::to_array<Field>({
    {"point.x", FieldType::F32, 0},
    {"point.y", FieldType::F32, 4},
    {"spring", FieldType::F32, 8},
    {"motor", FieldType::F32, 12},
    {"lower", FieldType::F32, 16},
    {"upper", FieldType::F32, 20},
});
static_assert(fieldsTile<JointImpulses>());

/// A touching contact. The manifold is a function of the two shapes and `relative` alone, so only
/// the pose at which it was made is kept, and how body A was turned then: while a manifold is kept,
/// its normal and anchors keep their directions in the world. Impulses are in the order of its
/// points.
struct ContactState {
    ShapeId shapeA;  ///< the lower shape id
    ShapeId shapeB;
    Pose relative;  ///< body B's centre frame seen from body A's when the manifold was made
    float turn;     ///< body A's rotation then, see `turnOf`
    std::array<float, 2> normalImpulse;   ///< N·s, ≥ 0
    std::array<float, 2> tangentImpulse;  ///< N·s
    float rollingImpulse;                 ///< N·m·s
};
template <>
inline constexpr auto fieldsOf<ContactState> = std::to_array<Field>({
    {"shapeA", FieldType::U32, 0},
    {"shapeB", FieldType::U32, 4},
    {"relative.x", FieldType::F32, 8},
    {"relative.y", FieldType::F32, 12},
    {"relative.c", FieldType::F32, 16},
    {"relative.s", FieldType::F32, 20},
    {"turn", FieldType::F32, 24},
    {"normalImpulse", FieldType::F32, 28, 2},
    {"tangentImpulse", FieldType::F32, 36, 2},
    {"rollingImpulse", FieldType::F32, 44},
});
static_assert(fieldsTile<ContactState>());

/// An author of commands: a player, or the host (id 0), which every world has.
struct PlayerRecord {
    PlayerId id;
    BodyId body;                 ///< the body the scene gave it, or 0
    std::uint64_t lastSequence;  ///< of its last command, applied or rejected
    JointId grab;                ///< its mouse joint, or 0
    std::uint32_t joined;        ///< how many players had joined before it
};
template <>
inline constexpr auto fieldsOf<PlayerRecord> = std::to_array<Field>({
    {"id", FieldType::U32, 0},
    {"body", FieldType::U32, 4},
    {"lastSequence", FieldType::U64, 8},
    {"grab", FieldType::U32, 16},
    {"joined", FieldType::U32, 20},
});
static_assert(fieldsTile<PlayerRecord>());

/// The world as a whole.
struct WorldInfo {
    std::uint64_t tick;  ///< steps taken since the scene was built
    std::uint32_t nextBody;
    std::uint32_t nextShape;
    std::uint32_t nextJoint;
    std::uint32_t flags;     ///< `sleep`, `players`
    Vec2 gravity;            ///< m/s²
    float stepSeconds;       ///< s
    std::uint32_t substeps;  ///< 0: planned
    std::uint32_t maxBodies;
    std::uint32_t maxShapes;
    std::uint32_t maxJoints;
    std::uint32_t maxCommandsPerTick;  ///< of all players together
    std::uint32_t maxPlayers;
    std::uint32_t maxSpawned;     ///< bodies, a player's at a time
    float maxImpulse;             ///< N·s, of a player's command
    float maxForce;               ///< N, of a player's command or grab
    std::uint32_t joinedPlayers;  ///< how many players ever joined
    std::uint32_t method;         ///< `Method`
    float penetrationNeed;        ///< m; 0: visual
    float jointNeed;              ///< m; 0: visual

    static constexpr std::uint32_t sleep = 1u;
    static constexpr std::uint32_t players = 2u;
    [[nodiscard]] Method solver() const { return static_cast<Method>(method); }
    /// Whether each island gets the substeps that it needs. Only the product's method plans.
    [[nodiscard]] bool planned() const { return substeps == 0 && solver() == Method::SoftStep; }
};
template <>
inline constexpr auto fieldsOf<WorldInfo> = std::to_array<Field>({
    {"tick", FieldType::U64, 0},
    {"nextBody", FieldType::U32, 8},
    {"nextShape", FieldType::U32, 12},
    {"nextJoint", FieldType::U32, 16},
    {"flags", FieldType::U32, 20},
    {"gravity", FieldType::F32, 24, 2},
    {"stepSeconds", FieldType::F32, 32},
    {"substeps", FieldType::U32, 36},
    {"maxBodies", FieldType::U32, 40},
    {"maxShapes", FieldType::U32, 44},
    {"maxJoints", FieldType::U32, 48},
    {"maxCommandsPerTick", FieldType::U32, 52},
    {"maxPlayers", FieldType::U32, 56},
    {"maxSpawned", FieldType::U32, 60},
    {"maxImpulse", FieldType::F32, 64},
    {"maxForce", FieldType::F32, 68},
    {"joinedPlayers", FieldType::U32, 72},
    {"method", FieldType::U32, 76},
    {"penetrationNeed", FieldType::F32, 80},
    {"jointNeed", FieldType::F32, 84},
});
static_assert(fieldsTile<WorldInfo>());

/// By which rules the world is played, and their dice.
struct RulesInfo {
    std::array<std::uint8_t, caps::maxRulesName> name;  ///< zeros behind it
    std::uint32_t version;
    std::uint32_t seed;  ///< the dice were started with it
    std::uint64_t dice;  ///< the generator's state, see `Game::roll`
};
template <>
inline constexpr auto fieldsOf<RulesInfo> = std::to_array<Field>({
    {"name", FieldType::U8, 0, caps::maxRulesName},
    {"version", FieldType::U32, 32},
    {"seed", FieldType::U32, 36},
    {"dice", FieldType::U64, 40},
});
static_assert(fieldsTile<RulesInfo>());

/// Four bytes of the state of the rules; which fields they belong to, the rules know.
struct RulesWord {
    std::uint32_t value;
};
template <>
inline constexpr auto fieldsOf<RulesWord> = std::to_array<Field>({
    {"value", FieldType::U32, 0},
});
static_assert(fieldsTile<RulesWord>());

/// A place where players appear.
struct SpawnPoint {
    Vec2 position;  ///< m
};
template <>
inline constexpr auto fieldsOf<SpawnPoint> = std::to_array<Field>({
    {"position.x", FieldType::F32, 0},
    {"position.y", FieldType::F32, 4},
});
static_assert(fieldsTile<SpawnPoint>());

}  // namespace huestep
