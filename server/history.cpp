#include "server/history.h"

#include <cassert>
#include <utility>

#include "core/state/hash.h"
#include "protocol/codec.h"

namespace huestep::server {

SharedSnapshot takeSnapshot(const World& world) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->tick = world.tick();
    snapshot->bytes = world.save();
    snapshot->hash = hash64(snapshot->bytes);
    return snapshot;
}

void FrameRing::push(protocol::Frame frame) {
    assert(m_entries.empty() || frame.tick == m_entries.back().frame.tick + 1);
    auto encoded =
        std::make_shared<const std::vector<std::byte>>(protocol::encode(protocol::Message{frame}));
    m_bytes += encoded->size();
    m_entries.push_back({std::move(frame), std::move(encoded)});
    while (m_entries.size() > m_most || (m_bytes > m_mostBytes && m_entries.size() > 1)) {
        m_bytes -= m_entries.front().encoded->size();
        m_entries.pop_front();
    }
}

const FrameRing::Entry* FrameRing::entry(std::uint64_t tick) const {
    if (m_entries.empty() || tick < oldest()) return nullptr;
    const std::uint64_t place = tick - oldest();
    return place < m_entries.size() ? &m_entries[static_cast<std::size_t>(place)] : nullptr;
}

const protocol::Frame* FrameRing::find(std::uint64_t tick) const {
    const Entry* found = entry(tick);
    return found ? &found->frame : nullptr;
}

SharedBytes FrameRing::encoded(std::uint64_t tick) const {
    const Entry* found = entry(tick);
    return found ? found->encoded : nullptr;
}

std::uint64_t FrameRing::oldest() const {
    return m_entries.empty() ? ~std::uint64_t{0} : m_entries.front().frame.tick;
}

void Keyframes::push(SharedSnapshot snapshot) {
    m_snapshots.push_back(std::move(snapshot));
    while (m_snapshots.size() > m_most) m_snapshots.pop_front();
}

SharedSnapshot Keyframes::before(std::uint64_t tick) const {
    for (auto it = m_snapshots.rbegin(); it != m_snapshots.rend(); ++it) {
        if ((*it)->tick <= tick) return *it;
    }
    return nullptr;
}

SharedSnapshot Keyframes::newest() const {
    return m_snapshots.empty() ? nullptr : m_snapshots.back();
}

Rebuilder::Answer Rebuilder::ask(std::uint64_t tick) {
    if (find(tick)) return Answer::Ready;
    for (const Job& job : m_waiting) {
        if (job.tick == tick) return Answer::Coming;
    }
    const SharedSnapshot base = m_keyframes.before(tick);
    const bool reachable =
        base && (base->tick == tick || (m_frames.find(base->tick) && m_frames.find(tick - 1)));
    if (!reachable || m_waiting.size() >= m_mostWaiting) return Answer::Gone;
    m_waiting.push_back({tick, std::nullopt});
    return Answer::Coming;
}

const World* Rebuilder::find(std::uint64_t tick) const {
    for (const World& world : m_done) {
        if (world.tick() == tick) return &world;
    }
    return nullptr;
}

bool Rebuilder::work(const StepResources& with) {
    if (m_waiting.empty()) return false;
    Job& job = m_waiting.front();
    if (!job.world) {
        const SharedSnapshot base = m_keyframes.before(job.tick);
        Result<World> restored =
            base ? World::restore(base->bytes) : Result<World>(Error{"no keyframe is that old"});
        if (!restored) {
            m_waiting.pop_front();
            return true;
        }
        job.world = std::move(*restored);
    } else if (const protocol::Frame* frame = m_frames.find(job.world->tick())) {
        job.world->step(frame->commands, with);
    } else {
        // The frames went out of the ring while this waited; whoever asked is told it is gone.
        m_waiting.pop_front();
        return true;
    }
    if (job.world->tick() == job.tick) {
        m_done.push_back(std::move(*job.world));
        if (m_done.size() > m_mostKept) m_done.pop_front();
        m_waiting.pop_front();
    }
    return true;
}

}  // namespace huestep::server
