#include "core/math/trig.h"

#include <cstdint>

namespace huestep {

namespace {

// Taylor series about 0. On [−π/4, π/4] the first term left out is below 1e-16.
double sineNearZero(double x) {
    const double x2 = x * x;
    double sum = -1.0 / 1307674368000.0;  // 15!
    sum = sum * x2 + 1.0 / 6227020800.0;  // 13!
    sum = sum * x2 - 1.0 / 39916800.0;    // 11!
    sum = sum * x2 + 1.0 / 362880.0;      // 9!
    sum = sum * x2 - 1.0 / 5040.0;        // 7!
    sum = sum * x2 + 1.0 / 120.0;         // 5!
    sum = sum * x2 - 1.0 / 6.0;           // 3!
    return x + x * x2 * sum;
}

double cosineNearZero(double x) {
    const double x2 = x * x;
    double sum = 1.0 / 20922789888000.0;   // 16!
    sum = sum * x2 - 1.0 / 87178291200.0;  // 14!
    sum = sum * x2 + 1.0 / 479001600.0;    // 12!
    sum = sum * x2 - 1.0 / 3628800.0;      // 10!
    sum = sum * x2 + 1.0 / 40320.0;        // 8!
    sum = sum * x2 - 1.0 / 720.0;          // 6!
    sum = sum * x2 + 1.0 / 24.0;           // 4!
    sum = sum * x2 - 0.5;                  // 2!
    return 1.0 + x2 * sum;
}

// atan(x) = x − x³/3 + x⁵/5 − …; for |x| ≤ tan(π/8) 17 terms leave less than 1e-14.
double arcTangentNearZero(double x) {
    const double x2 = x * x;
    double sum = 0.0;
    for (int k = 33; k >= 1; k -= 2) {
        sum = 1.0 / k - x2 * sum;
    }
    return x * sum;
}

}  // namespace

RotationT<double> rotationOf(double radians) {
    if (!(radians >= -1e9 && radians <= 1e9)) radians = 0.0;
    const double quarters = radians * (2.0 / pi);
    const auto k = static_cast<std::int64_t>(quarters + (quarters < 0 ? -0.5 : 0.5));
    // π/2 in two parts: the first has 33 bits, so that k times it is exact.
    constexpr double high = 1.57079632673412561417e+00;
    constexpr double low = 6.07710050650619224932e-11;
    const double kd = static_cast<double>(k);
    const double r = (radians - kd * high) - kd * low;
    const double s = sineNearZero(r);
    const double c = cosineNearZero(r);
    switch (k & 3) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case 2:
            return {-c, -s};
        default:
            return {s, -c};
    }
}

Rotation rotationOf(float radians) {
    const auto q = rotationOf(static_cast<double>(radians));
    return {static_cast<float>(q.c), static_cast<float>(q.s)};
}

float sine(float radians) {
    return rotationOf(radians).s;
}
float cosine(float radians) {
    return rotationOf(radians).c;
}

double angleOf(RotationT<double> q) {
    const double c = q.c < 0 ? -q.c : q.c;
    const double s = q.s < 0 ? -q.s : q.s;
    if (!(c > 0) && !(s > 0)) return 0.0;
    const bool steep = s > c;
    const double t = steep ? c / s : s / c;  // in [0, 1]
    constexpr double tangentOfEighth = 0.41421356237309504880;
    const double a = t > tangentOfEighth ? pi / 4 + arcTangentNearZero((t - 1.0) / (t + 1.0))
                                         : arcTangentNearZero(t);
    const double quarter = steep ? pi / 2 - a : a;
    const double half = q.c < 0 ? pi - quarter : quarter;
    return q.s < 0 ? -half : half;
}

float angleOf(Rotation q) {
    return static_cast<float>(
        angleOf(RotationT<double>{static_cast<double>(q.c), static_cast<double>(q.s)}));
}

}  // namespace huestep
