/// Scenes and commands drawn from a seed.
#pragma once

#include <algorithm>
#include <array>

#include "core/math/trig.h"
#include "tests/core/support.h"

namespace huestep::test {

inline ShapeDef randomShape(Random& random) {
    const float radius = random.once(2) ? 0.0f : random.betweenF(0.01, 0.2);
    ShapeDef shape = ShapeDef::box(random.betweenF(0.1, 0.8), random.betweenF(0.1, 0.8), {},
                                   rotationOf(random.betweenF(-3.0, 3.0)), radius);
    switch (random.below(4)) {
        case 0:
            shape = ShapeDef::circle(random.point(-0.2, 0.2), random.betweenF(0.1, 0.6));
            break;
        case 1:
            shape = ShapeDef::capsule({-random.betweenF(0.1, 0.5), 0.0f}, random.point(0.1, 0.4),
                                      random.betweenF(0.05, 0.3));
            break;
        case 2:
            shape = ShapeDef::polygon(
                std::vector<Vec2>{{-0.3f, -0.2f}, {0.4f, -0.3f}, {0.2f, random.betweenF(0.2, 0.9)}},
                radius);
            break;
        default:
            break;
    }
    shape.density = random.betweenF(0.2, 5.0);
    shape.material = {random.betweenF(0.0, 1.2), random.once(3) ? random.betweenF(0.0, 1.0) : 0.0f,
                      random.once(3) ? 0.05f : 0.0f, random.once(5) ? 1.5f : 0.0f};
    if (random.once(6)) shape.filter.group = random.once(2) ? -1 : 1;
    if (random.once(6)) shape.filter.mask = 0xfffffffeu;
    return shape;
}

inline BodyDef randomBody(Random& random) {
    BodyDef body;
    body.type = BodyType::Dynamic;
    body.position = {random.betweenF(-6.0, 6.0), random.betweenF(0.3, 9.0)};
    body.rotation = rotationOf(random.betweenF(-3.0, 3.0));
    body.shapes = {randomShape(random)};
    if (random.once(4)) body.shapes.push_back(randomShape(random));
    if (random.once(3)) {
        body.velocity = random.point(-5.0, 5.0);
        body.angularVelocity = random.betweenF(-8.0, 8.0);
    }
    body.fixedRotation = random.once(8);
    body.maySleep = !random.once(8);
    body.linearDamping = random.once(5) ? 0.3f : 0.0f;
    body.angularDamping = random.once(5) ? 0.5f : 0.0f;
    body.gravityScale = random.once(8) ? random.betweenF(-0.5, 2.0) : 1.0f;
    if (random.once(10)) body.type = BodyType::Kinematic;
    if (random.once(12)) {
        body.type = BodyType::Static;
        body.velocity = {};
        body.angularVelocity = 0.0f;
    }
    return body;
}

inline JointDef randomJoint(Random& random, const std::vector<BodyDef>& bodies) {
    JointDef joint;
    constexpr std::array kinds{JointKind::Revolute, JointKind::Revolute, JointKind::Distance,
                               JointKind::Weld, JointKind::Prismatic};
    joint.kind = kinds[random.below(kinds.size())];
    joint.bodyA = random.below(bodies.size());
    joint.bodyB = (joint.bodyA + 1 + random.below(bodies.size() - 1)) %
                  static_cast<std::uint32_t>(bodies.size());
    joint.anchorA = random.point(-0.5, 0.5);
    joint.anchorB = random.point(-0.5, 0.5);
    joint.length = random.betweenF(0.5, 2.0);
    joint.collideConnected = random.once(2);
    if (random.once(3)) joint.spring = {true, random.betweenF(0.5, 6.0), random.betweenF(0.0, 1.0)};
    joint.reference = rotationOf(random.betweenF(-3.0, 3.0));
    joint.axis = rotationOf(random.betweenF(-3.0, 3.0));
    if (joint.kind == JointKind::Weld) return joint;
    if (random.once(3)) joint.limit = {true, -0.5f, 1.0f};
    if (joint.kind == JointKind::Distance) joint.limit.lower = 0.2f;
    if (joint.limit.enabled && joint.kind == JointKind::Distance) joint.limit.upper = 3.0f;
    if (random.once(3)) joint.motor = {true, random.betweenF(-4.0, 4.0), 200.0f};
    return joint;
}

inline Scene randomScene(Random& random) {
    Scene scene;
    BodyDef room;
    room.shapes = {ShapeDef::box(10.0f, 1.0f, {0.0f, -1.0f}),
                   ShapeDef::segment({-8.0f, 0.0f}, {-8.0f, 12.0f}),
                   ShapeDef::capsule({8.0f, 0.0f}, {8.0f, 12.0f}, 0.2f)};
    std::vector<Vec2> wave;
    for (int i = 0; i < 12; ++i) {
        wave.push_back({6.0f - 0.8f * static_cast<float>(i), random.betweenF(1.0, 2.0)});
    }
    for (const ShapeDef& segment : ShapeDef::chain(wave, random.once(2))) {
        room.shapes.push_back(segment);
    }
    scene.bodies.push_back(room);
    const std::uint32_t bodies = 20 + random.below(60);
    for (std::uint32_t i = 0; i < bodies; ++i) scene.bodies.push_back(randomBody(random));
    const std::uint32_t joints = random.below(20);
    for (std::uint32_t i = 0; i < joints; ++i) {
        scene.joints.push_back(randomJoint(random, scene.bodies));
    }
    scene.gravity = {random.betweenF(-2.0, 2.0), random.betweenF(-12.0, -2.0)};
    scene.substeps = 1 + random.below(6);
    scene.sleep = !random.once(4);
    PlayerDef players;
    if (!random.once(3)) players.body = discAt({}, 0.4f);
    players.spawnPoints = {{-3.0f, 10.0f}, {3.0f, 10.0f}};
    players.maxSpawned = 6;
    scene.players = players;
    return scene;
}

/// Any action, most of them sensible, aimed at any id.
inline Action randomAction(Random& random, const World& world) {
    const BodyId body = 1 + random.below(world.info().nextBody + 1);
    const JointId joint = 1 + random.below(world.info().nextJoint + 1);
    const auto at = world.find(body);
    const Vec2 point = at ? world.motions()[*at].position : random.point(-5.0, 5.0);
    switch (random.below(13)) {
        case 0:
            return AddPlayer{1 + random.below(5)};
        case 1:
            return RemovePlayer{1 + random.below(5)};
        case 2:
            return ApplyImpulse{body, random.point(-60.0, 60.0), point};
        case 3:
            return ApplyForce{body, random.point(-600.0, 600.0), point};
        case 4:
            return Grab{body, point, random.point(-5.0, 8.0)};
        case 5:
            return MoveGrab{random.point(-5.0, 8.0)};
        case 6:
            return Release{};
        case 7: {
            Spawn spawn;
            for (std::uint32_t i = 0; i < 1 + random.below(3); ++i) {
                spawn.bodies.push_back(randomBody(random));
            }
            if (spawn.bodies.size() > 1 && random.once(2)) {
                spawn.joints.push_back(randomJoint(random, spawn.bodies));
            }
            return spawn;
        }
        case 8:
            return RemoveBody{body};
        case 9:
            return RemoveJoint{joint};
        case 10:
            return SetMotor{joint, random.once(2), random.betweenF(-5.0, 5.0)};
        case 11:
            return SetVelocity{body, random.point(-2.0, 2.0), random.betweenF(-2.0, 2.0)};
        default:
            return SetTarget{body, random.point(-5.0, 8.0), rotationOf(random.betweenF(-3.0, 3.0))};
    }
}

/// Commands of the next tick; quiet stretches let things fall asleep.
inline std::vector<Command> randomCommands(Random& random, const World& world,
                                           std::uint64_t& sequence) {
    std::vector<Command> commands;
    if (world.tick() % 100 > 60) return commands;
    const std::uint32_t count = random.below(4);
    for (std::uint32_t i = 0; i < count; ++i) {
        const PlayerId author = random.once(2) ? 0 : random.below(5);
        commands.push_back({author, ++sequence, randomAction(random, world)});
    }
    return commands;
}

}  // namespace huestep::test
