/// The collide stage: from poses and the last step's contacts to this step's.
#pragma once

#include <span>

#include "core/collision/hull.h"
#include "core/contact/contact.h"

namespace huestep {

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
/// state alone.
ContactUpdate updateContact(Contact& contact, const NarrowPhaseInput& in);

/// Makes the manifold of `state.relative` again, where it was dropped.
void remakeManifold(Contact& contact, const NarrowPhaseInput& in);

}  // namespace huestep
