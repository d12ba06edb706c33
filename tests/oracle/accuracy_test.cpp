// Accuracy beside the gates of tests/core/solver/gates_test.cpp: the right answer is the solution
// of a differential equation or a state of rest.
#include <gtest/gtest.h>

#include <cmath>

#include "core/box2d/engine.h"
#include "core/scene/catalog.h"
#include "core/scene/measure.h"
#include "core/world/world.h"

namespace huestep::oracle {
namespace {

World worldOf(const char* text) {
    Result<Scene> scene = sceneFromCatalog(text);
    EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
    Result<World> world = World::create(*scene);
    EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().message);
    return std::move(world.value());
}

Measures measured(const World& world) {
    return measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions());
}

TEST(Accuracy, ADoublePendulumIsWhereItsEquationsSayAfterASecond) {
    World world = worldOf("double_pendulum");
    for (int tick = 0; tick < 60; ++tick) world.step({});
    const Vec2 tip = world.motions()[2].position;
    const double off =
        std::hypot(static_cast<double>(tip.x) + 1.4771364, static_cast<double>(tip.y) + 1.2884217);
    EXPECT_LT(off, 6e-3);
}

/// Beams welded end to end to a wall, and a lift that carries the last of them on its edge.
Scene cantilever() {
    Scene scene;
    scene.sleep = false;
    scene.bodies.emplace_back();
    for (std::uint32_t i = 0; i < 8; ++i) {
        BodyDef beam;
        beam.type = BodyType::Dynamic;
        beam.position = {0.5f + static_cast<float>(i), 0.0f};
        beam.shapes = {ShapeDef::box(0.5f, 0.125f)};
        scene.bodies.push_back(beam);
        JointDef weld;
        weld.kind = i == 4 ? JointKind::Prismatic : JointKind::Weld;
        weld.limit = {i == 4, 0.0f, 0.0f};
        weld.bodyA = i;
        weld.bodyB = i + 1;
        weld.anchorA = {i == 0 ? 0.0f : 0.5f, 0.0f};
        weld.anchorB = {-0.5f, 0.0f};
        scene.joints.push_back(weld);
    }
    return scene;
}

TEST(Accuracy, WeldsAndSlidesAreOffByNoMoreThanThoseOfBox2D) {
    const Scene scene = cantilever();
    Result<World> world = World::create(scene);
    ASSERT_TRUE(world.ok());
    Result<std::unique_ptr<Engine>> peer = makeBox2dEngine(scene);
    ASSERT_TRUE(peer.ok());
    for (int tick = 0; tick < 600; ++tick) {
        world->step({});
        ASSERT_TRUE((*peer)->step({}).ok());
    }
    const auto errorOf = [&](std::span<const BodyMotion> motions) {
        return measure(world->info(), world->bodies(), world->shapes(), world->joints(), motions)
            .maxJointError;
    };
    const double ours = errorOf(world->motions());
    const double theirs = errorOf((*peer)->motions());
    RecordProperty("ours", std::to_string(ours));
    RecordProperty("theirs", std::to_string(theirs));
    EXPECT_LT(ours, 0.02);
    EXPECT_LE(ours, theirs) << "8 m of beams bend each engine's welds";
}

TEST(Accuracy, AStackOfTwentyBoxesAtRestOverlapsByLessThanTwoCentimetres) {
    World world = worldOf("stack:n=20");
    for (int tick = 0; tick < 1200; ++tick) world.step({});
    EXPECT_LT(measured(world).maxPenetration, 0.02);
}

TEST(Accuracy, TheHingeSceneComesToRestAndSleeps) {
    World world = worldOf("hinges");
    for (int tick = 0; tick < 600; ++tick) world.step({});
    for (std::size_t i = 1; i < world.motions().size(); ++i) {
        EXPECT_TRUE(world.motions()[i].asleep()) << "body " << world.bodies()[i].id;
    }
    EXPECT_LT(measured(world).maxJointError, 5e-3);
    EXPECT_LT(measured(world).maxPenetration, 0.01) << "visual: 1 % of a box";
}

}  // namespace
}  // namespace huestep::oracle
