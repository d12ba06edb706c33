// Pairs in the order of their key, against the standard library's sort.

#include "core/collision/shape_pair.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

TEST(PairSorter, SortsWhatAnyBlocksFoundOnAnyTeam) {
    Random random(71);
    SCOPED_TRACE(random.trace());
    Executor team(3);
    PairSorter sorter;
    for (int trial = 0; trial < 60; ++trial) {
        const std::uint32_t shapes = 2 + static_cast<std::uint32_t>(random.below(3000));
        // Hubs too: some shapes have far more pairs than a handful.
        const std::uint32_t hub = static_cast<std::uint32_t>(random.below(shapes));
        const std::size_t blocks = random.below(9);
        sorter.begin(shapes, blocks);
        std::vector<ShapePair> expected;
        for (std::size_t block = 0; block < blocks; ++block) {
            for (std::size_t i = random.below(400); i > 0; --i) {
                const auto any = static_cast<std::uint32_t>(random.below(shapes));
                const auto other = static_cast<std::uint32_t>(random.below(shapes));
                const std::uint32_t first = random.once(4) ? hub : other;
                if (any == first) continue;
                const ShapePair pair{std::min(any, first), std::max(any, first)};
                sorter.block(block).push_back(pair);
                expected.push_back(pair);
            }
        }
        std::sort(expected.begin(), expected.end());
        std::vector<ShapePair> sorted;
        sorter.sortInto(sorted, random.once(2) ? &team : nullptr);
        ASSERT_EQ(sorted, expected) << "trial " << trial;
    }
}

}  // namespace
}  // namespace huestep::test
