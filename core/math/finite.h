/// Finiteness by bits: a test the compiler cannot optimise away, the same everywhere.
#pragma once

#include <bit>
#include <cstdint>

#include "core/math/vec.h"

namespace huestep {

constexpr bool isFinite(float v) {
    return (std::bit_cast<std::uint32_t>(v) & 0x7f800000u) != 0x7f800000u;
}
constexpr bool isFinite(Vec2 v) {
    return isFinite(v.x) && isFinite(v.y);
}

/// A number fit for state: canonical zero; 0 for what is not finite.
constexpr float finiteOrZero(float v) {
    return isFinite(v) ? canonicalZero(v) : 0.0f;
}

}  // namespace huestep
