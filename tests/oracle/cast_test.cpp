// Rays against Box2D 2.4 where it has the shape, and against sampling where it has not.
#include "core/collision/cast.h"

#include <box2d/box2d.h>
#include <gtest/gtest.h>

#include "tests/core/hulls.h"
#include "tests/oracle/brute.h"

namespace huestep::oracle {
namespace {

using test::hullOfDef;

struct Ray {
    Vec2 from, to;
};

Ray randomRay(Random& random) {
    const double angle = random.between(-3.14, 3.14);
    const Vec2 from{static_cast<float>(4.0 * std::cos(angle)),
                    static_cast<float>(4.0 * std::sin(angle))};
    return {from, {random.betweenF(-2.0, 2.0), random.betweenF(-2.0, 2.0)}};
}

Point pointOf(const Ray& ray, double fraction) {
    const Point from{static_cast<double>(ray.from.x), static_cast<double>(ray.from.y)};
    const Point to{static_cast<double>(ray.to.x), static_cast<double>(ray.to.y)};
    return from + fraction * (to - from);
}

/// The least distance to the outline along the ray, and the first fraction where it is not above
/// zero, by marching as far as the distance allows (sphere tracing: Hart 1996).
struct March {
    double nearest = std::numeric_limits<double>::infinity();
    double fraction = -1.0;
};

March march(const Outline& shape, const Ray& ray) {
    const double whole = lengthOf(pointOf(ray, 1.0) - pointOf(ray, 0.0));
    March result;
    for (double t = 0.0; t <= 1.0;) {
        const double distance = distanceToPoint(shape, pointOf(ray, t));
        result.nearest = std::min(result.nearest, distance);
        if (distance < 1e-7) {
            result.fraction = t;
            return result;
        }
        t += std::max(distance, 1e-6) / whole;
    }
    return result;
}

TEST(RayCast, HitsEveryShapeWhereMarchingDoes) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int hits = 0, misses = 0;
    for (int i = 0; i < 3'000; ++i) {
        const ShapeDef shape = random.shape();
        const Ray ray = randomRay(random);
        const Outline outline = outlineOf(shape);
        const March expected = march(outline, ray);
        if (expected.fraction < 0.0 && expected.nearest < 1e-4) continue;  // grazes
        const auto hit = castRayAtHull(hullOfDef<float>(shape), ray.from, ray.to);
        SCOPED_TRACE("ray " + std::to_string(i));
        // A ray that ends less than a hair inside may round either way.
        if (expected.fraction > 1.0 - 1e-4) continue;
        ASSERT_EQ(hit.has_value(), expected.fraction >= 0.0);
        if (!hit) {
            ++misses;
            continue;
        }
        ++hits;
        // Grazing rays magnify the rounding of the surface; 1e-3 of at most 6 m.
        EXPECT_NEAR(static_cast<double>(hit->fraction), expected.fraction, 1e-3);
        const Point at = pointOf(ray, static_cast<double>(hit->fraction));
        EXPECT_NEAR(distanceToPoint(outline, at), 0.0, 1e-4);
        const Point normal{static_cast<double>(hit->normal.x), static_cast<double>(hit->normal.y)};
        EXPECT_NEAR(lengthOf(normal), 1.0, 1e-4);
        EXPECT_LE(dotOf(normal, pointOf(ray, 1.0) - pointOf(ray, 0.0)), 1e-4);
        // A small step along the outward normal leaves the shape by that step.
        EXPECT_NEAR(distanceToPoint(outline, at + 1e-2 * normal), 1e-2, 5e-4);
    }
    EXPECT_GT(hits, 500);
    EXPECT_GT(misses, 500);
}

TEST(RayCast, FromWithinDoesNotHit) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int inside = 0;
    for (int i = 0; i < 2'000; ++i) {
        const ShapeDef shape = random.shape();
        Ray ray = randomRay(random);
        ray.from = {random.betweenF(-0.5, 0.5), random.betweenF(-0.5, 0.5)};
        if (distanceToPoint(outlineOf(shape), pointOf(ray, 0.0)) > -1e-3) continue;
        EXPECT_FALSE(castRayAtHull(hullOfDef<float>(shape), ray.from, ray.to).has_value()) << i;
        ++inside;
    }
    EXPECT_GT(inside, 200);
}

/// What Box2D says of the same ray; nothing where its hull drops a corner that is nearly in line.
struct Peer {
    bool known = true;
    bool hit = false;
    b2RayCastOutput output{};
};

Peer castByBox2D(const ShapeDef& shape, const Ray& ray) {
    b2Transform identity;
    identity.SetIdentity();
    b2RayCastInput input;
    input.p1 = {ray.from.x, ray.from.y};
    input.p2 = {ray.to.x, ray.to.y};
    input.maxFraction = 1.0f;
    std::array<b2Vec2, maxPolygonVertices> points;
    for (std::size_t k = 0; k < points.size(); ++k) {
        points[k] = {shape.vertices[k].x, shape.vertices[k].y};
    }
    Peer peer;
    if (shape.kind == ShapeKind::Circle) {
        b2CircleShape circle;
        circle.m_p = points[0];
        circle.m_radius = shape.radius;
        peer.hit = circle.RayCast(&peer.output, input, identity, 0);
    } else if (shape.kind == ShapeKind::Polygon) {
        b2PolygonShape polygon;
        polygon.Set(points.data(), shape.vertexCount);
        peer.known = polygon.m_count == shape.vertexCount;
        peer.hit = polygon.RayCast(&peer.output, input, identity, 0);
    } else {
        b2EdgeShape edge;
        edge.SetTwoSided(points[0], points[1]);
        peer.hit = edge.RayCast(&peer.output, input, identity, 0);
    }
    return peer;
}

ShapeDef shapeOfBoth(Random& random) {
    const std::size_t kind = random.below(3);
    if (kind == 0) return random.circle();
    if (kind == 1) return random.polygon(0.0f);
    return ShapeDef::segment({random.betweenF(-1.0, -0.1), random.betweenF(-1.0, 1.0)},
                             {random.betweenF(0.1, 1.0), random.betweenF(-1.0, 1.0)});
}

bool nearCorner(const ShapeDef& shape, Point at) {
    const Outline outline = outlineOf(shape);
    return std::any_of(outline.points.begin(), outline.points.end(),
                       [&](Point corner) { return lengthOf(at - corner) < 1e-3; });
}

TEST(RayCast, HitsDiscsPolygonsAndSegmentsWhereBox2DDoes) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int hits = 0;
    for (int i = 0; i < 10'000; ++i) {
        const ShapeDef shape = shapeOfBoth(random);
        const Ray ray = randomRay(random);
        const March graze = march(outlineOf(shape), ray);
        if (graze.fraction < 0.0 && graze.nearest < 1e-3) continue;
        if (graze.fraction > 1.0 - 1e-3) continue;
        const Peer peer = castByBox2D(shape, ray);
        if (!peer.known) continue;
        const auto hit = castRayAtHull(hullOfDef<float>(shape), ray.from, ray.to);
        SCOPED_TRACE("ray " + std::to_string(i));
        ASSERT_EQ(hit.has_value(), peer.hit);
        if (!hit) continue;
        ++hits;
        EXPECT_NEAR(hit->fraction, peer.output.fraction, 1e-4f);
        // At a corner either face may give the normal; elsewhere they agree.
        if (nearCorner(shape, pointOf(ray, static_cast<double>(hit->fraction)))) continue;
        EXPECT_GT(hit->normal.x * peer.output.normal.x + hit->normal.y * peer.output.normal.y,
                  0.999f);
    }
    EXPECT_GT(hits, 1'000);
}

}  // namespace
}  // namespace huestep::oracle
