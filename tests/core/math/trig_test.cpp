// Our trigonometry against libm's in double.

#include "core/math/trig.h"

#include <cmath>
#include <limits>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

/// Size of the last place of a float near `v`.
double ulpAt(double v) {
    const float f = std::abs(static_cast<float>(v));
    return wide(std::nextafter(f, 2.0f * f + 1.0f)) - wide(f);
}

TEST(Trig, SineAndCosineInFloatAreWithinOneUlpOfLibmUpToAMillionRadians) {
    Random random(11);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 400'000; ++i) {
        const double range = std::pow(10.0, random.between(-8.0, 6.0));
        const float angle = random.betweenF(-range, range);
        const Rotation q = rotationOf(angle);
        const double s = std::sin(wide(angle)), c = std::cos(wide(angle));
        ASSERT_LE(std::abs(wide(q.s) - s), ulpAt(s)) << angle;
        ASSERT_LE(std::abs(wide(q.c) - c), ulpAt(c)) << angle;
        ASSERT_EQ(sine(angle), q.s);
        ASSERT_EQ(cosine(angle), q.c);
    }
}

TEST(Trig, InDoubleIsExactTo1e15NearZeroAndTo1e6FarOut) {
    Random random(12);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 200'000; ++i) {
        const double angle = random.between(-100.0, 100.0);
        const auto q = rotationOf(angle);
        ASSERT_NEAR(q.s, std::sin(angle), 1e-15);
        ASSERT_NEAR(q.c, std::cos(angle), 1e-15);
        const double far = random.between(-1e9, 1e9);
        const auto p = rotationOf(far);
        ASSERT_NEAR(p.s, std::sin(far), 1e-6);
        ASSERT_NEAR(p.c, std::cos(far), 1e-6);
        ASSERT_NEAR(p.c * p.c + p.s * p.s, 1.0, 1e-15);
    }
}

TEST(Trig, BeyondItsRangeAndForNaNGivesTheRotationByZero) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    for (const double angle : {1.0001e9, -1.0001e9, nan, inf, -inf, 1e300}) {
        EXPECT_EQ(rotationOf(angle), (RotationT<double>{1.0, 0.0})) << angle;
    }
}

TEST(Trig, IsExactAtZeroAndOddInItsAngle) {
    EXPECT_EQ(rotationOf(0.0f), (Rotation{1.0f, 0.0f}));
    Random random(13);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 100'000; ++i) {
        const float angle = random.betweenF(-1000.0, 1000.0);
        const Rotation plus = rotationOf(angle), minus = rotationOf(-angle);
        ASSERT_EQ(plus.c, minus.c) << angle;
        ASSERT_EQ(plus.s, -minus.s) << angle;
    }
}

TEST(Trig, TheAngleOfARotationIsThatOfAtan2) {
    Random random(14);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 400'000; ++i) {
        const double scale = std::pow(10.0, random.between(-20.0, 20.0));
        const double c = scale * random.between(-1.0, 1.0);
        const double s =
            scale * std::pow(10.0, random.between(-12.0, 0.0)) * random.between(-1.0, 1.0);
        const double exact = std::atan2(s, c);
        ASSERT_NEAR(angleOf(RotationT<double>{c, s}), exact, 1e-12) << c << " " << s;
        ASSERT_NEAR(angleOf(RotationT<double>{s, c}), std::atan2(c, s), 1e-12) << c << " " << s;
    }
    EXPECT_EQ(angleOf(RotationT<double>{0.0, 0.0}), 0.0);
    EXPECT_NEAR(angleOf(RotationT<double>{-1.0, 0.0}), pi, 1e-15) << "not −π";
    EXPECT_NEAR(angleOf(RotationT<double>{0.0, -1.0}), -pi / 2, 1e-15);
    EXPECT_NEAR(wide(angleOf(Rotation{0.0f, 1.0f})), pi / 2, 1e-7);
}

TEST(Trig, CayleyTurnsByTheAngleToThirdOrderAndKeepsUnitLength) {
    Random random(15);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 200'000; ++i) {
        const float half = random.betweenF(-0.5, 0.5);
        const Rotation q = cayley(half);
        const double turned = std::atan2(wide(q.s), wide(q.c));
        ASSERT_NEAR(turned, 2.0 * std::atan(wide(half)), 2e-7);
        const double angle = 2.0 * wide(half);
        ASSERT_LE(std::abs(turned - angle), std::abs(angle * angle * angle) / 12.0 + 2e-7);
        ASSERT_NEAR(std::hypot(wide(q.c), wide(q.s)), 1.0, 2e-7);
    }
    EXPECT_EQ(cayley(0.0f), (Rotation{1.0f, 0.0f}));
}

}  // namespace
}  // namespace huestep::test
