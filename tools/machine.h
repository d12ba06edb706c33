/// Where and from what a measurement was made: a time without these is not a result.
#pragma once

#include <string>

namespace huestep::tools {

std::string machineName();   ///< the processor's name and how many threads it runs
std::string compilerName();  ///< of this program, with its build type
std::string commitName();    ///< that this program was built from; "-dirty" if changed since
}  // namespace huestep::tools
