#include "core/collision/sweep.h"

#include "core/collision/axes.h"

namespace huestep {

namespace {

// Each look comes nearer by a part that depends on how far the bound is from the truth; hulls that
// take more are as good as there.
constexpr int mostLooks = 48;
// Cores this deep in each other by their faces may yet be apart: two segments end to end.
constexpr float faceTolerance = 0.0001f;  // m

/// The face of `a` over which `b` is highest, and how high; nothing where `a` has no faces.
void highestOverFaces(const Hull& a, const Hull& b, bool flipped, bool& found, Separation& best) {
    if (a.count < 2) return;
    const Axis<float> axis = bestAxis(a, b);
    if (found && !(axis.separation > best.distance)) return;
    found = true;
    const Vec2 n = a.normals[asIndex(axis.edge)];
    best = {axis.separation, flipped ? -n : n};
}

}  // namespace

Separation separationOf(const Hull& a, const Hull& b, const Pose& relative) {
    const Hull there = moved(b, relative);
    Separation best;
    bool faces = false;
    highestOverFaces(a, there, false, faces, best);
    highestOverFaces(there, a, true, faces, best);
    const bool mayPass = a.count <= 2 && b.count <= 2 && best.distance > -faceTolerance;
    if (!faces || best.distance > 0.0f || mayPass) {
        const Nearest<float> nearest = nearestPoints(a, there);
        const Vec2 way = nearest.pointB - nearest.pointA;
        const float distance = length(way);
        // What is nearer than the tolerance may be on either side: faces know which.
        if (!faces || distance > maxOf(best.distance, faceTolerance)) {
            best = {distance, normalized(way)};
        }
    }
    best.distance -= a.radius + b.radius;
    return best;
}

Pose relativeAt(const SweptHull& a, const SweptHull& b, float t) {
    const Rotation q = a.at(t).q;
    const Vec2 apart = (b.from.p - a.from.p) + t * (b.travel - a.travel);
    return {unrotate(q, apart), relative(q, b.at(t).q)};
}

std::optional<float> timeOfApproach(const SweptHull& a, const SweptHull& b,
                                    const Separation& atStart, float target, float tolerance,
                                    float until) {
    const float swing = absoluteOf(a.turn) * a.reach + absoluteOf(b.turn) * b.reach;
    float t = 0.0f;
    Separation s = atStart;
    for (int look = 0; look < mostLooks; ++look) {
        if (look > 0) s = separationOf(*a.hull, *b.hull, relativeAt(a, b, t));
        const float gap = s.distance - target;
        if (gap <= tolerance) return t;
        // Along this normal, fixed in the world, the gap shrinks no faster; and the separation is
        // the greatest over all normals.
        const Vec2 normal = rotate(a.at(t).q, s.normal);
        const float rate = swing - dot(normal, b.travel - a.travel);
        if (!(rate > 0.0f)) return std::nullopt;
        t += gap / rate;
        if (!(t < until)) return std::nullopt;
    }
    return t;
}

}  // namespace huestep
