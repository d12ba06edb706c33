/// A pair of shapes whose fat bounds overlap: its contact state, and what is derived from it.
#pragma once

#include <cstdint>

#include "core/collision/manifold.h"
#include "core/state/records.h"

namespace huestep {

/// Speculative margin: points up to this far apart are contact points. See physics page.
inline constexpr float speculativeDistance = 0.02f;  // m

/// One candidate pair. `state` is state while `pointCount` > 0 and means nothing otherwise; all
/// else is an accelerator. The array of contacts is sorted by key, so place order is key order.
struct Contact {
    ContactState state;
    std::uint32_t bodyA = 0;  ///< places in the world's arrays
    std::uint32_t bodyB = 0;
    std::uint32_t placeA = 0;  ///< of the shapes
    std::uint32_t placeB = 0;
    float friction = 0;
    float restitution = 0;
    float rollingResistance = 0;  ///< m: coefficient times the larger radius
    float tangentSpeed = 0;
    float reach = 0;      ///< m: farthest point of either body that can turn, from its centre
    float roundness = 0;  ///< m: the larger radius
    float slack = 0;      ///< m: how far the bodies may move while a manifold is kept
    std::uint8_t pointCount = 0;  ///< 0: not touching

    // The manifold at `state.relative`, turned into the world as body A was then. Anchors are from
    // the two centres of mass; they coincided when the manifold was made.
    Vec2 normal;
    Vec2 anchorA[2];
    Vec2 anchorB[2];
    Rotation rotationA;  // of the bodies then
    Rotation rotationB;
    float separation[2]{};
    std::uint16_t feature[2]{};
};

}  // namespace huestep
