/// What tests of joints ask of a world.
#pragma once

#include <cmath>

#include "core/scene/measure.h"
#include "tests/core/support.h"

namespace huestep::test {

/// rad, in (−π, π].
inline double angleOfBody(const World& world, BodyId id) {
    const BodyMotion m = motionOf(world, id);
    return std::atan2(wide(m.rotation.s), wide(m.rotation.c));
}

/// The largest joint error, m.
inline double errorOf(const World& world) {
    return measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions())
        .maxJointError;
}

}  // namespace huestep::test
