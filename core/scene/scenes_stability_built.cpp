// Scenes of the stability suite that are built of parts with care, on joints or leaning on each
// other, and what is thrown at a wall (physics page, rows 13, 14, 16, 19, 20, 23 and 26).
#include <array>
#include <cmath>

#include "core/math/trig.h"
#include "core/scene/scenes.h"

namespace huestep::scenes {

namespace {

/// Of a chain: its links do not touch each other.
ShapeDef ghost(ShapeDef shape) {
    shape.filter.group = -1;
    return shape;
}

/// A revolute joint between two points of bodies that need not be where the joint wants them.
JointDef pin(std::uint32_t bodyA, Vec2 anchorA, std::uint32_t bodyB, Vec2 anchorB) {
    JointDef joint;
    joint.bodyA = bodyA;
    joint.bodyB = bodyB;
    joint.anchorA = anchorA;
    joint.anchorB = anchorB;
    return joint;
}

}  // namespace

Scene ballAndChain(Values values) {
    const std::uint32_t links = count(values[0]);
    const float half = 0.5f;
    const float radius = 8.0f;
    Scene scene = awake();
    std::uint32_t last = add(scene, BodyDef{});
    Vec2 hook{};  // of the last body
    ShapeDef link = ghost(ShapeDef::capsule({-half, 0.0f}, {half, 0.0f}, 0.125f));
    link.density = 20.0f;
    for (std::uint32_t i = 0; i < links; ++i) {
        const Vec2 position{static_cast<float>(i) + half, 0.0f};
        const std::uint32_t place = add(scene, bodyOf(BodyType::Dynamic, position, link));
        scene.joints.push_back(pin(last, hook, place, {-half, 0.0f}));
        last = place;
        hook = {half, 0.0f};
    }
    ShapeDef disc = ghost(ShapeDef::circle({}, radius));
    disc.density = 20.0f;
    const Vec2 position{static_cast<float>(links) + radius, 0.0f};
    const std::uint32_t ball = add(scene, bodyOf(BodyType::Dynamic, position, disc));
    scene.joints.push_back(pin(last, hook, ball, {-radius, 0.0f}));
    return scene;
}

Scene bridge(Values values) {
    const std::uint32_t planks = count(values[0]);
    const float half = 0.5f;
    const float end = half * static_cast<float>(planks);
    Scene scene = awake();
    const std::uint32_t banks = add(scene, BodyDef{});
    std::uint32_t last = banks;
    Vec2 hook{-end, 0.0f};
    for (std::uint32_t i = 0; i < planks; ++i) {
        const Vec2 position{-end + half + static_cast<float>(i), 0.0f};
        BodyDef plank = bodyOf(BodyType::Dynamic, position, ShapeDef::box(half, 0.125f));
        plank.shapes[0].density = 20.0f;
        plank.linearDamping = plank.angularDamping = 0.1f;
        const std::uint32_t place = add(scene, plank);
        scene.joints.push_back(pin(last, hook, place, {-half, 0.0f}));
        last = place;
        hook = {half, 0.0f};
    }
    scene.joints.push_back(pin(last, hook, banks, {end, 0.0f}));
    return scene;
}

Scene stretchedChain(Values values) {
    const std::uint32_t links = count(values[0]);
    const auto stretch = static_cast<float>(values[1]);
    const float half = 0.5f;
    Scene scene = awake();
    std::uint32_t last = add(scene, BodyDef{});
    Vec2 hook{};
    for (std::uint32_t i = 0; i < links; ++i) {
        const Vec2 position{0.0f, -stretch * (half + static_cast<float>(i))};
        const ShapeDef disc = ghost(ShapeDef::circle({}, 0.2f));
        const std::uint32_t place = add(scene, bodyOf(BodyType::Dynamic, position, disc));
        scene.joints.push_back(pin(last, hook, place, {0.0f, half}));
        last = place;
        hook = {0.0f, -half};
    }
    return scene;
}

namespace {

constexpr double archHalfSpan = 5.0;  // m, of its middle line
constexpr double archHeight = 10.54;  // m
constexpr double archFoot = 2.0;      // m, thickness at the springing …
constexpr double archCrown = 1.3;     // m, … and at the crown
constexpr int archHalfStones = 8;     // to either side of the keystone

/// A joint between two stones: where it meets the inside and the outside of the arch.
struct ArchJoint {
    Vec2T<double> inner, outer;
};

/// The joints to the right of the crown, down to the foot, which stands flat. The middle line is
/// the parabola that carries a load spread evenly along x; stones are equally long along it.
std::array<ArchJoint, archHalfStones + 1> archJoints() {
    constexpr int steps = 20'000;
    const auto heightAt = [](double x) {
        return archHeight * (1.0 - x * x / (archHalfSpan * archHalfSpan));
    };
    const auto lengthOf = [&](int i) {  // of a step
        const double dx = archHalfSpan / steps;
        const double dy = heightAt(dx * (i + 1)) - heightAt(dx * i);
        return std::sqrt(dx * dx + dy * dy);
    };
    double whole = 0.0;
    for (int i = 0; i < steps; ++i) whole += lengthOf(i);
    std::array<ArchJoint, archHalfStones + 1> joints;
    double along = 0.0;
    int step = 0;
    for (int k = 0; k <= archHalfStones; ++k) {
        const double share = (k + 0.5) / (archHalfStones + 0.5);
        for (; step < steps && along < share * whole; ++step) along += lengthOf(step);
        const double x = archHalfSpan * step / steps;
        const double slope = 2.0 * archHeight * x / (archHalfSpan * archHalfSpan);
        const double t = 0.5 * (archCrown + share * (archFoot - archCrown));
        const Vec2T<double> outwards =
            k == archHalfStones ? Vec2T<double>{1.0, 0.0} : normalized(Vec2T<double>{slope, 1.0});
        const Vec2T<double> middle{x, k == archHalfStones ? 0.0 : heightAt(x)};
        joints[static_cast<std::size_t>(k)] = {middle - t * outwards, middle + t * outwards};
    }
    return joints;
}

/// Adds a stone with these corners, counter-clockwise, its body at their mean.
void addStone(Scene& scene, const std::array<Vec2T<double>, 4>& corners) {
    Vec2T<double> mean;
    for (const Vec2T<double>& corner : corners) mean += 0.25 * corner;
    std::array<Vec2, 4> local;
    for (std::size_t i = 0; i < 4; ++i) {
        local[i] = {static_cast<float>(corners[i].x - mean.x),
                    static_cast<float>(corners[i].y - mean.y)};
    }
    const Vec2 position{static_cast<float>(mean.x), static_cast<float>(mean.y)};
    add(scene, bodyOf(BodyType::Dynamic, position, ShapeDef::polygon(local)));
}

}  // namespace

Scene arch(Values) {
    Scene scene = awake();
    addFloor(scene, 50.0f);
    const auto joints = archJoints();
    const auto mirrored = [](Vec2T<double> p) { return Vec2T<double>{-p.x, p.y}; };
    for (std::size_t k = archHalfStones; k-- > 0;) {  // the left side, from the foot upwards
        const ArchJoint& up = joints[k];
        const ArchJoint& down = joints[k + 1];
        addStone(scene, {mirrored(up.outer), mirrored(down.outer), mirrored(down.inner),
                         mirrored(up.inner)});
    }
    const ArchJoint& crown = joints[0];
    addStone(scene, {mirrored(crown.inner), crown.inner, crown.outer, mirrored(crown.outer)});
    for (std::size_t k = 0; k < archHalfStones; ++k) {
        addStone(scene,
                 {joints[k].inner, joints[k + 1].inner, joints[k + 1].outer, joints[k].outer});
    }
    for (int i = 0; i < 4; ++i) {
        const Vec2 position{0.0f, static_cast<float>(crown.outer.y + 0.5 + i)};
        add(scene, bodyOf(BodyType::Dynamic, position, ShapeDef::box(2.0f, 0.5f)));
    }
    return scene;
}

namespace {

constexpr float cardHalf = 0.2f;       // m, of its length
constexpr float cardThin = 0.001f;     // m, half its thickness
constexpr float cardGap = 0.001f;      // m, between cards at the start
constexpr float cardLean = 25.0f;      // degrees from upright
constexpr float cardSpacing = 0.175f;  // m, from a leaning card to the next

BodyDef card(Vec2 position, float degrees) {
    ShapeDef shape = ShapeDef::box(cardThin, cardHalf);
    shape.material.friction = 0.7f;
    BodyDef body = bodyOf(BodyType::Dynamic, position, shape);
    body.rotation = rotationOf(static_cast<float>(pi / 180.0) * degrees);
    return body;
}

}  // namespace

/// Each level has a pair less than the one below, and lies on cards that join the pairs below it.
/// Those are longer than the pairs are apart, so every other one lies on its neighbours' ends.
Scene cardHouse(Values values) {
    const std::uint32_t levels = count(values[0]);
    const Rotation lean = rotationOf(static_cast<float>(pi / 180.0) * cardLean);
    const float halfHeight = cardHalf * lean.c + cardThin * lean.s;  // of a leaning card
    Scene scene = awake();
    addFloor(scene, 50.0f);
    float floor = 0.0f;
    for (std::uint32_t level = 0; level < levels; ++level) {
        const std::uint32_t pairs = levels - level;
        const float first = -cardSpacing * (static_cast<float>(pairs) - 0.5f);
        const float y = floor + cardGap + halfHeight;
        for (std::uint32_t pair = 0; pair < pairs; ++pair) {
            const float x = first + 2.0f * cardSpacing * static_cast<float>(pair);
            add(scene, card({x, y}, -cardLean));
            add(scene, card({x + cardSpacing, y}, cardLean));
        }
        const float low = y + halfHeight + cardGap + cardThin;
        const float high = low + cardGap + 2.0f * cardThin;
        for (std::uint32_t i = 0; i + 1 < pairs; ++i) {
            const float x = first + cardSpacing * (2.0f * static_cast<float>(i) + 1.5f);
            add(scene, card({x, i % 2 == 0 ? low : high}, 90.0f));
        }
        floor = high + cardThin;
    }
    return scene;
}

Scene dominoes(Values values) {
    const std::uint32_t dominoes = count(values[0]);
    Scene scene = awake();
    addFloor(scene, 2.0f * static_cast<float>(dominoes));
    for (std::uint32_t i = 0; i < dominoes; ++i) {
        add(scene,
            bodyOf(BodyType::Dynamic, {static_cast<float>(i), 0.5f}, ShapeDef::box(0.125f, 0.5f)));
    }
    return scene;
}

void dominoesHost(Values, std::uint64_t tick, std::vector<Action>& actions) {
    const BodyId first = 2;  // after the floor
    if (tick == 0) actions.emplace_back(ApplyImpulse{first, {0.2f, 0.0f}, {-0.125f, 1.0f}});
}

namespace {

/// A wall of 2 cm that stands on a floor, its middle at x = 0.
Scene thinWall() {
    Scene scene = awake();
    addFloor(scene, 50.0f);
    add(scene, bodyOf(BodyType::Static, {0.0f, 3.0f}, ShapeDef::box(0.01f, 3.0f)));
    return scene;
}

}  // namespace

Scene bullet(Values values) {
    Scene scene = thinWall();
    BodyDef disc = bodyOf(BodyType::Dynamic, {-10.0f, 2.0f}, ShapeDef::circle({}, 0.05f));
    disc.velocity = {static_cast<float>(values[0]), 0.0f};
    add(scene, disc);
    return scene;
}

Scene whirlingRod(Values values) {
    Scene scene = thinWall();
    const ShapeDef rod = ShapeDef::capsule({0.0f, -1.0f}, {0.0f, 1.0f}, 0.05f);
    BodyDef body = bodyOf(BodyType::Dynamic, {-0.6f, 3.0f}, rod);
    body.angularVelocity = static_cast<float>(values[0]);
    add(scene, body);
    return scene;
}

}  // namespace huestep::scenes
