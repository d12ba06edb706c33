/// Queries as functions of a state: the world's own, and those of its rules. Private to core/world.
#pragma once

#include <vector>

#include "core/state/state.h"
#include "core/world/world.h"

namespace huestep {

/// As `World::castRay` and `World::overlap`.
std::vector<RayHit> castRay(const WorldState& state, Vec2 from, Vec2 to);
std::vector<ShapeId> overlapping(const WorldState& state, const ShapeDef& shape, const Pose& pose);

}  // namespace huestep
