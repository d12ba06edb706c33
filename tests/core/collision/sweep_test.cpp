// Sweeps against many looks on the way, and distances against those of manifolds in double.

#include "core/collision/sweep.h"

#include <optional>

#include "core/collision/axes.h"
#include "core/collision/manifold.h"
#include "tests/core/hulls.h"

namespace huestep::test {
namespace {

SweptHull randomSweep(Random& random, const Hull& hull, double far) {
    SweptHull swept;
    swept.hull = &hull;
    swept.from = {random.point(-far, far), rotationOf(random.betweenF(-3.1, 3.1))};
    swept.travel = random.point(-3.0, 3.0);
    swept.turn = random.once(3) ? 0.0f : random.betweenF(-5.0, 5.0);
    swept.reach = coreReachOf(hull);
    return swept;
}

Separation separationAtStart(const SweptHull& a, const SweptHull& b) {
    return separationOf(*a.hull, *b.hull, relativeAt(a, b, 0.0f));
}

TEST(Sweep, DistancesAreThoseOfTheNearestPoints) {
    Random random(41);
    SCOPED_TRACE(random.trace());
    int compared = 0;
    for (int trial = 0; trial < 20'000; ++trial) {
        const ShapeDef a = randomShapeDef(random), b = randomShapeDef(random);
        const Pose relative{random.point(-2.0, 2.0), rotationOf(random.betweenF(-3.1, 3.1))};
        const Separation s = separationOf(hullOfDef<float>(a), hullOfDef<float>(b), relative);
        const PoseT<double> pose{wide(relative.p), {wide(relative.q.c), wide(relative.q.s)}};
        const auto m = collide(hullOfDef<double>(a), hullOfDef<double>(b), pose, 10.0);
        if (m.count == 0) continue;
        double nearest = m.points[0].separation;
        if (m.count == 2 && m.points[1].separation < nearest) nearest = m.points[1].separation;
        // Where cores overlap, a manifold's points may be less deep than the hulls.
        if (nearest < 0.0) {
            ASSERT_LT(wide(s.distance), nearest + 2e-3) << "trial " << trial;
        } else {
            ASSERT_NEAR(wide(s.distance), nearest, 1e-3) << "trial " << trial;
            ++compared;
        }
        ASSERT_NEAR(wide(length(s.normal)), 1.0, 1e-5);
    }
    EXPECT_GT(compared, 5'000);
}

TEST(Sweep, TheNearestEdgeAndVertexInLanesAreThoseOfOneAtATime) {
    Random random(43);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 20'000; ++trial) {
        const Hull a = hullOfDef<float>(randomShapeDef(random));
        const Hull b = moved(hullOfDef<float>(randomShapeDef(random)),
                             Pose{random.point(-2.0, 2.0), rotationOf(random.betweenF(-3.1, 3.1))});
        int edge = -1, vertex = -1;
        float least = 0.0f;
        for (int i = 0; i < a.count; ++i) {
            for (int j = 0; j < b.count; ++j) {
                const Vec2 w = b.vertices[asIndex(j)];
                const float squared = lengthSquared(w - NearestOnEdge<float>(a, i, w).point);
                if (edge >= 0 && !(squared < least)) continue;
                edge = i;
                vertex = j;
                least = squared;
            }
        }
        const EdgeAndVertex<float> nearest = nearestEdgeAndVertex(a, b);
        ASSERT_EQ(nearest.squared, least) << "trial " << trial;
        ASSERT_EQ(nearest.edge, edge) << "trial " << trial;
        ASSERT_EQ(nearest.vertex, vertex) << "trial " << trial;
    }
}

TEST(Sweep, NothingIsNearerThanTheTargetBeforeTheTimeOfApproach) {
    Random random(42);
    SCOPED_TRACE(random.trace());
    int met = 0, missed = 0, givenUp = 0;
    for (int trial = 0; trial < 3'000; ++trial) {
        const Hull a = hullOfDef<float>(randomShapeDef(random));
        const Hull b = hullOfDef<float>(randomShapeDef(random));
        const SweptHull first = randomSweep(random, a, 0.5);
        const SweptHull second = randomSweep(random, b, 3.0);
        const float target = random.betweenF(-0.02, 0.02);
        const float tolerance = 0.002f;
        const auto distanceAt = [&](float t) {
            return separationOf(a, b, relativeAt(first, second, t)).distance;
        };
        if (distanceAt(0.0f) <= target + tolerance) continue;
        const auto time = timeOfApproach(first, second, separationAtStart(first, second), target,
                                         tolerance, 1.0f);
        const float end = time ? *time : 1.0f;
        for (int look = 0; look < 500; ++look) {
            const float t = end * (static_cast<float>(look) / 500.0f);
            ASSERT_GT(distanceAt(t), target - 1e-4f) << "trial " << trial << " at " << t;
        }
        time ? ++met : ++missed;
        // Looks are limited: a few that turn fast are given up before they meet.
        if (time && distanceAt(*time) > target + 2.0f * tolerance) ++givenUp;
    }
    EXPECT_GT(met, 300);
    EXPECT_LT(givenUp, met / 20);
    EXPECT_GT(missed, 300);
}

TEST(Sweep, ADiscThatSlidesAlongAFaceNeverComesNearer) {
    const Hull floor = hullOfDef<float>(ShapeDef::box(100.0f, 0.5f));
    const Hull disc = hullOfDef<float>(ShapeDef::circle({}, 0.1f));
    const SweptHull still{&floor, {}, {}, 0.0f, 0.0f};
    const SweptHull sliding{&disc, {{-50.0f, 0.601f}, {}}, {90.0f, 0.0f}, 0.0f, 0.1f};
    EXPECT_FALSE(
        timeOfApproach(still, sliding, separationAtStart(still, sliding), -0.001f, 0.0005f, 1.0f)
            .has_value());
    const SweptHull sinking{&disc, {{-50.0f, 0.7f}, {}}, {90.0f, -0.2f}, 0.0f, 0.1f};
    const auto time =
        timeOfApproach(still, sinking, separationAtStart(still, sinking), 0.0f, 0.0005f, 1.0f);
    ASSERT_TRUE(time.has_value());
    EXPECT_NEAR(wide(*time), 0.5, 0.005);
}

}  // namespace
}  // namespace huestep::test
