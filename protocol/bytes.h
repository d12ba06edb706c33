/// Numbers in byte arrays. Our files and frames are little-endian, as every machine we build for
/// is (core/state/records.h asserts it), so a value is copied as it lies in memory.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

namespace huestep::protocol {

template <class T>
T load(std::span<const std::byte> bytes, std::size_t offset) {
    static_assert(std::is_trivially_copyable_v<T>);
    assert(offset + sizeof(T) <= bytes.size());
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

template <class T>
void store(std::span<std::byte> bytes, std::size_t offset, T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    assert(offset + sizeof(T) <= bytes.size());
    std::memcpy(bytes.data() + offset, &value, sizeof value);
}

}  // namespace huestep::protocol
