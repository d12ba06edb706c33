/// The document as people see it: one HTML page with all in it, and pictures.
///
/// Both come from the same description of each chart (page/charts.js) and the same library
/// (ECharts, which npm brings at build time): the page draws in the browser, the pictures are drawn
/// here, by Duktape.
#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "tools/text.h"

namespace huestep::tools::chart {

/// A page that asks nobody for anything: style, scripts and data stand in it.
std::string pageOf(const Json& document);

struct Picture {
    std::string name;  ///< of letters, digits and hyphens
    std::string svg;
};

/// Every chart of the document as SVG, for light backgrounds. Fails with what the script said.
Result<std::vector<Picture>> picturesOf(const Json& document);

}  // namespace huestep::tools::chart
