/// Hubs: bodies with so many contacts that colouring would leave nearly every one of them a colour
/// to itself, and those beyond the last colour to one thread.
///
/// A hub's contacts leave the colours. They are solved in buckets of one contact block each: every
/// lane has a copy of the hub with its share of the mass, and the copies' mean is the hub's new
/// velocity. Gauss-Seidel from bucket to bucket, Jacobi with mass splitting within one (Tonge,
/// Benevolenski, Voroshilov, "Mass Splitting for Jitter-Free Parallel Rigid Body Simulation",
/// 2012).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/graph/coloring.h"

namespace huestep {

/// Contacts that a body may have before it is a hub: more than the 6 to 12 that a pile's bodies
/// have, less than the colours that there are. Those with moving bodies and those with fixed ones
/// are counted apart, as they are coloured apart.
inline constexpr std::uint32_t standardHubDegree = 32;

/// Contacts of one hub, no two with the same other body that moves; in key order.
struct HubRun {
    BodyPlace hub = fixedWorld;
    bool fixed = false;  ///< the others do not move
    std::vector<std::uint32_t> constraints;
};

/// The runs of all hubs: first those with moving others, then those with fixed ones; by hub, then
/// by how often the other body has met the hub before in key order. `contacts`: of places below
/// `bodyCount`, negative ones fixed. A contact of two hubs is in no run.
std::vector<HubRun> findHubs(std::span<const ConstraintBodies> contacts, std::uint32_t bodyCount,
                             std::uint32_t hubDegree = standardHubDegree);

}  // namespace huestep
