// Invariants of manifolds, and separations against brute force in double.

#include "core/collision/manifold.h"

#include <cmath>
#include <functional>

#include "tests/core/hulls.h"

namespace huestep::test {
namespace {

using Point = Vec2T<double>;
using Posed = PoseT<double>;

constexpr double margin = 0.02;
/// Cores nearer than half a millimetre count as touching faces, and of two nearly equal faces that
/// of A is preferred by a tenth of that.
constexpr double tolerance = 6e-4;

struct Meeting {
    ShapeDef a, b;
    Posed pose;  ///< of B in the frame of A
};

/// Corners of a shape at a pose.
std::vector<Point> cornersOf(const ShapeDef& shape, const Posed& pose) {
    std::vector<Point> corners;
    for (std::size_t i = 0; i < shape.vertexCount; ++i) {
        corners.push_back(transform(pose, vertexOf(shape, i)));
    }
    return corners;
}

/// Distance of the surfaces, or minus the least translation along an edge normal that parts them.
double bruteSeparation(const Meeting& s) {
    const std::vector<Point> a = cornersOf(s.a, Posed{}), b = cornersOf(s.b, s.pose);
    const double radius = wide(s.a.radius) + wide(s.b.radius);
    double deepest = -1e300;
    const auto along = [&](const std::vector<Point>& from, const std::vector<Point>& to) {
        for (std::size_t i = 0; from.size() > 1 && i < from.size(); ++i) {
            const Point n = normalized(perpRight(from[(i + 1) % from.size()] - from[i]));
            double nearest = 1e300, farthest = -1e300;
            for (const Point p : to) nearest = std::min(nearest, dot(n, p));
            for (const Point p : from) farthest = std::max(farthest, dot(n, p));
            deepest = std::max(deepest, nearest - farthest);
        }
    };
    along(a, b);
    along(b, a);
    if ((a.size() > 1 || b.size() > 1) && deepest < 0.0) return deepest - radius;
    double best = 1e300;
    const auto toEdges = [&](const std::vector<Point>& from, const std::vector<Point>& to) {
        for (const Point p : from) {
            for (std::size_t i = 0; i < to.size(); ++i) {
                const Point ab = to[(i + 1) % to.size()] - to[i];
                const double squared = lengthSquared(ab);
                const double t =
                    squared > 0.0 ? std::clamp(dot(p - to[i], ab) / squared, 0.0, 1.0) : 0.0;
                best = std::min(best, length(p - (to[i] + t * ab)));
            }
        }
    };
    toEdges(a, b);
    toEdges(b, a);
    return best - radius;
}

Meeting randomMeeting(Random& random) {
    Meeting s{randomShapeDef(random), randomShapeDef(random), {}};
    const double angle = random.between(-3.14, 3.14);
    s.pose.q = {std::cos(angle), std::sin(angle)};
    const double way = random.between(-3.14, 3.14);
    const Point along{std::cos(way), std::sin(way)};
    s.pose.p = 6.0 * along;
    const double wanted = random.between(-0.2, 0.05);
    for (int i = 0; i < 60; ++i) {
        s.pose.p = s.pose.p - (bruteSeparation(s) - wanted) * 0.7 * along;
    }
    return s;
}

ManifoldT<double> manifoldOf(const Meeting& s) {
    return collide(hullOfDef<double>(s.a), hullOfDef<double>(s.b), s.pose, margin);
}

double leastSeparation(const ManifoldT<double>& m) {
    double least = 1e300;
    for (int i = 0; i < m.count; ++i) least = std::min(least, m.points[i].separation);
    return least;
}

void forRandomMeetings(std::uint64_t seed, int trials, const std::function<void(Meeting)>& check) {
    Random random(seed);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < trials && !testing::Test::HasFatalFailure(); ++i) {
        SCOPED_TRACE("trial " + std::to_string(i));
        check(randomMeeting(random));
    }
}

TEST(Manifold, HasUnitNormalsAtMostTwoPointsAndTheDistanceOfBruteForce) {
    int touching = 0, two = 0;
    forRandomMeetings(51, 20'000, [&](const Meeting& s) {
        const ManifoldT<double> m = manifoldOf(s);
        const double exact = bruteSeparation(s);
        ASSERT_GE(m.count, 0);
        ASSERT_LE(m.count, 2);
        if (exact > margin + tolerance) {
            ASSERT_EQ(m.count, 0) << exact;
        }
        if (exact < margin - tolerance) {
            ASSERT_GT(m.count, 0) << exact;
        }
        if (m.count == 0) return;
        ++touching;
        two += m.count == 2;
        ASSERT_NEAR(length(m.normal), 1.0, 1e-9);
        ASSERT_NEAR(leastSeparation(m), exact, tolerance);
        for (int i = 0; i < m.count; ++i) ASSERT_LE(m.points[i].separation, margin);
        if (m.count == 2) {
            ASSERT_NE(m.points[0].feature, m.points[1].feature);
        }
    });
    EXPECT_GT(touching, 10'000);
    EXPECT_GT(two, 2'000);
}

TEST(Manifold, MovingBAlongTheNormalByTheDepthPartsTheShapes) {
    forRandomMeetings(52, 10'000, [](Meeting s) {
        const ManifoldT<double> m = manifoldOf(s);
        if (m.count == 0) return;
        s.pose.p += -leastSeparation(m) * m.normal;
        const double left = bruteSeparation(s);
        ASSERT_GT(left, -2.0 * tolerance);
        ASSERT_LT(left, 0.06) << "and no farther than that";
    });
}

TEST(Manifold, OfExchangedShapesIsTheSameFromTheOtherSide) {
    int compared = 0;
    forRandomMeetings(53, 20'000, [&](const Meeting& s) {
        const ManifoldT<double> m = manifoldOf(s);
        const Meeting back{s.b, s.a, relative(s.pose, Posed{})};
        const ManifoldT<double> n = manifoldOf(back);
        // At the rim of the margin one side may see it and the other not.
        if (std::abs(bruteSeparation(s) - margin) < tolerance) return;
        ASSERT_EQ(m.count > 0, n.count > 0);
        if (m.count == 0) return;
        ASSERT_NEAR(leastSeparation(m), leastSeparation(n), tolerance);
        // Where the two best faces are equally deep either may be the reference.
        const Point turned = -rotate(s.pose.q, n.normal);
        if (dot(m.normal, turned) < 0.9999) return;
        ++compared;
        for (int i = 0; i < m.count; ++i) {
            double nearest = 1e300;
            for (int k = 0; k < n.count; ++k) {
                nearest = std::min(
                    nearest, length(transform(s.pose, n.points[k].point) - m.points[i].point));
            }
            if (m.points[i].separation < margin - tolerance) {
                ASSERT_LT(nearest, 0.05) << "point " << i;
            }
        }
    });
    EXPECT_GT(compared, 8'000);
}

TEST(Manifold, DoesNotSeeACommonMotionOfBothShapes) {
    Random random(54);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 5'000; ++i) {
        const Meeting s = randomMeeting(random);
        const double angle = random.between(-3.1, 3.1);
        const Posed a{{random.between(-99.0, 99.0), random.between(-99.0, 99.0)},
                      {std::cos(angle), std::sin(angle)}};
        const Posed b{transform(a, s.pose.p), compose(a.q, s.pose.q)};
        const ManifoldT<double> here = manifoldOf(s);
        const ManifoldT<double> there = manifoldOf({s.a, s.b, relative(a, b)});
        if (std::abs(bruteSeparation(s) - margin) < 1e-6 || here.count != there.count) continue;
        if (dot(here.normal, there.normal) < 0.999) continue;  // a tie between two faces
        for (int k = 0; k < here.count; ++k) {
            ASSERT_NEAR(here.points[k].separation, there.points[k].separation, 1e-9);
            ASSERT_LT(length(here.points[k].point - there.points[k].point), 1e-9);
            ASSERT_EQ(here.points[k].feature, there.points[k].feature);
        }
    }
}

TEST(Manifold, InFloatIsThatInDoubleButForRounding) {
    forRandomMeetings(55, 10'000, [](const Meeting& s) {
        const auto f = [](Point p) {
            return Vec2{static_cast<float>(p.x), static_cast<float>(p.y)};
        };
        const Pose pose{f(s.pose.p),
                        {static_cast<float>(s.pose.q.c), static_cast<float>(s.pose.q.s)}};
        const Manifold m =
            collide(hullOfDef<float>(s.a), hullOfDef<float>(s.b), pose, static_cast<float>(margin));
        const ManifoldT<double> d = manifoldOf(s);
        if (std::abs(bruteSeparation(s) - margin) < tolerance) return;
        ASSERT_EQ(m.count > 0, d.count > 0);
        if (m.count == 0) return;
        double least = 1e300;
        for (int i = 0; i < m.count; ++i) least = std::min(least, wide(m.points[i].separation));
        ASSERT_NEAR(least, leastSeparation(d), tolerance);
        ASSERT_NEAR(length(wide(m.normal)), 1.0, 1e-6);
    });
}

TEST(Manifold, OfABoxOnABoxHasItsTwoCornersWithFeaturesThatStayAsItSlides) {
    const HullT<float> box = hullOfDef<float>(ShapeDef::box(0.5f, 0.5f));
    const Manifold first = collide(box, box, {{0.1f, 0.99f}, {}}, 0.02f);
    ASSERT_EQ(first.count, 2);
    EXPECT_EQ(first.normal, (Vec2{0.0f, 1.0f}));
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(wide(first.points[i].separation), -0.01, 1e-6);
    for (const float x : {0.02f, 0.05f, 0.3f, 0.45f}) {
        const Manifold m = collide(box, box, {{x, 0.99f}, {}}, 0.02f);
        ASSERT_EQ(m.count, 2);
        for (int i = 0; i < 2; ++i) EXPECT_EQ(m.points[i].feature, first.points[i].feature) << x;
    }
}

TEST(Manifold, OfDiscsAtOnePlaceStillHasAUnitNormal) {
    const HullT<float> disc = hullOfDef<float>(ShapeDef::circle({}, 0.5f));
    const Manifold m = collide(disc, disc, {{}, {}}, 0.02f);
    ASSERT_EQ(m.count, 1);
    EXPECT_EQ(length(m.normal), 1.0f);
    EXPECT_NEAR(wide(m.points[0].separation), -1.0, 1e-6);
}

}  // namespace
}  // namespace huestep::test
