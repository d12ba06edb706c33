/// The parts of the page, embedded at build time (embed.cmake).
#pragma once

#include <string_view>

namespace huestep::tools::chart::assets {

extern const std::string_view pageHtml;
extern const std::string_view pageStyle;
extern const std::string_view pageScript;
extern const std::string_view charts;
extern const std::string_view library;  ///< ECharts

}  // namespace huestep::tools::chart::assets
