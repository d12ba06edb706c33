// The ball game: who may do what when, what counts as a goal, and how a game goes on.

#include "core/games/ball.h"

#include <cstring>
#include <functional>
#include <limits>

#include "core/state/snapshot.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

using games::BallPhase;
using games::BallState;

BallState stateOf(const World& world) {
    return rulesStateOf<BallState>(world.rulesState());
}

/// A game that players have joined, driven tick by tick.
class Match {
 public:
    explicit Match(const std::string& scene, PlayerId players = 2) : world(worldOf(scene)) {
        std::vector<Command> commands;
        for (PlayerId player = 1; player <= players; ++player) {
            commands.push_back({0, ++m_sequence, AddPlayer{player}});
        }
        world.step(commands);
    }
    [[nodiscard]] BallState state() const { return stateOf(world); }
    [[nodiscard]] BallPhase phase() const { return static_cast<BallPhase>(state().phase); }
    [[nodiscard]] BodyId bodyOf(PlayerId id) const {
        for (const PlayerRecord& player : world.players()) {
            if (player.id == id) return player.body;
        }
        return 0;
    }
    [[nodiscard]] Vec2 placeOf(BodyId body) const { return motionOf(world, body).position; }

    Rejection say(PlayerId author, Action action) {
        world.step(std::vector<Command>{{author, ++m_sequence, std::move(action)}});
        return world.events().commands[0].reason;
    }
    /// An impulse that gives the body this velocity, by the host, whom no rules bind.
    void drive(BodyId body, Vec2 velocity) {
        const auto place = *world.find(body);
        const BodyMotion& motion = world.motions()[place];
        const Vec2 impulse = world.bodies()[place].mass * (velocity - motion.velocity);
        ASSERT_EQ(say(0, ApplyImpulse{body, impulse, motion.position}), Rejection::None);
    }
    bool runUntil(const std::function<bool()>& reached, int ticks = 2000) {
        for (int i = 0; i < ticks; ++i) {
            if (reached()) return true;
            world.step({});
        }
        return reached();
    }
    bool runIntoPlay() {
        return runUntil([&] { return phase() == BallPhase::Play; });
    }

    World world;

 private:
    std::uint64_t m_sequence = 0;
};

TEST(BallGame, PutsWhoeverEntersIntoTheSmallerTeamAndItsOwnHalf) {
    Match match("ball", 5);
    const BallState s = match.state();
    std::array<int, 2> strength{};
    for (PlayerId player = 1; player <= 5; ++player) {
        ASSERT_EQ(s.player[player - 1], player);
        ++strength[s.team[player - 1]];
        const float x = match.placeOf(match.bodyOf(player)).x;
        EXPECT_EQ(x < 0.0f, s.team[player - 1] == 0) << "player " << player;
    }
    EXPECT_EQ(strength[0], 3);
    EXPECT_EQ(strength[1], 2);
    match.say(0, RemovePlayer{1});
    EXPECT_EQ(match.state().player[0], 0u) << "its seat is free";
    match.say(0, AddPlayer{9});
    EXPECT_EQ(match.state().player[0], 9u);
}

TEST(BallGame, LetsNobodyMoveBeforeTheKickOff) {
    Match match("ball");
    EXPECT_EQ(match.phase(), BallPhase::Pause);
    const BodyId mine = match.bodyOf(1);
    EXPECT_EQ(match.say(1, ApplyImpulse{mine, {1.0f, 0.0f}, match.placeOf(mine)}),
              Rejection::AgainstRules);
    ASSERT_TRUE(match.runIntoPlay());
    EXPECT_EQ(match.world.tick(), 90u) << "1.5 s at 60 Hz";
    EXPECT_EQ(match.say(1, ApplyImpulse{mine, {1.0f, 0.0f}, match.placeOf(mine)}), Rejection::None);
    EXPECT_GT(motionOf(match.world, mine).velocity.x, 0.0f);
}

TEST(BallGame, LetsPlayersPushThemselvesOnceATickAndNothingElse) {
    Match match("ball");
    ASSERT_TRUE(match.runIntoPlay());
    const BodyId mine = match.bodyOf(1);
    const BodyId ball = match.state().ball;
    const Vec2 here = match.placeOf(mine);
    const Vec2 there = match.placeOf(ball);
    EXPECT_EQ(match.say(1, ApplyImpulse{ball, {1.0f, 0.0f}, there}), Rejection::AgainstRules);
    EXPECT_EQ(match.say(1, ApplyForce{mine, {1.0f, 0.0f}, here}), Rejection::AgainstRules);
    EXPECT_EQ(match.say(1, Grab{ball, there, here}), Rejection::AgainstRules);
    EXPECT_EQ(match.say(1, RemoveBody{ball}), Rejection::AgainstRules);
    EXPECT_EQ(match.say(1, Custom{77, 0, 0, {}}), Rejection::UnknownAction);
    EXPECT_EQ(match.say(1, Custom{games::kick, 0, 0, {1.0f, 0.0f}}), Rejection::TooFar);
    EXPECT_EQ(match.say(1, ApplyImpulse{mine, {5.0f, 0.0f}, here}), Rejection::TooStrong)
        << "the scene's own cap";
    match.world.step(std::vector<Command>{{1, 500, ApplyImpulse{mine, {1.0f, 0.0f}, here}},
                                          {1, 501, ApplyImpulse{mine, {1.0f, 0.0f}, here}}});
    EXPECT_EQ(match.world.events().commands[0].reason, Rejection::None);
    EXPECT_EQ(match.world.events().commands[1].reason, Rejection::AgainstRules);
}

TEST(BallGame, AKickWithinReachDrivesTheBallAndTheNextHasToWait) {
    Match match("ball");
    ASSERT_TRUE(match.runIntoPlay());
    const BodyId mine = match.bodyOf(1);
    const BodyId ball = match.state().ball;
    const auto near = [&] { return length(match.placeOf(ball) - match.placeOf(mine)) < 1.2f; };
    for (int i = 0; i < 600 && !near(); ++i) {
        const Vec2 way = match.placeOf(ball) - match.placeOf(mine);
        match.drive(mine, (5.0f / length(way)) * way);
    }
    ASSERT_TRUE(near());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(match.say(1, Custom{games::kick, 0, 0, {}}), Rejection::NotFinite) << "no direction";
    EXPECT_EQ(match.say(1, Custom{games::kick, 0, 0, {nan, 0.0f}}), Rejection::NotFinite);
    match.drive(ball, {});
    ASSERT_EQ(match.say(1, Custom{games::kick, 0, 0, {0.0f, 300.0f}}), Rejection::None);
    EXPECT_NEAR(wide(motionOf(match.world, ball).velocity.y), 14.0, 0.5) << "as hard as it gets";
    EXPECT_EQ(match.state().lastTouch, 1u);
    EXPECT_EQ(match.say(1, Custom{games::kick, 0, 0, {0.0f, 1.0f}}), Rejection::AgainstRules);
}

TEST(BallGame, CountsAGoalForTheTeamThatPlaysThereAndKicksOffAgain) {
    for (const float side : {1.0f, -1.0f}) {
        Match match("ball");
        ASSERT_TRUE(match.runIntoPlay());
        const BodyId ball = match.state().ball;
        const BodyId keeper = match.bodyOf(1);
        const Vec2 before = match.placeOf(keeper);
        match.drive(keeper, {0.0f, 4.0f});
        match.drive(ball, {25.0f * side, 0.0f});
        ASSERT_TRUE(match.runUntil([&] { return match.phase() == BallPhase::Pause; }));
        const std::size_t team = side > 0.0f ? 0 : 1;
        EXPECT_EQ(match.state().goals[team], 1u);
        EXPECT_EQ(match.state().goals[1 - team], 0u);
        EXPECT_GT(side * match.placeOf(ball).x, 15.0f) << "past the line";
        match.world.step({});
        EXPECT_FALSE(match.world.find(ball).has_value()) << "a new ball";
        const Vec2 spot = match.placeOf(match.state().ball);
        EXPECT_LT(length(spot), 1.0f);
        EXPECT_FALSE(match.world.find(keeper).has_value()) << "all are put back";
        EXPECT_LT(length(match.placeOf(match.bodyOf(1)) - before), 1.0f);
    }
}

TEST(BallGame, CountsAGoalForItsScorerWhoTouchedTheBallLast) {
    Match match("ball");
    ASSERT_TRUE(match.runIntoPlay());
    const BodyId mine = match.bodyOf(1);
    const BodyId ball = match.state().ball;
    const auto touched = [&] { return match.state().lastTouch == 1; };
    for (int i = 0; i < 600 && !touched(); ++i) {
        const Vec2 way = match.placeOf(ball) - match.placeOf(mine);
        match.drive(mine, (8.0f / length(way)) * way);
    }
    ASSERT_TRUE(touched()) << "by a contact that begins";
    match.drive(ball, {30.0f, 0.0f});
    ASSERT_TRUE(match.runUntil([&] { return match.phase() == BallPhase::Pause; }));
    EXPECT_EQ(match.state().scored[0], 1u);
}

TEST(BallGame, EndsAtItsGoalsOrItsTimeAndAnotherBegins) {
    Match quick("ball:goals=1");
    ASSERT_TRUE(quick.runIntoPlay());
    quick.drive(quick.state().ball, {30.0f, 0.0f});
    ASSERT_TRUE(quick.runUntil([&] { return quick.phase() == BallPhase::Over; }));
    EXPECT_EQ(quick.world.score(), "red 1 : 0 blue, over");
    Match timed("ball:seconds=2");
    ASSERT_TRUE(timed.runIntoPlay());
    const std::uint64_t begin = timed.world.tick();
    ASSERT_TRUE(timed.runUntil([&] { return timed.phase() == BallPhase::Over; }));
    // The tick in which play began counts as the first of the 120.
    EXPECT_EQ(timed.world.tick() - begin, 119u);
    for (Match* match : {&quick, &timed}) {
        ASSERT_TRUE(match->runUntil([&] { return match->phase() != BallPhase::Over; }));
        EXPECT_EQ(match->state().games, 2u);
        EXPECT_EQ(match->state().goals, (std::array<std::uint32_t, 2>{}));
        EXPECT_TRUE(match->runIntoPlay());
    }
}

TEST(BallGame, IsPlayedInTheFrameOfItsPitchWhereverThatStands) {
    Match match("ball:turn=90,far=2");
    ASSERT_TRUE(match.runIntoPlay());
    match.drive(match.state().ball, {0.0f, 25.0f});  // along the pitch
    ASSERT_TRUE(match.runUntil([&] { return match.phase() == BallPhase::Pause; }));
    EXPECT_EQ(match.state().goals[0], 1u);
}

TEST(BallGame, AStateThatNoGameComesToIsRefused) {
    Match match("ball");
    const WorldState good = *readSnapshot(match.world.save());
    const auto saying = [&](auto&& spoil) {
        BallState s = match.state();
        spoil(s);
        WorldState bad = good;
        std::memcpy(bad.rulesWords.data(), &s, sizeof s);
        const Result<World> world = World::restore(writeSnapshot(bad));
        return world.ok() ? std::string() : world.error().message;
    };
    EXPECT_EQ(saying([](BallState&) {}), "");
    EXPECT_NE(saying([](BallState& s) { s.team[3] = 2; }), "");
    EXPECT_NE(saying([](BallState& s) { s.phase = 3; }), "");
    EXPECT_NE(saying([](BallState& s) { s.phaseLeft = 0; }), "");
    // What may be wrong without harm is lived with.
    for (const std::uint32_t id : {0u, 1u, 77u, 0xffffffffu}) {
        WorldState odd = good;
        BallState s = match.state();
        s.ball = s.pitch = s.lastTouch = s.player[5] = s.player[0] = id;
        s.phase = static_cast<std::uint32_t>(BallPhase::Play);
        std::memcpy(odd.rulesWords.data(), &s, sizeof s);
        Result<World> world = World::restore(writeSnapshot(odd));
        ASSERT_TRUE(world.ok());
        run(*world, 10);
        EXPECT_TRUE(World::restore(world->save()).ok());
    }
}

}  // namespace
}  // namespace huestep::test
