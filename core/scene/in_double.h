/// A vector in double, in which definitions are checked and motions measured.
#pragma once

#include "core/math/vec.h"

namespace huestep {

constexpr Vec2T<double> inDouble(Vec2 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y)};
}

}  // namespace huestep
