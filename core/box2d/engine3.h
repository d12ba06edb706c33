/// Box2D 3 as an engine beside Huestep: for comparisons, never required.
///
/// Compiled where CMake is given an installation by HUESTEP_BOX2D3_DIR; the target huestep_box2d3
/// then exists and defines HUESTEP_HAS_BOX2D3. Written for the interface of Box2D 3.2.
#pragma once

#include <memory>

#include "core/result.h"
#include "core/scene/engine.h"

namespace huestep {

/// A scene in a Box2D 3 world with 4 substeps, as its users have it, on `threads` threads (1 to
/// 32) of its own. Everything of a scene is carried over, but for the spin of a body of fixed
/// rotation; its default softness stays. The scene must have passed `check`. Fails, with a path,
/// for polygons and segments that Box2D 3 would weld or flatten. Thread rule: one caller; several
/// engines may live side by side, but are built and destroyed one at a time.
Result<std::unique_ptr<Engine>> makeBox2d3Engine(const Scene& scene, int threads = 1);

}  // namespace huestep
