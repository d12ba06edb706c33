/// Where and from what a measurement was made: a time without these is not a result.
#pragma once

#include <string>

#include "tools/text.h"

namespace huestep::tools {

std::string machineName();   ///< the processor's name and how many threads it runs
std::string compilerName();  ///< of this program, with its build type
std::string commitName();    ///< that this program was built from; "-dirty" if changed since

/// The three in a line, as stands above a table.
std::string originLine();

/// The three beside results, as a document; `finished`: of all that was asked for.
Json documentOf(Json results, bool finished);

}  // namespace huestep::tools
