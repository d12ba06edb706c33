/// One run of a scene of the suite in one configuration, judged; and the same run in other ways,
/// whose hashes must be the same.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/scene/script.h"
#include "tools/stability/judge.h"
#include "tools/stability/rows.h"
#include "tools/stability/suite.h"

namespace huestep::tools::stability {

/// What is run: a placed scene, ready for an engine, and what its host does.
struct Setup {
    Trial trial;
    std::string text;  ///< as `huestep run` takes it
    Scene scene;       ///< with the configuration's method and substeps
    Script script;
    Placement placement;
    StabilityConfiguration configuration;
    std::uint64_t ticks = 0;
};

/// Fails for an unknown method or a wrong scene. `trial.substeps` goes before the configuration's.
Result<Setup> setUp(const Trial& trial, const Placing& placing,
                    const StabilityConfiguration& configuration);

/// Whether the engine takes a method and substeps of ours.
bool isHuestep(const StabilityConfiguration& configuration);

/// Called after every tick; whether to go on.
using Tick = std::function<bool()>;

struct RunOptions {
    int threads = 1;
    bool untilBroken = false;     ///< whether a pass is all that is asked for
    std::uint64_t hashTicks = 0;  ///< keep the motion root after each of the first so many ticks
    Tick onTick;
};

struct RunOutcome {
    Judgement judgement;
    std::vector<std::uint64_t> roots;  ///< place i: after tick i + 1
    std::uint64_t fullRoot = 0;        ///< after the last of these; Huestep's
    bool finished = true;              ///< false: `onTick` said to stop
};

/// Fails where the engine cannot have the scene.
Result<RunOutcome> runOnce(const Setup& setup, const RunOptions& options);

/// The same, and where the trial compares with key order, that run before it: the value is the
/// ratio of both then. A reference that breaks a rule, is not finite or measures nothing compares
/// with nothing: the run is not taken and has failed.
Result<RunOutcome> runAsAsked(const Setup& setup, const RunOptions& options);

/// What the comparison of hashes came to.
struct HashesCompared {
    bool equal = true;
    std::string said;  ///< what was compared, or what differs
    bool finished = true;
};

/// Plays the first ticks of a run of Huestep, as many as the outcome has roots, on two threads with
/// scalar lanes and restored from a snapshot half way, and on three with the widest; every motion
/// root and the last full root must be those of the run.
Result<HashesCompared> compareHashes(const Setup& setup, const RunOutcome& run, const Tick& onTick);

}  // namespace huestep::tools::stability
