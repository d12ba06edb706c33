/// The document as people see it: one HTML page with all in it, and pictures.
///
/// Both come from the same description of each chart (page/charts.js) and the same library
/// (ECharts, which npm brings at build time): the page draws in the browser, the pictures are drawn
/// here, by Duktape.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "core/result.h"
#include "tools/text.h"

namespace huestep::tools::chart {

/// A page that asks nobody for anything: style, scripts and data stand in it.
std::string pageOf(const Json& document);

struct Picture {
    std::string name;  ///< of letters, digits and hyphens
    std::string svg;
};

/// Gets a picture, the how manieth it is and of how many; says whether to go on.
using TakePicture =
    std::function<Result<bool>(const Picture& picture, std::size_t number, std::size_t of)>;

/// Every chart of the document as SVG, for light backgrounds, one after another: each takes up to a
/// second. False: `take` said to stop. Fails with what the script or `take` said.
Result<bool> drawPictures(const Json& document, const TakePicture& take);

}  // namespace huestep::tools::chart
