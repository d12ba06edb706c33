#include "client/smoothing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/play_scene.h"

namespace huestep::client {
namespace {

/// A world and the same one after a push of body 2, both a few ticks later.
struct TwoWays {
    World right = *World::create(test::playScene());
    World wrong = right;

    explicit TwoWays(Vec2 impulse, int ticks = 8) {
        const Vec2 above = right.motions()[*right.find(2)].position + Vec2{0.3f, 0.3f};
        wrong.step(std::vector<Command>{{0, 1, ApplyImpulse{2, impulse, above}}});
        right.step({});
        for (int i = 1; i < ticks; ++i) {
            right.step({});
            wrong.step({});
        }
    }
    static Pose poseOf(const World& world, BodyId body) {
        return world.motions()[*world.find(body)].pose();
    }
};

TEST(Smoothing, ABodyStaysWhereItWasShownAndComesToWhereItIs) {
    const TwoWays ways({0.5f, 0.0f});
    const std::uint64_t before = ways.right.fullRoot();
    Smoothing smoothing{SmoothingRules{}};
    EXPECT_FALSE(smoothing.awaits(ways.wrong.tick()));
    smoothing.shown(ways.wrong);
    EXPECT_TRUE(smoothing.awaits(ways.right.tick()));
    EXPECT_FALSE(smoothing.awaits(ways.right.tick() + 1));
    const float largest = smoothing.corrected(ways.right);
    const Pose was = TwoWays::poseOf(ways.wrong, 2);
    const Pose is = TwoWays::poseOf(ways.right, 2);
    ASSERT_GT(length(was.p - is.p), 0.05f);
    EXPECT_NEAR(largest, length(was.p - is.p), 1e-6f);
    const Pose shown = smoothing.posed(2, is);
    EXPECT_LT(length(shown.p - was.p), 1e-6f);
    EXPECT_NEAR(shown.q.c, was.q.c, 1e-6f);
    EXPECT_NEAR(shown.q.s, was.q.s, 1e-6f);
    // e-fold after the time that the rules name, and nothing at last.
    smoothing.decay(0.1f);
    EXPECT_NEAR(length(smoothing.posed(2, is).p - is.p), std::exp(-1.0f) * largest, 1e-5f);
    float turn = std::abs(relative(is.q, smoothing.posed(2, is).q).s);
    for (int i = 0; i < 40 && !smoothing.errors().empty(); ++i) {
        smoothing.decay(1.0f / 60.0f);
        const float less = std::abs(relative(is.q, smoothing.posed(2, is).q).s);
        EXPECT_LE(less, turn + 1e-6f);
        turn = less;
    }
    EXPECT_TRUE(smoothing.errors().empty());
    EXPECT_EQ(smoothing.posed(2, is), is);
    EXPECT_EQ(ways.right.fullRoot(), before);
}

TEST(Smoothing, ASecondCorrectionStartsFromWhatIsShownOfTheFirst) {
    const TwoWays first({0.5f, 0.0f});
    const TwoWays second({-0.4f, 0.0f});
    Smoothing smoothing{SmoothingRules{}};
    smoothing.shown(first.wrong);
    smoothing.corrected(first.right);
    smoothing.decay(0.05f);
    const Pose shown = smoothing.posed(2, TwoWays::poseOf(second.wrong, 2));
    smoothing.shown(second.wrong);
    smoothing.corrected(second.right);
    const Pose after = smoothing.posed(2, TwoWays::poseOf(second.right, 2));
    EXPECT_LT(length(after.p - shown.p), 1e-5f);
    EXPECT_NEAR(after.q.s, shown.q.s, 1e-5f);
}

TEST(Smoothing, WhatWouldBeHiddenTooFarOrHardlyAtAllIsNot) {
    const TwoWays far({200.0f, 0.0f});
    Smoothing smoothing{SmoothingRules{}};
    smoothing.shown(far.wrong);
    EXPECT_GT(smoothing.corrected(far.right), 2.0f);
    for (const ShownError& error : smoothing.errors()) EXPECT_NE(error.body, 2u);
    const TwoWays near({1e-4f, 0.0f});
    smoothing.forget();
    smoothing.shown(near.wrong);
    EXPECT_GT(smoothing.corrected(near.right), 0.0f);
    EXPECT_TRUE(smoothing.errors().empty());
}

TEST(Smoothing, IdsThatWentToBodiesOfOthersAreNotTakenForTheSameBody) {
    World one = *World::create(test::playScene());
    one.step(std::vector<Command>{{0, 1, AddPlayer{1}}, {0, 2, AddPlayer{2}}});
    World two = one;
    BodyDef ball;
    ball.type = BodyType::Dynamic;
    ball.shapes.push_back(ShapeDef::circle({}, 0.2f));
    const auto spawn = [&](World& world, PlayerId player, float x) {
        ball.position = {x, 8.0f};
        const Events& events = world.step(std::vector<Command>{{player, 1, Spawn{{ball}, {}}}});
        EXPECT_EQ(events.commands.at(0).reason, Rejection::None);
        return events.commands.at(0).firstBody;
    };
    ASSERT_EQ(spawn(one, 1, -3.0f), spawn(two, 2, -2.5f));
    Smoothing smoothing{SmoothingRules{}};
    smoothing.shown(one);
    EXPECT_EQ(smoothing.corrected(two), 0.0f);
    EXPECT_TRUE(smoothing.errors().empty());
}

TEST(Smoothing, OfTwoWaysBackBeforeTheTickIsReachedTheFirstCounts) {
    const TwoWays ways({0.5f, 0.0f});
    World early = *World::create(test::playScene());
    Smoothing smoothing{SmoothingRules{}};
    smoothing.shown(ways.wrong);
    smoothing.shown(early);
    EXPECT_TRUE(smoothing.awaits(ways.wrong.tick()));
    smoothing.corrected(ways.right);
    const Pose shown = smoothing.posed(2, TwoWays::poseOf(ways.right, 2));
    EXPECT_LT(length(shown.p - TwoWays::poseOf(ways.wrong, 2).p), 1e-6f);
}

}  // namespace
}  // namespace huestep::client
