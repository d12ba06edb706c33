/// The clocks that tools measure with; the core has none but the one that it is handed.
#pragma once

#include <cstdint>

namespace huestep::tools {

/// Nanoseconds of a clock that never goes back; fits `huestep::Clock`.
std::uint64_t nanoseconds();

/// Milliseconds since 1970-01-01 UTC, by the clock that people set.
std::uint64_t wallMilliseconds();

/// Nanoseconds for which a processor has worked on the calling thread, or on all threads of this
/// program: what others do on the machine is not in them.
std::uint64_t threadProcessorNanoseconds();
std::uint64_t programProcessorNanoseconds();

}  // namespace huestep::tools
