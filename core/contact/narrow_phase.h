/// The collide stage: from poses and the last step's contacts to this step's.
#pragma once

#include <span>

#include "core/collision/hull.h"
#include "core/contact/contact.h"

namespace huestep {

// Recycling (physics page, 4): a manifold is kept while no point of its bodies has moved more
// than the contact's slack (at most 5 cm) against the other body since it was made, and neither has
// turned by 11.5° in the world. Its separations follow the bodies; its points, its normal and the
// arms of its rows stay. That is what holds tall stacks up: rows whose arms follow the tilt of a
// box feed that tilt (measured here: with rows that follow, 14 boxes stand and 15 fall; with rows
// that stay, 100 stand).
inline constexpr float recycleCosine = 0.98f;
// A rounded surface that rolls by θ lifts a kept anchor by r(1 − cos θ): keep that below 0.5 mm.
inline constexpr float recycleLift = 0.0005f;  // m

/// What the narrow phase reads. Place i of `hulls` and `bounds` is shape i.
struct NarrowPhaseInput {
    std::span<const BodyMotion> motions;
    std::span<const Hull> hulls;
    std::span<const Bounds> bounds;  ///< tight, grown by half the speculative margin
};

enum class ContactUpdate : std::uint8_t { Apart, Recycled, Fresh };

/// Brings one contact up to date: drops it where the bounds are apart, keeps its manifold where the
/// bodies have hardly moved against each other since it was made, makes a new one and matches
/// impulses by feature otherwise. A function of the two motions, the two shapes and the contact's
/// state alone. `ContactKernels::check` finds those that stay for many at once.
ContactUpdate updateContact(Contact& contact, const NarrowPhaseInput& in);

/// The same for a contact that is known not to stay as it is.
ContactUpdate renewContact(Contact& contact, const NarrowPhaseInput& in);

/// The manifold of two shapes as they are now; no points where they do not touch. `bodyA` and
/// `bodyB` are places of motions, `shapeA` and `shapeB` of hulls.
Manifold manifoldOf(std::uint32_t bodyA, std::uint32_t bodyB, std::uint32_t shapeA,
                    std::uint32_t shapeB, const NarrowPhaseInput& in);

/// Gives a new contact its first manifold, that of `manifoldOf`.
void beginContact(Contact& contact, const Manifold& manifold, const NarrowPhaseInput& in);

/// Makes the manifold at the relative pose again, where it was dropped.
void remakeManifold(Contact& contact, const Pose& relative, const NarrowPhaseInput& in);

}  // namespace huestep
