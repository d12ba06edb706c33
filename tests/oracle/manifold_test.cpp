// The narrow phase against brute force and against Box2D 2.4.
#include "core/collision/manifold.h"

#include <box2d/b2_distance.h>
#include <box2d/box2d.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/hulls.h"
#include "tests/oracle/brute.h"

namespace huestep::oracle {
namespace {

constexpr double margin = 0.05;
/// The narrow phase treats cores that are nearer than half a millimetre as touching faces, and
/// prefers one reference face over an equal one by a tenth of that.
constexpr double tolerance = 7e-4;

using test::hullOfDef;

struct Pair {
    ShapeDef a, b;
    Point position;  ///< of B in the frame of A
    double angle = 0.0;

    template <class Real>
    [[nodiscard]] ManifoldT<Real> manifold() const {
        const PoseT<Real> pose{
            {static_cast<Real>(position.x), static_cast<Real>(position.y)},
            {static_cast<Real>(std::cos(angle)), static_cast<Real>(std::sin(angle))}};
        return collide(hullOfDef<Real>(a), hullOfDef<Real>(b), pose, static_cast<Real>(margin));
    }
    [[nodiscard]] Outline outlineA() const { return outlineOf(a); }
    [[nodiscard]] Outline outlineB() const { return outlineOf(b, position, angle); }
};

/// Two shapes so near that most pairs touch or nearly do.
Pair nearPair(Random& random, const ShapeDef& a, const ShapeDef& b) {
    Pair pair{a, b, {}, random.between(-3.14, 3.14)};
    const double direction = random.between(-3.14, 3.14);
    const Point along{std::cos(direction), std::sin(direction)};
    // Moved out along a line until apart by a chosen distance, in a few steps of its own length.
    const double wanted = random.between(-0.3, 0.1);
    for (int i = 0; i < 12; ++i) {
        const double off = wanted - separation(pair.outlineA(), pair.outlineB());
        pair.position = pair.position + off * along;
    }
    return pair;
}

template <class Real>
double leastSeparation(const ManifoldT<Real>& manifold) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < manifold.count; ++i) {
        least = std::min(least, static_cast<double>(manifold.points[i].separation));
    }
    return least;
}

std::string describe(const Pair& pair) {
    std::string text;
    for (const ShapeDef* shape : {&pair.a, &pair.b}) {
        text += "radius " + std::to_string(shape->radius) + ":";
        for (std::size_t i = 0; i < shape->vertexCount; ++i) {
            text += " (" + std::to_string(shape->vertices[i].x) + ", " +
                    std::to_string(shape->vertices[i].y) + ")";
        }
        text += "; ";
    }
    return text + "B at (" + std::to_string(pair.position.x) + ", " +
           std::to_string(pair.position.y) + ") turned " + std::to_string(pair.angle);
}

template <class Real>
void expectSoundManifold(const Pair& pair) {
    const Outline a = pair.outlineA();
    const Outline b = pair.outlineB();
    const double expected = separation(a, b);
    const auto manifold = pair.manifold<Real>();
    if (expected > margin + tolerance) {
        EXPECT_EQ(manifold.count, 0) << "apart by " << expected;
        return;
    }
    if (expected > margin - tolerance) return;
    ASSERT_GE(manifold.count, 1) << "apart by " << expected;
    EXPECT_NEAR(leastSeparation(manifold), expected, tolerance);
    const Point normal{static_cast<double>(manifold.normal.x),
                       static_cast<double>(manifold.normal.y)};
    EXPECT_NEAR(lengthOf(normal), 1.0, 1e-5);
    // Moved along the normal by its depth, B just touches A.
    EXPECT_NEAR(separation(a, moved(b, -expected * normal)), 0.0, 2.0 * tolerance);
    for (int i = 0; i < manifold.count; ++i) {
        const auto& p = manifold.points[i];
        const Point point{static_cast<double>(p.point.x), static_cast<double>(p.point.y)};
        const double half = 0.5 * std::abs(static_cast<double>(p.separation)) + tolerance;
        EXPECT_LE(distanceToPoint(a, point), half) << "point " << i << " lies off A";
        EXPECT_LE(distanceToPoint(b, point), half) << "point " << i << " lies off B";
        EXPECT_LE(static_cast<double>(p.separation), margin + 1e-6);
    }
}

TEST(Manifold, HasTheDepthNormalAndPointsThatBruteForceFindsForAllShapes) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    for (int i = 0; i < 10'000; ++i) {
        const ShapeDef a = random.shape();
        const ShapeDef b = random.shape();
        const Pair pair = nearPair(random, a, b);
        expectSoundManifold<double>(pair);
        expectSoundManifold<float>(pair);
        if (testing::Test::HasFailure()) FAIL() << "pair " << i << ": " << describe(pair);
    }
}

TEST(Manifold, OfSwappedShapesIsTheSameSeenFromTheOtherSide) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    for (int i = 0; i < 5'000; ++i) {
        const ShapeDef a = random.shape();
        const ShapeDef b = random.shape();
        const Pair pair = nearPair(random, a, b);
        const double c = std::cos(pair.angle);
        const double s = std::sin(pair.angle);
        const Pair swapped{
            b,
            a,
            {-c * pair.position.x - s * pair.position.y, s * pair.position.x - c * pair.position.y},
            -pair.angle};
        const auto there = pair.manifold<double>();
        const auto back = swapped.manifold<double>();
        if (there.count == 0 || back.count == 0) {
            const double expected = separation(pair.outlineA(), pair.outlineB());
            EXPECT_TRUE(there.count == back.count || std::abs(expected - margin) < tolerance);
        } else {
            EXPECT_NEAR(leastSeparation(there), leastSeparation(back), tolerance);
        }
        if (testing::Test::HasFailure()) FAIL() << "pair " << i << ": " << describe(pair);
    }
}

/// Polygons of Box2D without their skin, so that both sides speak of the same shapes.
b2PolygonShape b2Polygon(const ShapeDef& shape) {
    std::array<b2Vec2, maxPolygonVertices> points;
    for (std::size_t i = 0; i < shape.vertexCount; ++i) {
        points[i] = {shape.vertices[i].x, shape.vertices[i].y};
    }
    b2PolygonShape polygon;
    polygon.Set(points.data(), shape.vertexCount);
    polygon.m_radius = 0.0f;
    return polygon;
}

b2CircleShape b2Circle(const ShapeDef& shape) {
    b2CircleShape circle;
    circle.m_p = {shape.vertices[0].x, shape.vertices[0].y};
    circle.m_radius = shape.radius;
    return circle;
}

b2Transform b2Identity() {
    b2Transform identity;
    identity.SetIdentity();
    return identity;
}

b2Transform poseOf(const Pair& pair) {
    return {{static_cast<float>(pair.position.x), static_cast<float>(pair.position.y)},
            b2Rot(static_cast<float>(pair.angle))};
}

/// Box2D's manifold in the frame of A: its normal and the sorted separations of its points.
struct Peer {
    int count = 0;
    Point normal;
    std::vector<double> separations;
};

Peer peerOf(const b2Manifold& manifold, const Pair& pair, float radiusA, float radiusB) {
    b2WorldManifold world;
    world.Initialize(&manifold, b2Identity(), radiusA, poseOf(pair), radiusB);
    Peer peer;
    peer.count = manifold.pointCount;
    peer.normal = {static_cast<double>(world.normal.x), static_cast<double>(world.normal.y)};
    for (int i = 0; i < manifold.pointCount; ++i) {
        peer.separations.push_back(static_cast<double>(world.separations[i]));
    }
    std::sort(peer.separations.begin(), peer.separations.end());
    return peer;
}

void expectSameAs(const Peer& peer, const Pair& pair) {
    const auto manifold = pair.manifold<float>();
    std::vector<double> separations;
    for (int i = 0; i < manifold.count; ++i) {
        const double s = static_cast<double>(manifold.points[i].separation);
        if (s <= 0.0) separations.push_back(s);  // Box2D keeps no point that is apart
    }
    std::sort(separations.begin(), separations.end());
    ASSERT_EQ(separations.empty(), peer.count == 0);
    if (peer.count == 0) return;
    EXPECT_NEAR(separations[0], peer.separations[0], 1e-4);
    const Point normal{static_cast<double>(manifold.normal.x),
                       static_cast<double>(manifold.normal.y)};
    EXPECT_GT(dotOf(normal, peer.normal), 0.9999);
    if (separations.size() == peer.separations.size()) {
        // Cut off at the side of the face, where a steep edge magnifies rounding.
        EXPECT_NEAR(separations.back(), peer.separations.back(), 1e-3);
    } else {
        // One side has a second point that only just touches.
        const double second = separations.size() > 1 ? separations[1] : peer.separations[1];
        EXPECT_GT(second, -1e-3);
    }
}

TEST(Manifold, OfOverlappingPolygonsIsThatOfBox2D) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int compared = 0;
    for (int i = 0; i < 10'000; ++i) {
        const ShapeDef a = random.polygon(0.0f);
        const ShapeDef b = random.polygon(0.0f);
        const Pair pair = nearPair(random, a, b);
        // Where two axes are nearly equal either engine may take either; Box2D's hull may also
        // drop a vertex that is nearly in line.
        const std::vector<double> along = gaps(pair.outlineA(), pair.outlineB());
        const b2PolygonShape b2a = b2Polygon(a);
        const b2PolygonShape b2b = b2Polygon(b);
        if (along[0] - along[1] < 2e-3 || along[0] > -1e-3) continue;
        if (b2a.m_count != a.vertexCount || b2b.m_count != b.vertexCount) continue;
        b2Manifold manifold;
        b2CollidePolygons(&manifold, &b2a, b2Identity(), &b2b, poseOf(pair));
        expectSameAs(peerOf(manifold, pair, 0.0f, 0.0f), pair);
        if (testing::Test::HasFailure()) FAIL() << "pair " << i << ": " << describe(pair);
        ++compared;
    }
    EXPECT_GT(compared, 2'500);
}

TEST(Manifold, OfOverlappingDiscsAndPolygonsIsThatOfBox2D) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int compared = 0;
    for (int i = 0; i < 10'000; ++i) {
        const bool polygon = i % 2 == 0;
        const ShapeDef a = polygon ? random.polygon(0.0f) : random.circle();
        const ShapeDef b = random.circle();
        const Pair pair = nearPair(random, a, b);
        const Outline center{{pair.outlineB().points[0]}, 0.0};
        const std::vector<double> along = gaps(pair.outlineA(), center);
        const bool inside = polygon && along[0] < 0.0;
        // The normal jumps where two faces are equally near to a centre inside, and where the
        // centres of two discs meet.
        if (inside && along[0] - along[1] < 2e-3) continue;
        if (polygon && std::abs(separation(pair.outlineA(), center)) < 2e-3) continue;
        if (!polygon && coreDistance(pair.outlineA(), center) < 2e-3) continue;
        if (separation(pair.outlineA(), pair.outlineB()) > -1e-3) continue;
        const b2CircleShape b2b = b2Circle(b);
        b2Manifold manifold;
        if (polygon) {
            const b2PolygonShape b2a = b2Polygon(a);
            if (b2a.m_count != a.vertexCount) continue;
            b2CollidePolygonAndCircle(&manifold, &b2a, b2Identity(), &b2b, poseOf(pair));
        } else {
            const b2CircleShape b2a = b2Circle(a);
            b2CollideCircles(&manifold, &b2a, b2Identity(), &b2b, poseOf(pair));
        }
        expectSameAs(peerOf(manifold, pair, polygon ? 0.0f : a.radius, b.radius), pair);
        if (testing::Test::HasFailure()) FAIL() << "pair " << i << ": " << describe(pair);
        ++compared;
    }
    EXPECT_GT(compared, 2'500);
}

TEST(Manifold, OfASegmentAndADiscIsThatOfBox2D) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int compared = 0;
    for (int i = 0; i < 10'000; ++i) {
        const ShapeDef a =
            ShapeDef::segment({random.betweenF(-1.0, -0.1), random.betweenF(-1.0, 1.0)},
                              {random.betweenF(0.1, 1.0), random.betweenF(-1.0, 1.0)});
        const ShapeDef b = random.circle();
        const Pair pair = nearPair(random, a, b);
        const Outline center{{pair.outlineB().points[0]}, 0.0};
        if (coreDistance(pair.outlineA(), center) < 2e-3) continue;
        b2EdgeShape edge;
        edge.SetTwoSided({a.vertices[0].x, a.vertices[0].y}, {a.vertices[1].x, a.vertices[1].y});
        edge.m_radius = 0.0f;
        const b2CircleShape circle = b2Circle(b);
        if (separation(pair.outlineA(), pair.outlineB()) > -1e-3) continue;
        b2Manifold manifold;
        b2CollideEdgeAndCircle(&manifold, &edge, b2Identity(), &circle, poseOf(pair));
        expectSameAs(peerOf(manifold, pair, 0.0f, b.radius), pair);
        if (testing::Test::HasFailure()) FAIL() << "pair " << i << ": " << describe(pair);
        ++compared;
    }
    EXPECT_GT(compared, 3'000);
}

TEST(Manifold, OfShapesThatAreApartHasTheDistanceOfBox2D) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int compared = 0;
    for (int i = 0; i < 10'000; ++i) {
        const ShapeDef a = random.shape();
        const ShapeDef b = random.shape();
        const Pair pair = nearPair(random, a, b);
        std::array<b2Vec2, 2 * maxPolygonVertices> points;
        for (std::size_t k = 0; k < maxPolygonVertices; ++k) {
            points[k] = {a.vertices[k].x, a.vertices[k].y};
            points[k + maxPolygonVertices] = {b.vertices[k].x, b.vertices[k].y};
        }
        b2DistanceInput input;
        input.proxyA.Set(points.data(), a.vertexCount, 0.0f);
        input.proxyB.Set(points.data() + maxPolygonVertices, b.vertexCount, 0.0f);
        input.transformA = b2Identity();
        input.transformB = poseOf(pair);
        input.useRadii = false;
        b2SimplexCache cache;
        cache.count = 0;
        b2DistanceOutput output;
        b2Distance(&output, &cache, &input);
        if (output.distance < 1e-3f) continue;  // cores overlap: no distance to compare
        const double expected = static_cast<double>(output.distance) -
                                static_cast<double>(a.radius) - static_cast<double>(b.radius);
        if (expected > margin - tolerance) continue;
        const auto manifold = pair.manifold<float>();
        EXPECT_GE(manifold.count, 1);
        EXPECT_NEAR(leastSeparation(manifold), expected, tolerance);
        if (testing::Test::HasFailure()) FAIL() << "pair " << i << ": " << describe(pair);
        ++compared;
    }
    EXPECT_GT(compared, 1'500);
}

}  // namespace
}  // namespace huestep::oracle
