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

/// From which size on a way pays.
struct Crossing {
    double constraints = 0.0;
    bool atMost = false;  ///< it pays at the smallest size that was measured, and may below
    friend bool operator==(const Crossing&, const Crossing&) = default;
};

/// From how many constraints on a way is faster at every larger size that was measured; none: not
/// even at the largest. `gains` by rising size; between two of them linear in the logarithms.
std::optional<Crossing> paysFrom(std::span<const Gain> gains);

}  // namespace huestep::tools::chart
