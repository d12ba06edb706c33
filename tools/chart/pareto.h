/// Which points of a work-precision diagram are worth choosing.
#pragma once

#include <span>
#include <vector>

namespace huestep::tools::chart {

/// What a point costs, and how wrong it is; either may be infinite, neither NaN.
struct Cost {
    double error = 0.0;
    double time = 0.0;
};

/// Place i: whether no other point has at most the error and at most the time of point i, and less
/// of one of the two. Of equal points all are on the front or none. A failure, whose error is
/// infinite, is on no front.
std::vector<bool> paretoFront(std::span<const Cost> points);

}  // namespace huestep::tools::chart
