// Rays against rounded hulls: by marching along them with the distance to the surface.

#include "core/collision/cast.h"

#include <cmath>

#include "tests/core/hulls.h"

namespace huestep::test {
namespace {

TEST(Cast, HitsWhereMarchingMeetsTheSurface) {
    Random random(61);
    SCOPED_TRACE(random.trace());
    int hits = 0, misses = 0;
    for (int trial = 0; trial < 4'000; ++trial) {
        const ShapeDef shape = randomShapeDef(random);
        const Vec2 from = random.point(-3.0, 3.0), to = random.point(-3.0, 3.0);
        const auto hit = castRayAtHull(hullOfDef<float>(shape), from, to);
        const Vec2T<double> start = wide(from), d = wide(to) - wide(from);
        const double reach = length(d);
        const double first = distanceTo(shape, start);
        if (first < 1e-3 || reach < 0.1) continue;  // from within: below
        // Sphere tracing: never steps through the surface.
        double t = 0.0, nearest = first;
        while (t < 1.0) {
            const double distance = distanceTo(shape, start + t * d);
            nearest = std::min(nearest, distance);
            if (distance < 1e-7) break;
            t += distance / reach;
        }
        const bool met = t < 1.0;
        if (!met && nearest < 1e-4) continue;  // grazes
        ASSERT_EQ(hit.has_value(), met) << "trial " << trial << ", " << nearest;
        (met ? hits : misses) += 1;
        if (!hit) continue;
        // A grazing ray may slide along the surface for a while: the point must be on it.
        const Vec2T<double> p = start + wide(hit->fraction) * d;
        ASSERT_NEAR(distanceTo(shape, p), 0.0, 2e-5) << "trial " << trial;
        ASSERT_NEAR(wide(hit->fraction), t, 0.02) << "trial " << trial;
        ASSERT_NEAR(length(wide(hit->normal)), 1.0, 1e-5);
        ASSERT_LT(dot(wide(hit->normal), d), 0.0) << "against the ray";
        // Outward: a little along the normal leads away from the shape.
        ASSERT_GT(distanceTo(shape, p + 1e-3 * wide(hit->normal)), 0.0);
    }
    EXPECT_GT(hits, 500);
    EXPECT_GT(misses, 500);
}

TEST(Cast, FromWithinMeetsNothing) {
    Random random(62);
    SCOPED_TRACE(random.trace());
    int inside = 0;
    for (int trial = 0; trial < 20'000; ++trial) {
        const ShapeDef shape = randomShapeDef(random);
        const Vec2 from = random.point(-1.0, 1.0);
        if (distanceTo(shape, wide(from)) > -1e-3) continue;
        ++inside;
        ASSERT_FALSE(castRayAtHull(hullOfDef<float>(shape), from, random.point(-9.0, 9.0)));
    }
    EXPECT_GT(inside, 1'000);
}

TEST(Cast, OfNoLengthMeetsNothing) {
    const Hull disc = hullOfDef<float>(ShapeDef::circle({}, 0.5f));
    EXPECT_FALSE(castRayAtHull(disc, {2.0f, 0.0f}, {2.0f, 0.0f}));
    EXPECT_FALSE(castRayAtHull(disc, {2.0f, 0.0f}, {1.0f, 0.0f})) << "too short";
    ASSERT_TRUE(castRayAtHull(disc, {2.0f, 0.0f}, {0.0f, 0.0f}));
    EXPECT_EQ(castRayAtHull(disc, {2.0f, 0.0f}, {0.0f, 0.0f})->fraction, 0.75f);
}

}  // namespace
}  // namespace huestep::test
