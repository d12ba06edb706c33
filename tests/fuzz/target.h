/// What a fuzz target is: one function over arbitrary bytes that ends the program when a promise is
/// broken. The name is libFuzzer's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace huestep::fuzz {

/// Unlike assert, holds in every build.
inline void require(bool promise, const char* sentence) {
    if (promise) return;
    std::fprintf(stderr, "broken promise: %s\n", sentence);
    std::abort();
}

inline std::span<const std::byte> bytesOf(const std::uint8_t* data, std::size_t size) {
    return std::as_bytes(std::span(data, size));
}

}  // namespace huestep::fuzz
