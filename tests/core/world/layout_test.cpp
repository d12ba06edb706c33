// What a world says of its last step, against worlds whose islands are counted by hand.

#include "core/graph/plan.h"
#include "core/solver/rows.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

TEST(StepLayout, CountsIslandsThatWereBuiltByHand) {
    // Two towers of 3 and 2 boxes, a pair of hinged discs in the air, a disc that flies alone.
    const World start = [] {
        Scene scene =
            sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({0.0f, 1.5f}), boxAt({0.0f, 2.5f}),
                     boxAt({10.0f, 0.5f}), boxAt({10.0f, 1.5f}), discAt({20.0f, 20.0f}),
                     discAt({22.0f, 20.0f}), discAt({30.0f, 30.0f})},
                    {hinge(6, {1.0f, 0.0f}, 7, {-1.0f, 0.0f})});
        scene.substeps = 4;  // planned, joints that are solved at once have batches of their own
        return worldOf(scene);
    }();
    World world = start;
    EXPECT_TRUE(world.stepLayout().islands.empty());
    world.step({});
    const StepLayout layout = world.stepLayout();
    ASSERT_EQ(layout.islands.size(), 3u);
    EXPECT_EQ(layout.islands[0].body, 2u);
    EXPECT_EQ(layout.islands[0].bodies, 3u);
    EXPECT_EQ(layout.islands[0].contacts, 3u);
    EXPECT_EQ(layout.islands[1].body, 5u);
    EXPECT_EQ(layout.islands[1].bodies, 2u);
    EXPECT_EQ(layout.islands[1].contacts, 2u);
    EXPECT_EQ(layout.islands[2].body, 7u);
    EXPECT_EQ(layout.islands[2].joints, 1u);
    EXPECT_EQ(layout.islands[2].colours, 1u);
    EXPECT_EQ(layout.freeBodies, 1u);
    EXPECT_EQ(layout.giants, 0u);
    for (const IslandView& island : layout.islands) {
        EXPECT_FALSE(island.giant);
        EXPECT_EQ(island.batch, 0u) << "all fit into one";
        EXPECT_EQ(island.batchConstraints, 6u);
        EXPECT_EQ(island.overflow, 0u);
    }
    EXPECT_GT(layout.bytesTouched, world.bodies().size() * sizeof(BodyMotion));
}

TEST(StepLayout, AgreesWithTheReportAndKnowsGiantsByTheirSize) {
    for (const char* scene : {"pyramid:base=30", "many_pyramids:rows=2,columns=3", "mixed"}) {
        World world = worldOf(scene);
        run(world, 20);
        const StepLayout layout = world.stepLayout();
        const StepReport& report = world.report();
        EXPECT_EQ(layout.islands.size(), report.islands) << scene;
        std::uint32_t overflow = 0;
        for (std::size_t i = 0; i < layout.islands.size(); ++i) {
            const IslandView& island = layout.islands[i];
            const std::uint32_t constraints = island.contacts + island.joints;
            overflow += island.overflow;
            EXPECT_EQ(island.giant, constraints > standardBatchSize) << scene;
            EXPECT_LE(constraints, island.batchConstraints);
            EXPECT_LE(island.colours, report.colours);
            EXPECT_LT(island.batch, report.batches);
            if (i > 0) {
                const IslandView& before = layout.islands[i - 1];
                EXPECT_GE(before.contacts + before.joints, constraints) << "largest first";
            }
        }
        EXPECT_EQ(overflow, report.overflow) << scene;
        EXPECT_LE(layout.sharedColours, layout.colours);
    }
}

TEST(StepResources, ThreadsThatShareEvenLittleWorkChangeHowAStepIsLaidOutAndNotItsResult) {
    World alone = worldOf("small:n=12");
    World shared = alone;
    Executor executor(2);
    for (int tick = 0; tick < 60; ++tick) {
        alone.step({});
        shared.step({}, {.executor = &executor, .shareAll = true});
        ASSERT_EQ(shared.fullRoot(), alone.fullRoot()) << "tick " << tick;
    }
    EXPECT_EQ(alone.stepLayout().giants, 0u);
    EXPECT_EQ(shared.stepLayout().giants, shared.report().islands);
    EXPECT_GT(shared.stepLayout().giants, 0u);
    EXPECT_GT(shared.stepLayout().sharedColours, 0u);
    EXPECT_EQ(shared.stepLayout().batchConstraints, 0u);
    // Of that step alone: the next one is laid out as if none had ever shared.
    alone.step({});
    shared.step({}, {.executor = &executor});
    EXPECT_EQ(shared.stepLayout().giants, 0u);
    EXPECT_EQ(shared.stepLayout().sharedColours, 0u);
    EXPECT_EQ(shared.stepLayout().batchConstraints, standardBatchSize);
    EXPECT_EQ(shared.fullRoot(), alone.fullRoot());
}

TEST(StepLayout, OfARestoredCheckpointTellsOfNoStepThatItHasNotTaken) {
    World world = worldOf("heavy_top:ratio=100,n=3");
    run(world, 30);
    Checkpoint then;
    world.checkpoint(then);
    const StepLayout before = world.stepLayout();
    ASSERT_EQ(before.islands.size(), 1u);
    EXPECT_GT(before.islands[0].strain, 0.0f);
    run(world, 90);
    ASSERT_NE(world.stepLayout().islands[0].strain, before.islands[0].strain);
    world.restore(then);
    const StepLayout after = world.stepLayout();
    ASSERT_EQ(after.islands.size(), 1u);
    EXPECT_EQ(after.islands[0].strain, 0.0f) << "unknown";
    EXPECT_EQ(after.islands[0].contacts, before.islands[0].contacts);
    EXPECT_EQ(after.islands[0].substeps, before.islands[0].substeps);
    EXPECT_EQ(after.islands[0].trees, before.islands[0].trees);
}

TEST(Rows, CountTheBytesOfEveryListThatAMethodGoesOver) {
    Rows rows;
    EXPECT_EQ(rows.bytes(), 0u);
    rows.bodies.resize(2);
    rows.poses.resize(3);
    rows.pushed.resize(5);
    rows.sources.resize(7);
    rows.joints.resize(11);
    rows.memory.changes.resize(13);
    rows.memory.shares.resize(17);
    rows.memory.locks.resize(19);
    EXPECT_EQ(rows.bytes(), 2 * sizeof(SolverBody) + 3 * sizeof(SolverPose) + 5 * 12 +
                                7 * sizeof(BodySource) + 11 * sizeof(JointRow) + 13 * 16 + 17 * 4 +
                                19 * 4);
}

}  // namespace
}  // namespace huestep::test
