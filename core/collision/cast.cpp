#include "core/collision/cast.h"

namespace huestep {

namespace {

/// Keeps the earliest hit.
void consider(std::optional<HullHit>& best, float fraction, Vec2 normal) {
    if (!(fraction >= 0.0f && fraction <= 1.0f)) return;
    if (!best || fraction < best->fraction) best = HullHit{fraction, normal};
}

/// The first root of |from + t d − center|² = r², entering.
void castAtCircle(std::optional<HullHit>& best, Vec2 center, float r, Vec2 from, Vec2 d) {
    const Vec2 m = from - center;
    const float a = dot(d, d);
    const float b = dot(m, d);
    const float c = dot(m, m) - r * r;
    const float discriminant = b * b - a * c;
    if (!(a > 0.0f) || discriminant < 0.0f || b >= 0.0f || c < 0.0f) return;
    const float t = (-b - std::sqrt(discriminant)) / a;
    consider(best, t, normalized(m + t * d));
}

/// The edge moved outward by the radius, met from outside.
void castAtEdge(std::optional<HullHit>& best, Vec2 v1, Vec2 v2, Vec2 normal, Vec2 from, Vec2 d) {
    const float approach = dot(normal, d);
    const float height = dot(normal, from - v1);
    if (approach >= 0.0f || height < 0.0f) return;
    const float t = height / -approach;
    const Vec2 p = from + t * d;
    if (dot(p - v1, v2 - v1) < 0.0f || dot(p - v2, v1 - v2) < 0.0f) return;
    consider(best, t, normal);
}

/// Whether a point is inside the rounded hull: then no ray from it hits.
bool inside(const Hull& hull, Vec2 p) {
    if (hull.count >= 3) {
        bool core = true;
        for (int i = 0; i < hull.count; ++i) {
            core = core && dot(hull.normals[asIndex(i)], p - hull.vertices[asIndex(i)]) <= 0.0f;
        }
        if (core) return true;
    }
    const float r2 = hull.radius * hull.radius;
    for (int i = 0; i < hull.count; ++i) {
        const Vec2 v1 = hull.vertices[asIndex(i)];
        const Vec2 edge = hull.vertices[asIndex(hull.next(i))] - v1;
        const float l2 = lengthSquared(edge);
        const float t = l2 > 0.0f ? clampTo(dot(p - v1, edge) / l2, 0.0f, 1.0f) : 0.0f;
        if (lengthSquared(p - (v1 + t * edge)) < r2) return true;
    }
    return false;
}

}  // namespace

std::optional<HullHit> castRayAtHull(const Hull& hull, Vec2 from, Vec2 to) {
    std::optional<HullHit> best;
    if (inside(hull, from)) return best;
    const Vec2 d = to - from;
    const int edges = hull.oneSided ? 1 : hull.count;
    for (int i = 0; i < edges; ++i) {
        if (hull.radius > 0.0f) castAtCircle(best, hull.vertices[asIndex(i)], hull.radius, from, d);
        if (hull.count < 2) continue;
        const Vec2 out = hull.radius * hull.normals[asIndex(i)];
        castAtEdge(best, hull.vertices[asIndex(i)] + out,
                   hull.vertices[asIndex(hull.next(i))] + out, hull.normals[asIndex(i)], from, d);
    }
    return best;
}

}  // namespace huestep
