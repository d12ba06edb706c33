#include "core/scene/scene.h"

#include <algorithm>

namespace huestep {

namespace {

/// Ids for all places of a list: those that are given stand, the others are counted up from
/// `next`, in the order of the list, past every id that is given.
template <class Def>
std::vector<std::uint32_t> idsOf(const std::vector<Def>& defs, std::uint32_t next) {
    std::vector<std::uint32_t> ids;
    ids.reserve(defs.size());
    for (const Def& def : defs) {
        if (def.id >= next) next = def.id + 1;
    }
    for (const Def& def : defs) ids.push_back(def.id != 0 ? def.id : next++);
    return ids;
}

}  // namespace

ShapeDef ShapeDef::circle(Vec2 center, float radius) {
    ShapeDef shape;
    shape.kind = ShapeKind::Circle;
    shape.vertexCount = 1;
    shape.vertices[0] = center;
    shape.radius = radius;
    return shape;
}

ShapeDef ShapeDef::capsule(Vec2 a, Vec2 b, float radius) {
    ShapeDef shape;
    shape.kind = ShapeKind::Capsule;
    shape.vertexCount = 2;
    shape.vertices[0] = a;
    shape.vertices[1] = b;
    shape.radius = radius;
    return shape;
}

ShapeDef ShapeDef::segment(Vec2 a, Vec2 b) {
    ShapeDef shape;
    shape.kind = ShapeKind::Segment;
    shape.vertexCount = 2;
    shape.vertices[0] = a;
    shape.vertices[1] = b;
    shape.radius = 0.0f;
    return shape;
}

ShapeDef ShapeDef::box(float hx, float hy, Vec2 center, Rotation q, float radius) {
    const Pose pose{center, q};
    const std::array<Vec2, 4> corners{transform(pose, Vec2{-hx, -hy}),
                                      transform(pose, Vec2{hx, -hy}), transform(pose, Vec2{hx, hy}),
                                      transform(pose, Vec2{-hx, hy})};
    return polygon(corners, radius);
}

ShapeDef ShapeDef::polygon(std::span<const Vec2> points, float radius) {
    ShapeDef shape;
    shape.kind = ShapeKind::Polygon;
    // A count beyond what fits is kept, so that `check` can name it; the points are cut off.
    shape.vertexCount = static_cast<std::uint8_t>(std::min<std::size_t>(points.size(), 255));
    const std::size_t kept = std::min<std::size_t>(points.size(), shape.vertices.size());
    std::copy_n(points.begin(), kept, shape.vertices.begin());
    shape.radius = radius;
    return shape;
}

ShapeDef ShapeDef::chainSegment(Vec2 before, Vec2 a, Vec2 b, Vec2 after) {
    ShapeDef shape;
    shape.kind = ShapeKind::ChainSegment;
    shape.vertexCount = 4;
    shape.vertices = {before, a, b, after};
    shape.radius = 0.0f;
    return shape;
}

std::vector<ShapeDef> ShapeDef::chain(std::span<const Vec2> points, bool loop) {
    const std::size_t n = points.size();
    std::vector<ShapeDef> segments;
    if (n < (loop ? 3u : 4u)) return segments;
    for (std::size_t i = 0; i < (loop ? n : n - 3); ++i) {
        segments.push_back(
            chainSegment(points[i], points[(i + 1) % n], points[(i + 2) % n], points[(i + 3) % n]));
    }
    return segments;
}

bool isRulesName(std::string_view name) {
    if (name.empty() || name.size() > caps::maxRulesName) return false;
    return std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

std::vector<BodyId> bodyIdsOf(const Scene& scene) {
    return idsOf(scene.bodies, scene.counters.nextBody);
}

std::vector<JointId> jointIdsOf(const Scene& scene) {
    return idsOf(scene.joints, scene.counters.nextJoint);
}

}  // namespace huestep
