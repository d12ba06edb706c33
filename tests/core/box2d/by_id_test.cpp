#include "core/box2d/by_id.h"

#include <map>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

TEST(ById, FindsWhatIsThereByIdsThatAreNeverUsedAgain) {
    Random random(5);
    SCOPED_TRACE(random.trace());
    ById<int> list({7, 3, 5}, {70, 30, 50}, 4);
    std::map<std::uint32_t, int> expected{{3, 30}, {5, 50}, {7, 70}};
    std::uint32_t next = 8;
    for (int tick = 0; tick < 200; ++tick) {
        for (std::uint32_t i = random.below(4); i > 0; --i) {
            EXPECT_EQ(list.add(static_cast<int>(10 * next)), next);
            expected[next] = static_cast<int>(10 * next);
            ++next;
        }
        for (std::uint32_t i = random.below(4); i > 0; --i) {
            const std::uint32_t id = random.below(next + 1);
            list.remove(id);
            expected.erase(id);
            EXPECT_FALSE(list.find(id).has_value());
        }
        list.tidy();
        ASSERT_EQ(list.entries().size(), expected.size());
        std::size_t place = 0;
        for (const auto& [id, handle] : expected) {
            EXPECT_EQ(list.entries()[place].id, id);
            EXPECT_EQ(list.entries()[place++].handle, handle);
            EXPECT_EQ(list.find(id), handle);
        }
    }
}

TEST(ById, CountsFromWhereTheSceneSaysIfThatIsHigher) {
    EXPECT_EQ(ById<int>({1, 2}, {0, 0}, 9).add(0), 9u);
    EXPECT_EQ((ById<int>({}, {}, 1).add(0)), 1u);
}

}  // namespace
}  // namespace huestep::test
