// The descent against closed forms of backward Euler, and what it is known to carry and to lose.

#include "core/solver/avbd.h"

#include "core/math/trig.h"
#include "tests/core/joint/jointed.h"
#include "tests/core/solver/line_of_discs.h"

namespace huestep::test {
namespace {

constexpr double dt = 1.0 / 60.0;

World descending(Scene scene, std::uint32_t iterations) {
    scene.method = Method::Avbd;
    scene.substeps = iterations;
    scene.sleep = false;
    return worldOf(scene);
}

/// A disc of 1 kg at (1, 0) that a distance joint holds by its centre to the origin.
Scene heldByItsCentre(Vec2 velocity) {
    JointDef joint = hinge(0, {}, 1, {});
    joint.kind = JointKind::Distance;
    joint.length = 1.0f;
    BodyDef disc = discAt({1.0f, 0.0f});
    disc.shapes[0].density = static_cast<float>(1.0 / (0.25 * pi));
    disc.velocity = velocity;
    return sceneOf({BodyDef{}, disc}, {joint});
}

TEST(Avbd, TakesAPointMassOnARodToTheProjectionOnItsCircleAsBackwardEulerDoes) {
    for (const Vec2 velocity : {Vec2{0.0f, 0.0f}, Vec2{0.0f, 4.0f}, Vec2{0.0f, -9.0f}}) {
        World world = descending(heldByItsCentre(velocity), 64);
        world.step({});
        // Nearest point of the circle to where gravity and velocity alone lead.
        Vec2T<double> y{1.0 + dt * wide(velocity.x), dt * wide(velocity.y) - dt * dt * 10.0};
        y = (1.0 / length(y)) * y;
        const BodyMotion m = motionOf(world, 2);
        EXPECT_NEAR(wide(m.position.x), y.x, 1e-5);
        EXPECT_NEAR(wide(m.position.y), y.y, 1e-5);
        EXPECT_NEAR(wide(m.velocity.x), (y.x - 1.0) / dt, 2e-3);
        EXPECT_NEAR(wide(m.velocity.y), y.y / dt, 2e-3);
    }
}

TEST(Avbd, TakesASpringAsImplicitEulerDoes) {
    Scene scene = heldByItsCentre({0.7f, 0.0f});
    scene.gravity = {};
    scene.joints[0].length = 0.9f;
    scene.joints[0].spring = {true, 2.0f, 0.3f};
    World world = descending(scene, 2);
    double x = 0.1, v = wide(scene.bodies[1].velocity.x);
    const double omega = 2.0 * M_PI * 2.0, stiffness = omega * omega, damping = 2.0 * 0.3 * omega;
    for (int tick = 0; tick < 30; ++tick) {
        world.step({});
        v = (v - dt * stiffness * x) / (1.0 + dt * damping + dt * dt * stiffness);
        x += dt * v;
        ASSERT_NEAR(wide(motionOf(world, 2).position.x) - 0.9, x, 2e-5) << tick;
    }
}

// It turns past π, where an angle jumps.
TEST(Avbd, TurnsAMotorWithTheTorqueThatItHasAndNoFasterThanItShould) {
    JointDef axle = hinge(0, {}, 1, {});
    axle.motor = {true, 4.0f, 0.25f};
    Scene scene = heldByItsCentre({});
    scene.gravity = {};
    scene.bodies[1].position = {};
    scene.joints = {axle};
    World world = descending(scene, 24);
    const double inertia = wide(world.bodies()[1].inertia);
    for (int tick = 1; tick <= 240; ++tick) {
        world.step({});
        const double w = std::min(4.0, 0.25 / inertia * tick / 60.0);
        ASSERT_NEAR(wide(motionOf(world, 2).angularVelocity), w, 2e-3) << tick;
    }
}

TEST(Avbd, LetsDiscsOnALineMeetAsTheDenseProblemDoes) {
    Random random(701);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 10; ++trial) {
        const LineOfDiscs line = mixedLine(random);
        World world = descending(sceneOf(line), 64);
        world.step({});
        LineOfDiscs exact = line;
        exact.velocity =
            exactVelocities(line, [](double gap) { return gap > 0.0 ? -gap / dt : 0.0; });
        EXPECT_LT(distanceOf(world, exact), 5e-3);
    }
}

TEST(Avbd, CarriesAThousandKilogramsOnFiveBoxesOfOne) {
    for (const std::uint32_t iterations : {4u, 10u}) {
        Scene scene = sceneOf({ground()});
        for (int i = 0; i < 6; ++i) {
            scene.bodies.push_back(boxAt({0.0f, 0.5f + static_cast<float>(i)}));
        }
        scene.bodies.back().shapes[0].density = 1000.0f;
        World world = descending(scene, iterations);
        run(world, 600);
        const Measures m =
            measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions());
        EXPECT_LT(m.maxPenetration, 0.05) << iterations;
        for (BodyId id = 2; id <= 7; ++id) {
            EXPECT_LT(std::abs(motionOf(world, id).position.x), 0.1f) << iterations;
        }
        EXPECT_GT(motionOf(world, 7).position.y, 5.3f) << iterations;
    }
}

TEST(Avbd, LosesMostOfTheEnergyOfAPendulumInTenSeconds) {
    World world = descending(*sceneFromCatalog("pendulum:angle=90"), 10);
    const auto energyOf = [&] {
        return measure(world.info(), world.bodies(), world.shapes(), world.joints(),
                       world.motions())
            .energy;
    };
    const double start = energyOf(), scale = wide(world.bodies()[1].mass) * 10.0;
    run(world, 600);
    const double loss = (start - energyOf()) / scale;
    EXPECT_GT(loss, 0.6) << "backward Euler over 1/60 s";
    EXPECT_LT(loss, 1.0);
}

TEST(Avbd, HoldsEveryKindOfJointUnderGravity) {
    for (const JointKind kind :
         {JointKind::Revolute, JointKind::Distance, JointKind::Weld, JointKind::Prismatic}) {
        JointDef joint = hinge(0, {}, 1, {-1.0f, 0.0f});
        joint.kind = kind;
        joint.length = 0.5f;
        joint.limit = {kind == JointKind::Prismatic, -0.5f, 0.5f};
        const float x = kind == JointKind::Distance ? 1.5f : 1.0f;
        World world = descending(sceneOf({BodyDef{}, boxAt({x, 0.0f})}, {joint}), 10);
        double worst = 0.0;
        for (int tick = 0; tick < 180; ++tick) {
            world.step({});
            worst = std::max(worst, errorOf(world));
        }
        EXPECT_LT(worst, 0.02) << static_cast<int>(kind);
    }
}

TEST(Avbd, KeepsFrictionWithinItsCone) {
    // A box that slides: it stops after v²/(2 μ g).
    Scene scene = sceneOf({ground(), boxAt({0.0f, 0.5f})});
    scene.bodies[1].velocity = {3.0f, 0.0f};
    for (BodyDef& body : scene.bodies) body.shapes[0].material.friction = 0.5f;
    World world = descending(scene, 10);
    run(world, 120);
    EXPECT_NEAR(wide(motionOf(world, 2).position.x), 9.0 / (2.0 * 0.5 * 10.0), 0.05);
    EXPECT_NEAR(wide(motionOf(world, 2).velocity.x), 0.0, 1e-3);
}

}  // namespace
}  // namespace huestep::test
