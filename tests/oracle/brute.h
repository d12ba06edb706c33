/// Answers by brute force in double, for what Box2D does not have or has with a skin of its own.
/// Written from the definitions, sharing no code with core/collision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "core/scene/scene.h"

namespace huestep::oracle {

struct Point {
    double x = 0.0;
    double y = 0.0;
};

inline Point operator+(Point a, Point b) {
    return {a.x + b.x, a.y + b.y};
}
inline Point operator-(Point a, Point b) {
    return {a.x - b.x, a.y - b.y};
}
inline Point operator*(double s, Point a) {
    return {s * a.x, s * a.y};
}
inline double dotOf(Point a, Point b) {
    return a.x * b.x + a.y * b.y;
}
inline double crossOf(Point a, Point b) {
    return a.x * b.y - a.y * b.x;
}
inline double lengthOf(Point a) {
    return std::hypot(a.x, a.y);
}

/// A convex outline somewhere in the plane, and how far it is rounded.
struct Outline {
    std::vector<Point> points;
    double radius = 0.0;
};

inline Outline outlineOf(const ShapeDef& shape, Point position = {}, double angle = 0.0) {
    Outline result;
    result.radius = static_cast<double>(shape.radius);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    for (std::size_t i = 0; i < shape.vertexCount; ++i) {
        const double x = static_cast<double>(shape.vertices[i].x);
        const double y = static_cast<double>(shape.vertices[i].y);
        result.points.push_back({position.x + c * x - s * y, position.y + s * x + c * y});
    }
    return result;
}

inline double distanceToSegment(Point p, Point a, Point b) {
    const Point ab = b - a;
    const double squared = dotOf(ab, ab);
    const double t = squared > 0.0 ? std::clamp(dotOf(p - a, ab) / squared, 0.0, 1.0) : 0.0;
    return lengthOf(p - (a + t * ab));
}

/// Outward unit normals of the edges; both of a segment's, none of a point's.
inline std::vector<Point> normalsOf(const Outline& shape) {
    std::vector<Point> normals;
    const std::size_t n = shape.points.size();
    for (std::size_t i = 0; n > 1 && i < n; ++i) {
        const Point edge = shape.points[(i + 1) % n] - shape.points[i];
        normals.push_back((1.0 / lengthOf(edge)) * Point{edge.y, -edge.x});
    }
    return normals;
}

/// How far apart the cores are along `axis`, from `a` to `b`; negative: they overlap along it.
inline double gapAlong(Point axis, const Outline& a, const Outline& b) {
    double farA = -std::numeric_limits<double>::infinity();
    double nearB = std::numeric_limits<double>::infinity();
    for (const Point p : a.points) farA = std::max(farA, dotOf(axis, p));
    for (const Point p : b.points) nearB = std::min(nearB, dotOf(axis, p));
    return nearB - farA;
}

/// The gaps along all edge normals, from A to B, largest first. The first is the depth (negated)
/// where the cores overlap: the normals of the Minkowski difference are those of both outlines.
inline std::vector<double> gaps(const Outline& a, const Outline& b) {
    std::vector<double> result;
    for (const Point n : normalsOf(a)) result.push_back(gapAlong(n, a, b));
    for (const Point n : normalsOf(b)) result.push_back(gapAlong(-1.0 * n, a, b));
    std::sort(result.rbegin(), result.rend());
    return result;
}

/// Distance of the cores by trying every vertex against every edge; 0 where they overlap.
inline double coreDistance(const Outline& a, const Outline& b) {
    const std::vector<double> along = gaps(a, b);
    const bool area = a.points.size() > 2 || b.points.size() > 2;
    if (!along.empty() && along[0] < 0.0 && area) return 0.0;
    double best = std::numeric_limits<double>::infinity();
    const auto tryAll = [&](const Outline& from, const Outline& to) {
        const std::size_t n = to.points.size();
        for (const Point p : from.points) {
            for (std::size_t i = 0; i < n; ++i) {
                best = std::min(best, distanceToSegment(p, to.points[i], to.points[(i + 1) % n]));
            }
        }
    };
    tryAll(a, b);
    tryAll(b, a);
    return best;
}

/// Signed distance of two rounded outlines: of the surfaces where the cores are apart, and minus
/// the least translation that parts them where they overlap.
inline double separation(const Outline& a, const Outline& b) {
    const double radius = a.radius + b.radius;
    const std::vector<double> along = gaps(a, b);
    if (!along.empty() && along[0] < 0.0) {
        // Two segments that cross, or an area that is entered. Segments that lie in one line apart
        // from each other have no negative gap along their normals, but a gap of 0.
        return along[0] - radius;
    }
    return coreDistance(a, b) - radius;
}

inline double distanceToPoint(const Outline& shape, Point p) {
    return separation(shape, Outline{{p}, 0.0});
}

inline Outline moved(Outline shape, Point by) {
    for (Point& p : shape.points) p = p + by;
    return shape;
}

/// Random numbers from a seed that every failing test prints; HUESTEP_TEST_SEED chooses another.
class Random {
 public:
    Random() {
        if (const char* text = std::getenv("HUESTEP_TEST_SEED"))
            m_seed = std::strtoull(text, nullptr, 10);
        m_engine.seed(m_seed);
    }
    [[nodiscard]] std::uint64_t seed() const { return m_seed; }
    double between(double low, double high) {
        const double unit = static_cast<double>(m_engine() >> 11) * 0x1p-53;
        return low + (high - low) * unit;
    }
    float betweenF(double low, double high) { return static_cast<float>(between(low, high)); }
    std::size_t below(std::size_t count) { return m_engine() % count; }

    /// A convex polygon with corners on an ellipse, none of its edges short.
    ShapeDef polygon(float radius) {
        const std::size_t corners = 3 + below(6);
        const double width = between(0.2, 1.5);
        const double height = between(0.2, 1.5);
        const double turn = between(0.0, 6.28);
        const Point middle{between(-0.3, 0.3), between(-0.3, 0.3)};
        std::array<Vec2, maxPolygonVertices> points{};
        for (std::size_t i = 0; i < corners; ++i) {
            const double angle = turn + 6.283185307179586 *
                                            (static_cast<double>(i) + between(0.0, 0.6)) /
                                            static_cast<double>(corners);
            points[i] = {static_cast<float>(middle.x + width * std::cos(angle)),
                         static_cast<float>(middle.y + height * std::sin(angle))};
        }
        return ShapeDef::polygon(std::span(points).first(corners), radius);
    }

    ShapeDef circle() {
        return ShapeDef::circle({betweenF(-0.5, 0.5), betweenF(-0.5, 0.5)}, betweenF(0.05, 1.0));
    }

    /// Any shape of the core, of a size between 10 cm and 3 m.
    ShapeDef shape() {
        const float radius = below(2) == 0 ? 0.0f : betweenF(0.01, 0.4);
        switch (below(5)) {
            case 0:
                return circle();
            case 1:
                return ShapeDef::box(betweenF(0.05, 1.0), betweenF(0.05, 1.0), {}, {}, radius);
            case 2:
                return polygon(radius);
            case 3:
                return ShapeDef::segment({betweenF(-1.0, -0.1), betweenF(-0.5, 0.5)},
                                         {betweenF(0.1, 1.0), betweenF(-0.5, 0.5)});
            default:
                return ShapeDef::capsule({betweenF(-1.0, -0.1), betweenF(-0.5, 0.5)},
                                         {betweenF(0.1, 1.0), betweenF(-0.5, 0.5)},
                                         betweenF(0.02, 0.5));
        }
    }

 private:
    std::uint64_t m_seed = 20260820;
    std::mt19937_64 m_engine;
};

}  // namespace huestep::oracle
