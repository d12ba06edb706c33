// Sleep: islands at rest fall asleep as a whole and wake as a whole.

#include "tests/core/support.h"

namespace huestep::test {
namespace {

bool allAsleep(const World& world) {
    for (std::size_t i = 0; i < world.bodies().size(); ++i) {
        if (world.bodies()[i].dynamic() && !world.motions()[i].asleep()) return false;
    }
    return true;
}

/// Three piles of two boxes, asleep.
World sleepers() {
    Scene scene = sceneOf({ground()});
    for (int pile = 0; pile < 3; ++pile) {
        for (int level = 0; level < 2; ++level) {
            scene.bodies.push_back(
                boxAt({4.0f * static_cast<float>(pile), 0.5f + static_cast<float>(level)}));
        }
    }
    World world = worldOf(scene);
    run(world, 120);
    EXPECT_TRUE(allAsleep(world));
    return world;
}

TEST(Sleep, ABodyAtRestSleepsAfterHalfASecondAndThenDoesNotMove) {
    World world = worldOf(sceneOf({ground(), boxAt({0.0f, 0.5f})}));
    int ticks = 0;
    while (!allAsleep(world) && ticks < 200) {
        world.step({});
        ++ticks;
    }
    EXPECT_GE(ticks, 30);
    EXPECT_LT(ticks, 60);
    EXPECT_EQ(world.motions()[1].velocity, Vec2{});
    const std::vector<ContactState> contacts = world.contacts();
    const BodyMotion before = world.motions()[1];
    run(world, 100);
    EXPECT_EQ(world.motions()[1].position, before.position);
    EXPECT_EQ(world.motions()[1].rotation, before.rotation);
    ASSERT_EQ(world.contacts().size(), contacts.size());
    EXPECT_EQ(world.contacts()[0].normalImpulse, contacts[0].normalImpulse);
    EXPECT_EQ(world.report().awakeBodies, 0u);
}

TEST(Sleep, OnePushWakesItsIslandAndNoOther) {
    World world = sleepers();
    world.step(std::vector<Command>{{0, 1, ApplyImpulse{2, {0.5f, 0.0f}, {0.0f, 0.5f}}}});
    EXPECT_FALSE(motionOf(world, 2).asleep());
    EXPECT_FALSE(motionOf(world, 3).asleep()) << "the box above";
    for (BodyId id = 4; id <= 7; ++id) EXPECT_TRUE(motionOf(world, id).asleep()) << id;
    EXPECT_EQ(world.report().awakeBodies, 2u);
}

TEST(Sleep, AnIslandStaysAwakeWhileOneOfItsBodiesMayNotSleep) {
    Scene scene =
        sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({0.0f, 1.5f}), boxAt({9.0f, 0.5f})});
    scene.bodies[2].maySleep = false;
    World world = worldOf(scene);
    run(world, 200);
    EXPECT_FALSE(motionOf(world, 2).asleep());
    EXPECT_FALSE(motionOf(world, 3).asleep());
    EXPECT_TRUE(motionOf(world, 4).asleep());
}

TEST(Sleep, WhereTheSceneForbidsItNothingSleeps) {
    Scene scene = sceneOf({ground(), boxAt({0.0f, 0.5f})});
    scene.sleep = false;
    World world = worldOf(scene);
    run(world, 200);
    EXPECT_FALSE(motionOf(world, 2).asleep());
}

TEST(Sleep, AFallingBodyWakesWhatItLandsOn) {
    World world = sleepers();
    world.step(std::vector<Command>{{0, 1, Spawn{{boxAt({0.0f, 6.0f})}, {}}}});
    bool woke = false;
    for (int tick = 0; tick < 120 && !woke; ++tick) {
        world.step({});
        woke = !motionOf(world, 2).asleep() && !motionOf(world, 3).asleep();
    }
    EXPECT_TRUE(woke);
    EXPECT_TRUE(motionOf(world, 4).asleep());
    run(world, 240);
    EXPECT_TRUE(allAsleep(world));
}

TEST(Sleep, AKinematicBodyThatStartsToMoveWakesWhatLiesOnIt) {
    BodyDef lift = bodyAt(BodyType::Kinematic, {0.0f, -0.5f}, ShapeDef::box(3.0f, 0.5f));
    World world = worldOf(sceneOf({lift, boxAt({0.0f, 0.5f})}));
    run(world, 120);
    ASSERT_TRUE(allAsleep(world));
    world.step(std::vector<Command>{{0, 1, SetVelocity{1, {0.0f, 1.0f}, 0.0f}}});
    run(world, 59);
    EXPECT_FALSE(motionOf(world, 2).asleep());
    EXPECT_NEAR(wide(motionOf(world, 2).position.y), 1.5, 0.03) << "carried up";
    run(world, 120);
    EXPECT_FALSE(motionOf(world, 2).asleep()) << "what is carried is not at rest";
    world.step(std::vector<Command>{{0, 2, SetVelocity{1, {}, 0.0f}}});
    run(world, 120);
    EXPECT_TRUE(motionOf(world, 2).asleep());
}

TEST(Sleep, BodiesJoinedByAJointSleepAndWakeTogether) {
    Scene scene = sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({1.5f, 0.5f})},
                          {hinge(1, {0.75f, 0.0f}, 2, {-0.75f, 0.0f})});
    World world = worldOf(scene);
    run(world, 200);
    ASSERT_TRUE(allAsleep(world));
    world.step(std::vector<Command>{{0, 1, ApplyImpulse{2, {0.0f, 0.3f}, {0.0f, 0.5f}}}});
    EXPECT_FALSE(motionOf(world, 3).asleep());
}

TEST(Sleep, BodiesThatStartAsleepStayWhereTheyAreUntilTouched) {
    BodyDef hanging = boxAt({0.0f, 10.0f});
    hanging.asleep = true;
    World world = worldOf(sceneOf({ground(), hanging}));
    run(world, 60);
    EXPECT_EQ(motionOf(world, 2).position.y, 10.0f);
    world.step(std::vector<Command>{{0, 1, ApplyImpulse{2, {}, {0.0f, 10.0f}}}});
    run(world, 30);
    EXPECT_LT(motionOf(world, 2).position.y, 9.5f);
}

}  // namespace
}  // namespace huestep::test
