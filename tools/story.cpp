#include "tools/story.h"

namespace huestep::tools {

std::string Way::sentence() const {
    std::string text = std::to_string(threads) + (threads == 1 ? " thread, " : " threads, ") +
                       std::string(nameOf(simd));
    if (restoreEvery != 0) text += ", restored every " + std::to_string(restoreEvery) + " ticks";
    if (disturbSeed != 0)
        text += ", accelerators dropped and blocks shuffled by seed " + std::to_string(disturbSeed);
    return text;
}

std::vector<Command> Story::commandsAt(std::uint64_t tick) const {
    std::vector<Command> all;
    if (script) all = script(tick);
    const auto found = commands.find(tick);
    if (found != commands.end()) all.insert(all.end(), found->second.begin(), found->second.end());
    return all;
}

Playback::Playback(const Story& story, const Way& way, Clock clock)
    : m_story(&story),
      m_way(way),
      m_world(*story.start),
      m_executor(std::make_unique<Executor>(way.threads, way.disturbSeed, clock)),
      m_resources{m_executor.get(), way.simd, clock},
      m_random(way.disturbSeed) {}

bool Playback::dropsNow() {
    if (m_way.disturbSeed == 0) return false;
    // 64-bit linear congruential generator (Knuth's MMIX constants); one tick in eight.
    m_random = m_random * 6364136223846793005u + 1442695040888963407u;
    return (m_random >> 61) == 0;
}

Status Playback::step() {
    if (dropsNow()) m_world.dropAccelerators();
    m_world.step(m_story->commandsAt(m_world.tick()), m_resources);
    if (m_way.restoreEvery == 0) return Done{};
    if ((m_world.tick() - m_story->start->tick()) % m_way.restoreEvery != 0) return Done{};
    Result<World> copy = World::restore(m_world.save());
    if (!copy)
        return Error{"the snapshot of tick " + std::to_string(m_world.tick()) +
                     " does not restore: " + copy.error().message};
    m_world = std::move(copy).value();
    return Done{};
}

Result<World> worldAt(const Story& story, const Way& way, std::uint64_t tick) {
    Playback playback(story, way);
    while (!playback.done() && playback.world().tick() < tick)
        if (const Status stepped = playback.step(); !stepped) return stepped.error();
    return playback.world();
}

}  // namespace huestep::tools
