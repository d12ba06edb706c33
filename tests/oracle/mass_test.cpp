// Mass, centre and inertia against Box2D 2.4 and against polygons of very many corners.
#include "core/collision/mass.h"

#include <box2d/box2d.h>
#include <gtest/gtest.h>

#include "tests/oracle/brute.h"

namespace huestep::oracle {
namespace {

MassProperties massOfDef(const ShapeDef& shape) {
    ShapeInfo info{};
    info.kind =
        static_cast<std::uint32_t>(shape.kind) | static_cast<std::uint32_t>(shape.vertexCount) << 8;
    info.radius = shape.radius;
    info.vertices = shape.vertices;
    return massOf(hullOf<double>(info), static_cast<double>(shape.density));
}

/// The rounded outline as a polygon: every corner becomes an arc of short edges.
std::vector<Point> withArcs(const Outline& shape) {
    const std::size_t steps = 4096;
    const std::size_t n = shape.points.size();
    std::vector<Point> result;
    if (n == 1) {
        for (std::size_t k = 0; k < steps; ++k) {
            const double angle = 2.0 * M_PI * static_cast<double>(k) / static_cast<double>(steps);
            result.push_back(shape.points[0] +
                             shape.radius * Point{std::cos(angle), std::sin(angle)});
        }
        return result;
    }
    const std::vector<Point> normals = normalsOf(shape);
    for (std::size_t i = 0; i < n; ++i) {
        const Point before = normals[(i + n - 1) % n];
        double turn = std::atan2(crossOf(before, normals[i]), dotOf(before, normals[i]));
        if (turn < 0.0) turn += 2.0 * M_PI;
        const double from = std::atan2(before.y, before.x);
        for (std::size_t k = 0; k <= steps; ++k) {
            const double angle = from + turn * static_cast<double>(k) / static_cast<double>(steps);
            result.push_back(shape.points[i] +
                             shape.radius * Point{std::cos(angle), std::sin(angle)});
        }
    }
    return result;
}

/// Green's theorem over the outline.
MassProperties integrate(const std::vector<Point>& outline, double density) {
    double area = 0.0, mx = 0.0, my = 0.0, second = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Point a = outline[i];
        const Point b = outline[(i + 1) % outline.size()];
        const double c = crossOf(a, b);
        area += c / 2.0;
        mx += c * (a.x + b.x) / 6.0;
        my += c * (a.y + b.y) / 6.0;
        second += c * (dotOf(a, a) + dotOf(a, b) + dotOf(b, b)) / 12.0;
    }
    MassProperties result;
    result.mass = density * area;
    result.center = {mx / area, my / area};
    result.inertia = density * second - result.mass * lengthSquared(result.center);
    return result;
}

void expectNear(const MassProperties& actual, const MassProperties& expected, double relative) {
    EXPECT_NEAR(actual.mass, expected.mass, relative * expected.mass);
    EXPECT_NEAR(actual.center.x, expected.center.x, relative);
    EXPECT_NEAR(actual.center.y, expected.center.y, relative);
    EXPECT_NEAR(actual.inertia, expected.inertia, relative * expected.inertia);
}

TEST(Mass, OfEveryRoundedShapeIsThatOfAPolygonOfVeryManyCorners) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    for (int i = 0; i < 200; ++i) {
        ShapeDef shape = random.shape();
        if (shape.kind == ShapeKind::Segment) continue;
        shape.density = random.betweenF(0.1, 20.0);
        SCOPED_TRACE("shape " + std::to_string(i));
        expectNear(massOfDef(shape),
                   integrate(withArcs(outlineOf(shape)), static_cast<double>(shape.density)), 2e-6);
    }
}

TEST(Mass, OfASegmentIsNone) {
    EXPECT_EQ(massOfDef(ShapeDef::segment({-1.0f, 0.0f}, {1.0f, 2.0f})).mass, 0.0);
}

TEST(Mass, OfDiscsAndPolygonsIsThatOfBox2D) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    int compared = 0;
    for (int i = 0; i < 1'000; ++i) {
        ShapeDef shape = i % 2 == 0 ? random.circle() : random.polygon(0.0f);
        shape.density = random.betweenF(0.1, 20.0);
        b2MassData peer{};
        if (shape.kind == ShapeKind::Circle) {
            b2CircleShape circle;
            circle.m_p = {shape.vertices[0].x, shape.vertices[0].y};
            circle.m_radius = shape.radius;
            circle.ComputeMass(&peer, shape.density);
        } else {
            std::array<b2Vec2, maxPolygonVertices> points;
            for (std::size_t k = 0; k < shape.vertexCount; ++k) {
                points[k] = {shape.vertices[k].x, shape.vertices[k].y};
            }
            b2PolygonShape polygon;
            polygon.Set(points.data(), shape.vertexCount);
            if (polygon.m_count != shape.vertexCount) continue;  // a corner nearly in line
            polygon.ComputeMass(&peer, shape.density);
        }
        MassProperties expected;
        expected.mass = static_cast<double>(peer.mass);
        expected.center = {static_cast<double>(peer.center.x), static_cast<double>(peer.center.y)};
        expected.inertia =
            static_cast<double>(peer.I) - expected.mass * lengthSquared(expected.center);
        SCOPED_TRACE("shape " + std::to_string(i));
        expectNear(massOfDef(shape), expected, 1e-4);
        ++compared;
    }
    EXPECT_GT(compared, 900);
}

TEST(Mass, OfACompoundIsThatOfABox2DBody) {
    Random random;
    SCOPED_TRACE("HUESTEP_TEST_SEED=" + std::to_string(random.seed()));
    b2World world({0.0f, 0.0f});
    for (int i = 0; i < 200; ++i) {
        b2BodyDef def;
        def.type = b2_dynamicBody;
        b2Body* body = world.CreateBody(&def);
        std::vector<MassProperties> parts;
        const std::size_t count = 1 + random.below(5);
        for (std::size_t k = 0; k < count; ++k) {
            ShapeDef shape = random.circle();
            shape.vertices[0] = {random.betweenF(-2.0, 2.0), random.betweenF(-2.0, 2.0)};
            shape.density = random.betweenF(0.1, 10.0);
            b2CircleShape circle;
            circle.m_p = {shape.vertices[0].x, shape.vertices[0].y};
            circle.m_radius = shape.radius;
            body->CreateFixture(&circle, shape.density);
            parts.push_back(massOfDef(shape));
        }
        b2MassData peer;
        body->GetMassData(&peer);
        const MassProperties whole = combine(parts);
        SCOPED_TRACE("compound " + std::to_string(i));
        EXPECT_NEAR(whole.mass, static_cast<double>(peer.mass), 1e-4 * whole.mass);
        EXPECT_NEAR(whole.center.x, static_cast<double>(peer.center.x), 1e-4);
        EXPECT_NEAR(whole.center.y, static_cast<double>(peer.center.y), 1e-4);
        const double aboutOrigin = whole.inertia + whole.mass * lengthSquared(whole.center);
        EXPECT_NEAR(aboutOrigin, static_cast<double>(peer.I), 1e-4 * aboutOrigin);
    }
}

}  // namespace
}  // namespace huestep::oracle
