/// The stability suite for every method of the chart.
#pragma once

#include "core/result.h"
#include "tools/chart/run.h"
#include "tools/text.h"

namespace huestep::tools::chart {

/// Adds the rows that `huestep stability --json` gives: the product as it comes, other methods with
/// the standard number, Box2D. False: interrupted.
Result<bool> measureStability(Extent extent, Json& rows);

}  // namespace huestep::tools::chart
