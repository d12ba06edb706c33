// Events: begin, end and hit of contacts as values, in key order.

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

using Key = std::pair<ShapeId, ShapeId>;

template <class Change>
std::vector<Key> keysOf(const std::vector<Change>& changes) {
    std::vector<Key> keys;
    for (const Change& c : changes) keys.emplace_back(c.shapeA, c.shapeB);
    return keys;
}

TEST(Events, OfAllTicksAddUpToTheContactsThatThereAre) {
    for (const char* scene : {"mixed", "tumbler:count=8", "sandbox", "hinges"}) {
        World world = worldOf(scene);
        std::set<Key> touching;
        for (int tick = 0; tick < 200; ++tick) {
            const Events& events = world.step({});
            for (const auto& keys :
                 {keysOf(events.begins), keysOf(events.ends), keysOf(events.hits)}) {
                EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
                EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
                for (const Key& key : keys) EXPECT_LT(key.first, key.second);
            }
            for (const Key& key : keysOf(events.ends)) {
                EXPECT_EQ(touching.erase(key), 1u) << "ended, but had not begun";
            }
            for (const Key& key : keysOf(events.begins)) {
                EXPECT_TRUE(touching.insert(key).second) << "began twice";
            }
            for (const Key& key : keysOf(events.hits)) EXPECT_TRUE(touching.contains(key));
            std::set<Key> now;
            for (const ContactState& c : world.contacts()) now.emplace(c.shapeA, c.shapeB);
            ASSERT_EQ(touching, now) << scene << ", tick " << tick;
        }
    }
}

TEST(Events, TellWhereAndHowHardADiscHitTheGround) {
    World world = worldOf(sceneOf({ground(), discAt({3.0f, 2.5f})}));
    std::vector<ContactHit> hits;
    int begins = 0;
    for (int tick = 0; tick < 120; ++tick) {
        const Events& events = world.step({});
        hits.insert(hits.end(), events.hits.begin(), events.hits.end());
        begins += static_cast<int>(events.begins.size());
    }
    EXPECT_EQ(begins, 1);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_EQ(hits[0].shapeA, 1u);
    EXPECT_EQ(hits[0].shapeB, 2u);
    // It fell 2 m: v² = 2 g h.
    EXPECT_NEAR(wide(hits[0].approach), std::sqrt(2.0 * 10.0 * 2.0), 0.2);
    EXPECT_NEAR(wide(hits[0].normal.y), 1.0, 1e-6) << "from the ground to the disc";
    EXPECT_NEAR(wide(hits[0].point.x), 3.0, 1e-3);
    EXPECT_NEAR(wide(hits[0].point.y), 0.0, 0.1);
}

TEST(Events, OfASlowTouchHaveNoHit) {
    World world = worldOf(sceneOf({ground(), discAt({0.0f, 0.52f})}));
    for (int tick = 0; tick < 60; ++tick) EXPECT_TRUE(world.step({}).hits.empty());
    EXPECT_EQ(world.contacts().size(), 1u);
}

TEST(Events, OfARemovedBodyEndItsContactsInTheSameTick) {
    World world = worldOf(sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({0.0f, 1.5f})}));
    run(world, 90);
    ASSERT_TRUE(world.motions()[2].asleep());
    ASSERT_EQ(world.contacts().size(), 2u);
    const Events& events = world.step(std::vector<Command>{{0, 1, RemoveBody{2}}});
    EXPECT_EQ(keysOf(events.ends), (std::vector<Key>{{1, 2}, {2, 3}}));
    EXPECT_TRUE(world.contacts().empty());
    EXPECT_FALSE(motionOf(world, 3).asleep()) << "what it touched wakes";
    run(world, 60);
    EXPECT_LT(motionOf(world, 3).position.y, 0.6f) << "and falls";
}

TEST(Events, LiveUntilTheNextStep) {
    World world = worldOf(sceneOf({ground(), discAt({0.0f, 0.5f})}));
    EXPECT_EQ(world.step({}).begins.size(), 1u);
    EXPECT_EQ(world.events().begins.size(), 1u);
    world.step({});
    EXPECT_TRUE(world.events().begins.empty());
}

}  // namespace
}  // namespace huestep::test
