/// Seats of a game: an array of who holds each, in which 0 is free.
#pragma once

#include <algorithm>
#include <optional>
#include <span>

#include "core/state/records.h"

namespace huestep::games {

/// Which seat the player has; none for 0.
inline std::optional<std::size_t> seatOf(std::span<const PlayerId> seats, PlayerId player) {
    const auto at = std::find(seats.begin(), seats.end(), player);
    if (player == 0 || at == seats.end()) return std::nullopt;
    return static_cast<std::size_t>(at - seats.begin());
}

}  // namespace huestep::games
