// The gates of the physics page, each for what one gets without asking: the soft step with planned
// substeps. Measures are those of `huestep accuracy` and `huestep stability`, which have tests of
// their own against known values; the limits are the page's.
#include <gtest/gtest.h>

#include <string>

#include "tools/engines.h"
#include "tools/metrics/metric.h"
#include "tools/stability/run.h"

namespace huestep::tools {
namespace {

double errorOfDefault(const std::string& name) {
    const MetricCase* metric = findMetricCase(name);
    EXPECT_NE(metric, nullptr) << name;
    const Setting setting{[](const Scene& scene) { return makeEngine("huestep", scene); },
                          Method::SoftStep, 0};
    const Result<double> error = errorOf(*metric, setting);
    EXPECT_TRUE(error.ok()) << name << ": " << (error.ok() ? "" : error.error().message);
    return error.ok() ? *error : 1.0 / 0.0;
}

/// A scene of the suite, upright, with the row's own criteria.
stability::Judgement judgedByDefault(const std::string& text) {
    for (const stability::Row& row : stability::sceneRows()) {
        for (const stability::Trial& trial : row.trials) {
            if (stability::textOf(trial, {}) != text) continue;
            const auto setup = stability::setUp(trial, {}, {"huestep", "soft-step", 0});
            const auto run = stability::runAsAsked(*setup, {});
            EXPECT_TRUE(run.ok()) << text;
            return run.ok() ? run->judgement : stability::Judgement{};
        }
    }
    ADD_FAILURE() << "no row has the scene " << text;
    return {};
}

TEST(PhysicsGate, FreeFlightIsOnItsParabolaToTenMicrometres) {
    EXPECT_LT(errorOfDefault("ballistic"), 1e-5);
}

TEST(PhysicsGate, PendulumKeepsItsPeriodToOneInTenThousandAndItsEnergyToTwoPerMille) {
    EXPECT_LT(errorOfDefault("pendulum-90-period"), 1e-4);
    EXPECT_LT(errorOfDefault("pendulum-90-energy"), 0.002);
}

TEST(PhysicsGate, DoublePendulumIsWithinSixMillimetresAfterASecond) {
    EXPECT_LT(errorOfDefault("double-pendulum-1s"), 0.006);
}

TEST(PhysicsGate, ChainOf1000To1HangsToFiveMillimetresAndSwingsToFiveCentimetresWithoutGain) {
    EXPECT_LT(errorOfDefault("chain-1000-hang"), 0.005);
    EXPECT_LT(errorOfDefault("chain-1000-swing"), 0.05);
    EXPECT_LT(errorOfDefault("chain-1000-swing-gain"), 1e-4) << "of weight times length";
}

TEST(PhysicsGate, StackOf100StandsFor20Seconds) {
    const stability::Judgement stack = judgedByDefault("stack:n=100,seed=1");
    EXPECT_TRUE(stack.pass) << stack.why;
}

TEST(PhysicsGate, HeavyOnLightOf1000To1SinksByLessThanFiveCentimetres) {
    const stability::Judgement stack = judgedByDefault("heavy_top:ratio=1000,n=5,seed=1");
    EXPECT_TRUE(stack.pass) << stack.why;
    EXPECT_EQ(stack.limit, 0.05) << "m";
}

TEST(PhysicsGate, TowerOverlapsByLessThanFiveCentimetres) {
    const stability::Judgement tower = judgedByDefault("tower:n=6,seed=1");
    EXPECT_TRUE(tower.pass) << tower.why;
    EXPECT_EQ(tower.limit, 0.05) << "m";
}

TEST(PhysicsGate, RampSlidesToFivePerMilleAndSticksToATenthOfAMillimetre) {
    EXPECT_LT(errorOfDefault("ramp-slide"), 0.005);
    EXPECT_LT(errorOfDefault("ramp-stick"), 1e-4);
}

TEST(PhysicsGate, RollingGoesItsWayToTwoPerMille) {
    EXPECT_LT(errorOfDefault("rolling-way"), 0.002);
}

}  // namespace
}  // namespace huestep::tools
