// A small world that touches every feature once: all shapes and materials, filters, damping, all
// joints with every part, kinematic bodies, sleepers, given ids and players. Used for golden hashes
// and for the fingerprint that two builds compare before they play together.
#include "core/math/trig.h"
#include "core/scene/scenes.h"

namespace huestep::scenes {

namespace {

const Rotation quarter{0.0f, 1.0f};

/// A valley of segments between two walls, a conveyor belt, a ramp and a rough step.
void addTerrain(Scene& scene) {
    BodyDef terrain;
    const std::array<Vec2, 6> line{Vec2{-20.0f, 2.0f}, Vec2{-14.0f, 0.0f}, Vec2{-4.0f, 0.0f},
                                   Vec2{4.0f, 0.0f},   Vec2{14.0f, 0.0f},  Vec2{20.0f, 2.5f}};
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        terrain.shapes.push_back(ShapeDef::segment(line[i], line[i + 1]));
    }
    terrain.shapes[2].material.tangentSpeed = 1.5f;
    terrain.shapes[2].material.friction = 0.9f;
    terrain.shapes.push_back(ShapeDef::box(0.5f, 10.0f, {-20.5f, 10.0f}));
    terrain.shapes.push_back(ShapeDef::box(0.5f, 10.0f, {20.5f, 10.0f}));
    terrain.shapes.push_back(ShapeDef::box(3.0f, 0.2f, {11.0f, 4.0f}, rotationOf(0.35f), 0.05f));
    terrain.shapes.push_back(ShapeDef::capsule({-13.0f, 5.0f}, {-9.0f, 4.5f}, 0.2f));
    terrain.shapes.back().material.restitution = 0.8f;
    add(scene, terrain);
}

/// A block of loose bodies of all shapes, each with a material and damping of its own.
void addLooseBodies(Scene& scene) {
    Sequence sequence(2024);
    const std::array<ShapeDef, 6> kinds{ShapeDef::circle({0.05f, 0.0f}, 0.3f),
                                        ShapeDef::capsule({-0.25f, 0.0f}, {0.25f, 0.0f}, 0.2f),
                                        ShapeDef::box(0.35f, 0.25f),
                                        regularPolygon(6, 0.3f, 0.05f),
                                        regularPolygon(3, 0.4f),
                                        regularPolygon(8, 0.35f, 0.02f)};
    for (std::uint32_t i = 0; i < 60; ++i) {
        const Vec2 position{
            -7.0f + static_cast<float>(i % 10) * 0.9f + sequence.between(-0.1f, 0.1f),
            1.0f + static_cast<float>(i / 10) * 1.0f};
        BodyDef body = bodyOf(BodyType::Dynamic, position, kinds[i % kinds.size()]);
        body.rotation = rotationOf(sequence.between(-3.0f, 3.0f));
        body.velocity = {sequence.between(-2.0f, 2.0f), sequence.between(-1.0f, 1.0f)};
        body.angularVelocity = sequence.between(-4.0f, 4.0f);
        ShapeDef& shape = body.shapes[0];
        shape.density = sequence.between(0.5f, 3.0f);
        shape.material.friction = sequence.between(0.1f, 0.9f);
        shape.material.restitution = i % 4 == 0 ? 0.6f : 0.0f;
        shape.material.rollingResistance = i % 3 == 0 ? 0.05f : 0.0f;
        if (i % 7 == 0) body.linearDamping = 0.2f;
        if (i % 5 == 0) body.angularDamping = 0.5f;
        if (i % 13 == 0) body.fixedRotation = true;
        if (i % 11 == 0) body.gravityScale = 0.5f;
        if (i % 17 == 0) body.maySleep = false;
        add(scene, body);
    }
}

/// Dumbbells, an L and a T: several shapes of different densities on one body.
void addCompounds(Scene& scene) {
    for (std::uint32_t i = 0; i < 9; ++i) {
        BodyDef body;
        body.type = BodyType::Dynamic;
        body.position = {-13.0f + static_cast<float>(i % 3) * 1.6f,
                         7.0f + static_cast<float>(i / 3) * 1.5f};
        if (i % 3 == 0) {
            body.shapes = {ShapeDef::circle({-0.4f, 0.0f}, 0.25f), ShapeDef::box(0.4f, 0.06f),
                           ShapeDef::circle({0.4f, 0.0f}, 0.2f)};
            body.shapes[2].density = 4.0f;
        } else if (i % 3 == 1) {
            body.shapes = {ShapeDef::box(0.5f, 0.12f), ShapeDef::box(0.12f, 0.4f, {-0.38f, 0.5f})};
        } else {
            body.shapes = {ShapeDef::box(0.12f, 0.4f),
                           ShapeDef::box(0.45f, 0.12f, {0.0f, 0.5f}, {}, 0.03f)};
        }
        add(scene, body);
    }
}

/// A sleeping pile on a shelf and a ball that wakes it; bodies that pass through each other.
void addSleepersAndGhosts(Scene& scene) {
    add(scene, bodyOf(BodyType::Static, {14.0f, 8.0f}, ShapeDef::box(3.0f, 0.25f)));
    for (std::uint32_t i = 0; i < 9; ++i) {
        const Vec2 position{13.0f + static_cast<float>(i % 3), 8.75f + static_cast<float>(i / 3)};
        BodyDef box = bodyOf(BodyType::Dynamic, position, ShapeDef::box(0.5f, 0.5f));
        box.asleep = true;
        add(scene, box);
    }
    BodyDef ball = bodyOf(BodyType::Dynamic, {8.0f, 14.0f}, ShapeDef::circle({}, 0.4f));
    ball.velocity = {6.0f, 2.0f};
    ball.shapes[0].density = 5.0f;
    add(scene, ball);
    for (std::uint32_t i = 0; i < 8; ++i) {
        const Vec2 position{-17.0f + static_cast<float>(i) * 0.2f, i % 2 == 0 ? 6.0f : 7.0f};
        BodyDef ghost = bodyOf(BodyType::Dynamic, position, ShapeDef::circle({}, 0.3f));
        // Even ones share a group that never touches; odd ones only touch category 1.
        ghost.shapes[0].filter = i % 2 == 0 ? Filter{1, ~0u, -7} : Filter{4, 1, 0};
        add(scene, ghost);
    }
}

/// A turning cross, a slow lift, and a slider that passes below everything.
void addKinematics(Scene& scene) {
    BodyDef cross;
    cross.type = BodyType::Kinematic;
    cross.position = {6.0f, 3.0f};
    cross.angularVelocity = 1.2f;
    cross.shapes = {ShapeDef::box(1.6f, 0.12f), ShapeDef::box(0.12f, 1.6f)};
    add(scene, cross);
    BodyDef lift = bodyOf(BodyType::Kinematic, {-11.0f, 0.3f}, ShapeDef::box(1.2f, 0.15f));
    lift.velocity = {0.0f, 0.25f};
    add(scene, lift);
    BodyDef slider = bodyOf(BodyType::Kinematic, {10.0f, 0.25f}, ShapeDef::box(0.5f, 0.2f));
    slider.velocity = {-0.4f, 0.0f};
    add(scene, slider);
}

/// Revolutes: a ragdoll-like chain with limits, a wheel with a motor, a flap with a spring.
void addRevolutes(Scene& scene) {
    const ShapeDef bone = ShapeDef::capsule({0.0f, -0.2f}, {0.0f, 0.2f}, 0.1f);
    std::uint32_t last = add(scene, bodyOf(BodyType::Static, {0.0f, 12.0f}, bone));
    for (std::uint32_t i = 0; i < 8; ++i) {
        const Vec2 position{0.0f, 11.5f - 0.5f * static_cast<float>(i)};
        BodyDef body = bodyOf(BodyType::Dynamic, position, bone);
        if (i == 7) body.velocity = {8.0f, 0.0f};
        const std::uint32_t place = add(scene, body);
        JointDef joint = hingeAt(scene, last, place, {0.0f, position.y + 0.25f});
        joint.limit = {i % 2 == 0, -0.5f, 0.9f};
        joint.spring = {i % 3 == 0, 3.0f, 0.7f};
        joint.motor = {i % 4 == 1, 0.0f, 0.05f};
        scene.joints.push_back(joint);
        last = place;
    }
    const std::uint32_t chassis =
        add(scene, bodyOf(BodyType::Dynamic, {-2.0f, 9.0f}, ShapeDef::box(0.9f, 0.15f)));
    for (const float side : {-0.7f, 0.7f}) {
        BodyDef wheel = bodyOf(BodyType::Dynamic, {-2.0f + side, 8.7f}, ShapeDef::circle({}, 0.3f));
        wheel.shapes[0].material.friction = 1.2f;
        const std::uint32_t place = add(scene, wheel);
        JointDef axle = hingeAt(scene, chassis, place, {-2.0f + side, 8.7f});
        axle.motor = {true, side < 0.0f ? -6.0f : -3.0f, 5.0f};
        scene.joints.push_back(axle);
    }
    const std::uint32_t post =
        add(scene, bodyOf(BodyType::Static, {2.5f, 6.0f}, ShapeDef::circle({}, 0.1f)));
    const std::uint32_t flap =
        add(scene, bodyOf(BodyType::Dynamic, {3.3f, 6.0f}, ShapeDef::box(0.8f, 0.08f)));
    JointDef hinge = hingeAt(scene, post, flap, {2.5f, 6.0f});
    hinge.spring = {true, 1.5f, 0.3f};
    hinge.limit = {true, -1.2f, 1.2f};
    hinge.motor = {true, 1.0f, 2.0f};
    scene.joints.push_back(hinge);
}

/// Distances: a rigid rod, a spring, a rope with slack, a driven spring; and a body held by a hand.
void addDistancesAndHand(Scene& scene) {
    const std::uint32_t beam =
        add(scene, bodyOf(BodyType::Static, {-6.0f, 14.0f}, ShapeDef::box(3.0f, 0.1f)));
    for (std::uint32_t i = 0; i < 4; ++i) {
        const float x = -2.1f + 1.4f * static_cast<float>(i);
        BodyDef bob = bodyOf(BodyType::Dynamic, {-6.0f + x, 12.2f}, regularPolygon(5, 0.35f));
        bob.velocity = {i % 2 == 0 ? 3.0f : -3.0f, 0.0f};
        const std::uint32_t place = add(scene, bob);
        JointDef rod = rodBetween(scene, beam, {x, -0.1f}, place, {0.0f, 0.2f});
        if (i == 1) rod.spring = {true, 2.0f, 0.2f};
        if (i == 2) rod.limit = {true, 0.2f, 1.9f};
        if (i == 3) {
            rod.spring = {true, 1.0f, 0.1f};
            rod.limit = {true, 0.5f, 2.5f};
            rod.motor = {true, 0.5f, 3.0f};
        }
        rod.collideConnected = i == 0;
        scene.joints.push_back(rod);
    }
    const std::uint32_t held =
        add(scene, bodyOf(BodyType::Dynamic, {3.0f, 10.0f}, ShapeDef::box(0.4f, 0.2f)));
    JointDef hand;
    hand.kind = JointKind::Mouse;
    hand.bodyA = 0;
    hand.bodyB = held;
    hand.anchorB = {0.3f, 0.0f};
    hand.target = {4.0f, 11.0f};
    hand.maxForce = 50.0f;
    hand.spring = {true, 4.0f, 0.7f};
    scene.joints.push_back(hand);
}

void addPlayers(Scene& scene) {
    PlayerDef players;
    BodyDef body = bodyOf(BodyType::Dynamic, {}, ShapeDef::circle({}, 0.4f));
    body.shapes[0].material.restitution = 0.5f;
    body.shapes[0].filter.category = 2u;
    players.body = body;
    players.spawnPoints = {{-16.0f, 12.0f}, {-8.0f, 16.0f}, {8.0f, 16.0f}, {17.0f, 14.0f}};
    players.maxImpulse = 10.0f;
    players.maxForce = 200.0f;
    scene.players = players;
}

}  // namespace

Scene mixed(Values) {
    Scene scene;
    addTerrain(scene);
    addLooseBodies(scene);
    addCompounds(scene);
    addSleepersAndGhosts(scene);
    addKinematics(scene);
    addRevolutes(scene);
    addDistancesAndHand(scene);
    addPlayers(scene);
    // A given id, lower than those that the order of the scene gives to all others.
    BodyDef last = bodyOf(BodyType::Dynamic, {0.0f, 15.0f}, ShapeDef::box(0.3f, 0.3f));
    last.id = 7;
    last.rotation = quarter;
    add(scene, last);
    return scene;
}

}  // namespace huestep::scenes
