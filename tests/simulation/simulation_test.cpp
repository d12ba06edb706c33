#include "simulation.h"

#include <gtest/gtest.h>

#include "runs.h"

namespace huestep::test {
namespace {

void addPlayers(Simulation& simulation, int count) {
    for (int i = 0; i < count; ++i) {
        simulation.addClient(protocol::Role::Player,
                             client::makeWanderBot(simulation.dice().roll()));
    }
}

void expectNoMismatch(Simulation& simulation) {
    for (std::size_t i = 0; i < simulation.clients(); ++i) {
        const client::Statistics& counts = simulation.client(i).replica().counts();
        EXPECT_EQ(counts.mismatches, 0u) << "client " << i;
        EXPECT_GT(counts.hashesCompared, 0u) << "client " << i;
    }
}

void endWell(Simulation& simulation) {
    simulation.weather = Weather{};
    simulation.disk.revive();
    EXPECT_TRUE(simulation.converge(20'000 * ms)) << "no agreement after the faults stopped";
    if (testing::Test::HasFatalFailure()) return;
    for (std::size_t i = 0; i < simulation.clients(); ++i) simulation.client(i).playing = false;
    simulation.run(3'000 * ms);
    for (std::size_t i = 0; i < simulation.clients(); ++i) {
        EXPECT_EQ(simulation.client(i).replica().pendingCommands(), 0u) << "client " << i;
    }
    expectNoMismatch(simulation);
    Executor two(2);
    simulation.checkAgainstJournal();
    simulation.checkAgainstJournal(&two);
}

TEST(Simulation, OnAFairDayAllClientsAgreeAtEveryTick) {
    forEachSeed("fair day", 2, [](std::uint64_t seed) {
        Simulation simulation(seed, playground());
        addPlayers(simulation, 4);
        simulation.addClient(protocol::Role::Spectator, client::makeIdleBot());
        simulation.run(8'000 * ms);
        addPlayers(simulation, 1);  // the late joiner
        simulation.run(4'000 * ms);
        endWell(simulation);
        for (std::size_t i = 0; i < 4; ++i) {
            const client::Statistics& counts = simulation.client(i).replica().counts();
            EXPECT_GT(counts.ticks, 600u);
            EXPECT_GT(counts.commandsSeen, 20u);
            EXPECT_EQ(counts.connections, 1u);
        }
    });
}

TEST(Simulation, BrokenConnectionsAndCorruptBytesLoseNothing) {
    forEachSeed("bad network", 4, [](std::uint64_t seed) {
        Simulation simulation(seed, playground());
        addPlayers(simulation, 4);
        simulation.weather.link = {40 * ms, 80 * ms, 2'000};
        simulation.weather.breakOnceIn = 1'500;
        simulation.run(15'000 * ms);
        EXPECT_GT(simulation.breaks(), 5u);
        endWell(simulation);
    });
}

TEST(Simulation, SlowReadersAreHeldUnderTheirBudgetAndComeBack) {
    forEachSeed("slow readers", 3, [](std::uint64_t seed) {
        server::Limits limits;
        limits.recentFrames = 300;
        Simulation simulation(seed, playground(), limits);
        addPlayers(simulation, 4);
        simulation.weather.pauseOnceIn = 1'500;
        simulation.weather.longestPause = 14'000 * ms;
        simulation.run(20'000 * ms);
        endWell(simulation);
    });
}

TEST(Simulation, AServerThatDiesBetweenWritesGoesOnFromItsJournal) {
    forEachSeed("dying server", 5, [](std::uint64_t seed) {
        server::Limits limits;
        limits.journalSnapshotTicks = 120;  // so that deaths meet snapshots too
        limits.segmentTicks = 240;
        Simulation simulation(seed, playground(), limits);
        addPlayers(simulation, 3);
        simulation.weather.dieOnceIn = 700;
        simulation.weather.powerOffOnceIn = 1'500;
        simulation.run(20'000 * ms);
        EXPECT_GT(simulation.crashes(), 3u);
        endWell(simulation);
    });
}

TEST(Simulation, EverythingAtOnce) {
    forEachSeed("everything", 6, [](std::uint64_t seed) {
        server::Limits limits;
        limits.journalSnapshotTicks = 120;
        limits.recentFrames = 600;
        Simulation simulation(seed, playground(), limits);
        addPlayers(simulation, 3);
        simulation.addClient(protocol::Role::Spectator, client::makeIdleBot());
        simulation.weather = {{30 * ms, 60 * ms, 3'000}, 2'500, 2'500, 5'000 * ms, 3'000, 3'000};
        simulation.run(10'000 * ms);
        addPlayers(simulation, 1);
        simulation.run(10'000 * ms);
        endWell(simulation);
    });
}

}  // namespace
}  // namespace huestep::test
