/// Which constraints touch a body: for methods that sum over a body's constraints.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/graph/coloring.h"

namespace huestep {

/// The sides of all constraints of a plan, by body. A slot is 2 · row + side (0: A, 1: B), where
/// rows are counted through the joints, the lanes of revolutes and the lanes of contacts, each in
/// solving order. Slots of padding, and of bodies that are not moved, belong to nobody.
struct Incidence {
    std::vector<std::uint32_t> first;  ///< solver place → first of its touches; one more at the end
    std::vector<std::uint32_t> touches;  ///< slots, rising for each place
    std::uint32_t joints = 0;            ///< rows
    std::uint32_t revoluteLanes = 0;
    std::uint32_t contactLanes = 0;

    [[nodiscard]] std::uint32_t slots() const {
        return 2 * (joints + revoluteLanes + contactLanes);
    }
    [[nodiscard]] std::uint32_t slotOfRevolute(std::uint32_t lane) const {
        return 2 * (joints + lane);
    }
    [[nodiscard]] std::uint32_t slotOfContact(std::uint32_t lane) const {
        return 2 * (joints + revoluteLanes + lane);
    }
    [[nodiscard]] std::span<const std::uint32_t> touchesOf(std::uint32_t place) const {
        return std::span(touches).subspan(first[place], first[place + 1] - first[place]);
    }
};

/// The bodies of each row in the order of slots; of padding, twice `fixedWorld`. A joint whose two
/// places are one body is B's alone.
Incidence incidenceOf(std::span<const ConstraintBodies> joints,
                      std::span<const ConstraintBodies> revoluteLanes,
                      std::span<const ConstraintBodies> contactLanes, std::uint32_t placeCount);

}  // namespace huestep
