/// The same scene by other histories: other orders of creation, and noise that was created and
/// destroyed.
#pragma once

#include <cstdint>
#include <vector>

#include "core/result.h"
#include "core/scene/scene.h"
#include "core/world/command.h"

namespace huestep::tools {

/// The scene's bodies and joints, with the ids that they have in its own order, listed in another
/// one drawn from the seed. A world of it must equal a world of the scene from tick 0.
Scene shuffled(const Scene& scene, std::uint64_t seed);

/// Which ids the scene's bodies and joints have in its worlds with and without noise.
struct NoiseIds {
    Counters from;  ///< where those of a world of the scene itself begin to count
    Counters to;    ///< and those of the worlds with and without noise

    /// A command to a world of the scene, with the ids that it must name in the others.
    [[nodiscard]] Command renamed(Command command) const;
};

/// A scene with and without noise: bodies far from all others, with contacts and joints of their
/// own, whose ids lie between and above the scene's.
struct NoisePair {
    /// The scene, its ids doubled to leave room, its counters where the noise would have left them.
    Scene quiet;
    Scene noisy;
    /// Host commands that remove the noise. Given to both worlds in the same tick they must leave
    /// the same state: in the quiet one they name bodies that do not exist and are rejected, and
    /// the sequence of a rejected command counts as that of an applied one does.
    std::vector<Command> removal;
    NoiseIds ids;
};

/// Requires a checked scene. Fails if its ids are too high to be doubled, or if the world has no
/// room for noise beside it: no free body, or none to the left and right of what is there.
Result<NoisePair> withNoise(const Scene& scene);

}  // namespace huestep::tools
