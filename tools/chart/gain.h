/// From which size on a way is worth while.
#pragma once

#include <optional>
#include <span>

namespace huestep::tools::chart {

/// A size and by what factor one way is faster than another there.
struct Gain {
    double constraints = 0.0;
    double factor = 1.0;
};

/// From how many constraints on a way is faster at every larger size that was measured; none: not
/// even at the largest. `gains` by rising size; between two of them linear in the logarithms.
std::optional<double> paysFrom(std::span<const Gain> gains);

}  // namespace huestep::tools::chart
