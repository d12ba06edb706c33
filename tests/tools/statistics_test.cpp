// Quantiles from counts against quantiles from all samples, sorted.
#include "tools/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace huestep::tools {
namespace {

TEST(Histogram, GivesTheQuantilesOfTheSortedSamplesToWithinAFiveHundredthOfTheirValue) {
    const std::uint64_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    for (const std::size_t count : {1u, 2u, 3u, 1'000u, 20'000u}) {
        Histogram histogram;
        std::vector<std::uint64_t> samples;
        for (std::size_t i = 0; i < count; ++i) {
            samples.push_back(random() >> (random() % 64));  // of every size up to 64 bits
            histogram.add(samples.back());
        }
        std::sort(samples.begin(), samples.end());
        for (const double q : {0.0, 0.25, 0.5, 0.75, 0.99, 1.0}) {
            const auto place = static_cast<std::size_t>(q * static_cast<double>(count - 1));
            const auto exact = static_cast<double>(samples[place]);
            EXPECT_NEAR(histogram.quantile(q), exact, exact < 512.0 ? 0.0 : exact / 500.0)
                << q << " of " << count;
        }
    }
}

TEST(Histogram, HoldsTheLargestSampleAndNone) {
    Histogram histogram;
    EXPECT_EQ(histogram.quantile(0.5), 0.0);
    histogram.add(~std::uint64_t{0});
    EXPECT_NEAR(histogram.quantile(0.5), 18446744073709551615.0, 18446744073709551615.0 / 500.0);
}

}  // namespace
}  // namespace huestep::tools
