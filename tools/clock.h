/// The clock that tools hand to the core, which has none.
#pragma once

#include <cstdint>

namespace huestep::tools {

/// Nanoseconds of a clock that never goes back; fits `huestep::Clock`.
std::uint64_t nanoseconds();

}  // namespace huestep::tools
