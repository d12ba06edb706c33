/// The stability suite of the physics page: 28 rows of scenes that solvers fall over, each with the
/// numbers that say whether one did.
///
/// A row has scenes, one for each of its parameters; each is run as it stands and once more with
/// gravity and everything else turned. What a scene must hold is judged in double, from definitions
/// and motions alone, so every engine and method is judged alike.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace huestep::tools {

/// What takes the steps: an engine, and of Huestep a method and its effort.
struct StabilityConfiguration {
    std::string engine = "huestep";    ///< of `engineNames()`
    std::string method = "soft-step";  ///< of `allMethods()`; engines with their own: as theirs
    /// Or iterations; 0: as needed, planned by Huestep. Engines that take none: no matter.
    std::uint32_t substeps = 0;
};

/// How much of the suite is run.
enum class StabilityEffort : std::uint8_t {
    Quick,     ///< the cheap scenes of every row, upright, shortened nowhere: seconds
    Standard,  ///< every row with all of its scenes, upright and turned; row 28 of small scenes
    Full       ///< row 28 of all scenes too, hashes compared over longer runs
};

struct StabilityOptions {
    StabilityConfiguration configuration;
    StabilityEffort effort = StabilityEffort::Standard;
    std::vector<int> rows;  ///< 1 to 28, in any order; empty: all
    /// Of rows 1 to 26 only scenes that begin with one of these: "stack" or "stack:n=10"; empty:
    /// all. Whole words of a scene's text are compared.
    std::vector<std::string> scenes;
    /// Also find the smallest number of substeps that passes: each scene is run again with 1, 2, 4
    /// and so on up to 32 until it passes. Of engines that take substeps.
    bool frontier = true;
    int threads = 1;     ///< of the runs that are judged: no verdict depends on it
    std::string saveTo;  ///< folder for what failed; empty: nothing is saved
};

/// What became of one scene of a row, with the criterion that was nearest to its limit or furthest
/// beyond it.
struct StabilityVerdict {
    int row = 0;         ///< 1 to 28
    std::string scene;   ///< as `huestep run` takes it: "stack:n=10,seed=1"
    std::string method;  ///< "soft-step", "box2d"
    bool pass = false;
    double value = 0.0;  ///< of that criterion, in `unit`; infinite: not finite, or never reached
    double limit = 0.0;  ///< in `unit`
    std::string unit;    ///< "m", "m/s", "rad", "bodies", "1": a share or a ratio
    int frontier = 0;  ///< smallest n of {1,2,4,8,16,32} that passes; 0: none; −1: not asked for,
                       ///< or n is the row's
    std::string why;   ///< of a failure, a sentence
    std::string what;  ///< what the value is: "farthest that a body moved"
    bool judged = true;   ///< false: reported only, the row may pass without it
    std::string hashes;   ///< what was compared and equal: "3,600 ticks on 1, 2, 3 threads, …"
    std::string replay;   ///< the command that plays the scene again, of a saved failure that one
    std::string savedTo;  ///< folder of this failure, under `saveTo`; empty: none
};

/// Called after every scene and, with `done` null, from time to time within one. `share` is of all
/// the work, [0, 1], a rough one. Returns whether to go on.
using StabilityProgress = std::function<bool(const StabilityVerdict* done, double share)>;

struct StabilityResult {
    std::vector<StabilityVerdict> verdicts;  ///< by row, then as the row lists its scenes
    bool finished = true;                    ///< false: `progress` said to stop
};

/// Runs rows for one configuration. Fails, with a sentence, for an unknown engine, method or row,
/// and where an engine cannot have a scene or a failure cannot be saved.
Result<StabilityResult> runStability(const StabilityOptions& options,
                                     const StabilityProgress& progress = {});

/// The row's name, "tall stack"; empty for a number that is no row.
std::string_view stabilityRowName(int row);
inline constexpr int stabilityRows = 28;

/// Whether a row passes: it has verdicts, and all that are judged do.
bool rowPasses(const std::vector<StabilityVerdict>& verdicts, int row);

}  // namespace huestep::tools
