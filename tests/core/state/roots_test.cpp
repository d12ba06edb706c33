// Hashes: over every field, by blocks of 64, and the same for equal states alone.

#include "core/state/roots.h"

#include <cstring>
#include <set>

#include "core/state/hash.h"
#include "core/state/snapshot.h"
#include "tests/core/spoil.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

std::uint64_t hashOfText(std::string_view text) {
    return hash64(std::as_bytes(std::span(text.data(), text.size())));
}

TEST(Roots, RestOnXxh3WithItsPublishedValues) {
    EXPECT_EQ(hashOfText(""), 0x2d06800538d394c2u);
    EXPECT_EQ(hashOfText("a"), 0xe6c632b61e964e1fu);
    EXPECT_EQ(hashOfText("abc"), 0x78af5f94892f3950u);
}

TEST(Roots, LeavesAreBlocksOf64RecordsAndNodesHaveSixteenChildren) {
    Random random(5);
    SCOPED_TRACE(random.trace());
    for (const std::size_t records : {0u, 1u, 63u, 64u, 65u, 1024u, 1025u, 20000u}) {
        std::vector<BodyMotion> array(records);
        for (BodyMotion& m : array) m.position = random.point(-1.0, 1.0);
        const auto bytes = std::as_bytes(std::span(array));
        const std::vector<std::uint64_t> leaves = leavesOf(bytes, sizeof(BodyMotion));
        ASSERT_EQ(leaves.size(), (records + 63) / 64);
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            const std::size_t from = i * 64, count = std::min<std::size_t>(64, records - from);
            EXPECT_EQ(leaves[i], hash64(bytes.subspan(from * 32, count * 32)));
        }
        // The tree again, from its description: level by level.
        std::vector<std::uint64_t> level = leaves;
        while (level.size() > 1) {
            std::vector<std::uint64_t> above;
            for (std::size_t i = 0; i < level.size(); i += 16) {
                const std::size_t n = std::min<std::size_t>(16, level.size() - i);
                above.push_back(hash64(std::as_bytes(std::span(level).subspan(i, n))));
            }
            level = above;
        }
        EXPECT_EQ(rootOf(leaves), records == 0 ? 0 : level[0]);
    }
}

TEST(Roots, TheFullRootChangesWithEveryBitOfEveryFieldTheMotionRootWithMotionsAndCounts) {
    World world = worldOf("mixed");
    world.step(std::vector<Command>{{0, 1, AddPlayer{3}}});
    run(world, 30);
    const WorldState good = *readSnapshot(world.save());
    RootCache fresh;
    const std::uint64_t full = fullRoot(good, fresh);
    const std::uint64_t motion = motionRoot(good);
    EXPECT_EQ(full, world.fullRoot());
    EXPECT_EQ(motion, world.motionRoot());
    const std::set<std::string> counted{"tick", "nextBody", "nextShape", "nextJoint"};
    std::size_t arrays = 0;
    forEachArray(good, [&](std::string_view array, const auto& records) {
        using Record = typename std::remove_cvref_t<decltype(records)>::value_type;
        if (isOfRules<Record>) return;  // rules_test.cpp
        ASSERT_FALSE(records.empty()) << "the scene must have a " << array;
        ++arrays;
        for (const Field& field : fieldsOf<Record>) {
            for (std::uint32_t k = 0; k < field.count * sizeOf(field.type); ++k) {
                WorldState bad = good;
                forEachArray(bad, [&](std::string_view name, auto& others) {
                    if constexpr (std::is_same_v<decltype(others), std::vector<Record>&>) {
                        if (name != array) return;
                        auto* base = reinterpret_cast<char*>(&others.back());
                        base[field.offset + k] = static_cast<char>(base[field.offset + k] ^ 4);
                    }
                });
                RootCache cache;
                EXPECT_NE(fullRoot(bad, cache), full) << array << " " << field.name;
                const bool moves =
                    array == "motion" || (array == "world" && counted.contains(field.name));
                EXPECT_EQ(motionRoot(bad) != motion, moves) << array << " " << field.name;
            }
        }
    });
    EXPECT_EQ(arrays, 12u);
}

TEST(Roots, KeptForDefinitionsFollowEveryCommandThatChangesOne) {
    Scene scene = sceneOf({ground(), boxAt({0.0f, 3.0f})}, {hinge(0, {0.0f, 4.0f}, 1, {})});
    scene.joints[0].motor = {true, 1.0f, 5.0f};
    scene.players = PlayerDef{};
    World world = worldOf(scene);
    std::uint64_t sequence = 0;
    const auto check = [&](Action action) {
        static_cast<void>(world.fullRoot());  // fills what is kept
        world.step(std::vector<Command>{{0, ++sequence, std::move(action)}});
        ASSERT_EQ(world.events().commands[0].reason, Rejection::None);
        RootCache cache;
        EXPECT_EQ(world.fullRoot(), fullRoot(*readSnapshot(world.save()), cache));
    };
    check(SetMotor{1, true, 2.0f});
    check(Grab{2, {0.0f, 3.0f}, {1.0f, 3.0f}});
    check(MoveGrab{{2.0f, 3.0f}});
    check(Release{});
    check(Spawn{{discAt({5.0f, 5.0f})}, {}});
    check(RemoveBody{3});
    check(RemoveJoint{1});
    check(AddPlayer{1});
    check(RemovePlayer{1});
}

TEST(Roots, MotionLeavesPointAtTheBlockOfAChangedBody) {
    World world = worldOf("pyramid:base=20");
    World other = world;
    WorldSpoiler::flip(other, 150, 2, 3);
    const auto a = world.motionLeaves(), b = other.motionLeaves();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i] != b[i], i == 149 / 64) << i;
    EXPECT_NE(world.motionRoot(), other.motionRoot());
}

}  // namespace
}  // namespace huestep::test
