// Mass properties against closed forms and Monte Carlo.

#include "core/collision/mass.h"

#include <cmath>

#include "core/math/trig.h"
#include "tests/core/hulls.h"

namespace huestep::test {
namespace {

TEST(Mass, OfADiscIsThatOfTheTextbook) {
    const MassProperties m = massOf(hullOfDef<double>(ShapeDef::circle({2.0f, -1.0f}, 0.5f)), 3.0);
    EXPECT_NEAR(m.mass, 3.0 * pi * 0.25, 1e-12);
    EXPECT_NEAR(m.inertia, 0.5 * m.mass * 0.25, 1e-12);
    EXPECT_EQ(m.center, (Vec2T<double>{2.0, -1.0}));
}

TEST(Mass, OfABoxIsThatOfTheTextbookWhereverItLies) {
    const MassProperties m =
        massOf(hullOfDef<double>(ShapeDef::box(1.5f, 0.5f, {7.0f, 3.0f}, rotationOf(0.7f))), 2.0);
    EXPECT_NEAR(m.mass, 6.0, 1e-5);
    EXPECT_NEAR(m.inertia, 6.0 * (9.0 + 1.0) / 12.0, 1e-5);
    EXPECT_NEAR(m.center.x, 7.0, 1e-6);
    EXPECT_NEAR(m.center.y, 3.0, 1e-6);
}

TEST(Mass, OfACapsuleIsARectangleAndTwoHalfDiscs) {
    const double r = 0.5, l = 2.0;
    const MassProperties m =
        massOf(hullOfDef<double>(ShapeDef::capsule({0.0f, 0.0f}, {2.0f, 0.0f}, 0.5f)), 1.0);
    const double rectangle = 2.0 * r * l, disc = pi * r * r;
    EXPECT_NEAR(m.mass, rectangle + disc, 1e-9);
    EXPECT_NEAR(m.center.x, 1.0, 1e-12);
    // Half discs: inertia about the flat side's middle r²/2 · m, moved out by l/2; 4r/3π is the
    // centroid of a half disc.
    const double offset = 4.0 * r / (3.0 * pi);
    const double expected =
        rectangle * (l * l + 4.0 * r * r) / 12.0 + disc * (0.5 * r * r + 0.25 * l * l + l * offset);
    EXPECT_NEAR(m.inertia, expected, 1e-9);
}

TEST(Mass, OfARoundedBoxIsItsCoreItsStripsAndADisc) {
    const double a = 1.0, b = 0.5, r = 0.25;
    const MassProperties m =
        massOf(hullOfDef<double>(ShapeDef::box(1.0f, 0.5f, {}, {}, 0.25f)), 1.0);
    EXPECT_NEAR(m.mass, 4.0 * a * b + 4.0 * r * (a + b) + pi * r * r, 1e-9);
    EXPECT_NEAR(length(m.center), 0.0, 1e-12);
}

TEST(Mass, OfAnyShapeIsWhatRandomPointsSay) {
    Random random(41);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 12; ++trial) {
        const ShapeDef shape = randomShapeDef(random);
        const MassProperties m = massOf(hullOfDef<double>(shape), 2.0);
        if (shape.kind == ShapeKind::Segment) {
            EXPECT_EQ(m.mass, 0.0);
            continue;
        }
        const double half = 3.0;
        const int points = 60'000;
        double inside = 0.0, turn = 0.0;
        Vec2T<double> sum;
        for (int i = 0; i < points; ++i) {
            const Vec2T<double> p{random.between(-half, half), random.between(-half, half)};
            if (distanceTo(shape, p) > 0.0) continue;
            inside += 1.0;
            sum += p;
            turn += lengthSquared(p - m.center);
        }
        const double weight = 2.0 * 4.0 * half * half / points;
        ASSERT_GT(inside, 50.0);
        const double noise = 5.0 / std::sqrt(inside);
        EXPECT_NEAR(weight * inside / m.mass, 1.0, noise);
        EXPECT_NEAR(weight * turn / m.inertia, 1.0, 2.0 * noise);
        EXPECT_LT(length((1.0 / inside) * sum - m.center), 2.0 * noise);
    }
}

TEST(Mass, OfJoinedPartsFollowsSteiner) {
    // Two halves of a box are the box.
    const auto half = [](float x) {
        return massOf(hullOfDef<double>(ShapeDef::box(0.5f, 1.0f, {x, 0.0f})), 1.0);
    };
    const MassProperties parts[] = {half(-0.5f), half(0.5f)};
    const MassProperties both = combine(parts);
    const MassProperties whole = massOf(hullOfDef<double>(ShapeDef::box(1.0f, 1.0f)), 1.0);
    EXPECT_NEAR(both.mass, whole.mass, 1e-12);
    EXPECT_NEAR(both.inertia, whole.inertia, 1e-12);
    EXPECT_NEAR(length(both.center - whole.center), 0.0, 1e-12);
    EXPECT_EQ(combine({}).mass, 0.0);
}

}  // namespace
}  // namespace huestep::test
