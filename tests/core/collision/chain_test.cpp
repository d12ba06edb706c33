// Chain segments: what a whole chain says of a shape against brute force in double.

#include <cmath>
#include <numbers>
#include <optional>

#include "core/collision/cast.h"
#include "core/collision/manifold.h"
#include "core/collision/mass.h"
#include "tests/core/hulls.h"

namespace huestep::test {
namespace {

using Point = Vec2T<double>;
using Posed = PoseT<double>;

constexpr double margin = 0.02;
constexpr double tolerance = 6e-4;  // see manifold_test.cpp

/// A loop around the origin, counter-clockwise, with corners that turn in and out.
std::vector<Vec2> randomLoop(Random& random) {
    std::vector<Vec2> points;
    const std::size_t corners = 4 + random.below(20);
    for (std::size_t i = 0; i < corners; ++i) {
        const double way = 2.0 * std::numbers::pi *
                           (static_cast<double>(i) + random.between(0.0, 0.5)) /
                           static_cast<double>(corners);
        const double far = random.between(2.0, 3.0);
        points.push_back(
            {static_cast<float>(far * std::cos(way)), static_cast<float>(far * std::sin(way))});
    }
    return points;
}

/// Even-odd rule.
bool insideOf(const std::vector<Vec2>& loop, Point p) {
    bool inside = false;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point a = wide(loop[i]), b = wide(loop[(i + 1) % loop.size()]);
        if ((a.y > p.y) == (b.y > p.y)) continue;
        inside ^= p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y);
    }
    return inside;
}

double distanceToLoop(const std::vector<Vec2>& loop, Point p) {
    double least = 1e300;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point a = wide(loop[i]), ab = wide(loop[(i + 1) % loop.size()]) - a;
        const double t = std::clamp(dot(p - a, ab) / lengthSquared(ab), 0.0, 1.0);
        least = std::min(least, length(p - (a + t * ab)));
    }
    return least;
}

TEST(Chain, HasASegmentForEachEdgeOfALoopAndGhostsAtItsOpenEnds) {
    const std::vector<Vec2> points{
        {0.0f, 0.0f}, {1.0f, 0.0f}, {2.0f, 1.0f}, {2.0f, 3.0f}, {0.0f, 3.0f}};
    EXPECT_EQ(ShapeDef::chain(points, true).size(), 5u);
    const std::vector<ShapeDef> open = ShapeDef::chain(points, false);
    ASSERT_EQ(open.size(), 2u);
    EXPECT_EQ(open[0], ShapeDef::chainSegment(points[0], points[1], points[2], points[3]));
    EXPECT_EQ(open[1], ShapeDef::chainSegment(points[1], points[2], points[3], points[4]));
    EXPECT_EQ(ShapeDef::chain(points, true)[4],
              ShapeDef::chainSegment(points[4], points[0], points[1], points[2]));
    EXPECT_TRUE(ShapeDef::chain(std::span(points).first(3), false).empty());
    EXPECT_TRUE(ShapeDef::chain(std::span(points).first(2), true).empty());
}

TEST(Chain, HasNeitherMassNorBoundsOfItsGhosts) {
    const ShapeDef shape =
        ShapeDef::chainSegment({-50.0f, 7.0f}, {-1.0f, 0.0f}, {1.0f, 0.5f}, {60.0f, -8.0f});
    const BoundsT<double> bounds = boundsOf(hullOfDef<double>(shape), Posed{});
    EXPECT_EQ(bounds.low, (Point{-1.0, 0.0}));
    EXPECT_EQ(bounds.high, (Point{1.0, 0.5}));
    EXPECT_EQ(massOf(hullOfDef<double>(shape), 1.0).mass, 0.0);
    EXPECT_NEAR(reachOf(hullOfDef<double>(shape)), std::hypot(1.0, 0.5), 1e-6);
}

TEST(Chain, OfADiscSaysTheDistanceOfBruteForceAndPushesAwayFromTheNearestPoint) {
    Random random(201);
    SCOPED_TRACE(random.trace());
    int touching = 0;
    for (int trial = 0; trial < 20'000; ++trial) {
        const std::vector<Vec2> loop = randomLoop(random);
        const Point center{random.between(-3.5, 3.5), random.between(-3.5, 3.5)};
        if (insideOf(loop, center)) continue;
        const double exact = distanceToLoop(loop, center);
        const double radius = std::max(0.01, exact + random.between(-0.1, 0.05));
        const ShapeDef disc = ShapeDef::circle({}, static_cast<float>(radius));
        double least = 1e300;
        for (const ShapeDef& segment : ShapeDef::chain(loop, true)) {
            const ManifoldT<double> m =
                collide(hullOfDef<double>(segment), hullOfDef<double>(disc), {center, {}}, margin);
            ASSERT_LE(m.count, 1);
            if (m.count == 0) continue;
            const double separation = m.points[0].separation;
            least = std::min(least, separation);
            // The point that pushes is on the chain, in the direction of the normal.
            const Point from = center - (separation + wide(disc.radius)) * m.normal;
            ASSERT_LT(distanceToLoop(loop, from), 1e-9);
            // No face or vertex is nearer in its own part: it is a least distance of its own.
            const Point beside = from + 1e-4 * (center - from);
            ASSERT_NEAR(distanceToLoop(loop, beside), length(beside - from), 1e-9);
        }
        const double wanted = exact - wide(disc.radius);
        if (wanted > margin - 1e-6) continue;
        ++touching;
        ASSERT_NEAR(least, wanted, 1e-9) << trial;
    }
    EXPECT_GT(touching, 5'000);
}

/// Distance of two convex outlines, or minus the least way along an edge normal that parts them.
double bruteSeparation(const std::vector<Point>& a, const std::vector<Point>& b, double radius) {
    double deepest = -1e300, best = 1e300;
    const auto visit = [&](const std::vector<Point>& from, const std::vector<Point>& to) {
        for (std::size_t i = 0; i < from.size(); ++i) {
            const Point v = from[i], edge = from[(i + 1) % from.size()] - v;
            const Point n = normalized(perpRight(edge));
            double nearest = 1e300;
            for (const Point p : to) {
                nearest = std::min(nearest, dot(n, p - v));
                const double t = std::clamp(dot(p - v, edge) / lengthSquared(edge), 0.0, 1.0);
                best = std::min(best, length(p - (v + t * edge)));
            }
            deepest = std::max(deepest, nearest);
        }
    };
    visit(a, b);
    visit(b, a);
    return (deepest < 0.0 ? deepest : best) - radius;
}

TEST(Chain, AroundAConvexShapeMeetsAPolygonAsTheSolidOfTheSameOutlineDoes) {
    Random random(202);
    SCOPED_TRACE(random.trace());
    int touching = 0;
    for (int trial = 0; trial < 10'000; ++trial) {
        const ShapeDef solid = randomPolygon(random, 0.0f);
        const ShapeDef other = randomPolygon(random, random.once(2) ? 0.0f : 0.05f);
        const std::vector<Vec2> outline(solid.vertices.begin(),
                                        solid.vertices.begin() + solid.vertexCount);
        Posed pose;
        const double angle = random.between(-3.1, 3.1), way = random.between(-3.1, 3.1);
        pose.q = {std::cos(angle), std::sin(angle)};
        const Point along{std::cos(way), std::sin(way)};
        std::vector<Point> a, b;
        for (const Vec2 v : outline) a.push_back(wide(v));
        const auto exactNow = [&] {
            b.clear();
            for (std::size_t i = 0; i < other.vertexCount; ++i) {
                b.push_back(transform(pose, vertexOf(other, i)));
            }
            return bruteSeparation(a, b, wide(other.radius));
        };
        pose.p = 6.0 * along;
        const double wanted = random.between(-0.02, 0.03);
        for (int i = 0; i < 80; ++i) pose.p = pose.p - (exactNow() - wanted) * 0.5 * along;
        const double exact = exactNow();
        const ManifoldT<double> whole =
            collide(hullOfDef<double>(solid), hullOfDef<double>(other), pose, margin);
        double least = 1e300;
        bool same = false;
        for (const ShapeDef& segment : ShapeDef::chain(outline, true)) {
            const HullT<double> hull = hullOfDef<double>(segment);
            const ManifoldT<double> m = collide(hull, hullOfDef<double>(other), pose, margin);
            for (int i = 0; i < m.count; ++i) {
                least = std::min(least, m.points[i].separation);
                same = same || dot(m.normal, whole.normal) > 0.999;
            }
            // Seen from the other side it is the same.
            const ManifoldT<double> back =
                collide(hullOfDef<double>(other), hull, relative(pose, Posed{}), margin);
            ASSERT_EQ(back.count, m.count);
            for (int i = 0; i < m.count; ++i) {
                ASSERT_NEAR(back.points[i].separation, m.points[i].separation, 1e-9);
                ASSERT_LT(length(rotate(pose.q, back.normal) + m.normal), 1e-9);
                ASSERT_LT(length(transform(pose, back.points[i].point) - m.points[i].point), 1e-9);
            }
        }
        if (exact > margin - tolerance) continue;
        ++touching;
        ASSERT_NEAR(least, exact, 2.0 * tolerance) << trial;
        ASSERT_TRUE(same) << trial << ": no segment pushes as the solid does";
    }
    EXPECT_GT(touching, 6'000);
}

TEST(Chain, DoesNotTouchWhatHasItsMiddleBehindIt) {
    Random random(203);
    SCOPED_TRACE(random.trace());
    const ShapeDef segment =
        ShapeDef::chainSegment({3.0f, 0.0f}, {1.0f, 0.0f}, {-1.0f, 0.0f}, {-3.0f, 0.0f});
    for (int trial = 0; trial < 2'000; ++trial) {
        const ShapeDef shape = ShapeDef::box(random.betweenF(0.1, 1.0), random.betweenF(0.1, 1.0));
        const double angle = random.between(-3.1, 3.1);
        Posed pose{{random.between(-1.0, 1.0), -random.between(0.0, 1.0)},
                   {std::cos(angle), std::sin(angle)}};
        ASSERT_EQ(collide(hullOfDef<double>(segment), hullOfDef<double>(shape), pose, margin).count,
                  0);
        const ShapeDef disc = ShapeDef::circle({}, random.betweenF(0.1, 1.0));
        ASSERT_EQ(collide(hullOfDef<double>(segment), hullOfDef<double>(disc), pose, margin).count,
                  0);
    }
    EXPECT_EQ(
        collide(hullOfDef<double>(segment), hullOfDef<double>(segment), Posed{}, margin).count, 0)
        << "two chains";
}

TEST(Chain, IsPushedAlongItsFaceWhereABoxSlidesOverAVertex) {
    // The front corner of a box has just passed from one segment of a floor to the next, and is
    // deeper in it than it is long: the box's own side would stop it.
    const std::vector<Vec2> floor{
        {4.0f, 0.0f}, {2.0f, 0.0f}, {0.0f, 0.0f}, {-2.0f, 0.0f}, {-4.0f, 0.0f}};
    const ShapeDef box = ShapeDef::box(0.5f, 0.5f);
    const Posed pose{{-0.498, 0.495}, {}};
    int points = 0;
    for (const ShapeDef& segment : ShapeDef::chain(floor, false)) {
        const ManifoldT<double> m =
            collide(hullOfDef<double>(segment), hullOfDef<double>(box), pose, margin);
        for (int i = 0; i < m.count; ++i) {
            ++points;
            EXPECT_NEAR(m.normal.y, 1.0, 1e-12);
            EXPECT_NEAR(m.points[i].separation, -0.005, 1e-12);
        }
    }
    EXPECT_GE(points, 2);
    // As a segment of two sides the first one pushes sideways.
    const ManifoldT<double> plain =
        collide(hullOfDef<double>(ShapeDef::segment({2.0f, 0.0f}, {0.0f, 0.0f})),
                hullOfDef<double>(box), pose, margin);
    EXPECT_NEAR(std::abs(plain.normal.x), 1.0, 1e-12);
}

TEST(Chain, IsHitByARayFromItsFrontAlone) {
    const Hull hull = hullOfDef<float>(
        ShapeDef::chainSegment({3.0f, 0.0f}, {1.0f, 0.0f}, {-1.0f, 0.0f}, {-3.0f, 0.0f}));
    const std::optional<HullHit> down = castRayAtHull(hull, {0.5f, 1.0f}, {0.5f, -1.0f});
    ASSERT_TRUE(down.has_value());
    EXPECT_EQ(down->fraction, 0.5f);
    EXPECT_EQ(down->normal, (Vec2{0.0f, 1.0f}));
    EXPECT_FALSE(castRayAtHull(hull, {0.5f, -1.0f}, {0.5f, 1.0f}).has_value());
    EXPECT_FALSE(castRayAtHull(hull, {2.0f, 1.0f}, {2.0f, -1.0f}).has_value()) << "a ghost";
}

}  // namespace
}  // namespace huestep::test
