/// What separates two hulls: the best of their edges, their nearest points, and a hull seen from
/// another one's frame.
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

/// The point of an edge that is nearest to a point, and the vertex of the edge that it is or that
/// the edge begins with.
template <class Real>
struct NearestOnEdge {
    NearestOnEdge(const HullT<Real>& hull, int edge, Vec2T<Real> w) {
        const Vec2T<Real> v1 = hull.vertices[asIndex(edge)];
        const Vec2T<Real> v2 = hull.vertices[asIndex(hull.next(edge))];
        const Vec2T<Real> along = v2 - v1;
        const Real squared = lengthSquared(along);
        const Real t = dot(w - v1, along);
        const bool before = t <= Real(0);
        const bool after = !before && t >= squared;
        point = before ? v1 : after ? v2 : v1 + (t / squared) * along;
        vertex = after ? hull.next(edge) : edge;
        isVertex = before || after;
    }
    Vec2T<Real> point;
    int vertex;
    bool isVertex;
};

/// The edge of one hull and the vertex of another that are nearest to each other; of several the
/// first edge, then the first vertex.
template <class Real>
struct EdgeAndVertex {
    int edge = 0;
    int vertex = 0;
    Real squared{0};  ///< m²
};

template <class Real>
EdgeAndVertex<Real> nearestEdgeAndVertex(const HullT<Real>& a, const HullT<Real>& b) {
    EdgeAndVertex<Real> nearest;
    for (int i = 0; i < a.count; ++i) {
        for (int j = 0; j < b.count; ++j) {
            const Vec2T<Real> way =
                b.vertices[asIndex(j)] - NearestOnEdge<Real>(a, i, b.vertices[asIndex(j)]).point;
            const Real squared = lengthSquared(way);
            if ((i == 0 && j == 0) || squared < nearest.squared) nearest = {i, j, squared};
        }
    }
    return nearest;
}

/// Four vertices at a time, in lanes; the same numbers.
template <>
inline EdgeAndVertex<float> nearestEdgeAndVertex(const HullT<float>& a, const HullT<float>& b) {
    EdgeAndVertex<float> nearest{};
    for (int first = 0; first < b.count; first += 4) {
        LaneF<4> wx, wy, least{}, edgeOf{};
        loadVectors(&b.vertices[asIndex(first)], wx, wy);
        for (int i = 0; i < a.count; ++i) {
            const Vec2 v1 = a.vertices[asIndex(i)], v2 = a.vertices[asIndex(a.next(i))];
            const Vec2 edge = v2 - v1;
            const float edgeSquared = lengthSquared(edge);
            const LaneF<4> x1 = splat<4>(v1.x), y1 = splat<4>(v1.y);
            const LaneF<4> t = (wx - x1) * splat<4>(edge.x) + (wy - y1) * splat<4>(edge.y);
            const auto before = t <= LaneF<4>{};
            const auto after = t >= splat<4>(edgeSquared);
            const LaneF<4> part = t / splat<4>(edgeSquared);
            const auto nearestTo = [&](float start, float end, float along) {
                return selectLanes(
                    before, splat<4>(start),
                    selectLanes(after, splat<4>(end), splat<4>(start) + part * splat<4>(along)));
            };
            const LaneF<4> dx = wx - nearestTo(v1.x, v2.x, edge.x);
            const LaneF<4> dy = wy - nearestTo(v1.y, v2.y, edge.y);
            const LaneF<4> squared = dx * dx + dy * dy;
            if (i == 0) {
                least = squared;
                continue;
            }
            const auto less = squared < least;
            least = selectLanes(less, squared, least);
            edgeOf = selectLanes(less, splat<4>(static_cast<float>(i)), edgeOf);
        }
        for (int j = first; j < b.count && j < first + 4; ++j) {
            const EdgeAndVertex<float> mine{static_cast<int>(edgeOf[j - first]), j,
                                            least[j - first]};
            const bool better = j == 0 || mine.squared < nearest.squared ||
                                (mine.squared == nearest.squared && mine.edge < nearest.edge);
            if (better) nearest = mine;
        }
    }
    return nearest;
}

/// The points of two hulls' cores that are nearest to each other, where the cores are apart: those
/// of two convex cores are on a vertex and an edge, or on two vertices.
template <class Real>
struct Nearest {
    Real squared{0};  ///< m²
    Vec2T<Real> pointA, pointB;
    int vertexA = 0;
    int vertexB = 0;
    bool twoVertices = false;
};

/// Both hulls in one frame. Of equals the one on an edge of A counts.
template <class Real>
Nearest<Real> nearestPoints(const HullT<Real>& a, const HullT<Real>& b) {
    const EdgeAndVertex<Real> onA = nearestEdgeAndVertex(a, b);
    const EdgeAndVertex<Real> onB = nearestEdgeAndVertex(b, a);
    if (onB.squared < onA.squared) {
        const Vec2T<Real> w = a.vertices[asIndex(onB.vertex)];
        const NearestOnEdge<Real> at(b, onB.edge, w);
        return {onB.squared, w, at.point, onB.vertex, at.vertex, at.isVertex};
    }
    const Vec2T<Real> w = b.vertices[asIndex(onA.vertex)];
    const NearestOnEdge<Real> at(a, onA.edge, w);
    return {onA.squared, at.point, w, at.vertex, onA.vertex, at.isVertex};
}

}  // namespace huestep
