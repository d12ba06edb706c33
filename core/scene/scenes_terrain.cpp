// Chains of one-sided segments: a room, an island and a conveyor, and all shapes loose among them.
#include "core/math/trig.h"
#include "core/scene/scenes.h"

namespace huestep::scenes {

namespace {

void addChain(Scene& scene, BodyDef body, std::span<const Vec2> points, bool loop) {
    for (const ShapeDef& segment : ShapeDef::chain(points, loop)) body.shapes.push_back(segment);
    add(scene, body);
}

/// Clockwise: what is inside stays inside. Its floor is wavy.
void addRoom(Scene& scene) {
    std::vector<Vec2> points{{-12.0f, 0.0f}, {-12.0f, 12.0f}, {12.0f, 12.0f}};
    for (std::uint32_t i = 0; i <= 48; ++i) {
        const float x = 12.0f - 0.5f * static_cast<float>(i);
        points.push_back({x, 0.5f * rotationOf(0.9f * x).s});
    }
    points.erase(points.begin());  // the wave ends where the wall starts
    addChain(scene, {}, points, true);
}

/// Counter-clockwise: solid, and turning.
void addIsland(Scene& scene) {
    BodyDef island;
    island.type = BodyType::Kinematic;
    island.position = {-3.0f, 4.0f};
    island.angularVelocity = 0.4f;
    std::vector<Vec2> points;
    for (std::uint32_t i = 0; i < 40; ++i) {
        const Rotation q = rotationOf(6.2831855f * static_cast<float>(i) / 40.0f);
        const float far = i % 8 < 4 ? 2.0f : 1.7f;
        points.push_back(far * Vec2{q.c, q.s});
    }
    addChain(scene, island, points, true);
}

/// A ledge with open ends, whose surface runs to the left.
void addConveyor(Scene& scene) {
    std::vector<Vec2> points;
    for (std::uint32_t i = 0; i < 12; ++i) {
        points.push_back({9.0f - 0.6f * static_cast<float>(i), 5.0f});
    }
    BodyDef belt;
    for (ShapeDef& segment : belt.shapes = ShapeDef::chain(points, false)) {
        segment.material.tangentSpeed = 1.0f;
        segment.material.restitution = 0.2f;
    }
    add(scene, belt);
}

void addLooseBodies(Scene& scene) {
    Sequence sequence(77);
    const std::array<ShapeDef, 5> kinds{ShapeDef::circle({}, 0.3f), ShapeDef::box(0.35f, 0.25f),
                                        ShapeDef::capsule({-0.3f, 0.0f}, {0.3f, 0.0f}, 0.15f),
                                        regularPolygon(6, 0.3f, 0.05f), regularPolygon(3, 0.4f)};
    for (std::uint32_t i = 0; i < 60; ++i) {
        const Vec2 position{-8.0f + static_cast<float>(i % 15) * 1.1f,
                            7.0f + static_cast<float>(i / 15) * 1.1f};
        BodyDef body = bodyOf(BodyType::Dynamic, position, kinds[i % kinds.size()]);
        body.rotation = rotationOf(sequence.between(-3.0f, 3.0f));
        body.velocity = {sequence.between(-3.0f, 3.0f), sequence.between(-1.0f, 1.0f)};
        body.shapes[0].material.friction = sequence.between(0.0f, 0.8f);
        add(scene, body);
    }
}

}  // namespace

Scene terrain(Values) {
    Scene scene;
    addRoom(scene);
    addIsland(scene);
    addConveyor(scene);
    addLooseBodies(scene);
    return scene;
}

}  // namespace huestep::scenes
