#include "tools/stability/ladder.h"

#include <gtest/gtest.h>

#include "tests/core/support.h"

namespace huestep::tools::stability {
namespace {

TEST(Ladder, HasNoFaultWhereMoreWorkPassesFromSomeWorkOn) {
    EXPECT_TRUE(faultsOf({2, 3, {false, false, true, false, true, true}}).empty());
    EXPECT_TRUE(faultsOf({2, 2, {false, false, false, false}}).empty());
    EXPECT_TRUE(faultsOf({2, 2, {true, true, true, true}}).empty());
}

TEST(Ladder, NamesTheStepUpThatFailsAndTheOneThatPassed) {
    // 30 Hz: pass, FAIL, pass; 60 Hz: FAIL, fail, pass.
    const std::vector<LadderFault> faults =
        faultsOf({2, 3, {true, false, true, false, false, true}});
    EXPECT_EQ(faults, (std::vector<LadderFault>{{0, 1, 0, 0}, {1, 0, 0, 0}}));
}

TEST(Ladder, HasAFaultIfAndOnlyIfSomePlaceFailsAboveOneThatPasses) {
    test::Random random(28);
    SCOPED_TRACE(random.trace());
    for (int round = 0; round < 500; ++round) {
        LadderGrid grid{1 + random.below(3), 1 + random.below(5), {}};
        for (std::size_t i = 0; i < grid.rates * grid.efforts; ++i)
            grid.passed.push_back(random.below(4) != 0);
        bool any = false;  // over all pairs, not by steps
        for (std::size_t rate = 0; rate < grid.rates; ++rate)
            for (std::size_t effort = 0; effort < grid.efforts; ++effort)
                for (std::size_t less = 0; less <= rate; ++less)
                    for (std::size_t fewer = 0; fewer <= effort; ++fewer)
                        any |= grid.at(less, fewer) && !grid.at(rate, effort);
        EXPECT_EQ(!faultsOf(grid).empty(), any);
    }
}

}  // namespace
}  // namespace huestep::tools::stability
