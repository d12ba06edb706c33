// Scenes of the stability suite whose bodies rest on each other or should: stacks with masses and
// sizes that differ much, overlaps, a hub (physics page, rows 2, 4 to 10, 21 and 24).
#include <algorithm>
#include <array>

#include "core/math/trig.h"
#include "core/scene/scenes.h"

namespace huestep::scenes {

namespace {

BodyDef boxOf(float half, Vec2 position, float density = 1.0f) {
    BodyDef body = bodyOf(BodyType::Dynamic, position, ShapeDef::box(half, half));
    body.shapes[0].density = density;
    return body;
}

}  // namespace

Scene droppedStack(Values values) {
    const std::uint32_t boxes = count(values[0]);
    const float pitch = 1.0f + static_cast<float>(values[1]);
    const float friction = 0.3f;
    Scene scene = awake();
    addFloor(scene, 20.0f, friction);
    for (std::uint32_t i = 0; i < boxes; ++i) {
        const float gap = pitch - 1.0f;
        const Vec2 position{i % 2 == 0 ? 0.01f : -0.01f,
                            pitch * static_cast<float>(i) + 0.5f + gap};
        BodyDef box = boxOf(0.5f, position);
        box.shapes[0].material.friction = friction;
        add(scene, box);
    }
    return scene;
}

Scene heavyTop(Values values) {
    const std::uint32_t boxes = count(values[1]);
    Scene scene = awake();
    addFloor(scene, 20.0f);
    for (std::uint32_t i = 0; i <= boxes; ++i) {
        const float density = i == boxes ? static_cast<float>(values[0]) : 1.0f;
        add(scene, boxOf(0.5f, {0.0f, static_cast<float>(i) + 0.5f}, density));
    }
    return scene;
}

Scene tower(Values values) {
    const std::uint32_t boxes = count(values[0]);
    Scene scene = awake();
    addFloor(scene, 100.0f);
    float bottom = 0.0f;
    float side = 1.0f;
    for (std::uint32_t i = 0; i < boxes; ++i, side *= 2.0f) {
        add(scene, boxOf(0.5f * side, {0.0f, bottom + 0.5f * side}));
        bottom += side;
    }
    return scene;
}

Scene bigBox(Values values) {
    Scene scene = awake();
    if (values[0] != 0.0) {
        add(scene, bodyOf(BodyType::Static, {0.0f, -2.0f}, ShapeDef::box(40.0f, 2.0f)));
    } else {
        add(scene, bodyOf(BodyType::Static, {}, ShapeDef::segment({-40.0f, 0.0f}, {40.0f, 0.0f})));
    }
    for (const float x : {-9.0f, 9.0f}) add(scene, boxOf(0.5f, {x, 0.5f}));
    add(scene, boxOf(10.0f, {0.0f, 16.0f + 10.0f}));
    return scene;
}

Scene heavyPyramids(Values values) {
    const std::uint32_t base = count(values[0]);
    const float friction = 0.5f;
    Scene scene = awake();
    const float pitch = 2.0f * static_cast<float>(base + 1);  // from pyramid to pyramid
    addFloor(scene, 2.0f * pitch, friction);
    for (int pyramid = 0; pyramid < 3; ++pyramid) {
        const float middle = pitch * static_cast<float>(pyramid - 1);
        for (std::uint32_t row = 0; row < base; ++row) {
            const bool top = row + 1 == base;
            const float y = 2.0f * static_cast<float>(row) + (top ? 3.0f : 1.0f);
            for (std::uint32_t column = row; column < base; ++column) {
                const float x = 2.0f * static_cast<float>(column) - static_cast<float>(row) -
                                static_cast<float>(base - 1);
                const float density = top ? 100.0f * static_cast<float>(pyramid + 1) : 1.0f;
                BodyDef box = boxOf(1.0f, {middle + x, y}, density);
                box.shapes[0].material.friction = friction;
                add(scene, box);
            }
        }
    }
    return scene;
}

/// Three discs one upon the other fall over by themselves: two walls without friction, 2 mm to
/// either side, keep them upright and carry none of their weight.
Scene release(Values) {
    Scene scene = awake();
    addFloor(scene, 20.0f);
    BodyDef slot;
    for (const float side : {-1.0f, 1.0f}) {
        slot.shapes.push_back(ShapeDef::box(0.5f, 2.0f, {side * (0.5f + 0.5f + 0.002f), 2.0f}));
        slot.shapes.back().material.friction = 0.0f;
    }
    add(scene, slot);
    for (const float density : {1.0f, 1.0f, 100.0f}) {
        const float y = static_cast<float>(scene.bodies.size()) - 1.5f;
        BodyDef disc = bodyOf(BodyType::Dynamic, {0.0f, y}, ShapeDef::circle({}, 0.5f));
        disc.shapes[0].density = density;
        add(scene, disc);
    }
    return scene;
}

void releaseHost(Values values, std::uint64_t tick, std::vector<Action>& actions) {
    const BodyId heavy = 5;  // after floor, slot and the two light discs
    if (tick == count(values[0])) actions.emplace_back(RemoveBody{heavy});
}

/// A pyramid of unit boxes, drawn together about the middle of its lowest row; its last boxes are
/// left out where the number is not one of a pyramid.
Scene overlap(Values values) {
    const std::uint32_t boxes = count(values[0]);
    const float pitch = 1.0f - static_cast<float>(0.01 * values[1]);
    Scene scene = awake();
    scene.need.penetration = 0.004f;  // of the 5 mm that its row of the suite allows
    addFloor(scene, 100.0f);
    std::uint32_t base = 1;
    while (base * (base + 1) / 2 < boxes) ++base;
    std::uint32_t left = boxes;
    for (std::uint32_t row = 0; row < base; ++row) {
        for (std::uint32_t column = row; column < base && left > 0; ++column, --left) {
            const float x = static_cast<float>(column) - 0.5f * static_cast<float>(row) -
                            0.5f * static_cast<float>(base - 1);
            add(scene, boxOf(0.5f, {pitch * x, 0.5f + pitch * static_cast<float>(row)}));
        }
    }
    return scene;
}

Scene confined(Values values) {
    const std::uint32_t side = count(values[0]);
    Scene scene = awake();
    scene.gravity = {};
    BodyDef room;
    for (const float end : {-1.0f, 1.0f}) {
        room.shapes.push_back(ShapeDef::box(1.0f, 12.0f, {11.0f * end, 0.0f}));
        room.shapes.push_back(ShapeDef::box(12.0f, 1.0f, {0.0f, 11.0f * end}));
    }
    add(scene, room);
    const float pitch = 0.72f;
    const float first = -0.5f * pitch * static_cast<float>(side - 1);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const Vec2 position{first + pitch * static_cast<float>(i % side),
                            first + pitch * static_cast<float>(i / side)};
        add(scene, bodyOf(BodyType::Dynamic, position, ShapeDef::circle({}, 0.5f)));
    }
    return scene;
}

namespace {

constexpr float hubRadius = 10.0f;
constexpr float rimRadius = 0.03f;
constexpr double hubMass = 50.0;  // kg
constexpr double rimMass = 0.05;  // kg
constexpr BodyId hubBody = 1;

float densityFor(double mass, float radius) {
    const auto r = static_cast<double>(radius);
    return static_cast<float>(mass / (pi * r * r));
}

/// The direction from the hub's centre to disc `i` of `discs`.
Vec2 spoke(std::uint32_t i, std::uint32_t discs) {
    const RotationT<double> q = rotationOf(2.0 * pi * i / discs);
    return {static_cast<float>(q.c), static_cast<float>(q.s)};
}

}  // namespace

/// Nobody turns. What presses a disc keeps its direction and the point where it acts, so it would
/// spin the disc once that moved, and the hub, once it turned a little, further and further.
Scene hub(Values values) {
    const std::uint32_t discs = count(values[0]);
    Scene scene = awake();
    scene.gravity = {};
    const BodyType type = values[1] != 0.0 ? BodyType::Kinematic : BodyType::Dynamic;
    BodyDef middle = bodyOf(type, {}, ShapeDef::circle({}, hubRadius));
    middle.shapes[0].density = densityFor(hubMass, hubRadius);
    middle.fixedRotation = true;
    add(scene, middle);
    for (std::uint32_t i = 0; i < discs; ++i) {
        const Vec2 position = (hubRadius + rimRadius) * spoke(i, discs);
        BodyDef disc = bodyOf(BodyType::Dynamic, position, ShapeDef::circle({}, rimRadius));
        disc.shapes[0].density = densityFor(rimMass, rimRadius);
        disc.fixedRotation = true;
        add(scene, disc);
    }
    fitLimits(scene);
    return scene;
}

/// Every disc is pressed on the hub by ten times its weight on Earth, and each third of them in
/// turn, for a sixth of a second, by thirty times, so that the hub is pushed about.
void hubHost(Values values, std::uint64_t tick, std::vector<Action>& actions) {
    const std::uint32_t discs = count(values[0]);
    const auto pressed = static_cast<std::uint32_t>(tick / 10 % 3);
    for (std::uint32_t i = 0; i < discs; ++i) {
        const float force = 3 * i / discs == pressed ? 15.0f : 5.0f;  // N
        actions.emplace_back(ApplyForce{hubBody + 1 + i, -force * spoke(i, discs), {}});
    }
}

}  // namespace huestep::scenes
