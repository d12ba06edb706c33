// Chain segments against the one-sided edges of Box2D 2.4.
#include <box2d/box2d.h>
#include <gtest/gtest.h>

#include <optional>

#include "core/collision/cast.h"
#include "core/collision/manifold.h"
#include "tests/core/hulls.h"
#include "tests/oracle/brute.h"

namespace huestep::oracle {
namespace {

using test::hullOfDef;
using test::wide;

/// A segment whose neighbours turn away from it by up to 80° either way.
ShapeDef randomSegment(Random& random) {
    const Vec2 a{random.betweenF(-1.5, -0.3), random.betweenF(-0.5, 0.5)};
    const Vec2 b{random.betweenF(0.3, 1.5), random.betweenF(-0.5, 0.5)};
    const double way = std::atan2(wide(b.y - a.y), wide(b.x - a.x));
    const auto beside = [&](Vec2 from, double side) {
        const double angle = way + random.between(-1.4, 1.4);
        const double far = side * random.between(0.3, 1.5);
        return from + Vec2{static_cast<float>(far * std::cos(angle)),
                           static_cast<float>(far * std::sin(angle))};
    };
    const Vec2 before = beside(a, -1.0);
    return ShapeDef::chainSegment(before, a, b, beside(b, 1.0));
}

b2EdgeShape edgeOf(const ShapeDef& segment) {
    std::array<b2Vec2, 4> p;
    for (std::size_t i = 0; i < p.size(); ++i)
        p[i] = {segment.vertices[i].x, segment.vertices[i].y};
    b2EdgeShape edge;
    edge.SetOneSided(p[0], p[1], p[2], p[3]);
    edge.m_radius = 0.0f;
    return edge;
}

/// What both say of a shape at a place: how deep, and along which normal; nothing: no contact.
struct Touch {
    double separation = 0.0;
    Point normal;
};

std::optional<Touch> touchOf(const ManifoldT<float>& manifold) {
    if (manifold.count == 0) return std::nullopt;
    Touch touch{wide(manifold.points[0].separation),
                {wide(manifold.normal.x), wide(manifold.normal.y)}};
    if (manifold.count == 2)
        touch.separation = std::min(touch.separation, wide(manifold.points[1].separation));
    return touch;
}

std::optional<Touch> touchOf(const b2Manifold& manifold, const b2Transform& pose, float radius) {
    if (manifold.pointCount == 0) return std::nullopt;
    b2Transform identity;
    identity.SetIdentity();
    b2WorldManifold world;
    world.Initialize(&manifold, identity, 0.0f, pose, radius);
    Touch touch{wide(world.separations[0]), {wide(world.normal.x), wide(world.normal.y)}};
    if (manifold.pointCount == 2)
        touch.separation = std::min(touch.separation, wide(world.separations[1]));
    return touch;
}

/// How far along the segment and above its front a point is, both in m.
struct Beside {
    double along = 0.0, above = 0.0, length = 0.0;
};

Beside besideOf(const ShapeDef& segment, Point p) {
    const Point a{wide(segment.vertices[1].x), wide(segment.vertices[1].y)};
    const Point b{wide(segment.vertices[2].x), wide(segment.vertices[2].y)};
    const double whole = lengthOf(b - a);
    const Point t = (1.0 / whole) * (b - a);
    return {dotOf(t, p - a), crossOf(p - a, t), whole};
}

TEST(Chain, TouchesADiscWhereAndHowBox2DsEdgeDoes) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int touching = 0, apart = 0;
    for (int i = 0; i < 20'000; ++i) {
        const ShapeDef segment = randomSegment(random);
        const ShapeDef disc = ShapeDef::circle({}, random.betweenF(0.1, 0.8));
        const Point at{random.between(-2.0, 2.0), random.between(-1.5, 1.5)};
        const Outline face{{{wide(segment.vertices[1].x), wide(segment.vertices[1].y)},
                            {wide(segment.vertices[2].x), wide(segment.vertices[2].y)}},
                           0.0};
        const double far = distanceToPoint(face, at);
        // Where it only just touches, has its middle on the line or lies between two faces' parts
        // either may round its own way.
        if (far < 2e-3 || std::abs(far - wide(disc.radius)) < 1e-3) continue;
        bool near = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point a{wide(segment.vertices[k].x), wide(segment.vertices[k].y)};
            const Point b{wide(segment.vertices[k + 1].x), wide(segment.vertices[k + 1].y)};
            const Point t = (1.0 / lengthOf(b - a)) * (b - a);
            near |= std::abs(crossOf(at - a, t)) < 1e-3 || std::abs(dotOf(t, at - a)) < 1e-3 ||
                    std::abs(dotOf(t, at - b)) < 1e-3;
        }
        if (near) continue;
        b2Transform pose;
        pose.Set({static_cast<float>(at.x), static_cast<float>(at.y)}, 0.0f);
        b2CircleShape circle;
        circle.m_radius = disc.radius;
        const b2EdgeShape edge = edgeOf(segment);
        b2Transform identity;
        identity.SetIdentity();
        b2Manifold manifold;
        b2CollideEdgeAndCircle(&manifold, &edge, identity, &circle, pose);
        const auto peer = touchOf(manifold, pose, disc.radius);
        const auto mine =
            touchOf(collide(hullOfDef<float>(segment), hullOfDef<float>(disc),
                            Pose{{static_cast<float>(at.x), static_cast<float>(at.y)}, {}}, 0.0f));
        SCOPED_TRACE("disc " + std::to_string(i));
        ASSERT_EQ(mine.has_value(), peer.has_value()) << "above by " << besideOf(segment, at).above;
        if (!mine) {
            ++apart;
            continue;
        }
        ++touching;
        EXPECT_NEAR(mine->separation, peer->separation, 1e-4);
        EXPECT_GT(dotOf(mine->normal, peer->normal), 0.9999);
    }
    EXPECT_GT(touching, 1'000);
    EXPECT_GT(apart, 5'000);
}

TEST(Chain, TouchesAPolygonAboveItsMiddleAsBox2DsEdgeDoesAndNoneBehind) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int touching = 0, behind = 0;
    for (int i = 0; i < 20'000; ++i) {
        ShapeDef segment = randomSegment(random);
        for (std::size_t k = 0; k < 4; ++k) segment.vertices[k] = 6.0f * segment.vertices[k];
        const ShapeDef other = random.polygon(0.0f);
        const double angle = random.between(-3.14, 3.14);
        Point at{random.between(-3.0, 3.0), random.between(-3.5, 3.5)};
        if (i % 2 == 0) {  // just above its face or just in it
            double lowest = 1e9;
            for (const Point p : outlineOf(other, at, angle).points)
                lowest = std::min(lowest, besideOf(segment, p).above);
            const Point face{wide(segment.vertices[2].x - segment.vertices[1].x),
                             wide(segment.vertices[2].y - segment.vertices[1].y)};
            const double by = (random.between(-0.02, 0.02) - lowest) / lengthOf(face);
            at = at + by * Point{face.y, -face.x};
        }
        const Outline outline = outlineOf(other, at, angle);
        Point middle;
        double lowest = 1e9, left = 1e9, right = 1e9;
        for (const Point p : outline.points) {
            const Beside beside = besideOf(segment, p);
            middle = middle + (1.0 / static_cast<double>(outline.points.size())) * p;
            lowest = std::min(lowest, beside.above);
            left = std::min(left, beside.along);
            right = std::min(right, beside.length - beside.along);
        }
        if (left < 0.1 || right < 0.1) continue;
        b2PolygonShape polygon;
        std::array<b2Vec2, maxPolygonVertices> points;
        for (std::size_t k = 0; k < other.vertexCount; ++k)
            points[k] = {other.vertices[k].x, other.vertices[k].y};
        polygon.Set(points.data(), other.vertexCount);
        polygon.m_radius = 0.0f;
        if (polygon.m_count != other.vertexCount) continue;
        b2Transform pose, identity;
        identity.SetIdentity();
        pose.Set({static_cast<float>(at.x), static_cast<float>(at.y)}, static_cast<float>(angle));
        const b2EdgeShape edge = edgeOf(segment);
        const auto mine = touchOf(collide(
            hullOfDef<float>(segment), hullOfDef<float>(other),
            Pose{{static_cast<float>(at.x), static_cast<float>(at.y)},
                 {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))}},
            0.0f));
        SCOPED_TRACE("polygon " + std::to_string(i));
        const double above = besideOf(segment, middle).above;
        if (above < -0.05) {
            ++behind;
            EXPECT_FALSE(mine) << "it has its middle behind the segment by " << above;
            continue;
        }
        // Sunk in deeper, another of its faces may be nearer.
        if (above < 0.05 || lowest < -0.02 || std::abs(lowest) < 1e-3) continue;
        b2Manifold manifold;
        b2CollideEdgeAndPolygon(&manifold, &edge, identity, &polygon, pose);
        const auto peer = touchOf(manifold, pose, 0.0f);
        ASSERT_EQ(mine.has_value(), lowest < 0.0);
        ASSERT_EQ(peer.has_value(), lowest < 0.0);
        if (!mine) continue;
        ++touching;
        EXPECT_NEAR(mine->separation, lowest, 1e-4);
        EXPECT_NEAR(mine->separation, peer->separation, 1e-4);
        EXPECT_GT(dotOf(mine->normal, peer->normal), 0.9999);
    }
    EXPECT_GT(touching, 1'000);
    EXPECT_GT(behind, 1'000);
}

TEST(Chain, IsHitByARayWhereBox2DsEdgeIs) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int hits = 0, misses = 0;
    for (int i = 0; i < 20'000; ++i) {
        const ShapeDef segment = randomSegment(random);
        const Vec2 from{random.betweenF(-3.0, 3.0), random.betweenF(-3.0, 3.0)};
        const Vec2 to{random.betweenF(-3.0, 3.0), random.betweenF(-3.0, 3.0)};
        const Beside start = besideOf(segment, {wide(from.x), wide(from.y)});
        const Beside end = besideOf(segment, {wide(to.x), wide(to.y)});
        if (std::abs(start.above) < 1e-3 || std::abs(end.above) < 1e-3) continue;
        const double t = start.above / (start.above - end.above);
        const double along = start.along + t * (end.along - start.along);
        if (std::abs(along) < 1e-3 || std::abs(along - start.length) < 1e-3) continue;
        b2Transform identity;
        identity.SetIdentity();
        b2RayCastInput input;
        input.p1 = {from.x, from.y};
        input.p2 = {to.x, to.y};
        input.maxFraction = 1.0f;
        b2RayCastOutput output;
        const bool peer = edgeOf(segment).RayCast(&output, input, identity, 0);
        const auto hit = castRayAtHull(hullOfDef<float>(segment), from, to);
        SCOPED_TRACE("ray " + std::to_string(i));
        ASSERT_EQ(hit.has_value(), peer);
        ASSERT_EQ(peer,
                  start.above > 0.0 && end.above < 0.0 && along > 0.0 && along < start.length);
        if (!hit) {
            ++misses;
            continue;
        }
        ++hits;
        EXPECT_NEAR(wide(hit->fraction), t, 1e-4);
        EXPECT_NEAR(hit->fraction, output.fraction, 1e-4f);
        EXPECT_NEAR(hit->normal.x, output.normal.x, 1e-4f);
        EXPECT_NEAR(hit->normal.y, output.normal.y, 1e-4f);
    }
    EXPECT_GT(hits, 500);
    EXPECT_GT(misses, 5'000);
}

}  // namespace
}  // namespace huestep::oracle
