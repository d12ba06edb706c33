#include "tools/chart/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace huestep::tools::chart {

std::vector<bool> paretoFront(std::span<const Cost> points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const Cost& p = points[a];
        const Cost& q = points[b];
        return p.error != q.error ? p.error < q.error : p.time < q.time;
    });
    std::vector<bool> front(points.size(), false);
    double least = std::numeric_limits<double>::infinity();  // time, of points with less error
    for (std::size_t i = 0; i < order.size();) {
        const Cost& best = points[order[i]];  // of those with its error
        if (!std::isfinite(best.error)) break;
        for (; i < order.size() && points[order[i]].error == best.error; ++i)
            front[order[i]] = points[order[i]].time == best.time && best.time < least;
        least = std::min(least, best.time);
    }
    return front;
}

}  // namespace huestep::tools::chart
