/// XXH3 over bytes that we lay out ourselves: the one hash of states, frames and files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace huestep {

/// XXH3-64 of the bytes, seed 0. Not for adversaries: see the network page on signed chains.
std::uint64_t hash64(std::span<const std::byte> bytes);

/// The same of a run of trivially copyable values.
template <class T>
std::uint64_t hash64Of(std::span<const T> values) {
    return hash64(std::as_bytes(values));
}

}  // namespace huestep
