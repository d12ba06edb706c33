/// Keeps a failure so that anyone can play it again.
#pragma once

#include <cstdint>
#include <string>

#include "core/result.h"
#include "tools/stability/run.h"

namespace huestep::tools::stability {

struct Saved {
    std::string folder;
    std::string command;  ///< that plays it again
};

/// Refuses a folder that holds something already, and makes one that is not there.
Status prepareFolder(const std::string& path);

/// Plays the run once more, up to a second after it broke, and writes what it was into a folder
/// of its own under `parent`. Of Huestep that is a journal, as a session has: `scene.bin`, the
/// commands and motion root of every tick, the full roots and snapshots of tick 0 and of the tick
/// before it broke; `huestep replay`, `verify` and `diff` take the folder, `run` takes the scene.
/// Of a peer, whose state cannot be saved, it is the scene alone.
Result<Saved> saveFailure(const std::string& parent, const Setup& setup,
                          const Judgement& judgement);

/// The command that plays a run from its start without anything saved.
std::string commandFor(const Setup& setup);

}  // namespace huestep::tools::stability
