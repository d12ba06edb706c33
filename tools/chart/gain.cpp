#include "tools/chart/gain.h"

#include <cmath>

namespace huestep::tools::chart {

std::optional<Crossing> paysFrom(std::span<const Gain> gains) {
    std::size_t first = gains.size();  // of those at the end that all gain
    while (first > 0 && gains[first - 1].factor > 1.0) --first;
    if (first == gains.size()) return std::nullopt;
    if (first == 0) return Crossing{gains.front().constraints, true};
    const Gain& low = gains[first - 1];
    const Gain& high = gains[first];
    const double share = -std::log(low.factor) / (std::log(high.factor) - std::log(low.factor));
    return Crossing{std::exp(std::log(low.constraints) +
                             share * (std::log(high.constraints) - std::log(low.constraints)))};
}

}  // namespace huestep::tools::chart
