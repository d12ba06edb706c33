/// Whole numbers on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>

namespace huestep::tools {

/// Takes decimal digits and nothing else, whatever zeros stand in front; CLI11 alone would take
/// octal and hexadecimal numbers, and −1 as the largest one there is.
CLI::Validator wholeNumber(std::uint64_t low,
                           std::uint64_t high = std::numeric_limits<std::uint64_t>::max());

}  // namespace huestep::tools
