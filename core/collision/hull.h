/// A shape as the narrow phase sees it: a rounded convex hull in the frame of its body's centre.
#pragma once

#include <array>

#include "core/math/lanes.h"
#include "core/math/vec.h"
#include "core/state/records.h"

namespace huestep {

/// Vertices and edges are counted in int, arrays in std::size_t.
constexpr std::size_t asIndex(int i) {
    return static_cast<std::size_t>(i);
}

/// Points within `radius` of the convex hull of `count` vertices (1 to 8, counter-clockwise).
/// `normals[i]` is the outward normal of the edge from vertex i to vertex i+1; a hull of two
/// vertices has two edges with opposite normals, a hull of one has none.
///
/// A chain segment is a one-sided hull of two vertices: its front is that of edge 0. Its ghosts,
/// before and after, are vertices 2 and 3, outside of the count; normals 2 and 3 are those of the
/// edges to them, in the direction of the chain.
template <class Real>
struct HullT {
    int count = 0;
    bool oneSided = false;
    Real radius{0};
    std::array<Vec2T<Real>, maxPolygonVertices> vertices{};
    std::array<Vec2T<Real>, maxPolygonVertices> normals{};

    [[nodiscard]] int next(int i) const { return i + 1 < count ? i + 1 : 0; }
};

using Hull = HullT<float>;

template <class Real>
HullT<Real> chainHullOf(const ShapeInfo& shape) {
    constexpr std::array<std::size_t, 4> order{1, 2, 0, 3};
    HullT<Real> hull;
    hull.count = 2;
    hull.oneSided = true;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Vec2 v = shape.vertices[order[i]];
        hull.vertices[i] = {static_cast<Real>(v.x), static_cast<Real>(v.y)};
    }
    const auto normal = [&](std::size_t from, std::size_t to) {
        return normalized(perpRight(hull.vertices[to] - hull.vertices[from]));
    };
    hull.normals = {normal(0, 1), normal(1, 0), normal(2, 0), normal(1, 3)};
    return hull;
}

template <class Real>
HullT<Real> hullOf(const ShapeInfo& shape) {
    if (shape.shapeKind() == ShapeKind::ChainSegment) return chainHullOf<Real>(shape);
    HullT<Real> hull;
    hull.count = shape.vertexCount();
    hull.radius = static_cast<Real>(shape.radius);
    for (std::size_t i = 0; i < static_cast<std::size_t>(hull.count); ++i) {
        hull.vertices[i] = {static_cast<Real>(shape.vertices[i].x),
                            static_cast<Real>(shape.vertices[i].y)};
    }
    if (hull.count < 2) return hull;
    for (int i = 0; i < hull.count; ++i) {
        const auto edge = hull.vertices[asIndex(hull.next(i))] - hull.vertices[asIndex(i)];
        hull.normals[asIndex(i)] = normalized(perpRight(edge));
    }
    return hull;
}

/// The hull's farthest point from `from`, m.
template <class Real>
Real reachOf(const HullT<Real>& hull, Vec2T<Real> from = {}) {
    Real squared{0};
    for (std::size_t i = 0; i < static_cast<std::size_t>(hull.count); ++i) {
        squared = maxOf(squared, lengthSquared(hull.vertices[i] - from));
    }
    return std::sqrt(squared) + hull.radius;
}

/// The core's farthest vertex from the origin, m: how far out turning moves anything, as the
/// roundness around a vertex is the same on all sides.
template <class Real>
Real coreReachOf(const HullT<Real>& hull) {
    return reachOf(hull) - hull.radius;
}

/// The tight box around the hull at the pose.
template <class Real>
BoundsT<Real> boundsOf(const HullT<Real>& hull, const PoseT<Real>& pose) {
    Vec2T<Real> low = transform(pose, hull.vertices[0]);
    Vec2T<Real> high = low;
    for (std::size_t i = 1; i < static_cast<std::size_t>(hull.count); ++i) {
        const Vec2T<Real> v = transform(pose, hull.vertices[i]);
        low = minOf(low, v);
        high = maxOf(high, v);
    }
    return grown(BoundsT<Real>{low, high}, hull.radius);
}

/// The same, two vertices at a time in lanes. Rounding is monotone, so the position may be added to
/// the least and the greatest alone: the numbers are those of the general form.
inline Bounds boundsOf(const Hull& hull, const Pose& pose) {
    const LaneF<4> c = splat<4>(pose.q.c);
    const LaneF<4> s{-pose.q.s, pose.q.s, -pose.q.s, pose.q.s};
    const auto rotated = [&](int i) {
        LaneF<4> v = loadLanes<4>(&hull.vertices[asIndex(i)].x);
        if (i + 1 == hull.count) v = __builtin_shufflevector(v, v, 0, 1, 0, 1);
        return c * v + s * __builtin_shufflevector(v, v, 1, 0, 3, 2);
    };
    LaneF<4> low = rotated(0);
    LaneF<4> high = low;
    for (int i = 2; i < hull.count; i += 2) {
        const LaneF<4> v = rotated(i);
        low = minLanes(low, v);
        high = maxLanes(high, v);
    }
    low = minLanes(low, __builtin_shufflevector(low, low, 2, 3, 0, 1));
    high = maxLanes(high, __builtin_shufflevector(high, high, 2, 3, 0, 1));
    const Vec2 lowest{pose.p.x + low[0], pose.p.y + low[1]};
    const Vec2 highest{pose.p.x + high[0], pose.p.y + high[1]};
    return grown(Bounds{lowest, highest}, hull.radius);
}

}  // namespace huestep
