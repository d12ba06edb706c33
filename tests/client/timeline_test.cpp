#include "client/timeline.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <memory>

#include "client/bot.h"
#include "tests/play_scene.h"
#include "tests/simulation/dice.h"

namespace huestep::client {
namespace {

using test::Dice;
using test::playScene;

World playWorld(PlayerId players) {
    World world = *World::create(playScene());
    std::vector<Command> joins;
    for (PlayerId id = 1; id <= players; ++id) joins.push_back({0, id, AddPlayer{id}});
    world.step(joins);
    return world;
}

/// What players do in the ticks of a world: by bots, who push, grab, spawn and remove.
class Players {
 public:
    Players(PlayerId count, std::uint64_t seed) : m_sequences(count + 1) {
        for (PlayerId id = 1; id <= count; ++id) m_bots.push_back(makeWanderBot(seed + id));
    }
    std::vector<Command> commands(const World& world) {
        std::vector<Command> out;
        for (const PlayerRecord& player : world.players()) {
            if (player.id == 0) continue;
            for (Action& action :
                 m_bots[player.id - 1]->act({world, player.id, player.body, world.tick()})) {
                out.push_back({player.id, ++m_sequences[player.id], std::move(action)});
            }
        }
        sortByKey(out);
        return out;
    }

 private:
    std::vector<std::unique_ptr<Bot>> m_bots;
    std::vector<std::uint64_t> m_sequences;
};

/// A guess at the tick: all of it, none of it, or what one player does.
std::vector<Command> guessAt(std::vector<Command> commands, Dice& dice) {
    const std::uint64_t kind = dice.roll() % 4;
    if (kind < 2) return commands;
    if (kind == 2) return {};
    std::erase_if(commands, [](const Command& command) { return command.author != 1; });
    return commands;
}

TEST(Timeline, WhateverWasPredictedTheFramesAloneDecide) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
        Dice dice(seed);
        Players players(3, seed);
        World truth = playWorld(3);
        Timeline timeline{World(truth)};
        std::deque<std::vector<Command>> frames;  // closed, and not yet told to the timeline
        World server = truth;
        std::uint64_t undone = 0;
        for (int turn = 0; turn < 500; ++turn) {
            frames.push_back(players.commands(server));
            server.step(frames.back());
            for (std::uint64_t ahead = dice.between(0, 12); timeline.ahead() < ahead;) {
                const std::size_t place = timeline.ahead();
                const bool known = place < frames.size();
                timeline.predict(known ? guessAt(frames[place], dice) : std::vector<Command>(), {});
            }
            while (frames.size() > dice.between(0, 10)) {
                undone += timeline.confirm(frames.front(), {});
                truth.step(frames.front());
                frames.pop_front();
                ASSERT_EQ(timeline.confirmed(), truth.tick());
                ASSERT_EQ(timeline.confirmedRoot(), truth.motionRoot()) << "turn " << turn;
                if (timeline.ahead() == 0) {
                    ASSERT_EQ(timeline.world().fullRoot(), truth.fullRoot()) << "turn " << turn;
                }
            }
        }
        EXPECT_GT(undone, 300u);
    }
}

}  // namespace
}  // namespace huestep::client
