// The front and the crossing against their definitions, by brute force.
#include "tools/chart/pareto.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tools/chart/gain.h"
#include "tools/statistics.h"

namespace huestep::tools::chart {
namespace {

bool beats(const Cost& p, const Cost& q) {
    return p.error <= q.error && p.time <= q.time && (p.error < q.error || p.time < q.time);
}

TEST(ParetoFront, HoldsWhatNoOtherPointBeats) {
    const std::uint64_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    for (int round = 0; round < 300; ++round) {
        std::vector<Cost> points(1 + random() % 30);
        // Few values, so that many points share one, some of them a failure's.
        for (Cost& p : points) {
            p = {static_cast<double>(random() % 8), static_cast<double>(random() % 8)};
            if (p.error == 7.0) p.error = std::numeric_limits<double>::infinity();
        }
        const std::vector<bool> front = paretoFront(points);
        ASSERT_EQ(front.size(), points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            bool beaten = !std::isfinite(points[i].error);
            for (const Cost& other : points) beaten = beaten || beats(other, points[i]);
            EXPECT_EQ(front[i], !beaten) << "point " << i << " of round " << round;
        }
    }
}

TEST(ParetoFront, OfNothingIsNothing) {
    EXPECT_TRUE(paretoFront({}).empty());
}

TEST(Gain, PaysFromWhereEveryLargerSizeGains) {
    const std::uint64_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> factor(0.5, 2.0);
    for (int round = 0; round < 300; ++round) {
        std::vector<Gain> gains(1 + random() % 6);
        double size = 1.0;
        for (Gain& gain : gains) gain = {size *= 3.0, factor(random)};
        const std::optional<Crossing> from = paysFrom(gains);
        EXPECT_EQ(from.has_value(), gains.back().factor > 1.0);
        for (const Gain& gain : gains) {
            if (!from) break;
            // Sizes from there on gain; the one before, if any, does not.
            const bool after = gain.constraints >= from->constraints;
            const bool before = !after && 3.0 * gain.constraints > from->constraints;
            EXPECT_TRUE(!after || gain.factor > 1.0) << gain.constraints;
            EXPECT_TRUE(!before || gain.factor <= 1.0) << gain.constraints;
        }
    }
}

TEST(Gain, LiesBetweenTwoSizesByTheirLogarithms) {
    const Gain gains[] = {{10.0, 0.5}, {1000.0, 2.0}};
    EXPECT_NEAR(paysFrom(gains).value_or(Crossing{}).constraints, 100.0, 1e-9);
    EXPECT_FALSE(paysFrom(gains).value_or(Crossing{}).atMost);
    // Where it pays at all sizes it pays from at most the smallest.
    EXPECT_EQ(paysFrom(std::span(gains).last(1)), (Crossing{gains[1].constraints, true}));
    EXPECT_EQ(paysFrom(std::span(gains, 1)), std::nullopt);
    EXPECT_EQ(paysFrom({}), std::nullopt);
}

TEST(Quantile, LiesAmongTheSortedSamplesAtItsShare) {
    const std::uint64_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (std::size_t count = 1; count < 40; ++count) {
        std::vector<double> samples(count);
        for (double& sample : samples) sample = any(random);
        // Insertion into place: no sort of the library's.
        std::vector<double> sorted;
        for (const double sample : samples) {
            std::size_t at = 0;
            while (at < sorted.size() && sorted[at] < sample) ++at;
            sorted.insert(sorted.begin() + static_cast<std::ptrdiff_t>(at), sample);
        }
        for (const std::size_t quarter : {0u, 1u, 2u, 3u, 4u}) {
            const std::size_t steps = quarter * (count - 1);
            const std::size_t low = steps / 4;
            const double share = static_cast<double>(steps % 4) / 4.0;
            const double high = sorted[std::min(low + 1, count - 1)];
            EXPECT_NEAR(quantile(samples, static_cast<double>(quarter) / 4.0),
                        sorted[low] + share * (high - sorted[low]), 1e-12)
                << quarter << " quarters of " << count;
        }
    }
}

}  // namespace
}  // namespace huestep::tools::chart
