/// Where and how a built-in scene stands: disturbed a little, turned, far from the origin. What
/// does not depend on the frame must not depend on any of it (physics page, A19 and the suite).
#pragma once

#include <cstdint>

#include "core/math/vec.h"
#include "core/scene/scene.h"
#include "core/world/command.h"

namespace huestep {

/// A value; the standard one leaves a scene as it is.
struct Placement {
    /// ≠ 0: every dynamic body that is on no joint starts up to 1 mm, or a tenth of its thickness
    /// if that is less, to either side of its place along x and y, and up to 1 mrad turned. One on
    /// a joint, which that would break, starts with up to 1 mm/s and 1 mrad/s more.
    std::uint64_t seed = 0;
    double turn = 0.0;  ///< degrees, counter-clockwise about the origin, gravity too
    double far = 0.0;   ///< km from the origin, along (0.8, −0.6)

    friend bool operator==(const Placement&, const Placement&) = default;
};

/// The pose of the scene's own frame in the world, in double.
PoseT<double> frameOf(const Placement& placement);

/// Puts a scene into the world; positions are rounded once. Definitions of shapes and joints are
/// in the frames of their bodies and stay.
void place(Scene& scene, const Placement& placement);

/// The same for what its host does.
void place(Action& action, const Placement& placement);

}  // namespace huestep
