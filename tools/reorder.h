/// The same scene by other histories: other orders of creation, and noise that was created and
/// destroyed. What must come out equal is written beside each.
#pragma once

#include <cstdint>
#include <vector>

#include "core/result.h"
#include "core/scene/scene.h"
#include "core/world/command.h"

namespace huestep::tools {

/// The scene with every id written out as a world would give it. Requires a checked scene.
Result<Scene> withExplicitIds(const Scene& scene);

/// The scene's bodies and joints listed in another order, drawn from the seed. A world of it must
/// equal a world of the scene from tick 0. Requires explicit ids.
Scene shuffled(const Scene& scene, std::uint64_t seed);

/// A scene with noise: bodies with contacts and joints of their own, far from all others.
struct Noisy {
    Scene scene;
    std::vector<Command> removal;  ///< host commands that remove the noise, in key order
};

/// Noise with ids above all others of the scene, listed among the others. Requires explicit ids.
Result<Noisy> withNoiseAbove(const Scene& scene);

/// The ids of the scene doubled, and noise with the odd ids between them. Requires explicit ids.
Result<Noisy> withNoiseBetween(const Scene& scene);

/// The scene without noise, but with counters as if it had had it: where `noisy`'s counters are.
Result<Scene> withCountersOf(const Scene& scene, const Noisy& noisy);

}  // namespace huestep::tools
