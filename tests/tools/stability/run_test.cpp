// Runs that are judged by their ratio to a run in key order, on made-up measures and on a real one.
#include "tools/stability/run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "tools/stability/measures.h"

namespace huestep::tools::stability {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// Some discs pressed onto a hub for a while.
Trial pressed(Measure measure) {
    Trial trial;
    trial.scene = "hub:n=40,kinematic=0";
    trial.seconds = 0.5;
    Criterion criterion{"residual over that of key order", "1", 1.2, std::move(measure)};
    criterion.mayReach = true;
    trial.criteria = {criterion};
    trial.energyRule = false;
    trial.againstKeyOrder = true;
    return trial;
}

Setup setupOf(const Trial& trial, const std::string& method = "soft-step") {
    return setUp(trial, {}, {"huestep", method, 4}).value();
}

/// Says one thing in the first run, which is the one in key order, and another in the second.
Measure inTurn(double first, double second) {
    const auto looks = std::make_shared<int>(0);
    return [=](const Moment&) { return ++*looks <= 30 ? first : second; };
}

Judgement judged(const Trial& trial, const std::string& method = "soft-step") {
    return runAsAsked(setupOf(trial, method), {})->judgement;
}

TEST(AgainstKeyOrder, IsTheRatioOfTheValuesOfTwoRuns) {
    const Trial trial = pressed(hubResidual);
    Trial alone = trial;
    alone.againstKeyOrder = false;
    alone.criteria.front().limit = unbounded;
    const double colours = judged(alone).value;
    const double keyOrder = judged(alone, "sequential").value;
    ASSERT_GT(keyOrder, 0.0);
    ASSERT_NE(colours, keyOrder);
    EXPECT_NEAR(judged(trial).value, colours / keyOrder, 1e-12 * colours / keyOrder);
    EXPECT_EQ(judged(trial, "sequential").value, 1.0) << "to itself";
}

TEST(AgainstKeyOrder, LimitsTheRatioAndNotTheReferenceItself) {
    for (const double size : {1e-6, 1.0, 1e6}) {
        EXPECT_TRUE(judged(pressed(inTurn(size, 1.1 * size))).pass) << size;
        EXPECT_NEAR(judged(pressed(inTurn(size, 1.1 * size))).value, 1.1, 1e-12);
        EXPECT_FALSE(judged(pressed(inTurn(size, 1.3 * size))).pass) << size;
    }
}

TEST(AgainstKeyOrder, FailsWhereTheReferenceSaysNothing) {
    for (const double reference : {unbounded, std::nan(""), 0.0, -1.0}) {
        const Judgement judgement = judged(pressed(inTurn(reference, 1.0)));
        EXPECT_FALSE(judgement.pass) << reference;
        EXPECT_TRUE(std::isinf(judgement.value)) << reference;
        EXPECT_TRUE(judgement.why.starts_with("the run in key order, to compare with, "))
            << reference;
    }
}

TEST(AgainstKeyOrder, FailsWhereTheReferenceBreaksARule) {
    Trial trial = pressed([](const Moment&) { return 1.0; });
    trial.scene = "arm:speed=100";  // its end is at 500 m/s
    const Judgement judgement = judged(trial);
    EXPECT_FALSE(judgement.pass);
    EXPECT_NE(judgement.why.find("the run in key order"), std::string::npos) << judgement.why;
    EXPECT_NE(judgement.why.find("fastest body"), std::string::npos) << judgement.why;
    trial.speedRule = false;
    EXPECT_TRUE(judged(trial).pass) << judged(trial).why;
}

}  // namespace
}  // namespace huestep::tools::stability
