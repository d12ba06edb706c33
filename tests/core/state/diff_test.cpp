// Differences: the first field in which two worlds differ, by name, with both values.

#include <charconv>
#include <cstring>

#include "tests/core/spoil.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

TEST(Difference, NamesTheBodyAndTheFieldOfAnyFlippedBitWithBothValues) {
    World world = worldOf("small");
    run(world, 30);
    for (std::uint32_t field = 0; field < fieldsOf<BodyMotion>.size(); ++field) {
        for (std::uint32_t bit = 0; bit < 8 * sizeOf(fieldsOf<BodyMotion>[field].type); bit += 7) {
            World other = world;
            WorldSpoiler::flip(other, 5, field, bit);
            const auto found = firstDifference(world, other);
            ASSERT_TRUE(found);
            EXPECT_EQ(found->body, 5u);
            EXPECT_EQ(found->name, "body 5");
            EXPECT_EQ(found->field, fieldsOf<BodyMotion>[field].name);
            EXPECT_NE(found->left, found->right);
            EXPECT_EQ(found->sentence(), "body 5 " + found->field + ": " + found->left + " here, " +
                                             found->right + " there");
            if (fieldsOf<BodyMotion>[field].type != FieldType::F32) continue;
            // The text reads back as the very number.
            const std::string& text = found->left;
            float value = 0.0f, kept = 0.0f;
            ASSERT_EQ(std::from_chars(text.data(), text.data() + text.size(), value).ec,
                      std::errc());
            std::memcpy(&kept,
                        reinterpret_cast<const char*>(&world.motions()[*world.find(5)]) +
                            fieldsOf<BodyMotion>[field].offset,
                        4);
            EXPECT_EQ(value, kept);
        }
    }
}

TEST(Difference, IsNoneBetweenEqualWorldsAndTheLowestBodyWhereThereAreSeveral) {
    World world = worldOf("small");
    World other = world;
    EXPECT_FALSE(firstDifference(world, other));
    WorldSpoiler::flip(other, 9, 0, 1);
    WorldSpoiler::flip(other, 4, 5, 1);
    EXPECT_EQ(firstDifference(world, other)->body, 4u);
    EXPECT_EQ(firstDifference(world, other)->field, "velocity.y");
}

TEST(Difference, NamesWhatIsThereInOneWorldAlone) {
    World world = worldOf(sceneOf({ground(), boxAt({0.0f, 9.0f})}));
    World other = worldOf(sceneOf({ground(), boxAt({0.0f, 9.0f}), discAt({5.0f, 9.0f})}));
    const auto found = firstDifference(world, other);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->name, "world") << "its counters come first";
    Scene more = sceneOf({ground(), boxAt({0.0f, 9.0f})});
    for (std::uint32_t i = 0; i < 2; ++i) more.bodies[i].id = more.bodies[i].firstShape = i + 1;
    more.counters = {4, 4, 1};
    const auto next = firstDifference(worldOf(more), other);
    ASSERT_TRUE(next);
    EXPECT_EQ(next->name, "body 3");
    EXPECT_EQ(next->field, "present");
    EXPECT_EQ(next->left, "no");
    EXPECT_EQ(next->right, "yes");
}

TEST(Difference, NamesJointsAndContactsByTheirIds) {
    World world = worldOf("mixed");
    run(world, 40);
    World other = world;
    other.step({});
    const auto found = firstDifference(world, other);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->record, "world");
    EXPECT_EQ(found->field, "tick");
    EXPECT_EQ(found->left, "40");
    EXPECT_EQ(found->right, "41");
}

TEST(Difference, HooksForTestsIgnoreWhatIsNotThere) {
    World world = worldOf("small");
    const std::uint64_t root = world.fullRoot();
    WorldSpoiler::flip(world, 9999, 0, 0);
    WorldSpoiler::flip(world, 2, 99, 0);
    WorldSpoiler::flip(world, 2, 0, 32);
    EXPECT_EQ(world.fullRoot(), root);
}

}  // namespace
}  // namespace huestep::test
