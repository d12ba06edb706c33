/// The runs whose hashes are kept in goldens.txt, for the programs of this machine and as
/// WebAssembly: nothing of a test's library is used here.
#pragma once

#include "tests/determinism/commands.h"
#include "tests/determinism/games.h"
#include "tests/determinism/script.h"

namespace huestep::test {

struct GoldenRun {
    std::string scene;
    std::string guards;  ///< why this golden exists
    std::vector<std::uint64_t> ticks;
    std::uint64_t debugTicks;  ///< where it is slow it stops here, at ticks of the others
    CommandsOf commandsOf = silence;
    bool watchSleep = false;  ///< the tick in which everything is asleep is golden too
};

inline std::vector<GoldenRun> goldenRuns() {
    return {
        {"pyramid:base=20", "one small island of contacts alone", {0, 1, 60, 240}, 240},
        {"pyramid:base=34",
         "one island above a batch: colours across threads, barriers",
         {1, 40, 120},
         40},
        {"many_pyramids:rows=5,columns=5,base=8",
         "many equal islands packed into batches",
         {1, 40, 120},
         40},
        {"joint_grid:n=20", "joints alone", {1, 60, 240}, 240},
        {"joint_grid:n=30", "joints alone, one giant island", {1, 40, 120}, 40},
        {"tumbler:count=24", "contacts that come and go, a motor", {1, 60, 120, 200}, 60},
        {"spinner:bodies=1000",
         "blows of a motor without bound, every shape in a room of one chain",
         {1, 60, 120, 240},
         60},
        {"washer:count=24",
         "a kinematic hub that turns and drifts, small boxes",
         {1, 60, 120, 240},
         60},
        {"smash:columns=24,rows=20",
         "sleepers that are woken, one island that grows",
         {1, 75, 120, 200},
         75},
        {"compounds:columns=6,rows=24",
         "two triangles a body, a ground of hundreds of shapes",
         {1, 60, 120, 240},
         60},
        {"junkyard:columns=200,rows=2",
         "a kinematic body that its host gives a target every tick",
         {1, 120, 240, 400},
         120,
         hostOf("junkyard:columns=200,rows=2")},
        {"rain:floors=2,columns=6,group=3,period=60",
         "bodies and joints that its host spawns and removes; limits, springs and brakes",
         {1, 60, 240, 420},
         60,
         hostOf("rain:floors=2,columns=6,group=3,period=60")},
        {"small", "a scene below every threshold; falls asleep", {1, 60, 240, 600}, 600},
        {"hinges",
         "contacts, limits, springs; the tick at which all sleep",
         {1, 60, 240, 600},
         600,
         silence,
         true},
        {"joints", "welds and slides with every part", {0, 1, 60, 240, 600}, 600},
        {"mixed", "every shape, joint, filter and kind of body", {0, 1, 60, 240, 600}, 600},
        {"terrain", "every shape on chains, open and closed", {0, 1, 60, 240, 600}, 600},
        {"sandbox",
         "players who join, push, grab, spawn, remove and leave",
         {1, 60, 240, 420},
         240,
         playersScript},
        {"ball:goals=2,length=12,width=8",
         "rules: kick-offs, kicks, goals, dice; players who join and leave",
         {1, 90, 240, 420},
         240,
         ballScript},
        {"building:budget=6",
         "rules: pieces that players put there and that go, dice",
         {1, 60, 240, 420},
         240,
         buildingScript},
    };
}

inline bool allAsleep(const World& world) {
    for (std::size_t i = 0; i < world.bodies().size(); ++i) {
        if (world.bodies()[i].dynamic() && !world.motions()[i].asleep()) return false;
    }
    return true;
}

}  // namespace huestep::test
