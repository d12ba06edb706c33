/// Threads of the standard library, and what stands for them where there are none: in WebAssembly
/// as it is built here a program is one thread, and a team its caller alone.
#pragma once

#include <atomic>
#include <cstdint>

#if defined(__wasm__)

#include <cassert>

namespace huestep {

/// Never made: a team of more than its caller is a mistake of whoever asks for it.
class Thread {
 public:
    template <class F>
    explicit Thread(F&&) {
        assert(false);
    }
    void join() {}
};

inline unsigned hardwareThreads() {
    return 1;
}
inline void letOthersRun() {}
/// Nobody would ever wake the caller.
inline void sleepWhile(std::atomic<std::uint32_t>&, std::uint32_t) {
    assert(false);
}

}  // namespace huestep

#else

#include <thread>

namespace huestep {

using Thread = std::thread;

inline unsigned hardwareThreads() {
    return std::thread::hardware_concurrency();
}
inline void letOthersRun() {
    std::this_thread::yield();
}
/// Waits until it is told of a change of `value`, if that is still `old`.
inline void sleepWhile(std::atomic<std::uint32_t>& value, std::uint32_t old) {
    value.wait(old, std::memory_order_acquire);
}

}  // namespace huestep

#endif
