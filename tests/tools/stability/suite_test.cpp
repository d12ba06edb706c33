// The suite as the chart runs it.
#include "tools/stability/suite.h"

#include <gtest/gtest.h>

#include <map>

namespace huestep::tools {
namespace {

/// Verdicts of two chains with a ball of 100 links, hanging and swinging, with so many substeps.
std::map<std::string, StabilityVerdict> chains(std::uint32_t substeps, bool frontier) {
    StabilityOptions options;
    options.configuration.substeps = substeps;
    options.effort = StabilityEffort::Quick;
    options.scenes = {"chain:ratio=100"};
    options.frontier = frontier;
    const Result<StabilityResult> result = runStability(options);
    EXPECT_TRUE(result.ok());
    std::map<std::string, StabilityVerdict> verdicts;
    for (const StabilityVerdict& verdict : result->verdicts) verdicts[verdict.scene] = verdict;
    return verdicts;
}

TEST(Suite, FindsFrontiersInItsQuickFormTooAndWhereItIsNotAskedToItSaysSo) {
    const auto found = chains(4, true);
    ASSERT_EQ(found.size(), 2u);
    std::map<std::string, int> fewest;
    for (const std::uint32_t substeps : {32u, 16u, 8u, 4u, 2u, 1u}) {
        for (const auto& [scene, verdict] : chains(substeps, false)) {
            EXPECT_EQ(verdict.frontier, -1);
            if (verdict.pass) fewest[scene] = static_cast<int>(substeps);
        }
    }
    for (const auto& [scene, verdict] : found) EXPECT_EQ(verdict.frontier, fewest[scene]) << scene;
    EXPECT_GT(fewest["chain:ratio=100,seed=1"], 4) << "the floor law: 15 mm at n = 4, of 10";
}

}  // namespace
}  // namespace huestep::tools
