/// What separates two hulls: the best of their edges, and a hull seen from another one's frame.
#pragma once

#include "core/collision/hull.h"

namespace huestep {

/// The hull as seen from another frame.
template <class Real>
HullT<Real> moved(const HullT<Real>& hull, const PoseT<Real>& pose) {
    HullT<Real> out;
    out.count = hull.count;
    out.radius = hull.radius;
    for (int i = 0; i < hull.count; ++i) {
        out.vertices[asIndex(i)] = transform(pose, hull.vertices[asIndex(i)]);
        out.normals[asIndex(i)] = rotate(pose.q, hull.normals[asIndex(i)]);
    }
    return out;
}

/// Two vectors at a time, in lanes; the same numbers.
template <>
inline HullT<float> moved(const HullT<float>& hull, const PoseT<float>& pose) {
    HullT<float> out;
    out.count = hull.count;
    out.radius = hull.radius;
    const LaneF<4> c = splat<4>(pose.q.c);
    const LaneF<4> s{-pose.q.s, pose.q.s, -pose.q.s, pose.q.s};
    const LaneF<4> p{pose.p.x, pose.p.y, pose.p.x, pose.p.y};
    const auto rotated = [&](const LaneF<4>& v) {
        return c * v + s * __builtin_shufflevector(v, v, 1, 0, 3, 2);
    };
    for (int i = 0; i < hull.count; i += 2) {
        storeLanes<4>(&out.vertices[asIndex(i)].x,
                      p + rotated(loadLanes<4>(&hull.vertices[asIndex(i)].x)));
        storeLanes<4>(&out.normals[asIndex(i)].x,
                      rotated(loadLanes<4>(&hull.normals[asIndex(i)].x)));
    }
    return out;
}

/// Four points as two columns.
HUESTEP_INLINE void loadVectors(const Vec2* from, LaneF<4>& x, LaneF<4>& y) {
    const LaneF<4> low = loadLanes<4>(&from[0].x), high = loadLanes<4>(&from[2].x);
    x = __builtin_shufflevector(low, high, 0, 2, 4, 6);
    y = __builtin_shufflevector(low, high, 1, 3, 5, 7);
}

/// The edge of `reference` whose normal separates `other` the most, and by how much.
template <class Real>
struct Axis {
    int edge = 0;
    Real separation{0};
};

template <class Real>
Axis<Real> bestAxis(const HullT<Real>& reference, const HullT<Real>& other) {
    Axis<Real> best;
    for (int i = 0; i < reference.count; ++i) {
        const Vec2T<Real> n = reference.normals[asIndex(i)];
        const Vec2T<Real> v = reference.vertices[asIndex(i)];
        Real lowest = dot(n, other.vertices[0] - v);
        for (int j = 1; j < other.count; ++j) {
            lowest = minOf(lowest, dot(n, other.vertices[asIndex(j)] - v));
        }
        if (i == 0 || lowest > best.separation) best = {i, lowest};
    }
    return best;
}

/// Four edges of the reference at a time, in lanes; the same numbers.
template <>
inline Axis<float> bestAxis(const HullT<float>& reference, const HullT<float>& other) {
    Axis<float> best;
    for (int first = 0; first < reference.count; first += 4) {
        LaneF<4> nx, ny, vx, vy;
        loadVectors(&reference.normals[asIndex(first)], nx, ny);
        loadVectors(&reference.vertices[asIndex(first)], vx, vy);
        const auto distances = [&](Vec2 w) {
            return nx * (splat<4>(w.x) - vx) + ny * (splat<4>(w.y) - vy);
        };
        LaneF<4> lowest = distances(other.vertices[0]);
        for (int j = 1; j < other.count; ++j) {
            lowest = minLanes(lowest, distances(other.vertices[asIndex(j)]));
        }
        for (int i = first; i < reference.count && i < first + 4; ++i) {
            if (i == 0 || lowest[i - first] > best.separation) best = {i, lowest[i - first]};
        }
    }
    return best;
}

}  // namespace huestep
