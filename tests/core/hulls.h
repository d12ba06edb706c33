/// Shapes at random, and how far a point is from one: by brute force in double, from the
/// definitions, sharing no code with core/collision but the hull itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/collision/hull.h"
#include "tests/core/support.h"

namespace huestep::test {

template <class Real>
HullT<Real> hullOfDef(const ShapeDef& shape) {
    ShapeInfo info{};
    info.kind = static_cast<std::uint32_t>(shape.kind) |
                (static_cast<std::uint32_t>(shape.vertexCount) << 8);
    info.radius = shape.radius;
    info.vertices = shape.vertices;
    return hullOf<Real>(info);
}

/// Corners on an ellipse, none of the edges short: convex by construction.
inline ShapeDef randomPolygon(Random& random, float radius) {
    const std::size_t corners = 3 + random.below(6);
    const double width = random.between(0.2, 1.2), height = random.between(0.2, 1.2);
    const double turn = random.between(0.0, 6.28);
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle = turn + 2.0 * M_PI *
                                        (static_cast<double>(i) + random.between(0.0, 0.6)) /
                                        static_cast<double>(corners);
        points.push_back({static_cast<float>(width * std::cos(angle)),
                          static_cast<float>(height * std::sin(angle))});
    }
    return ShapeDef::polygon(points, radius);
}

/// Any kind of shape, from 10 cm to 3 m.
inline ShapeDef randomShapeDef(Random& random) {
    const float radius = random.once(2) ? 0.0f : random.betweenF(0.01, 0.3);
    switch (random.below(5)) {
        case 0:
            return ShapeDef::circle(random.point(-0.4, 0.4), random.betweenF(0.05, 1.0));
        case 1:
            return ShapeDef::box(random.betweenF(0.1, 1.0), random.betweenF(0.1, 1.0), {}, {},
                                 radius);
        case 2:
            return ShapeDef::segment({-random.betweenF(0.1, 1.0), 0.2f}, random.point(0.2, 1.0));
        case 3:
            return ShapeDef::capsule({-random.betweenF(0.1, 1.0), 0.1f}, random.point(0.2, 0.8),
                                     random.betweenF(0.05, 0.4));
        default:
            return randomPolygon(random, radius);
    }
}

inline Vec2T<double> vertexOf(const ShapeDef& shape, std::size_t i) {
    return wide(shape.vertices[i % shape.vertexCount]);
}

/// Signed distance of a point from the surface; negative inside.
inline double distanceTo(const ShapeDef& shape, Vec2T<double> p) {
    double edge = 1e300, deepest = -1e300;
    const std::size_t n = shape.vertexCount;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2T<double> a = vertexOf(shape, i), ab = vertexOf(shape, i + 1) - a;
        const double squared = lengthSquared(ab);
        const double t = squared > 0.0 ? std::clamp(dot(p - a, ab) / squared, 0.0, 1.0) : 0.0;
        edge = std::min(edge, length(p - (a + t * ab)));
        if (n > 2) deepest = std::max(deepest, cross(p - a, ab) / std::sqrt(squared));
    }
    const bool inside = n > 2 && deepest < 0.0;
    return (inside ? -edge : edge) - wide(shape.radius);
}

}  // namespace huestep::test
