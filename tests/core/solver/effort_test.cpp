// The law of effort: which level follows from how much rows give way.

#include "core/solver/effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace huestep::test {
namespace {

/// Plans a number of steps with the same strain at full frequency, as of the level at the start.
EffortPlan after(EffortPlan now, float strain, int steps, const EffortRange& range = {}) {
    const std::uint8_t start = now.level;
    for (int i = 0; i < steps; ++i) {
        const float quarter = std::pow(0.25f, static_cast<float>(now.level - start));
        const float share = rampShare(rampOf(now.calm));
        now = planEffort(now, {strain * quarter / (share * share)}, range);
    }
    return now;
}

TEST(Effort, IsRaisedAtTheThirdStrainedStepToTheLevelThatIsNeeded) {
    const EffortRange range{};
    EXPECT_EQ(after({2, 0}, 1.5f, 1, range).level, 2);
    EXPECT_EQ(after({2, 0}, 1.5f, 2, range).level, 2);
    EXPECT_EQ(after({2, 0}, 1.5f, 3, range).level, 3) << "half the violation at half the substep²";
    EXPECT_EQ(after({2, 0}, 3.9f, 3, range).level, 3);
    EXPECT_EQ(after({2, 0}, 4.1f, 3, range).level, 4);
    EXPECT_EQ(after({2, 0}, 63.0f, 3, range).level, 5);
    EXPECT_EQ(after({2, 0}, 1.0e9f, 3, range).level, 5) << "and not beyond the highest";
}

TEST(Effort, ForgetsStrainThatIsOverBeforeTheThirdStep) {
    const EffortRange range{};
    EffortPlan plan = after({2, 0}, 50.0f, 2, range);
    EXPECT_LT(plan.calm, 0);
    plan = planEffort(plan, {0.5f}, range);
    EXPECT_EQ(plan.calm, 0);
    EXPECT_EQ(after(plan, 50.0f, 2, range).level, 2);
}

TEST(Effort, StaysWithinTheBudget) {
    EXPECT_EQ(after({2, 0}, 50.0f, 10, {.most = 3}).level, 3);
    EXPECT_EQ(planEffort({5, 0}, {0.9f}, {.most = 3}).level, 3);
    // 16,384 constraint substeps, and four substeps for everyone.
    EXPECT_EQ(affordableEffort(512), 5);
    EXPECT_EQ(affordableEffort(513), 4);
    EXPECT_EQ(affordableEffort(2048), 3);
    EXPECT_EQ(affordableEffort(2049), 2);
    EXPECT_EQ(affordableEffort(1'000'000), 2);
}

TEST(Effort, FallsOneLevelAfterThirtyCalmStepsAndNotBelowItsRange) {
    const EffortRange range{};
    EffortPlan plan{4, 0};
    plan = after(plan, 0.01f, 29, range);
    EXPECT_EQ(plan.level, 4);
    plan = planEffort(plan, {0.01f}, range);
    EXPECT_EQ(plan.level, 3);
    EXPECT_EQ(plan.calm, 0);
    EXPECT_EQ(after(plan, 1.0e-6f, 300, range).level, standardEffort);
    EXPECT_EQ(after(plan, 1.0e-6f, 300, {.least = restingEffort, .gentle = true}).level,
              restingEffort);
    EXPECT_EQ(planEffort({restingEffort, 0}, {}, range).level, standardEffort)
        << "who no longer rests goes up at once";
}

TEST(Effort, OfALevelThatWouldJustDoIsNotCalm) {
    // Half the substeps give four times the violation: it must stay below 1 with a margin.
    EXPECT_TRUE(isCalm(4, 0.15f, {}));
    EXPECT_FALSE(isCalm(4, 0.17f, {}));
}

TEST(Effort, OfJointsComesNearerToItsFrequencyByASixteenthOfAnOctaveAStep) {
    const EffortRange range{.jointed = true};
    EffortPlan plan = after({2, 0}, 10.0f, 3, range);
    EXPECT_EQ(plan.level, 4);
    EXPECT_EQ(rampOf(plan.calm), 32);
    EXPECT_FLOAT_EQ(rampShare(32), 0.25f) << "it starts with the frequency that it had";
    for (int left = 31; left >= 0; --left) {
        const float share = rampShare(rampOf(plan.calm));
        plan = planEffort(plan, {10.0f / 16.0f / (share * share)}, range);
        EXPECT_EQ(rampOf(plan.calm), left);
        EXPECT_NEAR(rampShare(rampOf(plan.calm)), std::exp2(-left / 16.0), 1.0e-6);
    }
    EXPECT_EQ(plan.level, 4);
    EXPECT_EQ(plan.calm, 0);
}

TEST(Effort, OfStrainedJointsThatMayBeSolvedAtOnceIsTheirTreeAndNoMoreSubsteps) {
    const EffortRange range{.jointed = true, .mayHaveTrees = true};
    EffortPlan plan{2, 0};
    for (int step = 0; step < 3; ++step) plan = planEffort(plan, {0.1f, 50.0f}, range);
    EXPECT_TRUE(plan.trees);
    EXPECT_EQ(plan.level, 2);
    EXPECT_EQ(plan.calm, 0);
    for (int step = 0; step < 100; ++step) plan = planEffort(plan, {0.1f, 0.5f}, range);
    EXPECT_TRUE(plan.trees) << "half of what they may: sweeps would hardly do";
    for (int step = 0; step < 30; ++step) plan = planEffort(plan, {0.1f, 0.2f}, range);
    EXPECT_FALSE(plan.trees);
    EXPECT_FALSE(planEffort({2, 0, false, true}, {}, {.jointed = true}).trees)
        << "of an island that has become too large";
}

TEST(Effort, OfUnlikeMassesAndLongRowsIsTheirTreeFromTheStart) {
    EXPECT_FLOAT_EQ(massRatio(0.001f, 1.0f), 1000.0f);
    EXPECT_FLOAT_EQ(massRatio(1.0f, 0.0f), 1.0f) << "a body that does not move has no part in it";
    EXPECT_TRUE(wantsTree({.joints = 11, .ratio = 20.0f}));
    EXPECT_TRUE(wantsTree({.joints = 40}));
    EXPECT_FALSE(wantsTree({.joints = 10, .ratio = 19.0f})) << "a ragdoll";
    EXPECT_FALSE(wantsTree({.joints = 3}));
    EXPECT_TRUE(wantsTree({.joints = 2})) << "a double pendulum";
    EXPECT_FALSE(wantsTree({}));
}

TEST(Effort, ComesDownFromARaisedLevelWhereTreesAreKeptToo) {
    const EffortRange kept{.jointed = true, .mayHaveTrees = true, .keepsTrees = true};
    EffortPlan plan{.level = 5, .trees = true};
    for (int i = 0; i < 100; ++i) plan = planEffort(plan, {0.01f, 0.01f}, kept);
    EXPECT_EQ(plan.level, standardEffort);
    EXPECT_TRUE(plan.trees);
    // Where nothing keeps them they go first.
    plan = {.level = 5, .trees = true};
    for (int i = 0; i < calmSteps; ++i) {
        plan = planEffort(plan, {0.01f, 0.01f}, {.jointed = true, .mayHaveTrees = true});
    }
    EXPECT_EQ(plan.level, 5);
    EXPECT_FALSE(plan.trees);
}

TEST(Effort, IsPackedIntoAByteThatGivesEachPartBack) {
    for (std::uint8_t level = 0; level <= highestEffort; ++level) {
        for (int bits = 0; bits < 8; ++bits) {
            const EffortPlan plan{level, 0, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0};
            EXPECT_EQ(levelOf(plan.packed()), level);
            EXPECT_EQ(gentleAt(plan.packed()), plan.gentle);
            EXPECT_EQ(treesAt(plan.packed()), plan.trees);
            EXPECT_EQ(recoversAt(plan.packed()), plan.recovers);
        }
    }
}

TEST(Effort, OfLargeIslandsIsStifferContactsInsteadOfMoreSubsteps) {
    EXPECT_FALSE(isLarge(2048));
    EXPECT_TRUE(isLarge(2049)) << "the most that 8 substeps are allowed for";
    EXPECT_GT(rowFrequency(4, true, true).contact, rowFrequency(4, true, false).contact);
    EXPECT_EQ(rowFrequency(4, false, true).contact, rowFrequency(4, false, false).contact)
        << "where something is hit nothing is stiffer";
}

TEST(Effort, KnowsTheFloorOfASoftRow) {
    // e = F / (m ω²) for F = λ/h: here λ/m = 1 m/s, h = 1/240 s and f = 30 Hz, an eighth of 240.
    const double omega = 2.0 * std::numbers::pi * 30.0;
    EXPECT_NEAR(softFloor(0.125f, 1.0f / 240.0f), 240.0 / (omega * omega), 1.0e-8);
}

TEST(Effort, OfABeginningAsksForTheWeightAndMomentumOfTheHeavierBody) {
    const float h = 1.0f / 240.0f;
    const auto strain = [&](float heavy, float approach) {
        return strainOfBeginning(1.0f, 1.0f / heavy, approach, 10.0f, 4.0f * h, 100.0f,
                                 standardEffort);
    };
    EXPECT_EQ(strain(1.0f, 20.0f), 0.0f) << "bodies of like mass";
    EXPECT_EQ(strain(3.9f, 20.0f), 0.0f);
    // 100 kg on a box of 1 kg, whose corner row has 0.4 kg: e = 1000 N / (0.4 kg ω²), ω at 30 Hz.
    const double omega = 2.0 * std::numbers::pi * 30.0;
    EXPECT_NEAR(strain(100.0f, 0.0f), 100.0 * 1000.0 / (0.4 * omega * omega), 0.01);
    EXPECT_NEAR(strain(100.0f, 1.0f) / strain(100.0f, 0.0f), 7.0f, 0.01f)
        << "1 m/s within 1/60 s is 60 m/s² more";
    EXPECT_EQ(strainOfBeginning(1.0f, 0.0f, 9.0f, 10.0f, h, 100.0f, 2), 0.0f) << "on the ground";
}

}  // namespace
}  // namespace huestep::test
