// Prismatic joints: motion along the axis against closed forms, and none across it.

#include <algorithm>
#include <cmath>

#include "core/math/trig.h"
#include "tests/core/joint/jointed.h"

namespace huestep::test {
namespace {

constexpr float angle30 = 0.52359878f;

/// A disc of 1 kg at the origin on an axis that starts there, fixed in the world.
Scene onAxis(float angle, float gravity = -10.0f) {
    JointDef joint = hinge(0, {}, 1, {});
    joint.kind = JointKind::Prismatic;
    joint.axis = rotationOf(angle);
    BodyDef disc = discAt({});
    disc.shapes[0].density = static_cast<float>(1.0 / (0.25 * pi));
    Scene scene = sceneOf({BodyDef{}, disc}, {joint});
    scene.gravity = {0.0f, gravity};
    scene.sleep = false;
    return scene;
}

/// Where the disc is along the axis.
double along(const World& world, float angle) {
    const Vec2T<double> p = wide(motionOf(world, 2).position);
    return p.x * std::cos(wide(angle)) + p.y * std::sin(wide(angle));
}

TEST(Prismatic, ABodyOnASlopeOf30DegreesAcceleratesAtHalfOfGravity) {
    World world = worldOf(onAxis(-angle30));
    for (int tick = 1; tick <= 60; ++tick) {
        world.step({});
        const double t = tick / 60.0;
        ASSERT_NEAR(wide(length(motionOf(world, 2).velocity)), 5.0 * t, 1e-3) << tick;
        ASSERT_NEAR(along(world, -angle30), 2.5 * t * t, 1e-3) << tick;
        ASSERT_LT(errorOf(world), 2e-3) << tick;
        ASSERT_NEAR(angleOfBody(world, 2), 0.0, 1e-5) << "it keeps its angle";
    }
}

TEST(Prismatic, LimitsStopABodyAtBothEnds) {
    for (const float gravity : {-10.0f, 10.0f}) {
        Scene scene = onAxis(-angle30, gravity);
        scene.joints[0].limit = {true, -0.75f, 1.25f};
        World world = worldOf(scene);
        double least = 0.0, most = 0.0;
        for (int tick = 0; tick < 300; ++tick) {
            world.step({});
            least = std::min(least, along(world, -angle30));
            most = std::max(most, along(world, -angle30));
        }
        EXPECT_GT(least, -0.75 - 2e-3);
        EXPECT_LT(most, 1.25 + 2e-3);
        EXPECT_NEAR(along(world, -angle30), gravity < 0.0f ? 1.25 : -0.75, 1e-3);
        EXPECT_LT(wide(length(motionOf(world, 2).velocity)), 5.0 / 240.0) << "a substep's worth";
    }
}

TEST(Prismatic, AMotorLiftsAtItsSpeedIfItIsStrongEnough) {
    Scene scene = onAxis(0.5f * static_cast<float>(pi));
    // 10 N hold, 20 N lift: 1.5 m/s within 0.1 s. Bodies that nothing touches move by v − h a / 2.
    scene.joints[0].motor = {true, 1.5f, 30.0f};
    World strong = worldOf(scene);
    run(strong, 30);
    const double start = wide(motionOf(strong, 2).position.y);
    run(strong, 60);
    EXPECT_NEAR(wide(motionOf(strong, 2).position.y) - start, 1.5 + 5.0 / 240.0, 1e-3);
    EXPECT_NEAR(wide(motionOf(strong, 2).velocity.y), 1.5, 1e-3);
    scene.joints[0].motor.maxEffort = 6.0f;  // 4 m/s² downwards are left
    World weak = worldOf(scene);
    run(weak, 60);
    EXPECT_NEAR(wide(motionOf(weak, 2).velocity.y), -4.0, 0.01);
}

TEST(Prismatic, AMotorObeysItsCommand) {
    Scene scene = onAxis(0.0f);
    scene.joints[0].motor = {true, 1.0f, 1000.0f};
    World world = worldOf(scene);
    world.step(std::vector<Command>{{0, 1, SetMotor{1, true, -2.0f}}});
    EXPECT_EQ(world.events().commands[0].reason, Rejection::None);
    run(world, 30);
    EXPECT_NEAR(wide(motionOf(world, 2).velocity.x), -2.0, 1e-3);
    world.step(std::vector<Command>{{0, 2, SetMotor{1, false, 0.0f}}});
    run(world, 30);
    EXPECT_NEAR(wide(motionOf(world, 2).velocity.x), -2.0, 1e-3) << "it coasts";
}

TEST(Prismatic, ASpringSwingsAtItsFrequencyAboutItsLoad) {
    Scene scene = onAxis(0.5f * static_cast<float>(pi));
    scene.joints[0].spring = {true, 1.0f, 0.0f};
    scene.substeps = 16;
    World world = worldOf(scene);
    // The load stretches it by g / ω²; released at 0 it swings down to twice that, every second.
    const double stretch = 10.0 / (4.0 * pi * pi);
    run(world, 30);
    EXPECT_NEAR(wide(motionOf(world, 2).position.y), -2.0 * stretch, 0.02);
    run(world, 30);
    EXPECT_NEAR(wide(motionOf(world, 2).position.y), 0.0, 0.02);
}

TEST(Prismatic, ASideLoadAndItsMomentAreHeldUpToTheFloorOfSoftRows) {
    // A bar of 1 m held at its left end on a level axis: the rows across and of the angle under the
    // load λ are off by e = J M⁻¹ Jᵀ λ / ω² (physics page, 1); and higher by ½ h g over the rate of
    // correction, as in the test of the cantilever.
    JointDef joint = hinge(0, {}, 1, {-0.5f, 0.0f});
    joint.kind = JointKind::Prismatic;
    const BodyDef bar = bodyAt(BodyType::Dynamic, {0.5f, 0.0f}, ShapeDef::box(0.5f, 0.125f));
    Scene scene = sceneOf({BodyDef{}, bar}, {joint});
    scene.sleep = false;
    scene.substeps = 4;
    World world = worldOf(scene);
    run(world, 600);
    const double h = 1.0 / 240.0;
    const double omega = 2.0 * pi * 0.25 / h;
    const double damped = 2.0 + h * omega;
    const double rate = omega / damped * (1.0 - 1.0 / (1.0 + h * omega * damped));
    const double mass = 0.25, iB = 12.0 / (mass * 1.0625);
    const double force = mass * 10.0, moment = force * 0.5;
    const double floor = ((1.0 / mass + 0.25 * iB) * force - 0.5 * iB * moment) / (omega * omega);
    const double gap = floor - 5.0 * h / rate;
    const double turn = (iB * moment - 0.5 * iB * force) / (omega * omega);
    const BodyMotion m = motionOf(world, 2);
    const double anchor = wide(m.position.y) - 0.5 * std::sin(angleOfBody(world, 2));
    EXPECT_NEAR(-anchor, gap, 0.01 * std::abs(gap));
    EXPECT_NEAR(-angleOfBody(world, 2), turn, 1e-6);
    EXPECT_NEAR(wide(m.position.x), 0.5, 1e-3) << "and nothing pushes it along";
}

TEST(Prismatic, ABeadOnATurningRodMovesOutAsACosh) {
    // r'' = ω² r, so r = r0 cosh(ω t): the axis turns with body A.
    JointDef joint = hinge(0, {}, 1, {});
    joint.kind = JointKind::Prismatic;
    BodyDef rod;
    rod.type = BodyType::Kinematic;
    rod.angularVelocity = 2.0f;
    BodyDef bead = discAt({0.5f, 0.0f}, 0.1f);
    bead.velocity = {0.0f, 1.0f};
    bead.angularVelocity = 2.0f;
    Scene scene = sceneOf({rod, bead}, {joint});
    scene.gravity = {};
    scene.substeps = 16;
    World world = worldOf(scene);
    for (int tick = 1; tick <= 60; ++tick) {
        world.step({});
        ASSERT_LT(errorOf(world), 1e-3) << tick;
    }
    const double r = wide(length(motionOf(world, 2).position));
    EXPECT_NEAR(r / (0.5 * std::cosh(2.0)), 1.0, 0.01);
    EXPECT_NEAR(std::remainder(angleOfBody(world, 2) - 2.0, 2.0 * pi), 0.0, 1e-3);
}

TEST(Prismatic, TwoFreeBodiesKeepTheirMomentumAndTheirAngle) {
    Random random(110);
    SCOPED_TRACE(random.trace());
    for (int round = 0; round < 20; ++round) {
        JointDef joint = hinge(0, random.point(-0.5, 0.5), 1, random.point(-0.5, 0.5));
        joint.kind = JointKind::Prismatic;
        joint.axis = rotationOf(random.betweenF(-3.0, 3.0));
        joint.reference = rotationOf(random.betweenF(-3.0, 3.0));
        joint.limit = {true, -0.4f, 0.8f};
        joint.motor = {random.once(2), random.betweenF(-3.0, 3.0), 4.0f};
        joint.spring = {random.once(2), 2.0f, 0.1f};
        Scene scene = sceneOf({boxAt({}), discAt({})}, {joint});
        scene.gravity = {};
        scene.sleep = false;
        BodyDef& a = scene.bodies[0];
        BodyDef& b = scene.bodies[1];
        a.rotation = rotationOf(random.betweenF(-3.0, 3.0));
        b.rotation = compose(a.rotation, joint.reference);
        b.position = rotate(a.rotation, joint.anchorA) - rotate(b.rotation, joint.anchorB);
        a.velocity = random.point(-2.0, 2.0);
        b.velocity = random.point(-2.0, 2.0);
        a.angularVelocity = random.betweenF(-4.0, 4.0);
        World world = worldOf(scene);
        const auto momentum = [&](Vec2T<double>& linear) {
            double angular = 0.0;
            linear = {};
            for (std::size_t i = 0; i < 2; ++i) {
                const BodyMotion& m = world.motions()[i];
                const BodyInfo& info = world.bodies()[i];
                const Vec2T<double> p = wide(info.mass) * wide(m.velocity);
                linear += p;
                angular +=
                    cross(wide(m.position), p) + wide(info.inertia) * wide(m.angularVelocity);
            }
            return angular;
        };
        Vec2T<double> before, after;
        const double spinBefore = momentum(before);
        for (int tick = 0; tick < 240; ++tick) {
            world.step({});
            ASSERT_LT(errorOf(world), 0.03) << round << ", " << tick;
        }
        const double spinAfter = momentum(after);
        EXPECT_LT(length(after - before), 1e-4) << round;
        // The arm of A reaches to B's anchor, where the impulse acts: angular momentum drifts by
        // the rounding and by what positions move within a substep alone.
        EXPECT_NEAR(spinAfter, spinBefore, 0.02 * std::abs(spinBefore) + 0.02) << round;
    }
}

}  // namespace
}  // namespace huestep::test
