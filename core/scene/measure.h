/// First measures of accuracy, in double, from nothing but definitions and motions, so that they
/// judge every engine alike (physics page: A1, A3, A4; A5 and A7 have their own scenes).
#pragma once

#include <span>

#include "core/scene/scene.h"
#include "core/state/records.h"

namespace huestep {

/// Of motions that are not finite the energy is no finite number, and a penetration or joint error
/// that such a body has part in is infinite.
struct Measures {
    double energy = 0.0;  ///< J: Σ m v²/2 + I ω²/2 − m g·x, of dynamic bodies, where g
                          ///< is the gravity that the body feels (its scale included)
    double maxPenetration = 0.0;   ///< m, from a fresh narrow phase in double; 0: none
    double meanPenetration = 0.0;  ///< m, over the pairs of shapes that overlap and may touch
    /// m, largest |pA − pB| of revolutes; of distance joints how far the length is outside the
    /// limit or, without limit and spring, off the rest length; of prismatic joints how far B's
    /// anchor is off the axis or outside the limit, of welds |pA − pB|. Where the angle is held,
    /// also how far it swings B's centre about B's anchor from where it should be.
    double maxJointError = 0.0;
};

/// J: m v²/2 + I ω²/2.
double kineticEnergy(const BodyInfo& body, const BodyMotion& motion);

/// J: what drift and injection of energy are measured against (E_scale): the weight of the dynamic
/// bodies times the diagonal of the box around all centres, at least 1 m, plus their kinetic
/// energy. 1 where that is 0.
double energyScale(const WorldInfo& world, std::span<const BodyInfo> bodies,
                   std::span<const BodyMotion> motions);

/// The parts of `measure` by themselves.
double energyOf(const WorldInfo& world, std::span<const BodyInfo> bodies,
                std::span<const BodyMotion> motions);
double maxJointErrorOf(std::span<const BodyInfo> bodies, std::span<const JointInfo> joints,
                       std::span<const BodyMotion> motions);

/// O(n log n) with a sweep along x: 22,000 bodies in pyramids take some tens of milliseconds.
/// `bodies`, `shapes`, `joints` and `motions` as `World` shows them: sorted by id, places matching.
Measures measure(const WorldInfo& world, std::span<const BodyInfo> bodies,
                 std::span<const ShapeInfo> shapes, std::span<const JointInfo> joints,
                 std::span<const BodyMotion> motions);

}  // namespace huestep
