/// Box2D 2.4 as an engine beside Huestep.
///
/// It steps as Box2D's users do: 8 velocity and 3 position iterations, continuous collision on,
/// sleeping as the scene says; `Scene::substeps` means nothing to it.
///
/// Thread rule: Box2D writes global counters from its distance and time-of-impact functions, so no
/// two Box2D engines of one process may be built, stepped or destroyed at the same time. One
/// engine after another, from any thread, is allowed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/scene/engine.h"

namespace huestep {

/// A scene in a `b2World`, created in the given order. The scene must have passed `check`. Fails
/// where `makeB2World` (core/box2d/b2world.h) does, with its sentence; `notes`, if given, gets its
/// sentences about what Box2D leaves out or approximates.
Result<std::unique_ptr<Engine>> makeBox2dEngine(const Scene& scene, const BuildOrder& order = {},
                                                std::vector<std::string>* notes = nullptr);

}  // namespace huestep
