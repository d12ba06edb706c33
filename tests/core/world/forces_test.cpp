// Forces of a tick.
#include "tests/core/support.h"

namespace huestep::test {
namespace {

TEST(Forces, OfATickThatAlsoSpawnsReachTheirBodyAlone) {
    Scene scene = sceneOf({discAt({}), discAt({10.0f, 0.0f})});
    scene.gravity = {};
    World world = worldOf(scene);
    Spawn spawn;
    for (int i = 0; i < 100; ++i)
        spawn.bodies.push_back(discAt({0.0f, 10.0f + 2.0f * static_cast<float>(i)}));
    const std::vector<Command> commands{{0, 1, ApplyForce{1, {5.0f, 0.0f}, {}}}, {0, 2, spawn}};
    const Events& events = world.step(commands);
    EXPECT_TRUE(events.quarantined.empty());
    for (std::size_t i = 1; i < world.bodies().size(); ++i) {
        EXPECT_EQ(world.motions()[i].velocity, Vec2{}) << "body " << world.bodies()[i].id;
        EXPECT_EQ(world.motions()[i].angularVelocity, 0.0f) << "body " << world.bodies()[i].id;
    }
    EXPECT_GT(world.motions()[0].velocity.x, 0.0f);
}

TEST(Forces, AddUpAndLastOneTick) {
    Scene scene = sceneOf({discAt({})});
    scene.gravity = {};
    World world = worldOf(scene);
    const double mass = wide(world.bodies()[0].mass);
    world.step(std::vector<Command>{{0, 1, ApplyForce{1, {3.0f, 0.0f}, {}}},
                                    {0, 2, ApplyForce{1, {0.0f, 4.0f}, {}}}});
    const double gain = 1.0 / 60.0 / mass;
    EXPECT_NEAR(wide(world.motions()[0].velocity.x), 3.0 * gain, 1e-7);
    EXPECT_NEAR(wide(world.motions()[0].velocity.y), 4.0 * gain, 1e-7);
    const Vec2 after = world.motions()[0].velocity;
    run(world, 10);
    EXPECT_EQ(world.motions()[0].velocity, after);
}

TEST(Forces, BesideTheCentreTurnTheBodyByTheirMoment) {
    Scene scene = sceneOf({boxAt({2.0f, 3.0f})});
    scene.gravity = {};
    World world = worldOf(scene);
    const double inertia = wide(world.bodies()[0].inertia);
    EXPECT_NEAR(inertia, 1.0 / 6.0, 1e-6) << "a unit box of 1 kg";
    world.step(std::vector<Command>{{0, 1, ApplyForce{1, {0.0f, 6.0f}, {2.5f, 3.0f}}}});
    EXPECT_NEAR(wide(world.motions()[0].angularVelocity), 0.5 * 6.0 / inertia / 60.0, 1e-5);
}

}  // namespace
}  // namespace huestep::test
