#include "server/command_queue.h"

#include <algorithm>
#include <utility>

#include "protocol/codec.h"

namespace huestep::server {

CommandQueue::Admission CommandQueue::push(Command command, std::uint64_t earliest,
                                           std::uint64_t lastSequence, bool late) {
    const std::uint64_t last = std::max(lastSequence, lastQueued(command.author));
    if (command.sequence <= last) return Admission::Old;
    const std::size_t bytes = protocol::commandBytes(command);
    const auto found = m_lines.find(command.author);
    if (found != m_lines.end() && (found->second.commands.size() >= m_limits.queuedPerPlayer ||
                                   found->second.bytes + bytes > m_limits.queuedBytesPerPlayer)) {
        return Admission::PlayerFull;
    }
    if (m_size >= m_limits.queuedInTotal || m_bytes + bytes > m_limits.queuedBytes) {
        return Admission::QueueFull;
    }
    Line& line = m_lines[command.author];
    line.commands.push_back({std::move(command), earliest, bytes, late});
    line.bytes += bytes;
    m_bytes += bytes;
    ++m_size;
    return Admission::Queued;
}

CommandQueue::Due CommandQueue::take(std::uint64_t tick, std::uint32_t most) {
    Due out;
    if (m_lines.empty()) return out;
    const std::size_t players = m_lines.size();
    std::size_t room = m_limits.frameCommandBytes;
    auto next = std::next(m_lines.begin(), static_cast<std::ptrdiff_t>(tick % players));
    for (std::size_t served = 0; served < players; ++served) {
        if (next == m_lines.end()) next = m_lines.begin();
        takeFrom(next->second, tick, most, room, out);
        next = next->second.commands.empty() ? m_lines.erase(next) : std::next(next);
    }
    std::sort(out.late.begin(), out.late.end());
    return out;
}

void CommandQueue::takeFrom(Line& line, std::uint64_t tick, std::uint32_t most, std::size_t& room,
                            Due& out) {
    bool late = false;
    for (std::uint32_t taken = 0; taken < m_limits.perPlayerPerFrame; ++taken) {
        if (line.commands.empty() || out.commands.size() >= most) return;
        Waiting& first = line.commands.front();
        if (first.earliest > tick || first.bytes > room) return;
        if (first.late && !std::exchange(late, true)) out.late.push_back(first.command.author);
        room -= first.bytes;
        line.bytes -= first.bytes;
        m_bytes -= first.bytes;
        --m_size;
        out.commands.push_back(std::move(first.command));
        line.commands.pop_front();
    }
}

std::uint64_t CommandQueue::lastQueued(PlayerId player) const {
    const auto found = m_lines.find(player);
    return found == m_lines.end() ? 0 : found->second.commands.back().command.sequence;
}

void CommandQueue::forget(PlayerId player) {
    const auto found = m_lines.find(player);
    if (found == m_lines.end()) return;
    m_size -= found->second.commands.size();
    m_bytes -= found->second.bytes;
    m_lines.erase(found);
}

}  // namespace huestep::server
