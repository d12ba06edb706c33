/// How long a pendulum takes: in closed form, and as a world shows it.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/core/support.h"

namespace huestep::test {

/// Arithmetic-geometric mean: it doubles its digits with every turn.
inline double agm(double a, double b) {
    for (int i = 0; i < 8; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return a;
}

/// s, under 10 m/s², of the scene "pendulum" let go at `angle` (rad): a disc of radius 0.1 m, 1 m
/// from its pivot, so the equivalent length is 1 + I/(m L) = 1.005 m.
inline double pendulumPeriod(double angle) {
    return 2.0 * std::numbers::pi * std::sqrt(1.005 / 10.0) / agm(1.0, std::cos(0.5 * angle));
}

/// s, as seen over so many ticks of 1/60 s: passages of the second body through x = 0, interpolated
/// by the cubic that positions and velocities at both ends of a tick give. Not a number of fewer
/// than seven passages.
inline double measuredPeriod(World& world, int ticks) {
    constexpr double dt = 1.0 / 60.0;
    std::vector<double> passages;
    for (int tick = 0; tick < ticks; ++tick) {
        const BodyMotion before = world.motions()[1];
        world.step({});
        const BodyMotion after = world.motions()[1];
        const double x0 = wide(before.position.x), x1 = wide(after.position.x);
        if ((x0 < 0.0) == (x1 < 0.0)) continue;
        const double v0 = dt * wide(before.velocity.x), v1 = dt * wide(after.velocity.x);
        double low = 0.0, high = 1.0;
        for (int i = 0; i < 60; ++i) {
            const double t = 0.5 * (low + high);
            const double x = (1 + 2 * t) * (1 - t) * (1 - t) * x0 + t * (1 - t) * (1 - t) * v0 +
                             t * t * (3 - 2 * t) * x1 + t * t * (t - 1) * v1;
            ((x < 0.0) == (x0 < 0.0) ? low : high) = t;
        }
        passages.push_back(dt * (tick + low));
    }
    if (passages.size() < 7) return std::numeric_limits<double>::quiet_NaN();
    return 2.0 * (passages.back() - passages.front()) / static_cast<double>(passages.size() - 1);
}

}  // namespace huestep::test
