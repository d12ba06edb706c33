// Accuracy beside the gates of tests/core/solver/gates_test.cpp: the right answer is the solution
// of a differential equation or a state of rest.
#include <gtest/gtest.h>

#include <cmath>

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
    EXPECT_LT(measured(world).maxPenetration, 5e-3);
}

}  // namespace
}  // namespace huestep::oracle
