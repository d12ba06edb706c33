/// Plays many combinations of stories and ways, some side by side, and finds the first difference.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "tools/story.h"

namespace huestep::tools {

struct Combination {
    std::size_t story = 0;  ///< place in the list of stories
    Way way;
};

struct Outcome {
    std::uint64_t tick = 0;        ///< of the world at the end
    std::uint64_t motionRoot = 0;  ///< at the end
    std::uint64_t fullRoot = 0;
    std::uint64_t rootsCompared = 0;
    /// Tick of the world in which a root was not what it must be.
    std::optional<std::uint64_t> differsAt;
    bool recordDiffers = false;  ///< it was a recorded root
    std::string failure;         ///< a snapshot that did not restore
    bool ended = false;          ///< played and compared to its end; false: stopped by Ctrl-C
    [[nodiscard]] bool fails() const { return differsAt || !failure.empty(); }
    /// Of one that does not fail: only at its end is it known to be equal.
    [[nodiscard]] bool equal() const { return ended && !fails(); }
    /// Whether there is nothing more to learn of it.
    [[nodiscard]] bool decided() const { return ended || fails(); }
};

struct Comparison {
    std::vector<Outcome> outcomes;              ///< place i: of combination i
    [[nodiscard]] bool finished() const;        ///< false: stopped by Ctrl-C
    [[nodiscard]] std::size_t decided() const;  ///< outcomes that are
};

/// Plays all combinations, `jobs` at a time. The first combination of each story that is its own
/// reference is what others are compared with; results do not depend on `jobs`.
Comparison playAll(const std::vector<Story>& stories, const std::vector<Combination>& combinations,
                   int jobs);

/// Plays the reference and the combination again to the tick in which they differ.
Result<std::optional<Difference>> nameDifference(const std::vector<Story>& stories,
                                                 const Combination& reference,
                                                 const Combination& other, std::uint64_t tick);

}  // namespace huestep::tools
