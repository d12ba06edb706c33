#include "core/collision/mass.h"

#include <array>

#include "core/math/trig.h"

namespace huestep {

namespace {

using Point = Vec2T<double>;

/// Area, first and second moments about the hull's frame, to be scaled by the density.
struct Moments {
    double area = 0.0;
    Point first;          // ∫ x dA
    double second = 0.0;  // ∫ |x|² dA

    /// A part with its own area, centroid and second moment about that centroid.
    void add(double partArea, Point centroid, double aboutCentroid) {
        area += partArea;
        first += partArea * centroid;
        second += aboutCentroid + partArea * lengthSquared(centroid);
    }
};

/// The triangle (origin, a, b): area ½ a×b, second moment about the origin
/// (a·a + a·b + b·b) / 6 times the area.
void addTriangle(Moments& m, Point origin, Point a, Point b) {
    const Point p = a - origin;
    const Point q = b - origin;
    const double area = 0.5 * cross(p, q);
    const Point centroid = (1.0 / 3.0) * (p + q);
    const double aboutOrigin = area * (dot(p, p) + dot(p, q) + dot(q, q)) / 6.0;
    m.add(area, origin + centroid, aboutOrigin - area * lengthSquared(centroid));
}

/// The strip of width r outside an edge.
void addStrip(Moments& m, Point a, Point b, Point normal, double r) {
    const double l = length(b - a);
    const double area = l * r;
    m.add(area, 0.5 * (a + b) + (0.5 * r) * normal, area * (l * l + r * r) / 12.0);
}

/// The sector of radius r at a corner, between the directions `from` and `to`, `angle` wide.
/// Centroid at 4 r sin(angle/2) / (3 angle) along the bisector; second moment about the apex
/// r⁴ angle / 4.
void addSector(Moments& m, Point apex, Point bisector, double angle, double r) {
    if (!(angle > 1e-12)) return;
    const double area = 0.5 * angle * r * r;
    const double reach = 4.0 * r * rotationOf(0.5 * angle).s / (3.0 * angle);
    m.add(area, apex + reach * bisector, 0.25 * angle * r * r * r * r - area * reach * reach);
}

}  // namespace

MassProperties massOf(const HullT<double>& given, double density) {
    // About a vertex, not about the frame's origin, which may be kilometres away: the second moment
    // about the centre is a difference of two that grow with the square of that distance.
    const Point origin = given.vertices[0];
    HullT<double> hull = given;
    for (int i = 0; i < hull.count; ++i) hull.vertices[static_cast<std::size_t>(i)] -= origin;
    Moments m;
    const double r = hull.radius;
    if (hull.count == 1) {
        m.add(pi * r * r, hull.vertices[0], 0.5 * pi * r * r * r * r);
    } else {
        for (int i = 1; i + 1 < hull.count; ++i) {
            addTriangle(m, hull.vertices[0], hull.vertices[static_cast<std::size_t>(i)],
                        hull.vertices[static_cast<std::size_t>(i) + 1]);
        }
        for (int i = 0; r > 0.0 && i < hull.count; ++i) {
            const auto here = static_cast<std::size_t>(i);
            const auto next = static_cast<std::size_t>(hull.next(i));
            addStrip(m, hull.vertices[here], hull.vertices[next], hull.normals[here], r);
            const RotationT<double> turn{dot(hull.normals[here], hull.normals[next]),
                                         cross(hull.normals[here], hull.normals[next])};
            // Half a turn at the end of a capsule may come out as −π by rounding, and no turn
            // between edges in line as a little less than 0.
            const double signedAngle = angleOf(turn);
            const double angle = signedAngle < -0.5 * pi ? signedAngle + 2.0 * pi : signedAngle;
            const RotationT<double> half = rotationOf(0.5 * angle);
            addSector(m, hull.vertices[next], rotate(half, hull.normals[here]), angle, r);
        }
    }
    if (!(m.area > 0.0)) return {0.0, origin, 0.0};
    const Point center = (1.0 / m.area) * m.first;
    return {density * m.area, origin + center,
            density * (m.second - m.area * lengthSquared(center))};
}

MassProperties combine(std::span<const MassProperties> parts) {
    MassProperties sum;
    Point first;
    for (const MassProperties& part : parts) {
        sum.mass += part.mass;
        first += part.mass * part.center;
    }
    if (!(sum.mass > 0.0)) return {};
    sum.center = (1.0 / sum.mass) * first;
    for (const MassProperties& part : parts) {
        sum.inertia += part.inertia + part.mass * lengthSquared(part.center - sum.center);
    }
    return sum;
}

}  // namespace huestep
