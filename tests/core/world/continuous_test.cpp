// Fast bodies against what does not give way: none passes, and none that would miss is touched.

#include <algorithm>
#include <cmath>

#include "core/math/trig.h"
#include "tests/core/joint/jointed.h"

namespace huestep::test {
namespace {

/// A step rate and a number of substeps.
struct Effort {
    float stepSeconds;
    std::uint32_t substeps;
};

std::vector<Effort> efforts() {
    std::vector<Effort> all;
    for (const float hertz : {30.0f, 60.0f, 120.0f}) {
        for (const std::uint32_t substeps : {1u, 2u, 4u, 8u, 16u}) {
            all.push_back({1.0f / hertz, substeps});
        }
    }
    return all;
}

std::string textOf(const Effort& effort) {
    return "at " + std::to_string(1.0f / effort.stepSeconds) +
           " Hz, n = " + std::to_string(effort.substeps);
}

Scene weightless(std::vector<BodyDef> bodies, const Effort& effort) {
    Scene scene = sceneOf(std::move(bodies));
    scene.gravity = {};
    scene.stepSeconds = effort.stepSeconds;
    scene.substeps = effort.substeps;
    return scene;
}

int ticksOf(const Effort& effort, double seconds) {
    return static_cast<int>(seconds / wide(effort.stepSeconds));
}

/// Walls around x = 0, 2 cm thick or none, from y = −half to half.
std::vector<ShapeDef> walls(float half) {
    return {ShapeDef::box(0.01f, half), ShapeDef::segment({0.0f, -half}, {0.0f, half}),
            ShapeDef::capsule({0.0f, -half}, {0.0f, half}, 0.01f)};
}

// Physics page, row 26.
TEST(Continuous, AFastDiscPassesNoWallFromEitherSideOrAtAnyAngle) {
    for (const Effort& effort : efforts()) {
        for (const ShapeDef& wall : walls(40.0f)) {
            for (const float side : {-1.0f, 1.0f}) {
                for (const float slope : {0.0f, 1.0f, 8.0f}) {
                    for (const float origin : {0.0f, 10'000.0f}) {
                        const Vec2 at{origin, -origin};
                        BodyDef disc = discAt(at + Vec2{5.1f * side, -0.5f * slope}, 0.1f);
                        const float x = -side * 200.0f / std::sqrt(1.0f + slope * slope);
                        disc.velocity = {x, slope * (x < 0.0f ? -x : x) * 0.1f};
                        World world =
                            worldOf(weightless({bodyAt(BodyType::Static, at, wall), disc}, effort));
                        const double before = wide(lengthSquared(disc.velocity));
                        for (int tick = 0; tick < ticksOf(effort, 0.5); ++tick) {
                            world.step({});
                            const BodyMotion motion = motionOf(world, 2);
                            const Vec2 p = motion.position - at;
                            ASSERT_GT(p.x * side, 0.0f)
                                << textOf(effort) << ", slope " << slope << ", origin " << origin
                                << ", tick " << tick;
                            ASSERT_LE(wide(lengthSquared(motion.velocity)), before * 1.0001);
                        }
                    }
                }
            }
        }
    }
}

TEST(Continuous, AFastBoxPassesNoWallHoweverItTurns) {
    Random random(31);
    SCOPED_TRACE(random.trace());
    for (const Effort& effort : efforts()) {
        for (const ShapeDef& wall : walls(40.0f)) {
            for (int trial = 0; trial < 4; ++trial) {
                BodyDef box = bodyAt(
                    BodyType::Dynamic, {-random.betweenF(1.0, 4.0), random.betweenF(-3.0, 3.0)},
                    ShapeDef::box(random.betweenF(0.05, 0.3), random.betweenF(0.05, 0.3)));
                box.rotation = rotationOf(random.betweenF(-3.0, 3.0));
                box.velocity = {random.betweenF(20.0, 150.0), random.betweenF(-50.0, 50.0)};
                box.angularVelocity = random.betweenF(-40.0, 40.0);
                World world =
                    worldOf(weightless({bodyAt(BodyType::Static, {}, wall), box}, effort));
                for (int tick = 0; tick < ticksOf(effort, 0.4); ++tick) {
                    world.step({});
                    ASSERT_LT(motionOf(world, 2).position.x, 0.0f)
                        << textOf(effort) << ", trial " << trial << ", tick " << tick;
                }
            }
        }
    }
}

// Physics page, row 26: the tip of the rod goes 0.42 m a tick at 60 Hz.
TEST(Continuous, ASpinningRodPassesNoWall) {
    for (const Effort& effort : efforts()) {
        for (const ShapeDef& wall : walls(3.0f)) {
            for (const bool capsule : {false, true}) {
                const ShapeDef rod = capsule ? ShapeDef::capsule({-0.5f, 0.0f}, {0.5f, 0.0f}, 0.02f)
                                             : ShapeDef::box(0.5f, 0.02f);
                BodyDef body = bodyAt(BodyType::Dynamic, {-0.3f, 0.0f}, rod);
                body.rotation = rotationOf(1.5707963f);
                body.angularVelocity = 50.0f;
                World world =
                    worldOf(weightless({bodyAt(BodyType::Static, {}, wall), body}, effort));
                const auto tipsBeyond = [&] {
                    const BodyMotion m = motionOf(world, 2);
                    const Vec2 arm = rotate(m.rotation, Vec2{0.5f, 0.0f});
                    return maxOf((m.position + arm).x, (m.position - arm).x);
                };
                const double before = 50.0 * 50.0 / wide(world.bodies()[1].inverseInertia);
                for (int tick = 0; tick < ticksOf(effort, 0.5); ++tick) {
                    world.step({});
                    ASSERT_LT(tipsBeyond(), 0.02f)
                        << textOf(effort) << (capsule ? " capsule" : " box") << ", tick " << tick;
                    const BodyMotion m = motionOf(world, 2);
                    const double energy =
                        wide(lengthSquared(m.velocity)) / wide(world.bodies()[1].inverseMass) +
                        wide(m.angularVelocity * m.angularVelocity) /
                            wide(world.bodies()[1].inverseInertia);
                    ASSERT_LE(energy, before * 1.001) << textOf(effort);
                }
            }
        }
    }
}

TEST(Continuous, AFastDiscPassesNoWallThatMoves) {
    for (const Effort& effort : efforts()) {
        for (const float speed : {-10.0f, 2.0f, 10.0f}) {
            for (const ShapeDef& shape : walls(5.0f)) {
                BodyDef wall = bodyAt(BodyType::Kinematic, {}, shape);
                wall.velocity = {speed, 0.0f};
                BodyDef disc = discAt({-3.0f, 0.0f}, 0.1f);
                disc.velocity = {200.0f, 0.0f};
                World world = worldOf(weightless({wall, disc}, effort));
                for (int tick = 0; tick < ticksOf(effort, 0.5); ++tick) {
                    world.step({});
                    ASSERT_LT(motionOf(world, 2).position.x, motionOf(world, 1).position.x)
                        << textOf(effort) << ", wall at " << speed << " m/s, tick " << tick;
                }
                EXPECT_NEAR(wide(motionOf(world, 2).velocity.x), wide(speed), 0.1)
                    << textOf(effort);
            }
        }
    }
}

TEST(Continuous, AFastDiscThatMissesAWallIsNotTouched) {
    for (const Effort& effort : efforts()) {
        for (const float gap : {0.05f, 0.025f}) {
            const BodyDef wall =
                bodyAt(BodyType::Static, {4.0f, -1.0f - 0.1f - gap}, ShapeDef::box(0.01f, 1.0f));
            const BodyDef above =
                bodyAt(BodyType::Static, {6.0f, 1.0f + 0.1f + gap}, ShapeDef::box(0.01f, 1.0f));
            BodyDef disc = discAt({}, 0.1f);
            disc.velocity = {200.0f, 0.0f};
            World world = worldOf(weightless({wall, above, disc}, effort));
            for (int tick = 0; tick < ticksOf(effort, 0.1); ++tick) {
                const Events& events = world.step({});
                ASSERT_TRUE(events.hits.empty() && events.begins.empty());
            }
            EXPECT_EQ(motionOf(world, 3).velocity, (Vec2{200.0f, 0.0f})) << textOf(effort);
            EXPECT_NEAR(wide(motionOf(world, 3).position.x),
                        200.0 * wide(effort.stepSeconds) * ticksOf(effort, 0.1), 1e-2);
        }
    }
}

TEST(Continuous, ABoxSlidesFastOverAFloorOfManyBoxesWithoutCatching) {
    std::vector<ShapeDef> floor;
    for (int i = 0; i < 200; ++i) {
        floor.push_back(ShapeDef::box(0.25f, 0.25f, {0.5f * static_cast<float>(i), -0.25f}));
    }
    for (ShapeDef& shape : floor) shape.material.friction = 0.0f;
    for (const Effort& effort : efforts()) {
        BodyDef ground;
        ground.shapes = floor;
        BodyDef box = boxAt({1.0f, 0.1f}, 0.1f);
        box.shapes[0].material.friction = 0.0f;
        box.velocity = {30.0f, 0.0f};
        Scene scene = weightless({ground, box}, effort);
        scene.gravity = {0.0f, -10.0f};
        World world = worldOf(scene);
        run(world, ticksOf(effort, 1.0));
        const BodyMotion motion = motionOf(world, 2);
        EXPECT_NEAR(wide(motion.velocity.x), 30.0, 0.01) << textOf(effort);
        EXPECT_NEAR(wide(motion.position.x), 31.0, 1.1) << textOf(effort);
        EXPECT_NEAR(wide(motion.position.y), 0.1, effort.substeps == 1 ? 0.02 : 0.005)
            << textOf(effort);
    }
}

TEST(Continuous, AFallGainsNoEnergyWhereItIsStopped) {
    for (const Effort& effort : efforts()) {
        for (const float restitution : {0.0f, 0.8f}) {
            BodyDef ground =
                bodyAt(BodyType::Static, {}, ShapeDef::segment({-9.0f, 0.0f}, {9.0f, 0.0f}));
            BodyDef disc = discAt({0.0f, 30.0f}, 0.05f);
            disc.shapes[0].material.restitution = restitution;
            Scene scene = weightless({ground, disc}, effort);
            scene.gravity = {0.0f, -10.0f};
            World world = worldOf(scene);
            double highest = 10.0 * 30.0;
            for (int tick = 0; tick < ticksOf(effort, 20.0); ++tick) {
                world.step({});
                const BodyMotion m = motionOf(world, 2);
                const double energy =
                    0.5 * wide(lengthSquared(m.velocity)) + 10.0 * wide(m.position.y);
                ASSERT_LE(energy, highest * 1.0001) << textOf(effort) << ", tick " << tick;
            }
        }
    }
}

TEST(Continuous, AFastBodyComesThroughAChainFromBehindAlone) {
    for (const bool front : {true, false}) {
        // Its front is to the right of its direction: up.
        const std::vector<Vec2> points{{9.0f, 0.0f}, {3.0f, 0.0f}, {-3.0f, 0.0f}, {-9.0f, 0.0f}};
        BodyDef chain;
        chain.shapes = {ShapeDef::chainSegment(points[0], points[1], points[2], points[3])};
        BodyDef disc = discAt({0.5f, front ? 2.0f : -2.0f}, 0.1f);
        disc.velocity = {0.0f, front ? -100.0f : 100.0f};
        World world = worldOf(weightless({chain, disc}, {1.0f / 60.0f, 4}));
        run(world, 30);
        EXPECT_GT(motionOf(world, 2).position.y, 0.0f);
    }
}

TEST(Continuous, AWheelSpinsOnTheSpotAsFastAsItLikes) {
    BodyDef wheel = discAt({0.0f, 0.299f}, 0.3f);
    wheel.angularVelocity = 3000.0f;
    wheel.shapes[0].material.friction = 0.0f;
    wheel.velocity = {5.0f, 0.0f};
    Scene scene = weightless({ground(), wheel}, {1.0f / 60.0f, 4});
    scene.gravity = {0.0f, -10.0f};
    World world = worldOf(scene);
    run(world, 60);
    EXPECT_EQ(motionOf(world, 2).angularVelocity, 3000.0f);
    EXPECT_NEAR(wide(motionOf(world, 2).position.x), 5.0, 1e-3);
}

TEST(Continuous, NobodyLeavesTheSpinnersRoomHoweverHardTheBarHits) {
    World world = worldOf("spinner:bodies=500");
    double fastest = 0.0;
    for (int tick = 0; tick < 300; ++tick) {
        world.step({});
        for (std::size_t i = 2; i < world.bodies().size(); ++i) {
            const BodyMotion& motion = world.motions()[i];
            ASSERT_LT(length(motion.position - Vec2{0.0f, 32.0f}), 40.0f)
                << "tick " << tick << ", body " << world.bodies()[i].id;
            fastest = std::max(fastest, wide(length(motion.velocity)));
        }
    }
    EXPECT_GT(fastest, 100.0) << "m/s, more than a body's width a tick";
}

TEST(Continuous, FiltersLetFastBodiesThrough) {
    BodyDef wall = bodyAt(BodyType::Static, {}, ShapeDef::box(0.01f, 5.0f));
    BodyDef disc = discAt({-3.0f, 0.0f}, 0.1f);
    disc.velocity = {200.0f, 0.0f};
    wall.shapes[0].filter.group = disc.shapes[0].filter.group = -3;
    World world = worldOf(weightless({wall, disc}, {1.0f / 60.0f, 4}));
    run(world, 4);
    EXPECT_NEAR(wide(motionOf(world, 2).position.x), -3.0 + 200.0 * 4.0 / 60.0, 1e-3);
}

TEST(Continuous, StopsBodiesOnJointsTogetherSoThatTheirJointsStayClosed) {
    for (const Effort& effort : efforts()) {
        SCOPED_TRACE(textOf(effort));
        // Four discs on hinges, one above the other, fall on a wall; joints are closed throughout.
        std::vector<BodyDef> bodies{
            bodyAt(BodyType::Static, {0.0f, -1.0f}, ShapeDef::box(5.0f, 1.0f))};
        std::vector<JointDef> joints;
        for (int i = 0; i < 4; ++i) {
            bodies.push_back(discAt({0.0f, 0.9f + 0.5f * static_cast<float>(i)}, 0.2f));
            bodies.back().velocity = {0.0f, -60.0f};
            if (i == 0) continue;
            const auto body = static_cast<std::uint32_t>(i);
            joints.push_back(hinge(body, {0.0f, 0.25f}, body + 1, {0.0f, -0.25f}));
        }
        Scene scene = weightless(std::move(bodies), effort);
        scene.joints = std::move(joints);
        World world = worldOf(scene);
        bool met = false;
        for (int tick = 0; tick < 3 && !met; ++tick) {
            run(world, 1);
            // The step in which the lowest one meets the wall, and only the stage knows of it.
            met = motionOf(world, 2).position.y < 0.25f;
            ASSERT_LT(errorOf(world), 0.001) << "tick " << tick;
        }
        EXPECT_TRUE(met);
        EXPECT_GT(motionOf(world, 2).position.y, 0.1f);
    }
}

TEST(Continuous, GivesNoSpeedBackThatABodyOnAFloorNeverGained) {
    Scene scene =
        sceneOf({ground(), bodyAt(BodyType::Static, {3.0f, 0.0f}, ShapeDef::box(0.1f, 2.0f)),
                 discAt({0.0f, 0.1f}, 0.1f)});
    for (BodyDef& body : scene.bodies) body.shapes[0].material.friction = 0.0f;
    scene.bodies[2].velocity = {30.0f, 0.0f};
    World world = worldOf(scene);
    double most = 0.0;
    for (int tick = 0; tick < 12; ++tick) {
        run(world, 1);
        most = std::max(most, wide(motionOf(world, 3).velocity.y));
    }
    EXPECT_LT(wide(motionOf(world, 3).position.x), 2.9) << "the wall is there";
    EXPECT_LT(most, 0.02);
}

TEST(Continuous, LeavesNobodyBehindAWallThatGoesOnWhoseNeighbourStoppedEarlier) {
    // Two on a hinge fall fast; the floor stops the one, a thin wall from the side meets the other.
    std::vector<BodyDef> bodies{
        bodyAt(BodyType::Static, {0.0f, -1.0f}, ShapeDef::box(1.0f, 1.0f)),
        bodyAt(BodyType::Kinematic, {2.0f, 0.0f}, ShapeDef::box(0.01f, 3.0f)),
        discAt({0.0f, 0.35f}, 0.2f), discAt({1.5f, 0.35f}, 0.2f)};
    bodies[1].velocity = {-50.0f, 0.0f};
    bodies[2].velocity = bodies[3].velocity = {0.0f, -60.0f};
    Scene scene = weightless(std::move(bodies), {1.0f / 60.0f, 4});
    scene.joints = {hinge(2, {0.75f, 0.0f}, 3, {-0.75f, 0.0f})};
    World world = worldOf(scene);
    run(world, 1);
    EXPECT_LT(motionOf(world, 4).position.x, motionOf(world, 2).position.x);
}

TEST(Continuous, FindsAWallThatTurnsRoundOnceAStep) {
    std::vector<BodyDef> bodies{bodyAt(BodyType::Kinematic, {}, ShapeDef::box(2.0f, 0.05f)),
                                discAt({-6.0f, 1.0f}, 0.05f)};
    bodies[0].angularVelocity = static_cast<float>(2.0 * pi * 60.0);
    bodies[1].velocity = {720.0f, 0.0f};
    World world = worldOf(weightless(std::move(bodies), {1.0f / 60.0f, 4}));
    run(world, 1);
    // Whatever it meets, it does not fly by as if nothing were there.
    EXPECT_LT(wide(motionOf(world, 2).position.x), 5.0);
}

}  // namespace
}  // namespace huestep::test
