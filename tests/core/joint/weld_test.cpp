// Welds: the floor law of soft rows, rigid bodies as their model, springs of the angle.

#include <array>
#include <cmath>
#include <numbers>

#include "core/math/trig.h"
#include "tests/core/joint/jointed.h"

namespace huestep::test {
namespace {

JointDef weld(std::uint32_t a, Vec2 anchorA, std::uint32_t b, Vec2 anchorB) {
    JointDef joint = hinge(a, anchorA, b, anchorB);
    joint.kind = JointKind::Weld;
    return joint;
}

/// Boxes of 1 m by 0.25 m, welded end to end to a wall at the origin, to the right.
Scene cantilever(std::uint32_t beams) {
    Scene scene = sceneOf({BodyDef{}});
    for (std::uint32_t i = 0; i < beams; ++i) {
        scene.bodies.push_back(bodyAt(BodyType::Dynamic, {0.5f + static_cast<float>(i), 0.0f},
                                      ShapeDef::box(0.5f, 0.125f)));
        scene.joints.push_back(weld(i, {i == 0 ? 0.0f : 0.5f, 0.0f}, i + 1, {-0.5f, 0.0f}));
    }
    scene.sleep = false;
    return scene;
}

TEST(Weld, ACantileverDroopsByTheFloorOfSoftRowsAndNoMore) {
    // At rest a block of soft rows of angular frequency ω under the load λ is off by
    // e = J M⁻¹ Jᵀ λ / ω² (physics page, 1): here for the rows y and angle of each weld, whose load
    // is the weight of all beams beyond it and its moment. Bodies that nothing touches move by
    // v − h a / 2, so that their parabolas are exact; so the first weld stands higher by that speed
    // over its rate of correction, ω / (2 ζ + h ω) times 1 − 1 / (1 + h ω (2 ζ + h ω)), ζ = 1.
    constexpr std::uint32_t beams = 4;
    World world = worldOf(cantilever(beams));
    run(world, 1200);
    const double h = 1.0 / 240.0;
    const double omega = 2.0 * std::numbers::pi * 0.25 / h;
    const double damped = 2.0 + h * omega;
    const double rate = omega / damped * (1.0 - 1.0 / (1.0 + h * omega * damped));
    const double mass = 0.25, g = 10.0;
    const double inertia = mass * (1.0 + 0.0625) / 12.0;
    double droop = -0.5 * h * g / rate, tilt = 0.0;
    for (std::uint32_t i = 0; i < beams; ++i) {
        const double beyond = beams - i;
        const double force = mass * g * beyond;
        const double moment = mass * g * 0.5 * beyond * beyond;  // arms ½, 1 ½, …
        // Rows against (y, w) of A and of B; anchors half a metre right of A, left of B.
        const double mA = i == 0 ? 0.0 : 1.0 / mass, iA = i == 0 ? 0.0 : 1.0 / inertia;
        const double mB = 1.0 / mass, iB = 1.0 / inertia;
        const double kyy = mA + mB + 0.25 * (iA + iB);
        const double kya = iA * 0.5 - iB * 0.5;
        const double kaa = iA + iB;
        const double gap = (kyy * force + kya * moment) / (omega * omega);
        const double turn = (kya * force + kaa * moment) / (omega * omega);
        tilt += turn;
        droop += gap + 0.5 * tilt;
        EXPECT_NEAR(-angleOfBody(world, i + 2) / tilt, 1.0, 0.01) << "beam " << i;
        EXPECT_NEAR(-wide(motionOf(world, i + 2).position.y) / droop, 1.0, 0.03) << "beam " << i;
        droop += 0.5 * tilt;
    }
    EXPECT_LT(droop, 0.05) << "5 cm at the end of 4 m";
    EXPECT_LT(wide(length(motionOf(world, 5).velocity)), g * h) << "at rest";
}

TEST(Weld, HoldsTheReferenceAngleBetweenTurnedBodies) {
    JointDef joint = weld(0, {1.0f, 0.0f}, 1, {0.0f, -0.5f});
    joint.reference = rotationOf(2.5f);
    Scene scene = sceneOf({boxAt({}), boxAt({})}, {joint});
    scene.bodies[0].rotation = rotationOf(1.0f);
    scene.bodies[1].rotation = rotationOf(3.45f);  // off by 0.05
    scene.bodies[1].position = rotate(scene.bodies[0].rotation, joint.anchorA) -
                               rotate(scene.bodies[1].rotation, joint.anchorB);
    scene.gravity = {};
    EXPECT_NEAR(errorOf(worldOf(scene)), 0.5 * 2.0 * std::sin(0.025), 1e-6);
    World world = worldOf(scene);
    run(world, 240);
    const double angle = angleOfBody(world, 2) - angleOfBody(world, 1);
    EXPECT_NEAR(std::remainder(angle - 2.5, 2.0 * std::numbers::pi), 0.0, 1e-4);
    EXPECT_LT(errorOf(world), 1e-4);
}

TEST(Weld, BodiesFlyAsOneBodyOfTheSameShapesDoes) {
    Scene apart =
        sceneOf({boxAt({}, 0.4f), boxAt({1.0f, 0.0f}, 0.4f), boxAt({1.0f, 1.0f}, 0.4f)},
                {weld(0, {0.5f, 0.0f}, 1, {-0.5f, 0.0f}), weld(1, {0.0f, 0.5f}, 2, {0.0f, -0.5f})});
    Scene whole = sceneOf({boxAt({})});
    whole.bodies[0].shapes = {ShapeDef::box(0.4f, 0.4f), ShapeDef::box(0.4f, 0.4f, {1.0f, 0.0f}),
                              ShapeDef::box(0.4f, 0.4f, {1.0f, 1.0f})};
    // About the common centre (2/3, 1/3), at 3 rad/s.
    const float w = 3.0f;
    const Vec2 center{2.0f / 3.0f, 1.0f / 3.0f};
    for (BodyDef& body : apart.bodies) {
        body.velocity = crossScalar(w, body.position - center);
        body.angularVelocity = w;
    }
    whole.bodies[0].angularVelocity = w;
    for (Scene* scene : {&apart, &whole}) scene->gravity = {};
    World parts = worldOf(apart);
    World one = worldOf(whole);
    for (int tick = 1; tick <= 120; ++tick) {
        parts.step({});
        one.step({});
        ASSERT_LT(errorOf(parts), 2e-3) << tick;
    }
    EXPECT_NEAR(wide(motionOf(parts, 1).angularVelocity), 3.0, 3e-3);
    const double phase = angleOfBody(parts, 1) - angleOfBody(one, 1);
    EXPECT_NEAR(std::remainder(phase, 2.0 * std::numbers::pi), 0.0, 0.02);
}

TEST(Weld, WithASpringSwingsAtItsFrequencyAndKeepsItsPointRigid) {
    JointDef joint = weld(0, {}, 1, {});
    joint.spring = {true, 1.0f, 0.0f};
    Scene scene = sceneOf({BodyDef{}, discAt({})}, {joint});
    scene.bodies[1].rotation = rotationOf(0.3f);
    scene.gravity = {0.0f, -10.0f};
    scene.substeps = 16;
    scene.sleep = false;
    World world = worldOf(scene);
    std::vector<double> passages;
    double last = angleOfBody(world, 2);
    for (int tick = 1; tick <= 150; ++tick) {
        world.step({});
        const double now = angleOfBody(world, 2);
        if ((now < 0.0) != (last < 0.0)) passages.push_back((tick - now / (now - last)) / 60.0);
        last = now;
        ASSERT_LT(errorOf(world), 1e-3) << tick;
    }
    ASSERT_GE(passages.size(), 3u);
    const double halves = static_cast<double>(passages.size() - 1);
    EXPECT_NEAR(2.0 * (passages.back() - passages.front()) / halves, 1.0, 0.02);
}

TEST(Weld, ConservesMomentumBothWaysInFreeSpace) {
    Random random(109);
    SCOPED_TRACE(random.trace());
    Scene scene;
    scene.gravity = {};
    scene.sleep = false;
    for (std::uint32_t i = 0; i < 8; ++i) {
        BodyDef body = discAt({1.1f * static_cast<float>(i), random.betweenF(-0.2, 0.2)},
                              random.betweenF(0.2, 0.4));
        body.velocity = random.point(-2.0, 2.0);
        body.angularVelocity = random.betweenF(-3.0, 3.0);
        scene.bodies.push_back(body);
        if (i == 0) continue;
        scene.joints.push_back(weld(i - 1, {0.55f, 0.0f}, i, {-0.55f, 0.0f}));
        if (i % 3 == 0) scene.joints.back().spring = {true, 3.0f, 0.2f};
    }
    World world = worldOf(scene);
    const auto momenta = [&] {
        std::array<double, 3> sum{};
        for (std::size_t i = 0; i < world.bodies().size(); ++i) {
            const Vec2T<double> p =
                wide(world.bodies()[i].mass) * wide(world.motions()[i].velocity);
            sum[0] += p.x;
            sum[1] += p.y;
            sum[2] += cross(wide(world.motions()[i].position), p) +
                      wide(world.bodies()[i].inertia) * wide(world.motions()[i].angularVelocity);
        }
        return sum;
    };
    // Anchors that are apart push as a couple: they start where they coincide but for the offsets.
    run(world, 120);
    const std::array<double, 3> before = momenta();
    run(world, 240);
    const std::array<double, 3> after = momenta();
    EXPECT_NEAR(after[0], before[0], 1e-4);
    EXPECT_NEAR(after[1], before[1], 1e-4);
    EXPECT_NEAR(after[2], before[2], 2e-2 * std::abs(before[2]) + 1e-3);
}

TEST(Weld, TakesNoMotorCommand) {
    World world = worldOf(cantilever(1));
    world.step(std::vector<Command>{{0, 1, SetMotor{1, true, 1.0f}}});
    EXPECT_EQ(world.events().commands[0].reason, Rejection::NoMotor);
}

}  // namespace
}  // namespace huestep::test
