/// Rays against rounded hulls.
#pragma once

#include <optional>

#include "core/collision/hull.h"

namespace huestep {

struct HullHit {
    float fraction = 0.0f;  ///< of the way from `from` to `to`, [0, 1]
    Vec2 normal;            ///< outward, in the frame of the hull
};

/// Where the segment from `from` to `to` enters the hull, in the hull's frame. A segment that
/// starts inside does not hit, as a ray that is cast from within a body should not meet it. A chain
/// segment is met from its front alone.
std::optional<HullHit> castRayAtHull(const Hull& hull, Vec2 from, Vec2 to);

}  // namespace huestep
