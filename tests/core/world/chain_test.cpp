// Bodies on chains: smooth where the chain is, held where it turns.

#include <algorithm>
#include <cmath>

#include "core/math/trig.h"
#include "core/scene/measure.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

BodyDef chainBody(const std::vector<Vec2>& points, bool loop, float friction = 0.0f) {
    BodyDef body;
    body.shapes = ShapeDef::chain(points, loop);
    for (ShapeDef& shape : body.shapes) shape.material.friction = friction;
    return body;
}

/// 50 segments of 0.37 m with their front up, from x = 18.5 to 0.
BodyDef flatChain() {
    std::vector<Vec2> points;
    for (int i = 51; i >= -1; --i) points.push_back({0.37f * static_cast<float>(i), 0.0f});
    return chainBody(points, false);
}

BodyDef flatSegment() {
    BodyDef body;
    body.shapes = {ShapeDef::segment({0.0f, 0.0f}, {18.5f, 0.0f})};
    body.shapes[0].material.friction = 0.0f;
    return body;
}

double penetration(const World& world) {
    return measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions())
        .maxPenetration;
}

TEST(ChainWorld, ABoxAndADiscSlideAlongManySegmentsAsAlongOne) {
    const std::vector<ShapeDef> shapes{ShapeDef::box(0.5f, 0.5f), ShapeDef::box(0.2f, 0.15f),
                                       ShapeDef::circle({}, 0.5f),
                                       ShapeDef::capsule({-0.4f, 0.0f}, {0.4f, 0.0f}, 0.25f),
                                       ShapeDef::box(0.5f, 0.4f, {}, {}, 0.1f)};
    for (const ShapeDef& shape : shapes) {
        for (const float speed : {0.5f, 2.0f, 8.0f, 30.0f}) {
            const double height = shape.kind == ShapeKind::Circle ? 0.5
                                  : shape.kind == ShapeKind::Capsule
                                      ? 0.25
                                      : -wide(shape.vertices[0].y) + wide(shape.radius);
            BodyDef body = bodyAt(BodyType::Dynamic, {1.0f, static_cast<float>(height)}, shape);
            body.velocity = {speed, 0.0f};
            World many = worldOf(sceneOf({flatChain(), body}));
            World one = worldOf(sceneOf({flatSegment(), body}));
            for (int tick = 0; tick < 180; ++tick) {
                many.step({});
                one.step({});
                const BodyMotion m = motionOf(many, 2), o = motionOf(one, 2);
                if (m.position.x > 17.5f) break;
                ASSERT_NEAR(wide(m.velocity.x), wide(speed), 1e-4 * wide(speed)) << tick;
                ASSERT_NEAR(wide(m.velocity.y), wide(o.velocity.y), 2e-3) << tick << ", " << speed;
                ASSERT_NEAR(wide(m.position.y), wide(o.position.y), 2e-4) << tick << ", " << speed;
                ASSERT_NEAR(wide(m.angularVelocity), 0.0, 5e-3) << tick << ", " << speed;
            }
        }
    }
}

TEST(ChainWorld, ADiscSlidesInsideALoopAsAPendulumSwings) {
    // Clockwise: a round room of radius 3 of 360 segments.
    std::vector<Vec2> points;
    for (int i = 0; i < 360; ++i) {
        const RotationT<double> q = rotationOf(-2.0 * pi * i / 360.0);
        points.push_back({static_cast<float>(3.0 * q.c), static_cast<float>(3.0 * q.s)});
    }
    Scene scene = sceneOf({chainBody(points, true), discAt({2.5f, 0.0f})});
    scene.sleep = false;
    World world = worldOf(scene);
    double fastest = 0.0, highest = 0.0;
    for (int tick = 0; tick < 300; ++tick) {
        world.step({});
        const BodyMotion m = motionOf(world, 2);
        ASSERT_LT(wide(length(m.position)), 2.5 + 0.02) << tick << ": it stays inside";
        ASSERT_GT(wide(length(m.position)), 2.5 - 0.02) << tick << ": it follows the wall";
        fastest = std::max(fastest, wide(length(m.velocity)));
        if (m.position.x < 0.0f) highest = std::max(highest, 2.5 + wide(m.position.y));
    }
    // m g h = m v² / 2, but for the turn of 1° from face to face: what goes into the next face is
    // lost, sin² 1° of the kinetic energy, whose mean over the swing is 2 / π of the whole.
    const double lost = 90.0 * std::pow(std::sin(pi / 180.0), 2.0) * 2.0 / pi;
    EXPECT_NEAR(fastest / std::sqrt(2.0 * 10.0 * 2.5), std::sqrt(1.0 - lost), 5e-3);
    EXPECT_NEAR(highest / 2.5, 1.0 - 2.0 * lost, 0.02) << "and up the other side";
}

TEST(ChainWorld, WhatComesFromBehindIsNotTouched) {
    Scene scene = sceneOf({flatChain(), discAt({5.0f, -2.0f}), boxAt({9.0f, -2.0f})});
    for (std::size_t i : {1u, 2u}) scene.bodies[i].velocity = {0.0f, 12.0f};
    World world = worldOf(scene);
    World free = worldOf(sceneOf({scene.bodies[1], scene.bodies[2]}));
    double highest = 0.0;
    for (int tick = 0; tick < 60; ++tick) {
        world.step({});
        free.step({});
        highest = std::max(highest, wide(motionOf(world, 2).position.y));
        if (motionOf(free, 1).velocity.y < 0.0f) continue;
        ASSERT_TRUE(world.contacts().empty() || motionOf(world, 2).position.y > 0.0f) << tick;
    }
    EXPECT_GT(highest, 4.0) << "through the floor, upwards";
    run(world, 240);
    EXPECT_NEAR(wide(motionOf(world, 2).position.y), 0.5, 0.01) << "and on it coming back";
    EXPECT_NEAR(wide(motionOf(world, 3).position.y), 0.5, 0.01);
}

TEST(ChainWorld, ABoxComesToRestInAConcaveCorner) {
    // A room, clockwise; and a valley of 30° sides in its floor.
    const std::vector<Vec2> room{{0.0f, 0.0f},  {-4.0f, 0.0f}, {-5.0f, -0.57735f}, {-6.0f, 0.0f},
                                 {-9.0f, 0.0f}, {-9.0f, 6.0f}, {0.0f, 6.0f}};
    Scene scene =
        sceneOf({chainBody(room, true, 0.3f), boxAt({-1.5f, 0.5f}), discAt({-5.0f, 2.0f})});
    scene.bodies[1].velocity = {3.0f, 0.0f};
    scene.bodies[1].shapes[0].material.friction = 0.1f;
    World world = worldOf(scene);
    for (int tick = 0; tick < 600; ++tick) {
        world.step({});
        ASSERT_LT(penetration(world), 0.05) << tick;
    }
    const BodyMotion box = motionOf(world, 2);
    EXPECT_NEAR(wide(box.position.x), -0.5, 0.01) << "against the wall";
    EXPECT_NEAR(wide(box.position.y), 0.5, 0.01) << "on the floor";
    // A disc of radius ½ in a valley: its centre ½ / cos 30° above the deepest point.
    const BodyMotion disc = motionOf(world, 3);
    EXPECT_NEAR(wide(disc.position.x), -5.0, 0.01);
    EXPECT_NEAR(wide(disc.position.y), -0.57735 + 0.5 / std::cos(pi / 6.0), 0.01);
}

TEST(ChainWorld, ABoxRoundsAConvexCornerAndLandsBesideTheTable) {
    // A table, counter-clockwise, on a floor.
    const std::vector<Vec2> table{{-3.0f, 0.0f}, {3.0f, 0.0f}, {3.0f, 2.0f}, {-3.0f, 2.0f}};
    Scene scene = sceneOf({ground(), chainBody(table, true, 0.4f), boxAt({2.0f, 2.5f}, 0.5f)});
    scene.bodies[2].velocity = {4.2f, 0.0f};  // 2.9 m/s at the edge: enough to tip, not to fly
    World world = worldOf(scene);
    Scene solid = scene;
    solid.bodies[1].shapes = {ShapeDef::polygon(table)};
    solid.bodies[1].shapes[0].material.friction = 0.4f;
    World same = worldOf(solid);
    // Until it leaves the edge it moves as on a table that is solid.
    for (int tick = 0; tick < 36; ++tick) {
        world.step({});
        same.step({});
        ASSERT_LT(penetration(world), 0.005) << tick;
        const BodyMotion m = motionOf(world, 3), s = motionOf(same, 3);
        ASSERT_LT(length(m.position - s.position), 0.01f) << tick;
        ASSERT_NEAR(wide(m.rotation.s), wide(s.rotation.s), 0.03) << tick;
    }
    EXPECT_LT(motionOf(world, 3).rotation.s, -0.3f) << "it tipped over the edge";
    run(world, 264);
    EXPECT_GT(motionOf(world, 3).position.x, 3.0f);
    EXPECT_NEAR(wide(motionOf(world, 3).position.y), 0.5, 0.02);
}

TEST(ChainWorld, RaysAndOverlapsMeetItsFrontAlone) {
    World world = worldOf(sceneOf({flatChain()}));
    ASSERT_EQ(world.castRay({5.0f, 1.0f}, {5.0f, -1.0f}).size(), 1u);
    EXPECT_EQ(world.castRay({5.0f, 1.0f}, {5.0f, -1.0f})[0].normal, (Vec2{0.0f, 1.0f}));
    EXPECT_TRUE(world.castRay({5.0f, -1.0f}, {5.0f, 1.0f}).empty());
    const ShapeDef disc = ShapeDef::circle({}, 0.1f);
    EXPECT_FALSE(world.overlap(disc, {{5.0f, 0.05f}, {}}).empty());
    EXPECT_TRUE(world.overlap(disc, {{5.0f, -0.05f}, {}}).empty());
}

}  // namespace
}  // namespace huestep::test
