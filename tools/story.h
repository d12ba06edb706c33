/// Stories: a world at its start and everything that is done to it, tick by tick; and the ways to
/// play one. Whatever the way, the hashes must be the same (laws 2 and 3 of the design).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/world/world.h"

namespace huestep::tools {

/// A value: copying one copies the commands, not the world.
struct Story {
    std::string name;
    std::shared_ptr<const World> start;
    std::uint64_t end = 0;  ///< tick of the world after the last step
    std::map<std::uint64_t, std::vector<Command>> commands;  ///< by the tick they lead from
    /// What a scene's host does besides, in the step that leads from a tick; none: nothing.
    std::function<std::vector<Command>(std::uint64_t tick)> script;
    /// Place of the story, in the list it stands in, whose full roots it must have …
    std::size_t reference = 0;
    std::uint64_t comparedFrom = 0;  ///< … in this tick of the world and after
    std::map<std::uint64_t, std::uint64_t> motionRoots;  ///< recorded, by tick of the world
    std::map<std::uint64_t, std::uint64_t> fullRoots;    ///< recorded, by tick of the world

    /// All that is done in the step that leads from a tick.
    [[nodiscard]] std::vector<Command> commandsAt(std::uint64_t tick) const;
    [[nodiscard]] std::uint64_t steps() const { return end - start->tick(); }
};

/// With what, and with what disturbances, a story is played.
struct Way {
    int threads = 1;
    Simd simd = Simd::Auto;
    std::uint64_t restoreEvery = 0;  ///< ticks; saved and restored after each; 0: never
    std::uint64_t disturbSeed = 0;  ///< ≠ 0: blocks shuffled, accelerators dropped at random ticks

    [[nodiscard]] std::string sentence() const;  ///< "2 threads, avx2, restored every 37 ticks"
};

/// A story on its way. Thread rule: one caller.
class Playback {
 public:
    /// Keeps a reference to the story.
    Playback(const Story& story, const Way& way, Clock clock = nullptr);

    [[nodiscard]] bool done() const { return m_world.tick() >= m_story->end; }
    /// One step; fails only if a snapshot of the world does not restore.
    Status step();
    [[nodiscard]] const World& world() const { return m_world; }

 private:
    bool dropsNow();
    const Story* m_story;
    Way m_way;
    World m_world;
    std::unique_ptr<Executor> m_executor;
    StepResources m_resources;
    std::uint64_t m_random;
};

/// The world of a story at a tick, played in a way.
Result<World> worldAt(const Story& story, const Way& way, std::uint64_t tick);

}  // namespace huestep::tools
