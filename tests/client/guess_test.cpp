#include "client/guess.h"

#include <gtest/gtest.h>

#include "tests/play_scene.h"

namespace huestep::client {
namespace {

TEST(PushesGoOn, OthersPushOnAtTheCentreOfTheSameBodyWithTheirNextSequences) {
    World world = *World::create(test::playScene());
    world.step(std::vector<Command>{{0, 1, AddPlayer{1}}, {0, 2, AddPlayer{2}}});
    const std::vector<Command> last{{0, 3, ApplyForce{2, {0.0f, 9.0f}, {0.0f, 2.0f}}},
                                    {1, 1, ApplyImpulse{3, {1.0f, 0.0f}, {1.0f, 2.0f}}},
                                    {2, 1, Release{}},
                                    {2, 2, ApplyImpulse{4, {0.5f, 0.0f}, {2.0f, 2.0f}}},
                                    {2, 3, ApplyForce{4, {0.0f, 1.0f}, {2.0f, 2.0f}}},
                                    {2, 4, ApplyImpulse{999, {1.0f, 0.0f}, {}}}};
    world.step(last);
    const Guess guess = pushesGoOn(5);
    const auto at = [&](BodyId body) { return world.motions()[*world.find(body)].position; };
    const std::vector<Command> expected{{0, 4, ApplyForce{2, {0.0f, 9.0f}, at(2)}},
                                        {2, 5, ApplyImpulse{4, {0.5f, 0.0f}, at(4)}},
                                        {2, 6, ApplyForce{4, {0.0f, 1.0f}, at(4)}}};
    EXPECT_EQ(guess({world, 1, last, 0}), expected);
    EXPECT_EQ(guess({world, 1, last, 4}), expected);
    EXPECT_TRUE(guess({world, 1, last, 5}).empty());
    // What is guessed is what the world takes.
    for (const CommandOutcome& outcome : world.step(expected).commands) {
        EXPECT_EQ(outcome.reason, Rejection::None) << describe(outcome.reason);
    }
}

}  // namespace
}  // namespace huestep::client
