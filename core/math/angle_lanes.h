/// The angle of a rotation, W at a time, in single precision.
#pragma once

#include "core/math/lanes.h"

namespace huestep {

/// The angle of (c, s), in (−π, π], of vectors of any length that is not zero; (0, 0) gives 0.
/// Absolute error below 4e-7 rad. For rows, where an angle is wanted many times a step; `angleOf`
/// is exact to the last bit.
template <int W>
HUESTEP_INLINE LaneF<W> angleLanes(const LaneF<W>& c, const LaneF<W>& s) {
    const auto constant = [](double x) __attribute__((always_inline)) {
        return splat<W>(static_cast<float>(x));
    };
    const LaneF<W> zero = constant(0.0), one = constant(1.0);
    constexpr double quarterTurn = 1.57079632679489661923;
    const LaneF<W> cosine = selectLanes(c < zero, zero - c, c);
    const LaneF<W> sine = selectLanes(s < zero, zero - s, s);
    const auto steep = sine > cosine;
    const LaneF<W> longer = selectLanes(steep, sine, cosine);
    const LaneF<W> shorter = selectLanes(steep, cosine, sine);
    const LaneF<W> t = shorter / selectLanes(longer > zero, longer, one);  // in [0, 1]
    // atan t = π/4 + atan((t − 1)/(t + 1)) brings it within tan(π/8) of 0.
    const auto far = t > constant(0.41421356237309504880);
    const LaneF<W> x = selectLanes(far, (t - one) / (t + one), t);
    const LaneF<W> x2 = x * x;
    // atan x = x − x³/3 + x⁵/5 − …: nine terms leave less than 3e-9.
    LaneF<W> sum = constant(1.0 / 17);
    sum = constant(1.0 / 15) - x2 * sum;
    sum = constant(1.0 / 13) - x2 * sum;
    sum = constant(1.0 / 11) - x2 * sum;
    sum = constant(1.0 / 9) - x2 * sum;
    sum = constant(1.0 / 7) - x2 * sum;
    sum = constant(1.0 / 5) - x2 * sum;
    sum = constant(1.0 / 3) - x2 * sum;
    const LaneF<W> near = x - x * x2 * sum;
    const LaneF<W> eighth = selectLanes(far, constant(0.5 * quarterTurn) + near, near);
    const LaneF<W> quarter = selectLanes(steep, constant(quarterTurn) - eighth, eighth);
    const LaneF<W> half = selectLanes(c < zero, constant(2.0 * quarterTurn) - quarter, quarter);
    return selectLanes(s < zero, zero - half, half);
}

}  // namespace huestep
