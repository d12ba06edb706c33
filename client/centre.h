/// Where a body is, for whoever acts on bodies by their ids.
#pragma once

#include <optional>

#include "core/world/world.h"

namespace huestep::client {

/// Of its mass, m, in the world; none: the body is not there.
inline std::optional<Vec2> centreOf(const World& world, BodyId body) {
    const std::optional<std::uint32_t> place = world.find(body);
    if (!place) return std::nullopt;
    return world.motions()[*place].position;
}

}  // namespace huestep::client
