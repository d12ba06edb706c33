#include "server/command_queue.h"

#include <algorithm>
#include <utility>

namespace huestep::server {

CommandQueue::Admission CommandQueue::push(Command command, std::uint64_t earliest,
                                           std::uint64_t lastSequence) {
    const std::uint64_t last = std::max(lastSequence, lastQueued(command.author));
    if (command.sequence <= last) return Admission::Old;
    const auto found = m_waiting.find(command.author);
    if (found != m_waiting.end() && found->second.size() >= m_perPlayer) {
        return Admission::PlayerFull;
    }
    if (m_size >= m_total) return Admission::QueueFull;
    m_waiting[command.author].push_back({std::move(command), earliest});
    ++m_size;
    return Admission::Queued;
}

std::vector<Command> CommandQueue::take(std::uint64_t tick, std::uint32_t perPlayer,
                                        std::uint32_t total) {
    std::vector<Command> out;
    if (m_waiting.empty()) return out;
    const std::size_t players = m_waiting.size();
    auto next = std::next(m_waiting.begin(), static_cast<std::ptrdiff_t>(tick % players));
    for (std::size_t served = 0; served < players && out.size() < total; ++served) {
        if (next == m_waiting.end()) next = m_waiting.begin();
        std::deque<Waiting>& waiting = next->second;
        for (std::uint32_t taken = 0; taken < perPlayer && out.size() < total; ++taken) {
            if (waiting.empty() || waiting.front().earliest > tick) break;
            out.push_back(std::move(waiting.front().command));
            waiting.pop_front();
        }
        next = waiting.empty() ? m_waiting.erase(next) : std::next(next);
    }
    m_size -= out.size();
    return out;
}

std::uint64_t CommandQueue::lastQueued(PlayerId player) const {
    const auto found = m_waiting.find(player);
    return found == m_waiting.end() ? 0 : found->second.back().command.sequence;
}

void CommandQueue::forget(PlayerId player) {
    const auto found = m_waiting.find(player);
    if (found == m_waiting.end()) return;
    m_size -= found->second.size();
    m_waiting.erase(found);
}

}  // namespace huestep::server
