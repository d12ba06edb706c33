// Sessions by the rules of a game, in the simulation of the whole: what rules remember goes through
// frames, snapshots, ways back, the journal and recovery like every other part of a world.
#include <gtest/gtest.h>

#include "core/games/ball.h"
#include "core/games/building.h"
#include "core/scene/catalog.h"
#include "runs.h"
#include "simulation.h"

namespace huestep::test {
namespace {

/// Three who play, the last without prediction, and one who watches.
void addPlayers(Simulation& simulation) {
    for (int i = 0; i < 3; ++i) {
        std::optional<client::PredictionRules> prediction;
        if (i < 2) prediction.emplace();
        simulation.addClient(protocol::Role::Player, client::makeGameBot(simulation.dice().roll()),
                             std::move(prediction));
    }
    simulation.addClient(protocol::Role::Spectator, client::makeIdleBot());
}

/// What they agree on after the faults stop.
World playedThroughFaults(std::uint64_t seed, const std::string& scene) {
    Simulation simulation(seed, *sceneFromCatalog(scene));
    simulation.weather.link = {40 * ms, 30 * ms};
    simulation.weather.link.loseOnceIn = 40;
    simulation.weather.breakOnceIn = 4'000;
    simulation.weather.powerOffOnceIn = 4'000;
    addPlayers(simulation);
    simulation.run(15'000 * ms);
    EXPECT_GT(simulation.breaks() + simulation.crashes(), 0u);
    simulation.weather = Weather{};
    simulation.disk.revive();
    EXPECT_TRUE(simulation.converge(20'000 * ms)) << "no agreement after the faults stopped";
    for (std::size_t i = 0; i < simulation.clients(); ++i) {
        const client::Replica& replica = simulation.client(i).replica();
        EXPECT_EQ(replica.counts().mismatches, 0u) << "client " << i;
        EXPECT_GT(replica.counts().hashesCompared, 300u) << "client " << i;
    }
    Executor two(2);
    simulation.checkAgainstJournal(&two);
    return *simulation.client(3).replica().world();
}

TEST(SimulatedGames, TheBallGameIsAgreedOnThroughLossBreaksAndRecovery) {
    forEachSeed("ball", 2, [](std::uint64_t seed) {
        const World world = playedThroughFaults(seed, "ball:goals=50");
        const auto state = rulesStateOf<games::BallState>(world.rulesState());
        std::printf("  %s\n", world.score().c_str());
        EXPECT_LT(state.ticksLeft, state.playTicks) << "it was played";
    });
}

TEST(SimulatedGames, TheSandboxIsAgreedOnThroughLossBreaksAndRecovery) {
    forEachSeed("building", 2, [](std::uint64_t seed) {
        const World world = playedThroughFaults(seed, "building:budget=4");
        std::printf("  %s\n", world.score().c_str());
        EXPECT_GT(rulesStateOf<games::BuildingState>(world.rulesState()).placed, 5u);
    });
}

}  // namespace
}  // namespace huestep::test
