// The world as a value: copies, restores, accelerators, free flight, quarantine.

#include <cmath>

#include "core/math/finite.h"
#include "core/math/trig.h"
#include "tests/core/odd_worlds.h"

namespace huestep::test {
namespace {

TEST(World, ACopyGoesOnLikeItsOriginalAndTheyDoNotTouchEachOther) {
    World world = worldOf("mixed");
    run(world, 70);
    World copy = world;
    EXPECT_EQ(differenceOf(world, copy), "");
    EXPECT_EQ(world.fullRoot(), copy.fullRoot());
    const std::uint64_t root = world.fullRoot();
    for (int tick = 0; tick < 60; ++tick) copy.step({});
    EXPECT_EQ(world.fullRoot(), root);
    World assigned = worldOf("small");
    assigned = world;
    for (int tick = 0; tick < 60; ++tick) {
        world.step({});
        assigned.step({});
        ASSERT_EQ(world.fullRoot(), assigned.fullRoot());
    }
    EXPECT_EQ(world.fullRoot(), copy.fullRoot());
    const World moved = std::move(copy);
    EXPECT_EQ(world.fullRoot(), moved.fullRoot());
}

TEST(World, IsRefusedWithTheSentenceOfCheck) {
    Scene scene = sceneOf({boxAt({})});
    scene.bodies[0].shapes[0].radius = -1.0f;
    const Status fine = check(scene);
    const Result<World> world = World::create(scene);
    ASSERT_FALSE(fine.ok());
    ASSERT_FALSE(world.ok());
    EXPECT_EQ(world.error().message, fine.error().message);
}

TEST(World, CountsItsTicks) {
    World world = worldOf("small");
    EXPECT_EQ(world.tick(), 0u);
    run(world, 5);
    EXPECT_EQ(world.tick(), 5u);
    EXPECT_EQ(restored(world).tick(), 5u);
}

TEST(World, FreeFlightIsTheParabolaWhateverTheTickAndTheSubsteps) {
    for (const float seconds : {1.0f / 30.0f, 1.0f / 60.0f, 1.0f / 120.0f}) {
        for (const std::uint32_t substeps : {1u, 4u, 16u}) {
            Scene scene = sceneOf({discAt({})});
            scene.bodies[0].velocity = {3.0f, 4.0f};
            scene.bodies[0].angularVelocity = 2.0f;
            scene.stepSeconds = seconds;
            scene.substeps = substeps;
            World world = worldOf(scene);
            const int ticks = static_cast<int>(std::lround(1.0 / wide(seconds)));
            run(world, ticks);
            const double t = ticks * wide(seconds);
            const BodyMotion& m = world.motions()[0];
            EXPECT_NEAR(wide(m.position.x), 3.0 * t, 1e-5);
            EXPECT_NEAR(wide(m.position.y), 4.0 * t - 5.0 * t * t, 1e-5);
            EXPECT_NEAR(std::atan2(wide(m.rotation.s), wide(m.rotation.c)), 2.0 * t, 1e-5);
        }
    }
}

TEST(World, FreeFlightWithDampingFollowsItsClosedForm) {
    Scene scene = sceneOf({discAt({})});
    scene.gravity = {};
    scene.bodies[0].velocity = {8.0f, 0.0f};
    scene.bodies[0].linearDamping = 0.5f;
    World world = worldOf(scene);
    run(world, 60);
    // v/(1 + h c) a tick, by its own definition; e^(−ct) to first order in h.
    EXPECT_NEAR(wide(world.motions()[0].velocity.x), 8.0 * std::pow(1.0 + 0.5 / 60.0, -60.0), 1e-4);
    EXPECT_NEAR(wide(world.motions()[0].velocity.x), 8.0 * std::exp(-0.5), 0.02);
}

TEST(World, ABodyThatLeavesTheWorldIsStoppedReportedAndHarmsNobody) {
    BodyDef runaway = discAt({9.9e5f, 50.0f});
    runaway.velocity = {9.0e4f, 0.0f};
    Scene scene = sceneOf({ground(), boxAt({0.0f, 0.5f}), runaway});
    World world = worldOf(scene);
    World alone = worldOf(sceneOf({ground(), boxAt({0.0f, 0.5f})}));
    int quarantined = 0;
    for (int tick = 0; tick < 60; ++tick) {
        const Events& events = world.step({});
        alone.step({});
        for (const BodyId id : events.quarantined) {
            EXPECT_EQ(id, 3u);
            ++quarantined;
        }
        for (const BodyMotion& m : world.motions()) {
            ASSERT_TRUE(isFinite(m.position) && isFinite(m.velocity));
            ASSERT_LE(std::abs(wide(m.position.x)), 1.0e6);
        }
        EXPECT_EQ(motionOf(world, 2).position, motionOf(alone, 2).position);
    }
    EXPECT_GT(quarantined, 0);
    ASSERT_TRUE(World::restore(world.save()).ok());
}

TEST(World, ABodyPushedBeyondAllSpeedsIsQuarantinedAndTheStateStaysValid) {
    World world = worldOf(
        sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({0.0f, 1.5f}), boxAt({30.0f, 0.5f})}));
    run(world, 10);
    bool reported = false;
    for (std::uint64_t tick = 1; tick < 40; ++tick) {
        // Each for itself is allowed: 9e4 m/s in a tick for the box of 1 kg. Both are too much.
        const Vec2 point = motionOf(world, 3).position;
        const ApplyForce push{3, {5.4e6f, 0.0f}, point};
        const Events& events = world.step(
            std::vector<Command>{{0, 10 * tick, push},
                                 {0, 10 * tick + 1, push},
                                 {0, 10 * tick + 2, ApplyImpulse{3, {1.0e38f, 0.0f}, point}}});
        EXPECT_EQ(events.commands[0].reason, Rejection::None);
        EXPECT_EQ(events.commands[2].reason, Rejection::TooStrong);
        reported = reported || !events.quarantined.empty();
        const Result<World> copy = World::restore(world.save());
        ASSERT_TRUE(copy.ok()) << "tick " << tick << ": " << copy.error().message;
        EXPECT_NEAR(wide(motionOf(world, 4).position.x), 30.0, 1e-3) << "it harms nobody";
    }
    EXPECT_TRUE(reported);
}

TEST(World, TellsStageByStageHowLongAStepTook) {
    static std::uint64_t ticks = 0;
    const Clock clock = [] { return ++ticks; };
    World world = worldOf("small");
    world.step({}, {nullptr, Simd::Auto, clock});
    std::uint64_t sum = 0;
    for (const std::uint64_t t : world.report().nanoseconds) sum += t;
    EXPECT_GT(sum, 0u);
    world.step({});
    for (const std::uint64_t t : world.report().nanoseconds) EXPECT_EQ(t, 0u);
    for (std::size_t i = 0; i < static_cast<std::size_t>(Stage::Count); ++i) {
        EXPECT_NE(nameOf(static_cast<Stage>(i)), "unknown");
    }
}

TEST(World, DroppingAcceleratorsEveryTickChangesNothing) {
    World world = worldOf("mixed");
    World other = world;
    for (int tick = 0; tick < 150; ++tick) {
        other.dropAccelerators();
        world.step({});
        other.step({});
        ASSERT_EQ(differenceOf(world, other), "") << "tick " << tick;
        ASSERT_EQ(world.events(), other.events()) << "tick " << tick;
    }
}

TEST(World, WhereAllAreAsleepNobodyMovesAndNothingIsSolved) {
    World world = worldOf(allAsleep());
    const std::vector<BodyMotion> before(world.motions().begin(), world.motions().end());
    run(world, 30);
    EXPECT_EQ(world.report().awakeBodies, 0u);
    EXPECT_EQ(world.report().islands, 0u);
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_EQ(world.motions()[i].position, before[i].position);
    }
}

TEST(World, FarAwayAStackStandsAsItDoesAtTheOrigin) {
    World world = worldOf(movedBy(*sceneFromCatalog("stack:n=6"), {2.0e4f, 0.0f}));
    run(world, 600);
    for (std::size_t i = 1; i < world.bodies().size(); ++i) {
        const double dx = wide(world.motions()[i].position.x) - 2.0e4;
        EXPECT_LT(std::abs(dx), 0.05) << "box " << i;
        EXPECT_NEAR(wide(world.motions()[i].position.y), static_cast<double>(i) - 0.5, 0.02);
    }
}

}  // namespace
}  // namespace huestep::test
