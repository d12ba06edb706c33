// The scene people play: a walled arena, 40 m x 24 m, with things to push, swing, climb and topple.
#include "core/math/trig.h"
#include "core/scene/scenes.h"

namespace huestep::scenes {

namespace {

const float arenaHalfWidth = 20.0f;
const float arenaHeight = 24.0f;

std::uint32_t addArena(Scene& scene) {
    BodyDef arena;
    const float middle = 0.5f * arenaHeight;
    arena.shapes = {ShapeDef::box(arenaHalfWidth + 1.0f, 0.5f, {0.0f, -0.5f}),
                    ShapeDef::box(arenaHalfWidth + 1.0f, 0.5f, {0.0f, arenaHeight + 0.5f}),
                    ShapeDef::box(0.5f, middle, {-arenaHalfWidth - 0.5f, middle}),
                    ShapeDef::box(0.5f, middle, {arenaHalfWidth + 0.5f, middle})};
    arena.shapes[2].material.restitution = 0.5f;
    arena.shapes[3].material.restitution = 0.5f;
    return add(scene, arena);
}

/// Two ledges, a ramp, a bouncy bumper, a conveyor belt that feeds the paddle, and a windmill.
void addPlatforms(Scene& scene) {
    add(scene, bodyOf(BodyType::Static, {-15.0f, 6.0f}, ShapeDef::box(4.0f, 0.2f, {}, {}, 0.1f)));
    add(scene, bodyOf(BodyType::Static, {15.0f, 9.0f}, ShapeDef::box(4.0f, 0.2f, {}, {}, 0.1f)));
    add(scene, bodyOf(BodyType::Static, {-7.0f, 12.0f},
                      ShapeDef::box(3.5f, 0.15f, {}, rotationOf(-0.3f), 0.1f)));
    BodyDef bumper = bodyOf(BodyType::Static, {0.0f, 8.5f}, ShapeDef::circle({}, 0.8f));
    bumper.shapes[0].material.restitution = 1.0f;
    add(scene, bumper);
    BodyDef belt = bodyOf(BodyType::Static, {15.5f, 0.0f},
                          ShapeDef::capsule({-2.5f, 0.1f}, {4.0f, 0.1f}, 0.15f));
    belt.shapes[0].material.tangentSpeed = 2.0f;
    belt.shapes[0].material.friction = 0.9f;
    add(scene, belt);
    BodyDef windmill;
    windmill.type = BodyType::Kinematic;
    windmill.position = {10.7f, 12.2f};
    windmill.rotation = rotationOf(0.785f);
    windmill.angularVelocity = 0.8f;  // its right side lifts: nothing is pressed on the ledge
    windmill.shapes = {ShapeDef::box(2.0f, 0.1f, {}, {}, 0.05f),
                       ShapeDef::box(0.1f, 2.0f, {}, {}, 0.05f)};
    add(scene, windmill);
}

void addSeeSaw(Scene& scene, std::uint32_t arena, Vec2 pivot) {
    const std::array<Vec2, 3> wedge{Vec2{-0.5f, 0.0f}, Vec2{0.5f, 0.0f},
                                    Vec2{0.0f, pivot.y - 0.2f}};
    add(scene, bodyOf(BodyType::Static, {pivot.x, 0.0f}, ShapeDef::polygon(wedge)));
    ShapeDef plank = ShapeDef::box(3.5f, 0.12f, {}, {}, 0.03f);
    plank.density = 2.0f;
    const std::uint32_t place = add(scene, bodyOf(BodyType::Dynamic, pivot, plank));
    JointDef hinge = hingeAt(scene, arena, place, pivot);
    hinge.limit = {true, -0.35f, 0.35f};
    hinge.collideConnected = true;
    scene.joints.push_back(hinge);
}

/// A cross that turns for ever and throws what it meets.
void addPaddle(Scene& scene, std::uint32_t arena, Vec2 center) {
    BodyDef paddle;
    paddle.type = BodyType::Dynamic;
    paddle.position = center;
    paddle.maySleep = false;
    paddle.shapes = {ShapeDef::box(2.2f, 0.12f, {}, {}, 0.05f),
                     ShapeDef::box(0.12f, 2.2f, {}, {}, 0.05f)};
    for (ShapeDef& blade : paddle.shapes) blade.density = 3.0f;
    JointDef axle = hingeAt(scene, arena, arena, center);
    axle.bodyB = add(scene, paddle);
    axle.anchorB = {};
    axle.motor = {true, 1.6f, 600.0f};
    scene.joints.push_back(axle);
}

/// A rope of distance joints with a weight at its end.
void addRope(Scene& scene, std::uint32_t arena, Vec2 hook) {
    const int knots = 10;
    std::uint32_t last = arena;
    Vec2 from = hook;
    for (int i = 1; i <= knots; ++i) {
        const Vec2 position =
            hook + Vec2{0.25f * static_cast<float>(i), -0.55f * static_cast<float>(i)};
        BodyDef knot =
            bodyOf(BodyType::Dynamic, position, ShapeDef::circle({}, i == knots ? 0.6f : 0.12f));
        knot.shapes[0].density = i == knots ? 1.0f : 4.0f;
        knot.angularDamping = 0.5f;
        const std::uint32_t place = add(scene, knot);
        scene.joints.push_back(rodBetween(scene, last, last == arena ? from : Vec2{}, place, {}));
        last = place;
        from = position;
    }
}

/// A swing: a seat on two springs.
void addSwing(Scene& scene, std::uint32_t arena, Vec2 seat) {
    ShapeDef board = ShapeDef::box(1.2f, 0.1f, {}, {}, 0.05f);
    const std::uint32_t place = add(scene, bodyOf(BodyType::Dynamic, seat, board));
    for (const float side : {-1.1f, 1.1f}) {
        JointDef rope = rodBetween(scene, arena, seat + Vec2{side, 5.0f}, place, {side, 0.0f});
        rope.spring = {true, 3.0f, 0.3f};
        rope.limit = {true, 3.5f, 6.0f};
        scene.joints.push_back(rope);
    }
}

/// Piles to knock over: a pyramid, a tower, and mixed heaps.
void addPiles(Scene& scene) {
    const ShapeDef brick = ShapeDef::box(0.4f, 0.25f);
    for (int row = 0; row < 7; ++row) {
        for (int column = row; column < 7; ++column) {
            const float x = 3.0f + 0.41f * static_cast<float>(2 * column - row);
            add(scene,
                bodyOf(BodyType::Dynamic, {x, 0.25f + 0.5f * static_cast<float>(row)}, brick));
        }
    }
    for (int i = 0; i < 8; ++i) {
        const Vec2 position{-16.5f, 6.65f + 0.7f * static_cast<float>(i)};
        add(scene, bodyOf(BodyType::Dynamic, position, ShapeDef::box(0.35f, 0.35f)));
    }
    Sequence sequence(7);
    const std::array<ShapeDef, 6> kinds{
        ShapeDef::circle({}, 0.3f),      ShapeDef::capsule({-0.3f, 0.0f}, {0.3f, 0.0f}, 0.2f),
        regularPolygon(6, 0.35f, 0.03f), ShapeDef::box(0.3f, 0.3f, {}, {}, 0.05f),
        regularPolygon(3, 0.45f, 0.03f), ShapeDef::capsule({0.0f, -0.2f}, {0.0f, 0.2f}, 0.25f)};
    for (std::uint32_t i = 0; i < 84; ++i) {
        const std::uint32_t heap = i % 3;
        const std::uint32_t level = i / 3;
        const Vec2 base = heap == 0   ? Vec2{-18.0f, 0.7f}
                          : heap == 1 ? Vec2{12.9f, 10.0f}
                                      : Vec2{-3.5f, 14.0f};
        const Vec2 position =
            base + Vec2{0.9f * static_cast<float>(level % 6) + sequence.between(-0.05f, 0.05f),
                        0.95f * static_cast<float>(level / 6)};
        BodyDef body = bodyOf(BodyType::Dynamic, position, kinds[(heap + level) % kinds.size()]);
        body.shapes[0].material.restitution = level % 4 == 0 ? 0.5f : 0.1f;
        body.shapes[0].material.rollingResistance = 0.01f;
        body.rotation = rotationOf(sequence.between(-0.5f, 0.5f));
        add(scene, body);
    }
}

/// A player: a bouncy disc of about 1.6 kg that never sleeps. An impulse of 20 N·s is a strong
/// jump; 400 N lift most things in the arena.
PlayerDef playersOf() {
    PlayerDef players;
    BodyDef body = bodyOf(BodyType::Dynamic, {}, ShapeDef::circle({}, 0.5f));
    ShapeDef& disc = body.shapes[0];
    disc.density = 2.0f;
    disc.material.friction = 0.8f;
    disc.material.restitution = 0.6f;
    disc.filter.category = 2u;
    body.maySleep = false;
    body.linearDamping = 0.1f;
    body.angularDamping = 0.3f;
    players.body = body;
    for (int i = 0; i < 8; ++i) {
        const float x = -14.0f + 4.0f * static_cast<float>(i);
        players.spawnPoints.push_back({x, i % 2 == 0 ? 20.0f : 21.5f});
    }
    players.maxSpawned = 16;
    players.maxImpulse = 20.0f;
    players.maxForce = 400.0f;
    return players;
}

}  // namespace

Scene sandbox(Values) {
    Scene scene;
    const std::uint32_t arena = addArena(scene);
    addPlatforms(scene);
    addSeeSaw(scene, arena, {-8.5f, 1.0f});
    addPaddle(scene, arena, {10.9f, 2.75f});
    addRope(scene, arena, {4.0f, 18.0f});
    addSwing(scene, arena, {-12.5f, 16.0f});
    addPiles(scene);
    scene.players = playersOf();
    scene.limits.bodies = 4'000;
    scene.limits.shapes = 8'000;
    scene.limits.joints = 4'000;
    scene.limits.players = 64;
    return scene;
}

}  // namespace huestep::scenes
