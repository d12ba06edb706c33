#include "tools/clock.h"

#include <chrono>
#include <ctime>

namespace huestep::tools {
namespace {

std::uint64_t read(clockid_t clock) {
    std::timespec now{};
    ::clock_gettime(clock, &now);
    return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000u +
           static_cast<std::uint64_t>(now.tv_nsec);
}

}  // namespace

std::uint64_t nanoseconds() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

std::uint64_t wallMilliseconds() {
    return read(CLOCK_REALTIME) / 1'000'000u;
}

std::uint64_t threadProcessorNanoseconds() {
    return read(CLOCK_THREAD_CPUTIME_ID);
}

std::uint64_t programProcessorNanoseconds() {
    return read(CLOCK_PROCESS_CPUTIME_ID);
}

}  // namespace huestep::tools
