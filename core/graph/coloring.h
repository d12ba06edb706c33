/// Colouring: constraints of one colour share no body that moves, so they can be solved side by
/// side and still be Gauss-Seidel from colour to colour.
///
/// Colour from nothing: first fit over the sorted list, with one 64-bit mask a body. A pure
/// function of the list; nothing is kept from step to step (design, "Colour from nothing").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/solver/contact_block.h"

namespace huestep {

/// Colours in the order in which they are solved.
inline constexpr std::uint8_t overflowColour = 64;        ///< after 0 … 63; solved one by one
inline constexpr std::uint8_t hubColour = 65;             ///< of hubs, in buckets (hubs.h)
inline constexpr std::uint8_t firstFixedColour = 66;      ///< against static or kinematic bodies
inline constexpr std::uint8_t fixedOverflowColour = 130;  ///< after 66 … 129; solved one by one
inline constexpr std::uint8_t fixedHubColour = 131;       ///< of hubs, in buckets
inline constexpr int colourCount = 132;

/// Whether constraints of a colour may share bodies, so that one worker takes them in key order.
constexpr bool isSerial(std::uint8_t colour) {
    return colour == overflowColour || colour == fixedOverflowColour;
}
/// Whether constraints of a colour are those of hubs.
constexpr bool isHub(std::uint8_t colour) {
    return colour == hubColour || colour == fixedHubColour;
}

/// The bodies of a constraint; negative: one that is never written (see `BodyPlace`).
struct ConstraintBodies {
    BodyPlace a = fixedWorld;
    BodyPlace b = fixedWorld;
};

/// A colour for each constraint. Places are below `bodyCount`. Constraints between two moving
/// bodies get the lowest colour below 64 that is free at both, those with one the lowest from
/// `firstFixedColour`; what finds none goes to the overflow of its kind. Where `colours`, as long
/// as the list, says that a constraint is a hub's, it stays that.
void color(std::span<const ConstraintBodies> constraints, std::uint32_t bodyCount,
           std::vector<std::uint8_t>& colours);

}  // namespace huestep
