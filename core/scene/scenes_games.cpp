// Scenes that name the rules of a game: what the rules need of them stands in core/games.
#include "core/scene/scenes.h"

namespace huestep::scenes {

namespace {

/// A pitch seen from above, as one body: walls all around, and behind each goal's line a box that
/// holds what has gone in.
BodyDef pitchOf(float halfLength, float halfWidth, float halfGoal) {
    const float wall = 0.5f;  // m, half of its thickness
    const float deep = 2.0f;  // m, of a goal
    const float corner = 0.5f * (halfWidth - halfGoal);
    const float beside = halfGoal + corner;
    BodyDef pitch;
    for (const float side : {-1.0f, 1.0f}) {
        const float line = side * (halfLength + wall);
        const float back = side * (halfLength + deep + wall);
        const float net = side * (halfLength + 0.5f * deep + wall);
        pitch.shapes.push_back(
            ShapeDef::box(halfLength + 2.0f * wall, wall, {0.0f, side * (halfWidth + wall)}));
        pitch.shapes.push_back(ShapeDef::box(wall, corner, {line, beside}));
        pitch.shapes.push_back(ShapeDef::box(wall, corner, {line, -beside}));
        pitch.shapes.push_back(ShapeDef::box(wall, halfGoal + 2.0f * wall, {back, 0.0f}));
        pitch.shapes.push_back(ShapeDef::box(0.5f * deep, wall, {net, halfGoal + wall}));
        pitch.shapes.push_back(ShapeDef::box(0.5f * deep, wall, {net, -halfGoal - wall}));
    }
    for (ShapeDef& shape : pitch.shapes) {
        shape.material.restitution = 0.6f;
        shape.material.friction = 0.2f;
    }
    return pitch;
}

}  // namespace

Scene ball(Values values) {
    const auto length = static_cast<float>(values[0]);
    const auto width = static_cast<float>(values[1]);
    const float goal = 0.3f * width;
    Scene scene;
    scene.gravity = {};
    scene.sleep = false;
    add(scene, pitchOf(0.5f * length, 0.5f * width, 0.5f * goal));
    PlayerDef players;
    BodyDef body = bodyOf(BodyType::Dynamic, {}, ShapeDef::circle({}, 0.6f));
    body.fixedRotation = true;
    body.maySleep = false;
    body.linearDamping = 2.0f;
    body.shapes[0].density = 3.0f;
    body.shapes[0].material.friction = 0.1f;
    body.shapes[0].material.restitution = 0.3f;
    players.body = body;
    players.spawnPoints = {{0.0f, 0.25f * width}, {0.0f, -0.25f * width}};
    players.maxSpawned = 0;
    players.maxImpulse = 4.0f;
    players.maxForce = 0.0f;
    scene.players = players;
    scene.limits.bodies = 256;
    scene.limits.shapes = 1024;
    scene.limits.joints = 16;
    scene.limits.players = 64;
    scene.rules = {.name = "ball",
                   .version = 1,
                   .seed = static_cast<std::uint32_t>(values[4]),
                   .parameters = {{"goal", goal},
                                  {"goals", static_cast<float>(values[2])},
                                  {"length", length},
                                  {"seconds", static_cast<float>(values[3])}}};
    return scene;
}

Scene building(Values values) {
    Scene scene = sandbox({});
    scene.rules = {.name = "building",
                   .version = 1,
                   .seed = static_cast<std::uint32_t>(values[2]),
                   .parameters = {{"budget", static_cast<float>(values[0])},
                                  {"pause", static_cast<float>(values[1])}}};
    scene.players->maxSpawned = 64;
    return scene;
}

}  // namespace huestep::scenes
