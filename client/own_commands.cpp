#include "client/own_commands.h"

#include <algorithm>
#include <string>
#include <utility>

#include "protocol/codec.h"
#include "protocol/frame.h"

namespace huestep::client {

namespace {

constexpr std::size_t keptLatencies = 4'096;

}  // namespace

void OwnCommands::welcomed(const protocol::Welcome& welcome, bool sameSeat, Statistics& counts) {
    m_player = welcome.player;
    m_maxCommandsPerIntent = std::max(welcome.maxCommandsPerIntent, 1u);
    m_maxQueuedCommands = welcome.maxQueuedCommands;
    m_maxQueuedBytes = welcome.maxQueuedBytes;
    if (sameSeat) return resend(welcome.lastSequence, counts);
    m_pending.clear();
    m_nextSequence = welcome.lastSequence + 1;
}

void OwnCommands::resend(std::uint64_t lastSequence, Statistics& counts) {
    for (Pending& pending : m_pending) {
        if (pending.command.sequence <= lastSequence) continue;
        pending.seenAt.reset();
        pending.tick = 0;  // long past, or not of this start of the server
        if (std::exchange(pending.sent, false)) ++counts.commandsResent;
    }
    m_nextSequence = std::max(m_nextSequence, lastSequence + 1);
}

Status OwnCommands::ask(Action action, std::uint64_t tick, Instant now, Statistics& counts) {
    if (m_pending.size() >= maxPendingCommands) {
        return Error{std::to_string(m_pending.size()) + " own commands wait for their commit"};
    }
    Command command{m_player, m_nextSequence, std::move(action)};
    // Whoever decodes it judges it: what the server would end the connection for stays here.
    const Result<protocol::Message> taken =
        protocol::readFrame(protocol::encode(protocol::Intent{{command}, std::nullopt}));
    if (!taken) return Error{"a command that cannot be sent: " + taken.error().message};
    const std::size_t bytes = protocol::commandBytes(command);
    if (bytes > m_maxQueuedBytes) {
        return Error{"a command of " + std::to_string(bytes) + " bytes; the server keeps at most " +
                     std::to_string(m_maxQueuedBytes)};
    }
    ++m_nextSequence;
    // The server keeps the order of a player's commands, so it would hold this one back too.
    if (tick != 0 && !m_pending.empty()) tick = std::max(tick, m_pending.back().tick);
    m_pending.push_back({std::move(command), tick, now, bytes, std::nullopt});
    ++counts.commandsSent;
    return Done{};
}

void OwnCommands::send(std::vector<protocol::Message>& out) {
    if (m_pending.empty() || m_pending.back().sent) return;
    // As many to a message as Welcome allows and as the payload's cap holds, and in all no more
    // than may wait at the server: what no frame has shown may be waiting there. The rest goes out
    // as frames come.
    const std::size_t room = protocol::maxPayload(protocol::MessageType::Intent) - 128;
    protocol::Intent intent;
    std::size_t bytes = 0;
    std::size_t underWay = 0;
    std::size_t underWayBytes = 0;
    for (Pending& pending : m_pending) {
        if (pending.seenAt) continue;
        underWay += 1;
        underWayBytes += pending.bytes;
        if (underWay > m_maxQueuedCommands || underWayBytes > m_maxQueuedBytes) break;
        if (std::exchange(pending.sent, true)) continue;
        if (!intent.commands.empty() &&
            (intent.commands.size() == m_maxCommandsPerIntent || intent.tick != pending.tick ||
             bytes + pending.bytes > room)) {
            out.emplace_back(std::exchange(intent, {}));
            bytes = 0;
        }
        bytes += pending.bytes;
        intent.tick = pending.tick;
        intent.commands.push_back(pending.command);
    }
    if (!intent.commands.empty()) out.emplace_back(std::move(intent));
}

void OwnCommands::expected(std::uint64_t tick, bool next, std::vector<Command>& out) const {
    for (const Pending& pending : m_pending) {
        if (pending.seenAt || pending.tick == 0) continue;
        const bool due = pending.tick == tick || (next && pending.tick < tick);
        if (due) out.push_back(pending.command);
    }
}

void OwnCommands::applied(const protocol::Frame& frame, std::span<const CommandOutcome> outcomes,
                          Instant now, Statistics& counts) {
    if (m_player == 0) return;
    for (const Command& command : frame.commands) {
        if (command.author != m_player) continue;
        passedOver(command.sequence, frame.tick, counts);
        seen(command.sequence, frame.tick, now, counts);
    }
    for (const CommandOutcome& outcome : outcomes) {
        if (outcome.author == m_player && outcome.reason != Rejection::None) {
            ++counts.commandsRejected;
        }
    }
}

void OwnCommands::seen(std::uint64_t sequence, std::uint64_t tick, Instant now,
                       Statistics& counts) {
    const auto pending = std::find_if(m_pending.begin(), m_pending.end(), [&](const Pending& p) {
        return p.command.sequence == sequence;
    });
    if (pending == m_pending.end() || pending->seenAt) return;
    pending->seenAt = tick;
    m_movedAt = tick;
    if (std::exchange(pending->counted, true)) return;
    ++counts.commandsSeen;
    noteLatency(static_cast<double>(now - pending->given) * 1e-9);
}

void OwnCommands::noteLatency(double seconds) {
    if (m_latencies.size() < keptLatencies) {
        m_latencies.push_back(seconds);
    } else {
        m_latencies[m_latencyAt++ % keptLatencies] = seconds;
    }
}

void OwnCommands::passedOver(std::uint64_t sequence, std::uint64_t tick, Statistics& counts) {
    // Sequences rise, so what the server let go of can never count any more.
    for (Pending& pending : m_pending) {
        if (pending.command.sequence >= sequence) return;
        if (pending.seenAt) continue;
        pending.seenAt = tick;
        if (!std::exchange(pending.counted, true)) ++counts.commandsLost;
    }
}

void OwnCommands::adopted(const World& world, Statistics& counts) {
    m_movedAt = world.tick();
    // Frames before a snapshot may never have come here; its record of this player tells which
    // commands they had. Frames after it come again, with the commands they had.
    std::uint64_t ordered = 0;
    for (const PlayerRecord& player : world.players()) {
        if (player.id == m_player && player.id != 0) ordered = player.lastSequence;
    }
    for (Pending& pending : m_pending) {
        if (pending.seenAt && *pending.seenAt >= world.tick()) pending.seenAt.reset();
        if (pending.seenAt || pending.command.sequence > ordered) continue;
        pending.seenAt = world.tick() - 1;
        if (!std::exchange(pending.counted, true)) ++counts.commandsSeen;
    }
}

void OwnCommands::committed(std::uint64_t below) {
    while (!m_pending.empty() && m_pending.front().seenAt && *m_pending.front().seenAt < below) {
        m_pending.pop_front();
    }
}

void OwnCommands::repeatOldest(std::uint64_t tick, std::uint64_t patience,
                               std::vector<protocol::Message>& out, Statistics& counts) {
    const auto oldest = std::find_if(m_pending.begin(), m_pending.end(),
                                     [](const Pending& pending) { return !pending.seenAt; });
    const bool underWay = oldest != m_pending.end() && oldest->sent;
    if (underWay && tick < m_movedAt + patience) return;
    m_movedAt = tick;
    if (!underWay) return;
    out.emplace_back(protocol::Intent{{oldest->command}, std::nullopt, oldest->tick});
    ++counts.commandsResent;
}

void OwnCommands::describe(Statistics& counts) const {
    std::vector<double> sorted = m_latencies;
    std::sort(sorted.begin(), sorted.end());
    if (sorted.empty()) return;
    counts.latencyMedian = sorted[sorted.size() / 2];
    counts.latencyP99 = sorted[std::min(sorted.size() - 1, sorted.size() * 99 / 100)];
}

}  // namespace huestep::client
