/// Two rounded hulls on their way: when they come near each other.
///
/// Method: conservative advancement (Mirtich, "Impulse-based Dynamic Simulation", 1996): from a
/// separation and a bound on how fast it can shrink follows a time before which nothing happens.
/// The bound is taken along the normal of the separation, so that what slides along a surface is
/// done in one or two looks.
#pragma once

#include <optional>

#include "core/collision/hull.h"
#include "core/math/trig.h"

namespace huestep {

/// The signed distance of two hulls: where they overlap, minus the least way apart.
struct Separation {
    float distance = 0.0f;  ///< m
    Vec2 normal;  ///< unit, from A to B, in the frame of A; 0 where two discs' centres meet
};

/// `relative` is B seen from A. A chain segment counts as one of two sides.
Separation separationOf(const Hull& a, const Hull& b, const Pose& relative);

/// A hull that goes evenly from one pose to another in the unit of time.
struct SweptHull {
    const Hull* hull = nullptr;
    Pose from;
    Vec2 travel;         ///< m
    float turn = 0.0f;   ///< rad
    float reach = 0.0f;  ///< m, farthest vertex from the centre, which it turns about

    [[nodiscard]] Pose at(float t) const {
        const Rotation q =
            turn == 0.0f ? from.q : normalized(compose(rotationOf(t * turn), from.q));
        return {from.p + t * travel, q};
    }
};

/// B seen from A at a time. Exact far from the origin too: the way between the two is small.
Pose relativeAt(const SweptHull& a, const SweptHull& b, float t);

/// The time in [0, until) at which the hulls have come to within `tolerance` (m, > 0) of a
/// separation of `target` (m; negative: an overlap), before which they were never nearer than
/// `target`; none if they stay farther apart. Where many looks have not settled it, the time of the
/// last: they may meet later or not at all. Requires that they start farther apart. `atStart`:
/// their separation at time 0.
std::optional<float> timeOfApproach(const SweptHull& a, const SweptHull& b,
                                    const Separation& atStart, float target, float tolerance,
                                    float until);

}  // namespace huestep
