/// Vectors and rotations in double, in which definitions are checked and motions measured.
#pragma once

#include "core/math/vec.h"

namespace huestep {

constexpr Vec2T<double> inDouble(Vec2 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y)};
}

constexpr RotationT<double> inDouble(RotationT<float> q) {
    return {static_cast<double>(q.c), static_cast<double>(q.s)};
}

}  // namespace huestep
