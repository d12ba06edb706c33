#include "client/bot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/games/ball.h"
#include "core/games/building.h"
#include "core/scene/catalog.h"
#include "tests/play_scene.h"

namespace huestep::client {
namespace {

using test::playScene;

/// A bot alone in a world, its commands applied at once.
struct Alone {
    World world = *World::create(playScene());
    std::uint64_t sequence = 0;
    std::uint64_t played = 0;
    BodyId body = 0;
    std::vector<CommandOutcome> outcomes;
    std::vector<Action> actions;

    Alone() {
        const std::vector<Command> join{{0, 1, AddPlayer{1}}};
        body = world.step(join).commands.at(0).firstBody;
    }
    void play(Bot& bot, int ticks) {
        for (int i = 0; i < ticks; ++i) {
            std::vector<Command> commands;
            for (Action& action : bot.act({world, 1, body, played})) {
                actions.push_back(action);
                commands.push_back({1, ++sequence, std::move(action)});
            }
            const Events& events = world.step(commands);
            outcomes.insert(outcomes.end(), events.commands.begin(), events.commands.end());
            ++played;
        }
    }
};

template <class A>
std::size_t countOf(const std::vector<Action>& actions) {
    std::size_t out = 0;
    for (const Action& action : actions) out += std::holds_alternative<A>(action);
    return out;
}

TEST(WanderBot, PlaysByTheRulesOfTheScene) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Alone alone;
        const std::unique_ptr<Bot> bot = makeWanderBot(seed);
        alone.play(*bot, 1'200);
        for (const CommandOutcome& outcome : alone.outcomes) {
            ASSERT_EQ(outcome.reason, Rejection::None)
                << "seed " << seed << ": " << describe(outcome.reason);
        }
        EXPECT_GT(countOf<ApplyImpulse>(alone.actions), 100u) << "seed " << seed;
        EXPECT_GT(countOf<Grab>(alone.actions) + countOf<Spawn>(alone.actions), 0u);
        EXPECT_LE(alone.world.bodies().size(), 7u + 4u);
    }
}

TEST(WanderBot, TheSameSeedAndWorldsGiveTheSameActions) {
    Alone one, two, other;
    one.play(*makeWanderBot(5), 300);
    two.play(*makeWanderBot(5), 300);
    other.play(*makeWanderBot(6), 300);
    EXPECT_EQ(one.actions, two.actions);
    EXPECT_NE(one.actions, other.actions);
}

TEST(IdleBot, DoesNothing) {
    Alone alone;
    alone.play(*makeIdleBot(), 100);
    EXPECT_TRUE(alone.actions.empty());
}

TEST(Script, EveryActionIsRead) {
    const Result<std::vector<ScriptLine>> lines = parseScript(
        "# a comment\n"
        "0 impulse me 1 2\n"
        "\n"
        "1 impulse 3 1 2 4 5   # with a point\n"
        "1 force spawned 0 -9.5\n"
        "2 grab 4 1 2 3 4\n"
        "3 move 5 6\n"
        "4 release\n"
        "5 spawn circle 0.25 1 3\n"
        "6 spawn box 0.5 0.25 -1 3\n"
        "7 remove spawned\n"
        "8 motor 2 off -1.5",
        "s");
    ASSERT_TRUE(lines.ok()) << lines.error().message;
    ASSERT_EQ(lines->size(), 10u);
    EXPECT_EQ(lines->at(0).action, Action(ApplyImpulse{0, {1, 2}, {}}));
    EXPECT_TRUE(lines->at(0).onSelf && lines->at(0).atCenter);
    EXPECT_EQ(lines->at(1).action, Action(ApplyImpulse{3, {1, 2}, {4, 5}}));
    EXPECT_FALSE(lines->at(1).onSelf || lines->at(1).atCenter);
    EXPECT_EQ(lines->at(2).action, Action(ApplyForce{0, {0, -9.5f}, {}}));
    EXPECT_TRUE(lines->at(2).onLastSpawn);
    EXPECT_EQ(lines->at(3).action, Action(Grab{4, {1, 2}, {3, 4}}));
    EXPECT_EQ(lines->at(4).action, Action(MoveGrab{{5, 6}}));
    EXPECT_EQ(lines->at(5).action, Action(Release{}));
    const BodyDef& circle = std::get<Spawn>(lines->at(6).action).bodies.at(0);
    EXPECT_EQ(circle.position, (Vec2{1, 3}));
    EXPECT_EQ(circle.shapes.at(0), ShapeDef::circle({}, 0.25f));
    EXPECT_EQ(std::get<Spawn>(lines->at(7).action).bodies.at(0).shapes.at(0),
              ShapeDef::box(0.5f, 0.25f));
    EXPECT_EQ(lines->at(9).action, Action(SetMotor{2, false, -1.5f}));
    EXPECT_EQ(lines->at(9).tick, 8u);
}

TEST(Script, WhatIsWrongIsToldWithFileAndLine) {
    const std::vector<std::pair<const char*, const char*>> wrong{
        {"0 impulse me 1 2\n1 jump me", "f.txt:2: there is no action 'jump'"},
        {"x release", "f.txt:1: the tick is no number"},
        {"-1 release", "f.txt:1: the tick is no number"},
        {"5 release\n4 release", "f.txt:2: tick 4 comes after tick 5"},
        {"0 impulse me 1", "f.txt:1: the impulse is missing"},
        {"0 impulse me 1 nan", "f.txt:1: the impulse is no number"},
        {"0 impulse you 1 2", "f.txt:1: a body is an id"},
        {"0 impulse 0 1 2", "f.txt:1: a body is an id"},
        {"0 release now", "f.txt:1: now is one word too many"},
        {"0 spawn hexagon 1 2", "f.txt:1: a spawned shape is"},
        {"0 spawn circle -1 0 0", "f.txt:1: spawn"},
        {"0 motor 1 maybe 2", "f.txt:1: a motor is"},
        {"0", "f.txt:1: the action is missing"},
        {"0 move 1e99 0", "f.txt:1: the target is no number"},
    };
    for (const auto& [text, sentence] : wrong) {
        const Result<std::vector<ScriptLine>> lines = parseScript(text, "f.txt");
        ASSERT_FALSE(lines.ok()) << text;
        EXPECT_EQ(lines.error().message.rfind(sentence, 0), 0u) << lines.error().message;
    }
}

TEST(Script, ActsAtItsTicksOnItsOwnBodyAndWhatItSpawned) {
    Result<std::vector<ScriptLine>> lines = parseScript(
        "2 impulse me 0 3\n"
        "4 spawn circle 0.2 0 9\n"
        "6 impulse spawned 1 0\n"
        "8 remove spawned\n",
        "s");
    ASSERT_TRUE(lines.ok());
    Alone alone;
    const std::unique_ptr<Bot> bot = makeScriptBot(*lines);
    const std::size_t before = alone.world.bodies().size();
    alone.play(*bot, 5);
    ASSERT_EQ(alone.actions.size(), 2u);
    EXPECT_EQ(std::get<ApplyImpulse>(alone.actions[0]).body, alone.body);
    EXPECT_EQ(alone.world.bodies().size(), before + 1);
    alone.play(*bot, 10);
    EXPECT_EQ(alone.world.bodies().size(), before);
    for (const CommandOutcome& outcome : alone.outcomes) {
        EXPECT_EQ(outcome.reason, Rejection::None) << describe(outcome.reason);
    }
}

TEST(Script, AMissingFileIsNamed) {
    const Result<std::unique_ptr<Bot>> bot = readScript("/nowhere/script.txt");
    ASSERT_FALSE(bot.ok());
    EXPECT_EQ(bot.error().message, "/nowhere/script.txt: cannot be opened");
}

TEST(Script, AFileIsReadWhole) {
    const std::string path = testing::TempDir() + "huestep_script.txt";
    std::ofstream(path) << "0 release\n3 fly me\n";
    const Result<std::unique_ptr<Bot>> bot = readScript(path);
    std::filesystem::remove(path);
    ASSERT_FALSE(bot.ok());
    EXPECT_EQ(bot.error().message.rfind(path + ":2: ", 0), 0u) << bot.error().message;
}

/// Several bots in one world of the catalogue.
void playTogether(World& world, std::vector<std::unique_ptr<Bot>>& bots, int ticks,
                  std::vector<CommandOutcome>& outcomes) {
    std::vector<Command> commands;
    for (std::size_t i = 0; i < bots.size(); ++i) {
        commands.push_back({0, world.tick() + i + 1, AddPlayer{static_cast<PlayerId>(i + 1)}});
    }
    for (int tick = 0; tick < ticks; ++tick) {
        world.step(commands);
        outcomes.insert(outcomes.end(), world.events().commands.begin(),
                        world.events().commands.end());
        commands.clear();
        for (const PlayerRecord& player : world.players()) {
            if (player.id == 0) continue;
            std::uint64_t sequence = player.lastSequence;
            for (Action& action : bots[player.id - 1]->act(
                     {world, player.id, player.body, static_cast<std::uint64_t>(tick)})) {
                commands.push_back({player.id, ++sequence, std::move(action)});
            }
        }
    }
}

std::vector<std::unique_ptr<Bot>> gameBots(std::size_t count) {
    std::vector<std::unique_ptr<Bot>> bots;
    for (std::size_t i = 0; i < count; ++i) bots.push_back(makeGameBot(i + 1));
    return bots;
}

TEST(GameBot, PlaysTheBallGameSoThatGoalsAreShot) {
    World world = *World::create(*sceneFromCatalog("ball:goals=20"));
    std::vector<std::unique_ptr<Bot>> bots = gameBots(4);
    std::vector<CommandOutcome> outcomes;
    playTogether(world, bots, 3'600, outcomes);
    const auto state = rulesStateOf<games::BallState>(world.rulesState());
    EXPECT_GT(state.goals[0] + state.goals[1], 0u) << world.score();
    std::size_t refused = 0;
    for (const CommandOutcome& outcome : outcomes) refused += outcome.reason != Rejection::None;
    // A kick-off may come between what a bot sees and what it does; a fair player is refused then.
    EXPECT_LT(20 * refused, outcomes.size());
    EXPECT_GT(outcomes.size(), 5'000u);
}

TEST(GameBot, BuildsWithinTheBudgetAndWandersWhereThereAreNoRules) {
    World world = *World::create(*sceneFromCatalog("building:budget=5"));
    std::vector<std::unique_ptr<Bot>> bots = gameBots(3);
    std::vector<CommandOutcome> outcomes;
    playTogether(world, bots, 1'200, outcomes);
    const auto state = rulesStateOf<games::BuildingState>(world.rulesState());
    EXPECT_GT(state.placed, 15u);
    EXPECT_EQ(*std::max_element(state.pieces.begin(), state.pieces.end()), 5u);
    Alone alone;
    const std::unique_ptr<Bot> bot = makeGameBot(1);
    alone.play(*bot, 600);
    EXPECT_GT(countOf<ApplyImpulse>(alone.actions), 50u);
}

}  // namespace
}  // namespace huestep::client
