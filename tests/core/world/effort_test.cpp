// Effort by need in whole worlds: who gets how many substeps, and that nothing jumps on the way.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/scene/measure.h"
#include "core/solver/effort.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

/// Boxes of a metre upon each other at x, the topmost of `density`.
void pile(Scene& scene, float x, int boxes, float density) {
    for (int i = 0; i < boxes; ++i) {
        scene.bodies.push_back(boxAt({x, 0.5f + static_cast<float>(i)}));
        if (i + 1 == boxes) scene.bodies.back().shapes[0].density = density;
    }
}

Scene twoPiles() {
    Scene scene = sceneOf({ground()});
    scene.sleep = false;
    pile(scene, -5.0f, 2, 1.0f);
    pile(scene, 5.0f, 2, 100.0f);
    return scene;
}

std::uint32_t substepsOfIslandOf(const World& world, BodyId body) {
    for (const IslandView& island : world.stepLayout().islands) {
        if (island.body == body) return island.substeps;
    }
    return 0;
}

double penetrationOf(const World& world) {
    return measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions())
        .maxPenetration;
}

/// What holds the body up from below, N.
double supportOf(const World& world, std::uint32_t shape) {
    double impulse = 0.0;
    for (const ContactState& contact : world.contacts()) {
        if (contact.shapeB != shape) continue;
        impulse += wide(contact.normalImpulse[0]) + wide(contact.normalImpulse[1]);
    }
    const std::uint8_t level = levelOf(world.motions()[shape - 1].effort);
    return impulse * substepsOf(level) / wide(world.info().stepSeconds);
}

TEST(WorldEffort, EachIslandGetsTheSubstepsThatItsNeedAsksFor) {
    World world = worldOf(twoPiles());
    run(world, 120);
    EXPECT_EQ(substepsOfIslandOf(world, 2), 2u) << "two boxes at rest: fewer than the standard";
    EXPECT_GE(substepsOfIslandOf(world, 4), 8u) << "a hundred times its mass on a box";
    EXPECT_LT(penetrationOf(world), 0.01) << "visual: 1 % of a box";
    EXPECT_EQ(world.report().tooStiff.islands, 0u);
}

TEST(WorldEffort, ImpulsesAreThoseOfTheSubstepsThatTheStateSays) {
    World world = worldOf(twoPiles());
    for (int tick = 0; tick < 240; ++tick) {
        world.step({});
        if (tick < 60) continue;
        // Two boxes of 1 kg, 1 + 100 kg, g = 10: whatever the levels are and have been.
        ASSERT_NEAR(supportOf(world, 2), 20.0, 0.2) << tick;
        ASSERT_NEAR(supportOf(world, 4), 1010.0, 10.0) << tick;
    }
}

TEST(WorldEffort, IslandsThatMergeTakeTheHigherLevelAndKeepTheirForces) {
    Scene scene = twoPiles();
    World world = worldOf(scene);
    run(world, 120);
    const std::uint8_t high = levelOf(motionOf(world, 4).effort);
    ASSERT_LT(levelOf(motionOf(world, 2).effort), high);
    // A plank lands on both piles and makes one island of them.
    BodyDef plank = bodyAt(BodyType::Dynamic, {0.0f, 2.3f}, ShapeDef::box(6.5f, 0.25f));
    plank.shapes[0].density = 0.1f;
    const std::vector<Command> spawn{{0, 1, Spawn{{plank}, {}}}};
    world.step(spawn);
    run(world, 45);
    ASSERT_EQ(world.stepLayout().islands.size(), 1u);
    EXPECT_GE(levelOf(motionOf(world, 2).effort), standardEffort);
    EXPECT_EQ(motionOf(world, 2).effort, motionOf(world, 4).effort);
    run(world, 60);
    const double half = 0.5 * 0.1 * 13.0 * 0.5 * 10.0;  // N, of the plank's weight
    EXPECT_NEAR(supportOf(world, 2), 20.0 + half, 0.5);
    EXPECT_NEAR(supportOf(world, 4), 1010.0 + half, 10.0);
}

TEST(WorldEffort, ATighterNeedOfTheSceneTakesMoreSubstepsAndIsMet) {
    Scene scene = sceneOf({ground()});
    scene.sleep = false;
    pile(scene, 0.0f, 8, 1.0f);
    World visual = worldOf(scene);
    scene.need.penetration = 0.0005f;
    World tight = worldOf(scene);
    run(visual, 180);
    run(tight, 180);
    EXPECT_GT(substepsOfIslandOf(tight, 2), substepsOfIslandOf(visual, 2));
    EXPECT_LT(penetrationOf(visual), 0.01);
    EXPECT_LT(penetrationOf(tight), 0.0005);
}

TEST(WorldEffort, OfAChainAtRestIsOneSubstepAndOfOneThatSwingsTheStandard) {
    World world = worldOf("chain:ratio=100");
    run(world, 120);
    EXPECT_EQ(world.stepLayout().islands.at(0).substeps, 1u);
    EXPECT_TRUE(world.stepLayout().islands.at(0).trees);
    const double error =
        measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions())
            .maxJointError;
    EXPECT_LT(error, 1e-5);
    const BodyMotion ball = world.motions().back();
    const std::vector<Command> push{
        {0, 1, ApplyImpulse{world.bodies().back().id, {2000.0f, 0.0f}, ball.position}}};
    world.step(push);
    run(world, 2);
    EXPECT_EQ(world.stepLayout().islands.at(0).substeps, substepsOf(standardEffort));
}

TEST(WorldEffort, SaysWhichIslandIsTooStiffForItsBudget) {
    Scene scene = sceneOf({ground()});
    scene.sleep = false;
    pile(scene, 0.0f, 2, 1.0f);
    pile(scene, 9.0f, 3, 20'000.0f);
    World world = worldOf(scene);
    run(world, 60);
    const TooStiff& stiff = world.report().tooStiff;
    EXPECT_EQ(stiff.islands, 1u);
    EXPECT_EQ(stiff.body, 4u);
    EXPECT_EQ(stiff.substeps, substepsOf(highestEffort));
    EXPECT_GT(stiff.neededSubsteps, stiff.substeps);
    EXPECT_FALSE(stiff.joint);
    // One shape a body, so shapes have the same ids. The heavy box presses itself through others.
    ContactView deepest;
    for (const ContactView& contact : world.contactViews()) {
        if (contact.separation[0] < deepest.separation[0]) deepest = contact;
    }
    EXPECT_EQ(std::minmax(stiff.bodyA, stiff.bodyB), std::minmax(deepest.shapeA, deepest.shapeB));
}

TEST(WorldEffort, APileTooLargeForMoreSubstepsComesToRestWithoutHeaving) {
    // It settles softly and deep. Stiffer contacts threw it up again, 1 m/s and more, for good.
    World world = worldOf("junkyard:columns=40");
    run(world, 800);
    float fastest = 0.0f;
    for (const BodyMotion& motion : world.motions()) {
        fastest = maxOf(fastest, length(motion.velocity));
    }
    EXPECT_LT(fastest, 0.05f);
}

TEST(WorldEffort, OfWhatFliesIsTheStandardWhateverItCameFrom) {
    Scene scene = sceneOf({ground()});
    pile(scene, 0.0f, 2, 100.0f);
    World world = worldOf(scene);
    run(world, 30);
    ASSERT_GT(levelOf(motionOf(world, 3).effort), standardEffort);
    const std::vector<Command> throwUp{
        {0, 1, ApplyImpulse{3, {0.0f, 800.0f}, motionOf(world, 3).position}}};
    world.step(throwUp);
    ASSERT_EQ(world.events().commands.at(0).reason, Rejection::None);
    run(world, 10);
    ASSERT_GT(motionOf(world, 3).position.y, 2.0f);
    EXPECT_EQ(motionOf(world, 3).effort, standardEffort);
    EXPECT_EQ(motionOf(world, 3).calm, 0);
}

TEST(WorldEffort, OfAFixedNumberIsThatNumberForEveryone) {
    Scene scene = twoPiles();
    scene.substeps = 6;
    World world = worldOf(scene);
    run(world, 90);
    for (const IslandView& island : world.stepLayout().islands) {
        EXPECT_EQ(island.substeps, 6u);
        EXPECT_EQ(island.strain, 0.0f) << "nobody asks";
    }
    EXPECT_EQ(world.report().tooStiff.islands, 0u);
}

}  // namespace
}  // namespace huestep::test
