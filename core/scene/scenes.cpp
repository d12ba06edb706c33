#include "core/scene/scenes.h"

#include <algorithm>

#include "core/math/trig.h"

namespace huestep::scenes {

Scene awake() {
    Scene scene;
    scene.sleep = false;
    return scene;
}

void addFloor(Scene& scene, float halfWidth, float friction) {
    BodyDef floor = bodyOf(BodyType::Static, {0.0f, -1.0f}, ShapeDef::box(halfWidth, 1.0f));
    floor.shapes[0].material.friction = friction;
    add(scene, floor);
}

std::uint32_t add(Scene& scene, const BodyDef& body) {
    scene.bodies.push_back(body);
    return static_cast<std::uint32_t>(scene.bodies.size() - 1);
}

BodyDef bodyOf(BodyType type, Vec2 position, const ShapeDef& shape) {
    BodyDef body;
    body.type = type;
    body.position = position;
    body.shapes.push_back(shape);
    return body;
}

void addStatic(Scene& scene, std::span<const ShapeDef> shapes) {
    while (!shapes.empty()) {
        const std::size_t some = std::min(shapes.size(), staticShapes);
        BodyDef body;
        body.shapes.assign(shapes.begin(), shapes.begin() + static_cast<std::ptrdiff_t>(some));
        add(scene, body);
        shapes = shapes.subspan(some);
    }
}

void addTrough(std::vector<ShapeDef>& shapes, std::uint32_t halfWidth, std::uint32_t height) {
    const auto end = static_cast<float>(halfWidth);
    for (std::uint32_t i = 0; i <= 2 * halfWidth; ++i) {
        shapes.push_back(ShapeDef::box(0.55f, 0.5f, {static_cast<float>(i) - end, 0.0f}));
    }
    for (const float x : {-end, end}) {
        for (std::uint32_t i = 0; i < height; ++i) {
            shapes.push_back(ShapeDef::box(0.5f, 0.55f, {x, static_cast<float>(i) + 1.0f}));
        }
    }
}

JointDef hingeAt(const Scene& scene, std::uint32_t bodyA, std::uint32_t bodyB, Vec2 point) {
    const BodyDef& a = scene.bodies[bodyA];
    const BodyDef& b = scene.bodies[bodyB];
    JointDef joint;
    joint.kind = JointKind::Revolute;
    joint.bodyA = bodyA;
    joint.bodyB = bodyB;
    joint.anchorA = untransform(Pose{a.position, a.rotation}, point);
    joint.anchorB = untransform(Pose{b.position, b.rotation}, point);
    joint.reference = relative(a.rotation, b.rotation);
    return joint;
}

JointDef weldAt(const Scene& scene, std::uint32_t bodyA, std::uint32_t bodyB, Vec2 point) {
    JointDef joint = hingeAt(scene, bodyA, bodyB, point);
    joint.kind = JointKind::Weld;
    return joint;
}

JointDef slideAt(const Scene& scene, std::uint32_t bodyA, std::uint32_t bodyB, Vec2 point,
                 Vec2 along) {
    JointDef joint = hingeAt(scene, bodyA, bodyB, point);
    joint.kind = JointKind::Prismatic;
    const Vec2 axis = normalized(unrotate(scene.bodies[bodyA].rotation, along));
    joint.axis = {axis.x, axis.y};
    return joint;
}

JointDef rodBetween(const Scene& scene, std::uint32_t bodyA, Vec2 localA, std::uint32_t bodyB,
                    Vec2 localB) {
    const BodyDef& a = scene.bodies[bodyA];
    const BodyDef& b = scene.bodies[bodyB];
    JointDef joint;
    joint.kind = JointKind::Distance;
    joint.bodyA = bodyA;
    joint.bodyB = bodyB;
    joint.anchorA = localA;
    joint.anchorB = localB;
    joint.length = length(transform(Pose{b.position, b.rotation}, localB) -
                          transform(Pose{a.position, a.rotation}, localA));
    return joint;
}

ShapeDef regularPolygon(int sides, float circumradius, float radius) {
    std::array<Vec2, maxPolygonVertices> corners{};
    const std::size_t used = static_cast<std::size_t>(sides);
    for (std::size_t i = 0; i < used; ++i) {
        const double angle = 2.0 * pi * static_cast<double>(i) / static_cast<double>(sides);
        const RotationT<double> q = rotationOf(angle);
        corners[i] = circumradius * Vec2{static_cast<float>(q.c), static_cast<float>(q.s)};
    }
    return ShapeDef::polygon(std::span(corners).first(used), radius);
}

void fitLimits(Scene& scene) {
    std::size_t shapes = 0;
    for (const BodyDef& body : scene.bodies) shapes += body.shapes.size();
    const auto atLeast = [](std::uint32_t& limit, std::size_t count) {
        limit = std::max(limit, static_cast<std::uint32_t>(count));
    };
    atLeast(scene.limits.bodies, scene.bodies.size());
    atLeast(scene.limits.shapes, shapes);
    atLeast(scene.limits.joints, scene.joints.size());
}

}  // namespace huestep::scenes
