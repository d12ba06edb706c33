// The angle in single precision: near the exact one everywhere, and the same at every width.

#include "core/math/angle_lanes.h"

#include <cmath>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

TEST(AngleLanes, AreNearTheExactAngleAllAround) {
    Random random(2718);
    SCOPED_TRACE(random.trace());
    constexpr double pi = 3.14159265358979323846;
    for (int trial = 0; trial < 200'000; ++trial) {
        const double angle = random.between(-pi, pi);
        const double size = random.between(0.5, 2.0);
        const auto c = static_cast<float>(size * std::cos(angle));
        const auto s = static_cast<float>(size * std::sin(angle));
        const double exact = std::atan2(static_cast<double>(s), static_cast<double>(c));
        ASSERT_NEAR(static_cast<double>(angleLanes<1>(c, s)), exact, 4e-7) << c << " " << s;
    }
    EXPECT_EQ(angleLanes<1>(0.0f, 0.0f), 0.0f);
    EXPECT_EQ(angleLanes<1>(1.0f, 0.0f), 0.0f);
    EXPECT_NEAR(static_cast<double>(angleLanes<1>(-1.0f, 0.0f)), pi, 4e-7);
    EXPECT_NEAR(static_cast<double>(angleLanes<1>(0.0f, -1.0f)), -0.5 * pi, 4e-7);
}

TEST(AngleLanes, OfSmallAnglesKeepTheirDigits) {
    for (float s = 1e-3f; s > 1e-30f; s *= 0.1f) {
        EXPECT_NEAR(static_cast<double>(angleLanes<1>(1.0f, s) / s), 1.0, 1e-6) << s;
    }
}

TEST(AngleLanes, GiveTheSameBitsSideBySide) {
    Random random(31);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 20'000; ++trial) {
        LaneF<4> c{}, s{};
        for (int i = 0; i < 4; ++i) {
            c[i] = random.once(9) ? 0.0f : random.betweenF(-1.0, 1.0);
            s[i] = random.once(9) ? -0.0f : random.betweenF(-1.0, 1.0);
        }
        const LaneF<4> wide = angleLanes<4>(c, s);
        for (int i = 0; i < 4; ++i) {
            const float alone = angleLanes<1>(c[i], s[i]);
            ASSERT_EQ(alone, wide[i]) << c[i] << " " << s[i];
        }
    }
}

}  // namespace
}  // namespace huestep::test
