// Clients that predict, in the simulation of the whole: delay, jitter, loss, breaks and deaths.
#include <gtest/gtest.h>

#include <cstdio>

#include "runs.h"
#include "simulation.h"

namespace huestep::test {
namespace {

client::PredictionRules rules(bool pushesGoOn = false) {
    client::PredictionRules out;
    if (pushesGoOn) out.guess = client::pushesGoOn(10);
    return out;
}

void addPredicting(Simulation& simulation, int count) {
    for (int i = 0; i < count; ++i) {
        simulation.addClient(protocol::Role::Player,
                             client::makeWanderBot(simulation.dice().roll()), rules(i % 2 == 1));
    }
}

const client::PredictionFigures figuresOf(Simulation& simulation, std::size_t place) {
    return *simulation.client(place).replica().statistics().prediction;
}

void print(Simulation& simulation, std::size_t place) {
    const client::PredictionFigures f = figuresOf(simulation, place);
    const client::Statistics s = simulation.client(place).replica().statistics();
    std::printf(
        "  client %zu: %llu ticks, lead %u, delay %u, round trip %.0f ms + %.0f; rollbacks %llu, "
        "depth mean %.1f max %u, again %llu, error mean %.3f max %.3f m, late %llu of %llu\n",
        place, static_cast<unsigned long long>(s.ticks), f.lead, f.inputDelay, 1e3 * f.roundTrip,
        1e3 * f.jitter, static_cast<unsigned long long>(f.rollbacks),
        f.rollbacks ? static_cast<double>(f.undone) / static_cast<double>(f.rollbacks) : 0.0,
        f.deepest, static_cast<unsigned long long>(f.again),
        f.rollbacks ? f.errorSum / static_cast<double>(f.rollbacks) : 0.0, f.errorMost,
        static_cast<unsigned long long>(f.late), static_cast<unsigned long long>(s.commandsSeen));
}

/// No fault any more: all agree, what was asked for counted once, corrections fade away.
void endWell(Simulation& simulation) {
    simulation.weather = Weather{};
    simulation.disk.revive();
    ASSERT_TRUE(simulation.converge(20'000 * ms)) << "no agreement after the faults stopped";
    for (std::size_t i = 0; i < simulation.clients(); ++i) simulation.client(i).playing = false;
    simulation.run(3'000 * ms);
    for (std::size_t i = 0; i < simulation.clients(); ++i) {
        SCOPED_TRACE("client " + std::to_string(i));
        const client::Replica& replica = simulation.client(i).replica();
        EXPECT_EQ(replica.counts().mismatches, 0u);
        EXPECT_GT(replica.counts().hashesCompared, 0u);
        EXPECT_EQ(replica.pendingCommands(), 0u);
        simulation.client(i).checkPrediction();
        if (!replica.prediction()) continue;
        print(simulation, i);
        EXPECT_LE(figuresOf(simulation, i).deepest, 60u);
        EXPECT_TRUE(replica.prediction()->smoothing().errors().empty()) << "nobody acts any more";
    }
    Executor two(2);
    simulation.checkAgainstJournal();
    simulation.checkAgainstJournal(&two);
}

TEST(SimulatedPrediction, OverAFairLineOwnCommandsAreInTimeAndTheWorldRunsARoundTripAhead) {
    forEachSeed("fair line", 2, [](std::uint64_t seed) {
        Simulation simulation(seed, playground());
        simulation.weather.link = {50 * ms, 0};
        addPredicting(simulation, 3);
        simulation.addClient(protocol::Role::Spectator, client::makeIdleBot(), rules());
        simulation.run(8'000 * ms);
        EXPECT_EQ(simulation.client(3).replica().prediction(), nullptr) << "a spectator";
        for (std::size_t i = 0; i < 3; ++i) {
            const client::PredictionFigures f = figuresOf(simulation, i);
            print(simulation, i);
            // 100 ms are six ticks; with what is to spare, and steps of 2 ms, one or two more.
            EXPECT_GE(f.lead, 6u);
            EXPECT_LE(f.lead, 8u);
            EXPECT_NEAR(f.roundTrip, 0.1, 0.01);
            EXPECT_EQ(f.late, 0u);
            EXPECT_GT(f.rollbacks, 10u) << "others act too";
            EXPECT_LE(f.deepest, 9u);
            // What was predicted and what was said agree: a command is seen when it was asked for.
            EXPECT_GT(simulation.client(i).replica().counts().commandsSeen, 50u);
        }
        endWell(simulation);
    });
}

TEST(SimulatedPrediction, AloneNothingIsEverSteppedTwice) {
    Simulation simulation(11, playground());
    simulation.weather.link = {80 * ms, 0};
    addPredicting(simulation, 1);
    simulation.run(2'000 * ms);
    const client::PredictionFigures before = figuresOf(simulation, 0);
    simulation.run(10'000 * ms);
    const client::PredictionFigures after = figuresOf(simulation, 0);
    print(simulation, 0);
    EXPECT_GT(after.predicted, before.predicted + 580);
    EXPECT_EQ(after.rollbacks, before.rollbacks);
    EXPECT_EQ(after.late, 0u);
    EXPECT_EQ(simulation.client(0).replica().counts().hashesCompared,
              simulation.client(0).replica().counts().ticks);
    endWell(simulation);
}

TEST(SimulatedPrediction, DelayJitterAndLossLoseNothing) {
    forEachSeed("jitter and loss", 2, [](std::uint64_t seed) {
        Simulation simulation(seed, playground());
        simulation.weather.link = {70 * ms, 50 * ms};
        simulation.weather.link.loseOnceIn = 20;
        addPredicting(simulation, 3);
        simulation.run(10'000 * ms);
        for (std::size_t i = 0; i < 3; ++i) {
            const client::PredictionFigures f = figuresOf(simulation, i);
            const client::Statistics s = simulation.client(i).replica().statistics();
            print(simulation, i);
            EXPECT_GT(f.rollbacks, 50u);
            EXPECT_GT(s.commandsSeen, 50u);
            EXPECT_LT(f.late, s.commandsSeen / 10) << "one of twenty is meant to be";
        }
        endWell(simulation);
    });
}

TEST(SimulatedPrediction, AWayOfOverASecondIsPredictedSixtyTicksAndNoMore) {
    Simulation simulation(5, playground());
    simulation.weather.link = {700 * ms, 100 * ms};
    addPredicting(simulation, 2);
    simulation.run(12'000 * ms);
    for (std::size_t i = 0; i < 2; ++i) {
        const client::PredictionFigures f = figuresOf(simulation, i);
        print(simulation, i);
        EXPECT_GE(f.deepest, 58u);
        EXPECT_LE(f.deepest, 60u);
        // What does not fit is felt: commands ask for the tick at which they can be there.
        EXPECT_LT(f.late, simulation.client(i).replica().counts().commandsSeen / 4);
    }
    endWell(simulation);
}

TEST(SimulatedPrediction, EverythingAtOnce) {
    forEachSeed("everything", 3, [](std::uint64_t seed) {
        server::Limits limits;
        limits.journalSnapshotTicks = 120;
        limits.recentFrames = 600;
        limits.maxInputDelay = 12;
        Simulation simulation(seed, playground(), limits);
        addPredicting(simulation, 3);
        simulation.addClient(protocol::Role::Player,
                             client::makeWanderBot(simulation.dice().roll()));
        simulation.weather = {
            {30 * ms, 60 * ms, 3'000, 50}, 2'500, 2'500, 5'000 * ms, 3'000, 3'000};
        simulation.run(10'000 * ms);
        addPredicting(simulation, 1);
        simulation.run(10'000 * ms);
        endWell(simulation);
    });
}

}  // namespace
}  // namespace huestep::test
