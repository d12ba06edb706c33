/// The verdicts of the suite as people and programs read them.
#pragma once

#include <vector>

#include "tools/stability/suite.h"
#include "tools/text.h"

namespace huestep::tools::stability {

/// A configuration and what it came to.
struct Configured {
    StabilityConfiguration configuration;
    StabilityResult result;
};

/// {"rows": [{"row", "scene", "method", "pass", "value", "limit", "unit", "frontier", …}], …}.
/// Values that are not finite are null.
Json asJson(const std::vector<Configured>& all, bool finished);

/// A row of the suite a line, its scenes below it; why each failure is one; a summary.
void print(const Configured& configured);

/// Rows that were judged, and how many of them pass.
struct Score {
    int judged = 0;
    int passed = 0;
};
Score scoreOf(const std::vector<StabilityVerdict>& verdicts);

}  // namespace huestep::tools::stability
