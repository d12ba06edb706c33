/// Our own trigonometry: + - * / and select only, so that every machine gives the same bits.
///
/// libm's results differ between libraries, and between CPUs under one library. Work is done in
/// double and rounded once, which makes the float results correct to within 1 ulp.
#pragma once

#include "core/math/vec.h"

namespace huestep {

inline constexpr double pi = 3.14159265358979323846;

/// sin and cos of an angle in rad, |angle| ≤ 1e9; beyond that, and for NaN, of 0.
RotationT<double> rotationOf(double radians);
Rotation rotationOf(float radians);
float sine(float radians);
float cosine(float radians);

/// The angle of a rotation in (−π, π]; (0, 0) gives 0. Absolute error below 1e-12 in double.
double angleOf(RotationT<double> q);
float angleOf(Rotation q);

/// The rotation by 2·atan(halfAngle), which is angle/2 to third order: Cayley's map. Exact unit
/// length but for rounding, one division, no square root; error angle³/12.
constexpr Rotation cayley(float halfAngle) {
    const float k2 = halfAngle * halfAngle;
    const float inverse = 1.0f / (1.0f + k2);
    return {(1.0f - k2) * inverse, (halfAngle + halfAngle) * inverse};
}

}  // namespace huestep
