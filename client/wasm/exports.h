/// What a page calls of the core that it loads as WebAssembly: plain functions over handles.
///
/// An instance of the module is a process of its own: its memory holds the worlds, it imports
/// nothing, and it has one thread. A handle or an address is a number of 32 bits, an offset into
/// the memory; a number of 64 bits is a BigInt. What is passed in and out beside numbers goes
/// through `Bytes`. A function that may be refused returns 0 then and leaves a sentence in `why`.
///
/// Whoever calls is the page's own code, as a C++ program is that calls a library: handles are not
/// checked. Bytes from outside are, by those who read them. An address into the memory holds until
/// the next call; the memory may have grown, and its views in JavaScript are to be made anew.
///
/// Where memory runs out or an assert fails, the instance stops with an unreachable instruction; a
/// page must then make a new one. `lastWords` says what happened.
///
/// V8 compiles a function better while it is called again and again, and not within a call: step
/// once a call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

/// A function of the module's, under its own name.
#define HUESTEP_EXPORT(name) extern "C" __attribute__((export_name(#name))) auto name

namespace huestep::wasm {

/// Most bytes that go in or out at once: those of the largest snapshot.
inline constexpr std::uint32_t maxBytes = 256u << 20;

using Bytes = std::vector<std::byte>;

inline std::string_view textOf(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline void write(Bytes& to, std::string_view text) {
    const auto* const from = reinterpret_cast<const std::byte*>(text.data());
    to.assign(from, from + text.size());
}

}  // namespace huestep::wasm
