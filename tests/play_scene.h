/// The scene of tests that need a place to play in: a ground, five boxes and a seat for players.
#pragma once

#include "core/scene/scene.h"

namespace huestep::test {

inline Scene playScene() {
    Scene scene;
    BodyDef ground;
    ground.shapes.push_back(ShapeDef::box(20.0f, 0.5f));
    scene.bodies.push_back(ground);
    for (int i = 0; i < 5; ++i) {
        BodyDef box;
        box.type = BodyType::Dynamic;
        box.position = {static_cast<float>(i), 2.0f};
        box.shapes.push_back(ShapeDef::box(0.4f, 0.4f));
        scene.bodies.push_back(box);
    }
    PlayerDef players;
    BodyDef body;
    body.type = BodyType::Dynamic;
    body.shapes.push_back(ShapeDef::circle({}, 0.4f));
    players.body = body;
    players.spawnPoints = {{0.0f, 6.0f}};
    scene.players = players;
    return scene;
}

}  // namespace huestep::test
