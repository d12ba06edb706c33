// The benchmark scenes that have a host who moves, spawns and removes bodies, set up as in Box2D's
// own benchmark set (performance page, "Scenes").
#include "core/math/trig.h"
#include "core/scene/scenes.h"

namespace huestep::scenes {

namespace {

constexpr BodyId pusher = 1;  // of the junkyard

/// Five points on a circle, each 2π/φ further than the one before (φ: the golden ratio), here in
/// counter-clockwise order.
ShapeDef scrap(float radius) {
    const double step = pi * (2.2360679774997896 - 1.0);
    std::array<Vec2, 5> corners{};
    std::size_t place = 0;
    for (const int point : {0, 2, 4, 1, 3}) {
        const RotationT<double> q = rotationOf(step * point);
        corners[place++] = radius * Vec2{static_cast<float>(q.c), static_cast<float>(q.s)};
    }
    return ShapeDef::polygon(corners);
}

}  // namespace

Scene junkyard(Values values) {
    const std::uint32_t columns = count(values[0]);
    const std::uint32_t rows = count(values[1]);
    Scene scene;
    add(scene, bodyOf(BodyType::Kinematic, {}, ShapeDef::box(2.0f, 4.0f, {0.0f, 4.0f})));
    std::vector<ShapeDef> ground;
    addTrough(ground, 80, 50);
    addStatic(scene, ground);
    const float radius = 0.25f;
    BodyDef body = bodyOf(BodyType::Dynamic, {}, scrap(radius));
    float side = -0.1f;  // every other body stands 0.2 m further left
    for (std::uint32_t column = 0; column < columns; ++column) {
        const float x =
            1.5f * (2.0f * static_cast<float>(column) - static_cast<float>(columns)) * radius;
        for (std::uint32_t row = 0; row < rows; ++row) {
            body.position = {x + side, 4.0f * static_cast<float>(row) * radius + 15.0f};
            side = -side;
            add(scene, body);
        }
    }
    fitLimits(scene);
    return scene;
}

void junkyardHost(Values, std::uint64_t tick, std::vector<Action>& actions) {
    const double seconds = static_cast<double>(tick) / 60.0;
    const auto x = static_cast<float>(60.0 * rotationOf(0.2 * seconds).s);
    actions.emplace_back(SetTarget{pusher, {x, 0.0f}, {}});
}

namespace {

constexpr std::uint32_t floorBoxes = 501;
constexpr float floorWidth = 250.0f;   // m, between the middles of the outermost boxes
constexpr float floorHeight = 45.0f;   // m, from floor to floor
constexpr std::uint32_t bonesOf = 11;  // a ragdoll

/// A capsule, upright in the ragdoll's own frame, and the joint to the bone it hangs from.
struct Bone {
    std::uint32_t parent;  ///< the hip is its own
    float height;          ///< m, of the body's origin over the ragdoll's
    float low, high;       ///< m, ends of the capsule's axis over the body's origin
    float radius;          ///< m
    float pivot;           ///< m, height of the joint over the ragdoll's origin
    double lower, upper;   ///< of the joint's limit, in half turns
    float friction;        ///< of the joint, as a share of the ragdoll's
    float damping;         ///< 1/s, linear
    double reference;      ///< angle at which the joint's coordinate is 0, in half turns
    bool foot;
};

constexpr std::array<Bone, bonesOf> bones{{
    {0, 0.95f, -0.02f, 0.02f, 0.095f, 0, 0, 0, 0, 0, 0, false},                     // hip
    {0, 1.2f, -0.135f, 0.135f, 0.09f, 1.0f, -0.25, 0.0, 0.5f, 0, 0, false},         // torso
    {1, 1.475f, -0.038f, 0.039f, 0.075f, 1.4f, -0.3, 0.1, 0.25f, 0.1f, 0, false},   // head
    {0, 0.775f, -0.125f, 0.125f, 0.06f, 0.9f, -0.05, 0.4, 1.0f, 0, 0, false},       // thigh
    {3, 0.475f, -0.155f, 0.125f, 0.045f, 0.625f, -0.5, -0.02, 0.5f, 0, 0, true},    // leg
    {0, 0.775f, -0.125f, 0.125f, 0.06f, 0.9f, -0.05, 0.4, 1.0f, 0, 0, false},       // thigh
    {5, 0.475f, -0.155f, 0.125f, 0.045f, 0.625f, -0.5, -0.02, 0.5f, 0, 0, true},    // leg
    {1, 1.225f, -0.125f, 0.125f, 0.035f, 1.35f, -0.1, 0.8, 0.5f, 0, 0, false},      // arm
    {7, 0.975f, -0.125f, 0.125f, 0.03f, 1.1f, -0.2, 0.3, 0.1f, 0.1f, 0.25, false},  // hand
    {1, 1.225f, -0.125f, 0.125f, 0.035f, 1.35f, -0.1, 0.8, 0.5f, 0, 0, false},      // arm
    {9, 0.975f, -0.125f, 0.125f, 0.03f, 1.1f, -0.2, 0.3, 0.1f, 0.1f, 0.25, false},  // hand
}};

/// A foot, which touches the ground but no ragdoll.
ShapeDef foot(const ShapeDef& bone) {
    const std::array<Vec2, 4> corners{Vec2{-0.03f, -0.185f}, Vec2{0.11f, -0.185f},
                                      Vec2{0.11f, -0.16f}, Vec2{-0.03f, -0.14f}};
    ShapeDef shape = ShapeDef::polygon(corners, 0.015f);
    shape.material.friction = 0.05f;
    shape.filter = bone.filter;
    shape.filter.mask = 1u;
    return shape;
}

BodyDef bodyOfBone(const Bone& bone, Vec2 at, std::int32_t group) {
    ShapeDef shape = ShapeDef::capsule({0.0f, bone.low}, {0.0f, bone.high}, bone.radius);
    shape.material.friction = 0.2f;
    shape.filter = {2u, 1u | 2u, -group};
    BodyDef body = bodyOf(BodyType::Dynamic, at + Vec2{0.0f, bone.height}, shape);
    body.linearDamping = bone.damping;
    if (bone.foot) body.shapes.push_back(foot(shape));
    return body;
}

JointDef jointOfBone(std::uint32_t place) {
    const Bone& bone = bones[place];
    const auto half = [](double turns) { return static_cast<float>(turns * pi); };
    JointDef joint;
    joint.bodyA = bone.parent;
    joint.bodyB = place;
    joint.anchorA = {0.0f, bone.pivot - bones[bone.parent].height};
    joint.anchorB = {0.0f, bone.pivot - bone.height};
    joint.reference = rotationOf(half(bone.reference));
    joint.spring = {true, 5.0f, 0.5f};
    joint.limit = {true, half(bone.lower), half(bone.upper)};
    joint.motor = {true, 0.0f, 0.05f * bone.friction};  // a brake: friction of the joint
    return joint;
}

/// A ragdoll that stands at a point. Bones of ragdolls of the same `group` do not touch.
Spawn ragdoll(Vec2 at, std::uint32_t group) {
    Spawn spawn;
    for (const Bone& bone : bones) {
        spawn.bodies.push_back(bodyOfBone(bone, at, static_cast<std::int32_t>(group)));
    }
    for (std::uint32_t place = 1; place < bonesOf; ++place) {
        spawn.joints.push_back(jointOfBone(place));
    }
    return spawn;
}

}  // namespace

Scene rain(Values values) {
    const std::uint32_t floors = count(values[0]);
    std::vector<ShapeDef> ground;
    for (std::uint32_t floor = 0; floor < floors; ++floor) {
        for (std::uint32_t i = 0; i < floorBoxes; ++i) {
            const float x = -0.5f * floorWidth + 0.5f * static_cast<float>(i);
            const float y = floorHeight * static_cast<float>(floor);
            ground.push_back(ShapeDef::box(0.25f, 0.25f, {x, y}));
        }
    }
    Scene scene;
    addStatic(scene, ground);
    fitLimits(scene);
    return scene;
}

void rainHost(Values values, std::uint64_t tick, std::vector<Action>& actions) {
    const std::uint32_t floors = count(values[0]);
    const std::uint32_t columns = count(values[1]);
    const std::uint32_t group = count(values[2]);
    const std::uint32_t period = count(values[3]);
    if (tick % period != 0) return;
    const std::uint64_t turn = tick / period;
    if (turn >= columns) {
        // Ids come from a counter, and every turn takes as many.
        const std::uint64_t ground = (floors * floorBoxes + staticShapes - 1) / staticShapes;
        const std::uint64_t aTurn = std::uint64_t{floors} * group * bonesOf;
        const std::uint64_t oldest = ground + 1 + (turn - columns) * aTurn;
        for (std::uint64_t id = oldest; id < oldest + aTurn; ++id) {
            actions.emplace_back(RemoveBody{static_cast<BodyId>(id)});
        }
    }
    const float width = floorWidth / static_cast<float>(columns);
    const float x = -0.5f * floorWidth + width * (static_cast<float>(turn % columns) + 0.5f);
    for (std::uint32_t floor = 0; floor < floors; ++floor) {
        const float y = 40.0f + floorHeight * static_cast<float>(floor);
        for (std::uint32_t i = 0; i < group; ++i) {
            actions.emplace_back(ragdoll({x + 0.5f * static_cast<float>(i), y}, i + 1));
        }
    }
}

}  // namespace huestep::scenes
