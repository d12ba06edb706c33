/// Scenes as values: everything a world starts from, and what may be spawned into one.
///
/// A scene is plain data. It has no behaviour, owns no resource and may be copied, compared,
/// written to a file (`protocol/scene_file.h`) and sent over the wire. `check(scene)` says whether
/// a world can be built from it; a `World` is built only from a checked scene.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec.h"
#include "core/result.h"

namespace huestep {

using BodyId = std::uint32_t;    ///< from a counter that is state; never reused; 0 is no body
using ShapeId = std::uint32_t;   ///< likewise; 0 is no shape
using JointId = std::uint32_t;   ///< likewise; 0 is no joint
using PlayerId = std::uint32_t;  ///< author of commands; 0 is the host

inline constexpr int maxPolygonVertices = 8;

/// Surface properties of a shape. Two shapes in touch mix friction by the geometric mean,
/// restitution and rolling resistance by the maximum, and add tangent speeds.
struct Material {
    float friction = 0.6f;           ///< Coulomb's μ, [0, 100]
    float restitution = 0.0f;        ///< Newton's e, [0, 1]; applies above 1 m/s of approach
    float rollingResistance = 0.0f;  ///< rolling moment / (normal force · radius), [0, 100]
    /// m/s, ±10,000: a conveyor belt's surface runs counter-clockwise around the shape, as that of
    /// a wheel does that turns with positive angular velocity.
    float tangentSpeed = 0.0f;
    friend bool operator==(const Material&, const Material&) = default;
};

/// Which shapes may touch. Shapes of one group ≠ 0 always touch (group > 0) or never (group < 0);
/// others touch if each one's category is in the other's mask.
struct Filter {
    std::uint32_t category = 1;
    std::uint32_t mask = 0xffffffffu;
    std::int32_t group = 0;
    friend bool operator==(const Filter&, const Filter&) = default;
};

/// Whether two shapes of different bodies may touch at all.
constexpr bool mayTouch(const Filter& a, const Filter& b) {
    if (a.group == b.group && a.group != 0) return a.group > 0;
    return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

enum class ShapeKind : std::uint8_t { Circle, Capsule, Polygon, Segment, ChainSegment };

/// A convex shape in the frame of its body's origin: the set of points within `radius` of the
/// convex hull of `vertices`. Circle: 1 vertex. Capsule and segment: 2, at least `caps::minEdge`
/// apart. Polygon: 3 to 8, convex, counter-clockwise, edges of at least `caps::minEdge`, every
/// vertex at least `caps::minVertexDepth` inside of every edge that it does not end (so none is
/// collinear). A segment has radius 0 and no mass. Vertices beyond `vertexCount` mean nothing.
///
/// A chain segment is one side of a segment, with its neighbours in a chain: 4 vertices p0 p1 p2
/// p3, each at least `caps::minEdge` from the next, radius 0, no mass. It reaches from p1 to p2 and
/// touches what is to the right of that direction; nothing touches its back, another chain segment,
/// or the lines to p0 and p3, its ghosts. Those say how the chain goes on: a shape that slides over
/// p1 or p2 is pushed along no normal but those between the faces that meet there, so it does not
/// catch on vertices inside the chain. Counter-clockwise loops are solid, clockwise ones rooms.
struct ShapeDef {
    ShapeKind kind = ShapeKind::Circle;
    std::uint8_t vertexCount = 1;
    std::array<Vec2, maxPolygonVertices> vertices{};  ///< m, ±10,000
    float radius = 0.5f;   ///< m, [0, 10,000]; circles and capsules: at least `caps::minEdge`
    float density = 1.0f;  ///< kg/m², 0 or [1e-6, 1e6]
    Material material;
    Filter filter;

    static ShapeDef circle(Vec2 center, float radius);
    static ShapeDef capsule(Vec2 a, Vec2 b, float radius);
    static ShapeDef segment(Vec2 a, Vec2 b);
    /// A box of half width `hx` and half height `hy`, turned by `q` about `center`.
    static ShapeDef box(float hx, float hy, Vec2 center = {}, Rotation q = {}, float radius = 0.0f);
    /// Takes the points as they are; `check` refuses what is not convex or counter-clockwise.
    static ShapeDef polygon(std::span<const Vec2> points, float radius = 0.0f);
    static ShapeDef chainSegment(Vec2 before, Vec2 a, Vec2 b, Vec2 after);
    /// The segments of a chain through the points, in their order. A loop of n points, 3 or more,
    /// has n; an open chain of n points, 4 or more, n − 3: the first and the last are ghosts. Fewer
    /// points give none.
    static std::vector<ShapeDef> chain(std::span<const Vec2> points, bool loop);

    friend bool operator==(const ShapeDef&, const ShapeDef&) = default;
};

enum class BodyType : std::uint8_t {
    Static,     ///< never moves
    Kinematic,  ///< moves with its velocity, pushed by nothing
    Dynamic
};

/// A dynamic body needs a shape with area and density: none is given a mass that its scene does
/// not say. Static and kinematic bodies may have no shape, to anchor joints.
struct BodyDef {
    /// 0: given by the order of the scene, see `bodyIdsOf`. A spawn allows 0 alone.
    BodyId id = 0;
    ShapeId firstShape = 0;  ///< with an id: its shapes' first id, rising as body ids do; 0: next
    BodyType type = BodyType::Static;
    bool fixedRotation = false;
    bool maySleep = true;
    bool asleep = false;  ///< starts asleep; dynamic bodies without velocity that may sleep
    Vec2 position;        ///< m, of the body's origin
    Rotation rotation;    ///< (cos θ, sin θ), c² + s² within `caps::rotationTolerance` of 1
    Vec2 velocity;        ///< m/s, of the centre of mass; zero if static
    float angularVelocity = 0.0f;  ///< rad/s
    float linearDamping = 0.0f;    ///< 1/s, [0, 1000]
    float angularDamping = 0.0f;   ///< 1/s, [0, 1000]
    float gravityScale = 1.0f;     ///< ±1000
    std::vector<ShapeDef> shapes;
    friend bool operator==(const BodyDef&, const BodyDef&) = default;
};

enum class JointKind : std::uint8_t {
    Revolute,  ///< two bodies share a point
    Distance,  ///< two points keep a distance, or a range of it
    Mouse,     ///< a point of body B is drawn to `target` with a bounded force
    Weld,      ///< two bodies share a point and an angle
    Prismatic  ///< a point of body B slides along an axis of body A, neither turns against it
};

/// A soft part: a damped harmonic oscillator of the row's effective mass.
struct SpringDef {
    bool enabled = false;
    float hertz = 0.0f;         ///< Hz, [0, 1000]; above 0 if enabled
    float dampingRatio = 0.0f;  ///< 1 is critical, [0, 1000]
    friend bool operator==(const SpringDef&, const SpringDef&) = default;
};

/// Bounds of the joint's coordinate: rad for a revolute joint within (−π, π), m for a distance, m
/// for a prismatic joint within ±100,000.
struct LimitDef {
    bool enabled = false;
    float lower = 0.0f;
    float upper = 0.0f;
    friend bool operator==(const LimitDef&, const LimitDef&) = default;
};

/// Drives the joint's coordinate at `speed` with at most `maxEffort`.
struct MotorDef {
    bool enabled = false;
    float speed = 0.0f;      ///< rad/s or m/s, ±100,000
    float maxEffort = 0.0f;  ///< N·m or N, [0, 1e12]
    friend bool operator==(const MotorDef&, const MotorDef&) = default;
};

/// A joint between two bodies of the same list (a scene's, or a spawn's), given by their places.
/// Two bodies that nothing can push may be joined; the joint then does nothing. A mouse joint has a
/// spring, neither limit nor motor, and its body A means nothing (it may be body B). A weld has
/// neither limit nor motor; its spring is that of its angle, the point stays rigid. The coordinate
/// of a prismatic joint is how far anchor B is from anchor A along the axis.
struct JointDef {
    JointId id = 0;  ///< as BodyDef::id
    JointKind kind = JointKind::Revolute;
    bool collideConnected = false;  ///< whether shapes of the two bodies may touch
    std::uint32_t bodyA = 0;        ///< place in `bodies`; a mouse joint has no body A
    std::uint32_t bodyB = 0;
    Vec2 anchorA;  ///< m, in the frame of body A's origin
    Vec2 anchorB;  ///< m, in the frame of body B's origin
    /// Revolute: rotation of B relative to A at coordinate 0; weld, prismatic: the one that is
    /// held.
    Rotation reference;
    Rotation axis;          ///< prismatic: its direction (cos θ, sin θ) in the frame of body A
    float length = 1.0f;    ///< distance: rest length, m, [0.001, 1e5]
    Vec2 target;            ///< mouse: m, in the world
    float maxForce = 0.0f;  ///< mouse: N, [0, 1e12]
    SpringDef spring;       ///< revolute, prismatic: to coordinate 0; distance: to `length`; mouse
                            ///< and weld: as above
    LimitDef limit;
    MotorDef motor;
    friend bool operator==(const JointDef&, const JointDef&) = default;
};

/// What players get when they join a session, and what they may do there.
struct PlayerDef {
    std::optional<BodyDef> body;    ///< spawned for each player at the next spawn point; id 0
    std::vector<Vec2> spawnPoints;  ///< m; player k gets point k mod size; at least one if `body`
    std::uint32_t maxSpawned = 16;  ///< bodies a player may have spawned at a time, [0, 1024]
    float maxImpulse = 100.0f;      ///< N·s a command, [0, 1e9]
    float maxForce = 1000.0f;       ///< N a command or a grab, [0, 1e9]
    friend bool operator==(const PlayerDef&, const PlayerDef&) = default;
};

/// Caps of a world. A command that would pass one is rejected, the same on every replica.
struct WorldLimits {
    std::uint32_t bodies = 100'000;
    std::uint32_t shapes = 200'000;
    std::uint32_t joints = 100'000;
    std::uint32_t commandsPerTick = 1'024;
    std::uint32_t players = 1'024;
    friend bool operator==(const WorldLimits&, const WorldLimits&) = default;
};

/// Where the id counters of a new world start: the next body, shape and joint get at least these.
struct Counters {
    std::uint32_t nextBody = 1;
    std::uint32_t nextShape = 1;
    std::uint32_t nextJoint = 1;
    friend bool operator==(const Counters&, const Counters&) = default;
};

/// How constraints are solved (core/solver/method.h). Part of a world's state, as every one of them
/// gives another future.
enum class Method : std::uint8_t {
    SoftStep,     ///< coloured Gauss-Seidel with soft rows and substeps: the product
    Sequential,   ///< the same in key order, one constraint after another
    Jacobi,       ///< the same with all constraints of a sweep side by side
    JacobiSplit,  ///< likewise, each with its share of its bodies' mass
    Pgs,          ///< projected Gauss-Seidel over one step, errors in the velocity rows (Baumgarte)
    PgsNgs,       ///< the same without errors in velocities; sweeps over positions follow
    Locks,        ///< the soft step, constraints to all threads in key order, a lock a body
    Atomics,      ///< likewise, with atomic additions to bodies instead of locks
    Avbd,         ///< augmented vertex block descent: positions body by body, backward Euler
    Direct,       ///< joint trees at once, all else as in the soft step
};
inline constexpr Method lastMethod = Method::Direct;

/// How far a world may be off at rest, where its substeps are planned: m, 0 or [1e-6, 1]. 0 is
/// *visual*: 5 mm, or 1 % of the smaller body if that is more.
struct Need {
    float penetration = 0.0f;
    float joint = 0.0f;
    friend bool operator==(const Need&, const Need&) = default;
};

/// A number that rules are started with, by name.
struct RulesParameter {
    std::string name;  ///< 1 to 32 of [a-zA-Z0-9_-]
    float value = 0.0f;
    friend bool operator==(const RulesParameter&, const RulesParameter&) = default;
};

/// Which rules a session is played by (core/rules/rules.h), and what they are started with.
struct RulesDef {
    std::string name;                        ///< 1 to 32 of [a-z0-9_-]
    std::uint32_t version = 1;               ///< of the rules: other versions play other games
    std::uint32_t seed = 0;                  ///< of their dice
    std::vector<RulesParameter> parameters;  ///< names that rise; those left out are the rules' own
    friend bool operator==(const RulesDef&, const RulesDef&) = default;
};

struct Scene {
    std::string name;                  ///< for people, ≤ 256 bytes; no part of a world's state
    Vec2 gravity{0.0f, -10.0f};        ///< m/s², ±10,000
    float stepSeconds = 1.0f / 60.0f;  ///< s, length of one tick, [0.0001, 0.1]
    /// Of a tick, [1, 64]; of methods without: iterations. 0: planned, for each island by `need`;
    /// of methods other than the product's 4.
    std::uint32_t substeps = 0;
    Need need;
    Method method = Method::SoftStep;
    bool sleep = true;  ///< whether islands at rest fall asleep
    std::vector<BodyDef> bodies;
    std::vector<JointDef> joints;
    std::optional<PlayerDef> players;  ///< without it, players may only watch
    WorldLimits limits;
    Counters counters;
    std::optional<RulesDef> rules;  ///< without them a world has none, and no state for any
    friend bool operator==(const Scene&, const Scene&) = default;
};

/// Hard limits of any scene, whatever it says of itself.
inline constexpr std::uint32_t maxShapesPerBody = 1024;
inline constexpr float maxCoordinate = 1.0e6f;  ///< m, of positions
inline constexpr float maxSpeed = 1.0e5f;       ///< m/s and rad/s, of definitions

namespace caps {
inline constexpr float maxExtent = 1.0e4f;        ///< m, of vertices and radii
inline constexpr float minEdge = 1.0e-3f;         ///< m, of edges, of radii of circles and capsules
inline constexpr float minVertexDepth = 1.0e-4f;  ///< m, from a vertex to any edge not its own
inline constexpr float minDensity = 1.0e-6f;      ///< kg/m², unless 0
inline constexpr float maxDensity = 1.0e6f;       ///< kg/m²
inline constexpr float minJointLength = 1.0e-3f;  ///< m
inline constexpr float maxJointLength = 1.0e5f;   ///< m
inline constexpr float maxEffort = 1.0e12f;       ///< N and N·m
inline constexpr float maxGravity = 1.0e4f;       ///< m/s²
inline constexpr std::uint32_t maxCommands = 65'536;  ///< a tick, of all players together
inline constexpr std::uint32_t maxPlayers = 65'536;
inline constexpr float maxPush = 1.0e9f;             ///< N·s and N, of a player's command
inline constexpr std::uint32_t maxSpawned = 1024;    ///< bodies, of a player at a time
inline constexpr float minStepSeconds = 1.0e-4f;     ///< s
inline constexpr float minTolerance = 1.0e-6f;       ///< m, of a need that is not visual
inline constexpr float maxTolerance = 1.0f;          ///< m
inline constexpr float rotationTolerance = 1.0e-3f;  ///< of c² + s²; the world normalises
inline constexpr std::uint32_t maxId = 0x7fffffffu;  ///< of definitions and counters at the start
inline constexpr std::uint32_t maxBodies = 1'000'000;
inline constexpr std::uint32_t maxShapes = 2'000'000;
inline constexpr std::uint32_t maxJoints = 1'000'000;
inline constexpr std::size_t maxSpawnPoints = 4096;
inline constexpr std::size_t maxSceneName = 256;  ///< bytes
inline constexpr std::size_t maxRulesName = 32;   ///< bytes, of parameters' names too
inline constexpr std::size_t maxRulesParameters = 64;
}  // namespace caps

/// The ids that bodies and joints get, place by place: those given stand; the others are counted
/// up in the order of the scene, from the counter or past the largest id given, whatever is more.
std::vector<BodyId> bodyIdsOf(const Scene& scene);
std::vector<JointId> jointIdsOf(const Scene& scene);

/// Whether the name is 1 to 32 of [a-z0-9_-].
bool isRulesName(std::string_view name);

/// Says whether a world can be built from the scene; the sentence names the first thing that is
/// wrong by its path, as in `bodies[3].shapes[0].vertices[2].x: not a finite number`.
Status check(const Scene& scene);

/// The same for a body or a joint alone, with `path` in front of each sentence.
Status check(const BodyDef& body, const std::string& path);
Status check(const JointDef& joint, std::size_t bodyCount, const std::string& path);

}  // namespace huestep
