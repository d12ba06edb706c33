// Snapshots, deltas, checkpoints, hashes and differences in worlds at the edge of what there is.

#include "tests/core/odd_worlds.h"
#include "core/state/hash.h"
#include "core/state/roots.h"
#include "core/state/snapshot.h"
#include "tests/core/spoil.h"

namespace huestep::test {
namespace {

class OddStates : public testing::TestWithParam<OddWorld> {
 protected:
    World m_world = worldOf(GetParam().scene);
};

INSTANTIATE_TEST_SUITE_P(All, OddStates, testing::ValuesIn(oddWorlds()), nameOfOdd);

/// Both go on alike for a while, in state and in what they tell. The first is the one that has come
/// all the way: a copy of it would start from its state alone, as the second does.
void expectSameFuture(World& left, World& right) {
    ASSERT_EQ(differenceOf(left, right), "");
    for (int i = 0; i < 15; ++i) {
        left.step({});
        right.step({});
        ASSERT_EQ(differenceOf(left, right), "") << "tick " << left.tick();
        ASSERT_EQ(left.fullRoot(), right.fullRoot()) << "tick " << left.tick();
        ASSERT_EQ(left.motionRoot(), right.motionRoot());
        ASSERT_EQ(left.events(), right.events()) << "tick " << left.tick();
    }
}

TEST_P(OddStates, AreRestoredFromASnapshotToTheByte) {
    for (int round = 0; round < 3; ++round) {
        World copy = restored(m_world);
        EXPECT_EQ(copy.save(), m_world.save());
        ASSERT_NO_FATAL_FAILURE(expectSameFuture(m_world, copy));
    }
}

TEST_P(OddStates, AreRestoredFromADeltaAgainstAnyOther) {
    const World start = m_world;
    run(m_world, 20);
    std::vector<World> bases{start, m_world, worldOf(sceneOf({}))};
    for (const OddWorld& other : oddWorlds()) bases.push_back(worldOf(other.scene));
    for (const World& base : bases) {
        const Result<World> copy = World::restore(base, m_world.saveDelta(base));
        ASSERT_TRUE(copy.ok()) << copy.error().message;
        EXPECT_EQ(copy->save(), m_world.save());
    }
    EXPECT_LT(m_world.saveDelta(m_world).size(), 200u) << "nothing has changed";
    Result<World> copy = World::restore(start, m_world.saveDelta(start));
    ASSERT_TRUE(copy.ok());
    ASSERT_NO_FATAL_FAILURE(expectSameFuture(m_world, *copy));
}

TEST_P(OddStates, AreGoneBackToByACheckpointOfAnyTick) {
    World straight = m_world;
    std::vector<std::uint64_t> roots;
    std::vector<Checkpoint> checkpoints(4);
    for (int tick = 0; tick < 40; ++tick) {
        roots.push_back(straight.fullRoot());
        straight.step({});
        if (tick % 10 == 0) m_world.checkpoint(checkpoints[static_cast<std::size_t>(tick / 10)]);
        m_world.step({});
    }
    // One vessel after the other, in and against the order of time, and in another's world.
    World other = worldOf("small:n=2");
    for (const std::size_t k : {3u, 0u, 2u, 1u, 1u}) {
        for (World* world : {&m_world, &other}) {
            world->restore(checkpoints[k]);
            ASSERT_EQ(world->tick(), 10 * k);
            for (std::size_t tick = 10 * k; tick < roots.size(); ++tick) {
                ASSERT_EQ(world->fullRoot(), roots[tick]) << "tick " << tick;
                world->step({});
            }
            ASSERT_EQ(differenceOf(*world, straight), "");
        }
    }
}

TEST_P(OddStates, HaveTheRootsOfTheirDescription) {
    for (int tick = 0; tick < 20; ++tick) {
        m_world.step({});
        const WorldState state = *readSnapshot(m_world.save());
        RootCache fresh;
        ASSERT_EQ(m_world.fullRoot(), fullRoot(state, fresh)) << "tick " << tick;
    }
    // The motion root once more from the words of its header: leaves of 64 records, nodes of 16.
    std::vector<std::uint64_t> level = m_world.motionLeaves();
    ASSERT_EQ(level.size(), (m_world.bodies().size() + 63) / 64);
    for (std::size_t i = 0; i < level.size(); ++i) {
        const std::size_t count = std::min<std::size_t>(64, m_world.motions().size() - 64 * i);
        EXPECT_EQ(level[i], hash64(std::as_bytes(m_world.motions().subspan(64 * i, count))));
    }
    ASSERT_LE(level.size(), 16u);
    if (level.size() > 1) level = {hash64(std::as_bytes(std::span(level)))};
    const WorldInfo& info = m_world.info();
    const std::vector<std::uint64_t> all{level.empty() ? 0 : level[0],
                                         info.tick,
                                         m_world.bodies().size(),
                                         info.nextBody,
                                         info.nextShape,
                                         info.nextJoint};
    EXPECT_EQ(m_world.motionRoot(), hash64(std::as_bytes(std::span(all))));
}

TEST_P(OddStates, ShowAFlippedBitOfAnyBodyInBothRootsAndByName) {
    run(m_world, 5);
    for (std::size_t body = 0; body < m_world.bodies().size(); body += 7) {
        const BodyId id = m_world.bodies()[body].id;
        const auto field = static_cast<std::uint32_t>(body % fieldsOf<BodyMotion>.size());
        World other = m_world;
        WorldSpoiler::flip(other, id, field, 3);
        EXPECT_NE(other.motionRoot(), m_world.motionRoot());
        EXPECT_NE(other.fullRoot(), m_world.fullRoot());
        const auto found = firstDifference(m_world, other);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->body, id);
        EXPECT_EQ(found->field, fieldsOf<BodyMotion>[field].name);
        const auto mine = m_world.motionLeaves(), its = other.motionLeaves();
        for (std::size_t leaf = 0; leaf < mine.size(); ++leaf)
            EXPECT_EQ(mine[leaf] != its[leaf], leaf == body / 64);
    }
}

}  // namespace
}  // namespace huestep::test
