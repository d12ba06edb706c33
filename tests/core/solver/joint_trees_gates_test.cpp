// The gates of the physics page that trees of joints have to pass: rows 11 to 14 and 16, and A5.
#include <cmath>
#include <numbers>

#include "tests/core/pendulum.h"
#include "tests/core/solver/tree_scenes.h"

namespace huestep::test {
namespace {

constexpr double g = 10.0;

Scene heavyChain(const std::string& ratio, const std::string& angle, std::uint32_t substeps) {
    Scene scene = *sceneFromCatalog("chain:ratio=" + ratio + ",angle=" + angle);
    scene.method = Method::Direct;
    scene.substeps = substeps;
    return scene;
}

TEST(TreeGate, ChainHangsToMicrometresWithATonAndToMillimetresWithAHundredTons) {
    for (const std::uint32_t substeps : {1u, 4u, 16u}) {
        SCOPED_TRACE(std::to_string(substeps) + " substeps");
        EXPECT_LT(runOfTree(heavyChain("100", "0", substeps), 10.0).peakError, 2e-6);
        EXPECT_LT(runOfTree(heavyChain("1000", "0", substeps), 10.0).peakError, 2e-6);
        EXPECT_LT(runOfTree(heavyChain("10000", "0", substeps), 10.0).peakError, 5e-5);
        EXPECT_LT(runOfTree(heavyChain("100000", "0", substeps), 10.0).peakError, 1e-3);
    }
}

TEST(TreeGate, ChainSwingsWithATonAndWithTenWithinCentimetresAndGainsNoEnergy) {
    for (const double ratio : {1000.0, 10'000.0}) {
        // m g L: 10 links and the ball, whose centre is 5.6 m from the hook.
        const double scale = g * (ratio * 5.6 + 25.0);
        for (const std::uint32_t substeps : {1u, 4u, 16u}) {
            const RunOfTree seen = runOfTree(
                heavyChain(std::to_string(static_cast<int>(ratio)), "90", substeps), 20.0);
            SCOPED_TRACE(std::to_string(ratio) + ":1, " + std::to_string(substeps) + " substeps");
            EXPECT_LT(seen.peakError, 0.05);
            EXPECT_LT(seen.energyGain, 0.01 * scale);
        }
    }
}

TEST(TreeGate, FirstSwingOfAChainWithATonCostsNoEnergy) {
    // Until the chain goes slack at the far side nothing happens that a substep is too long for.
    const RunOfTree seen = runOfTree(heavyChain("1000", "90", 4), 2.5);
    const double scale = g * (1000.0 * 5.6 + 25.0);
    EXPECT_LT(seen.peakError, 1e-5);
    EXPECT_LT(std::abs(seen.energyLoss), 2e-4 * scale);
}

TEST(TreeGate, BallAndChainHolds) {
    for (const std::uint32_t substeps : {1u, 4u}) {
        const RunOfTree seen = runOfTree(ballAndChain(substeps), 20.0);
        SCOPED_TRACE(std::to_string(substeps) + " substeps");
        EXPECT_LT(seen.peakError, 0.3);
        EXPECT_LT(seen.endError, 0.1);
        EXPECT_LT(seen.energyGain, 0.01 * 4021.0 * g * 48.0);
    }
}

TEST(TreeGate, BridgeHolds) {
    for (const std::uint32_t substeps : {1u, 4u}) {
        const RunOfTree seen = runOfTree(bridge(substeps), 20.0);
        SCOPED_TRACE(std::to_string(substeps) + " substeps");
        EXPECT_LT(seen.peakError, 0.1);
        EXPECT_LT(seen.endError, 0.03);
        EXPECT_LE(seen.energyGain, 1.0);
    }
}

TEST(TreeGate, StretchedChainComesTogetherGently) {
    for (const std::uint32_t substeps : {1u, 4u, 16u}) {
        const RunOfTree seen = runOfTree(stretchedChain(substeps), 5.0);
        SCOPED_TRACE(std::to_string(substeps) + " substeps");
        EXPECT_NEAR(seen.peakError, 0.95, 0.06) << "it starts 1 m apart";
        EXPECT_LT(seen.peakSpeed, 1.0);
        EXPECT_LT(seen.endError, 1e-5);
    }
}

TEST(TreeGate, PendulumIsOfSecondOrderAndKeepsItsEnergy) {
    const double exact = pendulumPeriod(0.5 * std::numbers::pi);
    std::vector<double> errors;
    for (const std::uint32_t substeps : {1u, 4u, 16u}) {
        Scene scene = *sceneFromCatalog("pendulum:angle=90");
        scene.method = Method::Direct;
        scene.substeps = substeps;
        World world = worldOf(scene);
        const double start = measuresOf(world).energy;
        const double scale = wide(world.bodies()[1].mass) * g;
        errors.push_back(std::abs(measuredPeriod(world, 600) / exact - 1.0));
        const double loss = (start - measuresOf(world).energy) / scale;
        SCOPED_TRACE(std::to_string(substeps) + " substeps: period off by " +
                     std::to_string(1e6 * errors.back()) + " ppm, energy lost " +
                     std::to_string(1e6 * loss) + " ppm");
        EXPECT_LT(std::abs(loss), 2e-3);
        RecordProperty("period" + std::to_string(substeps), std::to_string(errors.back()));
        RecordProperty("loss" + std::to_string(substeps), std::to_string(loss));
    }
    EXPECT_LT(errors[1], 1e-4);
    EXPECT_GT(std::log2(errors[0] / errors[1]) / 2.0, 1.8) << "order of convergence";
}

}  // namespace
}  // namespace huestep::test
