// Distances and times of approach against brute force in double and against Box2D 2.4.
#include "core/collision/sweep.h"

#include <box2d/b2_distance.h>
#include <box2d/b2_time_of_impact.h>
#include <box2d/box2d.h>
#include <gtest/gtest.h>

#include <optional>

#include "tests/core/hulls.h"
#include "tests/oracle/brute.h"

namespace huestep::oracle {
namespace {

using test::hullOfDef;
using test::wide;

b2DistanceProxy proxyOf(const ShapeDef& shape, std::array<b2Vec2, maxPolygonVertices>& points) {
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = {shape.vertices[i].x, shape.vertices[i].y};
    b2DistanceProxy proxy;
    proxy.Set(points.data(), shape.vertexCount, shape.radius);
    return proxy;
}

float distanceByBox2D(const ShapeDef& a, const ShapeDef& b, Point position, double angle) {
    std::array<b2Vec2, maxPolygonVertices> pointsA, pointsB;
    b2DistanceInput input;
    input.proxyA = proxyOf(a, pointsA);
    input.proxyB = proxyOf(b, pointsB);
    input.transformA.SetIdentity();
    input.transformB.Set({static_cast<float>(position.x), static_cast<float>(position.y)},
                         static_cast<float>(angle));
    input.useRadii = false;
    b2SimplexCache cache;
    cache.count = 0;
    b2DistanceOutput output;
    b2Distance(&output, &cache, &input);
    return output.distance - a.radius - b.radius;
}

TEST(Separation, IsTheDistanceOfBruteForceAndOfBox2D) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int apart = 0, overlapping = 0;
    for (int i = 0; i < 20'000; ++i) {
        const ShapeDef a = random.shape(), b = random.shape();
        const Point at{random.between(-2.5, 2.5), random.between(-2.5, 2.5)};
        const double angle = random.between(-3.14, 3.14);
        const Pose relative{
            {static_cast<float>(at.x), static_cast<float>(at.y)},
            {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))}};
        const Separation found = separationOf(hullOfDef<float>(a), hullOfDef<float>(b), relative);
        const Outline mine = outlineOf(a), other = outlineOf(b, at, angle);
        const double expected = separation(mine, other);
        ASSERT_NEAR(wide(found.distance), expected, 1e-4) << "pair " << i;
        const Point normal{wide(found.normal.x), wide(found.normal.y)};
        ASSERT_NEAR(lengthOf(normal), 1.0, 1e-5) << "pair " << i;
        // Moved along the normal by the depth, or back by the distance, they just touch.
        ASSERT_NEAR(separation(mine, moved(other, -expected * normal)), 0.0, 2e-3) << "pair " << i;
        const float peer = distanceByBox2D(a, b, at, angle);
        if (peer < 1e-3f - a.radius - b.radius) {
            ++overlapping;  // of the cores, where Box2D says no more
            continue;
        }
        ++apart;
        ASSERT_NEAR(found.distance, peer, 1e-4f) << "pair " << i;
    }
    EXPECT_GT(apart, 5'000);
    EXPECT_GT(overlapping, 1'000);
}

/// B on its way past A, which stays.
struct Passage {
    ShapeDef a, b;
    Point from, travel;
    double angle = 0.0, turn = 0.0;

    [[nodiscard]] double separationAt(double t) const {
        return separation(outlineOf(a), outlineOf(b, from + t * travel, angle + t * turn));
    }
    /// The first time at which they are as near as `wanted`, by steps in which no point of B goes
    /// farther than that is away.
    [[nodiscard]] std::optional<double> firstWithin(double wanted) const {
        double reach = 0.0;
        for (const Point p : outlineOf(b).points) reach = std::max(reach, lengthOf(p));
        const double speed = lengthOf(travel) + reach * std::abs(turn);
        for (double t = 0.0; t <= 1.0;) {
            const double left = separationAt(t) - wanted;
            if (left < 1e-6) return t;
            t += std::max(left, 1e-6) / speed;
        }
        return std::nullopt;
    }
};

Passage randomPassage(Random& random) {
    Passage p{random.shape(), random.shape(), {}, {}, 0.0, 0.0};
    const double way = random.between(-3.14, 3.14);
    p.from = {random.between(3.0, 5.0) * std::cos(way), random.between(3.0, 5.0) * std::sin(way)};
    const Point to{random.between(-2.5, 2.5), random.between(-2.5, 2.5)};
    p.travel = to - p.from;
    p.angle = random.between(-3.14, 3.14);
    p.turn = random.below(3) == 0 ? 0.0 : random.between(-4.0, 4.0);
    return p;
}

b2TOIOutput timeByBox2D(const Passage& p) {
    std::array<b2Vec2, maxPolygonVertices> pointsA, pointsB;
    b2TOIInput input;
    input.proxyA = proxyOf(p.a, pointsA);
    input.proxyB = proxyOf(p.b, pointsB);
    const b2Vec2 from{static_cast<float>(p.from.x), static_cast<float>(p.from.y)};
    const b2Vec2 travel{static_cast<float>(p.travel.x), static_cast<float>(p.travel.y)};
    input.sweepA = {b2Vec2_zero, b2Vec2_zero, b2Vec2_zero, 0.0f, 0.0f, 0.0f};
    input.sweepB = {b2Vec2_zero,
                    from,
                    from + travel,
                    static_cast<float>(p.angle),
                    static_cast<float>(p.angle + p.turn),
                    0.0f};
    input.tMax = 1.0f;
    b2TOIOutput output;
    b2TimeOfImpact(&output, &input);
    return output;
}

TEST(TimeOfApproach, IsThatOfBruteForceAndOfBox2D) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int met = 0, missed = 0, compared = 0, givenUp = 0, passedByPeer = 0;
    for (int i = 0; i < 4'000; ++i) {
        const Passage p = randomPassage(random);
        // What Box2D aims at: its slop of overlap, and within a quarter of its slop.
        const double radii = wide(p.a.radius) + wide(p.b.radius);
        const double slop = wide(b2_linearSlop);
        const double target = std::max(slop, radii - 3.0 * slop) - radii;
        const double tolerance = 0.25 * slop;
        if (p.separationAt(0.0) < target + 2.0 * tolerance) continue;
        const auto soonest = p.firstWithin(target + tolerance + 1e-4);
        const auto latest = p.firstWithin(target - 1e-4);

        const Hull a = hullOfDef<float>(p.a), b = hullOfDef<float>(p.b);
        const SweptHull still{&a, {}, {}, 0.0f, coreReachOf(a)};
        const Pose pose{
            {static_cast<float>(p.from.x), static_cast<float>(p.from.y)},
            {static_cast<float>(std::cos(p.angle)), static_cast<float>(std::sin(p.angle))}};
        const SweptHull passing{&b,
                                pose,
                                {static_cast<float>(p.travel.x), static_cast<float>(p.travel.y)},
                                static_cast<float>(p.turn),
                                coreReachOf(b)};
        const Separation atStart = separationOf(a, b, relativeAt(still, passing, 0.0f));
        const auto time = timeOfApproach(still, passing, atStart, static_cast<float>(target),
                                         static_cast<float>(tolerance), 1.0f);
        SCOPED_TRACE("passage " + std::to_string(i));
        if (!time) {
            ++missed;
            ASSERT_FALSE(latest) << "passes through at " << *latest;
            continue;
        }
        ++met;
        // Never late; early only where looks ran out.
        if (latest) {
            ASSERT_LE(wide(*time), *latest + 1e-4);
        }
        if (!soonest || wide(*time) < *soonest - 1e-4) {
            ++givenUp;
            continue;
        }
        const b2TOIOutput peer = timeByBox2D(p);
        const auto farthest = p.firstWithin(target - tolerance - 1e-4);
        if (peer.state != b2TOIOutput::e_touching || !farthest) continue;
        ++compared;
        // Both lie where the two come from a tolerance above the target to one below it. Box2D
        // follows one axis at a time and may pass a first touch of what turns fast.
        const double off = std::abs(wide(*time) - wide(peer.t));
        if (off > *farthest - *soonest + 1e-4) {
            ++passedByPeer;
            EXPECT_GT(peer.t, *time);
            EXPECT_NE(p.turn, 0.0);
        }
    }
    EXPECT_GT(met, 1'000);
    EXPECT_GT(missed, 500);
    EXPECT_GT(compared, 1'000);
    EXPECT_LT(givenUp, met / 50);
    EXPECT_LT(passedByPeer, compared / 100);
}

}  // namespace
}  // namespace huestep::oracle
