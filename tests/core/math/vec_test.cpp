// Vectors, rotations, poses and boxes, against complex numbers and the definitions.

#include "core/math/vec.h"

#include <bit>
#include <cmath>
#include <complex>
#include <limits>

#include "core/math/finite.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

using Complex = std::complex<double>;

TEST(Vec, ProductsAreTheRealAndImaginaryPartsOfComplexOnes) {
    Random random(21);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 10'000; ++i) {
        const Vec2T<double> a = wide(random.point(-9.0, 9.0)), b = wide(random.point(-9.0, 9.0));
        const Complex product = std::conj(Complex(a.x, a.y)) * Complex(b.x, b.y);
        ASSERT_NEAR(dot(a, b), product.real(), 1e-12);
        ASSERT_NEAR(cross(a, b), product.imag(), 1e-12);
        ASSERT_NEAR(length(a), std::abs(Complex(a.x, a.y)), 1e-12);
        ASSERT_EQ(dot(a, perpLeft(a)), 0.0);
        ASSERT_GT(cross(a, perpLeft(a)), 0.0) << "left is counter-clockwise";
        ASSERT_EQ(perpRight(a), -perpLeft(a));
        ASSERT_EQ(crossScalar(2.0, a), 2.0 * perpLeft(a));
    }
}

TEST(Vec, NormalizedHasLengthOneOrIsZeroWhereThereIsNoDirection) {
    Random random(22);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 10'000; ++i) {
        const double scale = std::pow(10.0, random.between(-15.0, 15.0));
        const Vec2T<double> a = scale * wide(random.point(-1.0, 1.0));
        ASSERT_NEAR(length(normalized(a)), 1.0, 1e-12);
    }
    EXPECT_EQ(normalized(Vec2{}), Vec2{});
    EXPECT_EQ(normalized(Vec2{1e-19f, 0.0f}), Vec2{});
}

TEST(Vec, RotationsAndPosesUndoAndCompose) {
    Random random(23);
    SCOPED_TRACE(random.trace());
    const auto pose = [&] {
        const double angle = random.between(-3.0, 3.0);
        return PoseT<double>{wide(random.point(-9.0, 9.0)), {std::cos(angle), std::sin(angle)}};
    };
    for (int i = 0; i < 10'000; ++i) {
        const PoseT<double> a = pose(), b = pose();
        const Vec2T<double> v = wide(random.point(-9.0, 9.0));
        const Complex turned = Complex(a.q.c, a.q.s) * Complex(v.x, v.y);
        ASSERT_NEAR(rotate(a.q, v).x, turned.real(), 1e-12);
        ASSERT_NEAR(rotate(a.q, v).y, turned.imag(), 1e-12);
        ASSERT_NEAR(length(untransform(a, transform(a, v)) - v), 0.0, 1e-12);
        const PoseT<double> seen = relative(a, b);
        ASSERT_NEAR(length(transform(a, transform(seen, v)) - transform(b, v)), 0.0, 1e-11);
        const RotationT<double> both = compose(a.q, b.q);
        ASSERT_NEAR(length(rotate(both, v) - rotate(a.q, rotate(b.q, v))), 0.0, 1e-11);
        const RotationT<double> back = compose(a.q, relative(a.q, b.q));
        ASSERT_NEAR(std::hypot(back.c - b.q.c, back.s - b.q.s), 0.0, 1e-14);
    }
    const RotationT<double> q = normalized(RotationT<double>{3.0, -4.0});
    EXPECT_NEAR(q.c, 0.6, 1e-15);
    EXPECT_NEAR(q.s, -0.8, 1e-15);
}

TEST(Vec, ATurnIsOneNumberFromWhichTheRotationComesBack) {
    Random random(24);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 300'000; ++i) {
        // All around, and crowded near the places where the formula changes.
        const double base =
            random.once(2) ? random.between(-3.15, 3.15) : 0.5 * M_PI * (random.below(5) - 2.0);
        const double angle =
            base + random.between(-1.0, 1.0) * std::pow(10.0, random.between(-9, -1));
        const Rotation q{static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
        const float turn = turnOf(q);
        ASSERT_LE(std::abs(turn), 3.0f);
        const Rotation back = fromTurn(turn);
        const double off = std::atan2(wide(q.c) * wide(back.s) - wide(q.s) * wide(back.c),
                                      wide(q.c) * wide(back.c) + wide(q.s) * wide(back.s));
        ASSERT_LE(std::abs(off), 4e-7) << angle << " came back as " << turn;
        ASSERT_NEAR(std::hypot(wide(back.c), wide(back.s)), 1.0, 3e-7);
        ASSERT_NE(std::bit_cast<std::uint32_t>(turn), 0x80000000u) << "no −0 in state";
    }
    EXPECT_EQ(std::bit_cast<std::uint32_t>(turnOf({1.0f, -0.0f})), 0u);
    EXPECT_EQ(fromTurn(0.0f), (Rotation{1.0f, 0.0f}));
}

TEST(Vec, BoxesOverlapContainAndUniteAsSetsOfPoints) {
    Random random(25);
    SCOPED_TRACE(random.trace());
    const auto box = [&] {
        // Whole numbers, so that edges coincide often.
        const auto at = [&] { return static_cast<float>(random.below(7)); };
        const float x = at(), y = at();
        return Bounds{{x, y}, {x + at(), y + at()}};
    };
    for (int i = 0; i < 20'000; ++i) {
        const Bounds a = box(), b = box();
        bool meet = false, inside = true;
        for (float x = 0.0f; x <= 13.0f; x += 1.0f) {
            for (float y = 0.0f; y <= 13.0f; y += 1.0f) {
                const auto in = [&](const Bounds& c) {
                    return c.low.x <= x && x <= c.high.x && c.low.y <= y && y <= c.high.y;
                };
                meet = meet || (in(a) && in(b));
                inside = inside && (!in(b) || in(a));
            }
        }
        ASSERT_EQ(overlaps(a, b), meet);
        ASSERT_EQ(contains(a, b), inside);
        ASSERT_TRUE(contains(unite(a, b), a) && contains(unite(a, b), b));
    }
    EXPECT_EQ(grown(Bounds{{0, 0}, {1, 2}}, 0.5f), (Bounds{{-0.5f, -0.5f}, {1.5f, 2.5f}}));
}

TEST(Vec, ClampMinAndMaxKeepTheFirstOfEquals) {
    EXPECT_EQ(minOf(2.0f, 1.0f), 1.0f);
    EXPECT_EQ(maxOf(2.0f, 1.0f), 2.0f);
    EXPECT_EQ(clampTo(5.0f, 0.0f, 3.0f), 3.0f);
    EXPECT_EQ(clampTo(-5.0f, 0.0f, 3.0f), 0.0f);
    EXPECT_EQ(clampTo(1.5f, 0.0f, 3.0f), 1.5f);
}

TEST(Finite, IsAskedByBits) {
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float v : {0.0f, -0.0f, 1e-45f, 3.4e38f, -3.4e38f}) {
        EXPECT_TRUE(isFinite(v));
        EXPECT_EQ(finiteOrZero(v), v);
    }
    for (const float v : {inf, -inf, nan, -nan}) {
        EXPECT_FALSE(isFinite(v));
        EXPECT_FALSE(isFinite(Vec2{0.0f, v}));
        EXPECT_EQ(finiteOrZero(v), 0.0f);
    }
    EXPECT_EQ(std::bit_cast<std::uint32_t>(canonicalZero(-0.0f)), 0u);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(finiteOrZero(-0.0f)), 0u);
    EXPECT_EQ(canonicalZero(-1.5f), -1.5f);
    EXPECT_EQ(canonicalZero(-1e-45f), -1e-45f) << "denormals are on";
}

}  // namespace
}  // namespace huestep::test
