/// All that `huestep chart` has found out, as one document.
#pragma once

#include <string>
#include <vector>

#include "tools/chart/colouring.h"
#include "tools/chart/effort.h"
#include "tools/chart/work.h"
#include "tools/text.h"

namespace huestep::tools::chart {

struct Findings {
    Extent extent = Extent::Full;
    bool finished = true;  ///< false: stopped before the end
    double seconds = 0.0;  ///< that all of it took
    std::vector<Case> cases;
    std::vector<WorkPoint> points;   ///< of those cases
    Json stability = Json::array();  ///< rows of `huestep stability --json`
    std::vector<WaysRow> sizes;
    std::vector<WaysRow> scenes;
    std::vector<PriceRow> prices;
    std::vector<EffortRow> effort;
};

/// Origin and date, methods, cases, and one list of flat rows a table.
Json documentOf(const Findings& findings);

/// The lists of flat rows in a document, by which its CSV files are called too.
std::vector<std::string> tableNames();

}  // namespace huestep::tools::chart
