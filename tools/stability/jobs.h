/// What a run of the suite has to do, as a list, and what of it an effort leaves out.
#pragma once

#include <vector>

#include "tools/stability/rows.h"
#include "tools/stability/suite.h"

namespace huestep::tools::stability {

/// One verdict to be found.
struct Job {
    enum class Kind : std::uint8_t {
        Plain,
        Far,    ///< passes if it does what it does at the origin
        Ladder  ///< passes if more work never fails where less passed
    };
    Kind kind = Kind::Plain;
    int row = 0;
    Trial trial;
    Placing placing;
    bool judged = true;
    double cost = 1.0;  ///< body-substeps, roughly: for progress
};

inline constexpr int farRow = 27;
inline constexpr int ladderRow = 28;

/// The jobs of the options' rows, by row. Fails for a number that is no row, a scene that no row
/// has, and where the effort leaves nothing of a row or scene that is named.
Result<std::vector<Job>> jobsOf(const StabilityOptions& options);

/// What a ladder is made of.
inline constexpr double ladderRates[] = {30.0, 60.0, 120.0};  // Hz
inline constexpr std::uint32_t ladderSubsteps[] = {1, 2, 4, 8, 16};

/// Substeps among which a frontier is looked for.
inline constexpr std::uint32_t frontierSubsteps[] = {1, 2, 4, 8, 16, 32};

}  // namespace huestep::tools::stability
