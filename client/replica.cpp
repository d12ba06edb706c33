#include "client/replica.h"

#include <algorithm>
#include <utility>

#include "core/state/hash.h"
#include "protocol/codec.h"
#include "protocol/fingerprint.h"
#include "protocol/frame.h"

namespace huestep::client {

using protocol::ByeReason;

namespace {

std::string shortened(const std::string& text) {
    return text.substr(0, protocol::maxReportText);
}

}  // namespace

Replica::Replica(ReplicaConfig config) : m_config(std::move(config)) {
    // Whoever watches has nothing to see at once.
    const bool predicts = m_config.prediction && m_config.role == protocol::Role::Player;
    if (predicts) m_prediction.emplace(std::move(*m_config.prediction));
}

void Replica::connected(Instant) {
    m_state = State::Greeting;
    m_outgoing.clear();
    m_incoming.reset();
    m_frozen.reset();
    m_bye.reset();
    protocol::Hello hello;
    hello.fingerprint = m_config.fingerprint;
    hello.rules = protocol::builtInRulesMarks();
    hello.session = m_config.session;
    hello.role = m_config.role;
    hello.resume = m_token;
    hello.ticket = m_config.ticket;
    if (m_timeline) {
        hello.haveTick = m_timeline->confirmed();
        hello.haveHash = m_timeline->confirmedRoot();
    }
    send(std::move(hello));
}

void Replica::disconnected() {
    m_state = State::Apart;
    m_outgoing.clear();
    m_incoming.reset();
}

Status Replica::receive(protocol::Message message, Instant now) {
    using namespace protocol;
    if (m_state == State::Apart) return Done{};
    if (const auto* bye = std::get_if<Bye>(&message)) return on(*bye);
    if (const auto* ping = std::get_if<Ping>(&message)) return on(*ping, now);
    if (m_state == State::Greeting) {
        if (const auto* welcome = std::get_if<Welcome>(&message)) return on(*welcome, now);
        return refuse(ByeReason::UnexpectedMessage, "the server's first message is no Welcome");
    }
    if (const auto* frame = std::get_if<Frame>(&message)) return on(*frame, now);
    if (const auto* begin = std::get_if<SnapshotBegin>(&message)) return on(*begin);
    if (auto* chunk = std::get_if<SnapshotChunk>(&message)) return on(std::move(*chunk));
    if (const auto* end = std::get_if<SnapshotEnd>(&message)) return on(*end);
    if (const auto* nodes = std::get_if<HashNodes>(&message)) return on(*nodes);
    return refuse(ByeReason::UnexpectedMessage, "a message that no server sends here");
}

Status Replica::refuse(ByeReason reason, std::string sentence) {
    m_outgoing.clear();
    send(protocol::Bye{reason, sentence.substr(0, protocol::maxByeText), true});
    m_state = State::Apart;
    return Error{std::move(sentence)};
}

Status Replica::on(const protocol::Welcome& welcome, Instant now) {
    ++m_statistics.connections;
    const bool sameSeat = m_token.has_value() && welcome.player == m_statistics.player;
    if (sameSeat) ++m_statistics.resumes;
    // A server that started again may be behind, but never below what it said is on disk.
    if (welcome.tick < m_committed) {
        m_statistics.committedLost += m_committed - welcome.tick;
        m_committed = welcome.tick;
    }
    m_statistics.player = welcome.player;
    m_token.reset();
    if (welcome.player != 0) m_token = welcome.resume;
    m_ticksPerSecond = welcome.ticksPerSecond;
    // The tail of frames, or a snapshot: the server's next message says which.
    m_state = m_timeline ? State::Following : State::Waiting;
    m_commands.welcomed(welcome, sameSeat, m_statistics);
    if (m_prediction) m_prediction->welcomed(welcome, now);
    return Done{};
}

// Frames -----------------------------------------------------------------------------------------

Status Replica::on(const protocol::Frame& frame, Instant now) {
    if (m_state != State::Following) return Done{};  // a snapshot comes, and its own tail
    if (frame.tick != m_timeline->confirmed()) {
        return refuse(ByeReason::UnexpectedMessage,
                      "frame of tick " + std::to_string(frame.tick) + " where tick " +
                          std::to_string(m_timeline->confirmed()) + " is next");
    }
    ++m_statistics.hashesCompared;
    if (frame.previousRoot != m_timeline->confirmedRoot()) {
        diverged(frame);
        return Done{};
    }
    if (m_prediction) {
        m_prediction->confirm(*m_timeline, frame, m_config.resources);
    } else {
        m_timeline->confirm(frame.commands, m_config.resources);
    }
    ++m_statistics.ticks;
    m_commands.applied(frame, m_timeline->outcomes(), now, m_statistics);
    noteCommitted(frame.committed);
    const auto patience = static_cast<std::uint64_t>(std::max(m_ticksPerSecond, 1.0f));
    m_commands.repeatOldest(m_timeline->confirmed(), patience, m_outgoing, m_statistics);
    if (m_timeline->confirmed() >= m_lastCheckpoint + m_config.checkpointEvery) {
        m_lastCheckpoint = m_timeline->confirmed();
        protocol::Intent intent;
        intent.checkpoint =
            protocol::Checkpoint{m_timeline->confirmed(), m_timeline->confirmedRoot()};
        send(std::move(intent));
    }
    return Done{};
}

void Replica::diverged(const protocol::Frame& frame) {
    m_timeline->retreat();  // to the tick that differs
    ++m_statistics.mismatches;
    protocol::DesyncReport report;
    report.tick = frame.tick;
    report.mine = m_timeline->confirmedRoot();
    report.yours = frame.previousRoot;
    m_frozen = std::move(report);
    m_state = State::Waiting;
    send(protocol::HashQuery{frame.tick});
    send(protocol::SnapshotRequest{frame.tick});
}

Status Replica::on(const protocol::HashNodes& nodes) {
    if (!m_frozen || nodes.tick != m_frozen->tick || m_frozen->body != 0) return Done{};
    // The first block that differs bounds the search; the snapshot will name body and field. Until
    // then, or if the server no longer has this tick, the block's first body stands in.
    const std::vector<std::uint64_t> mine = m_timeline->world().motionLeaves();
    for (std::size_t i = 0; i < nodes.leaves.size(); ++i) {
        const std::size_t block = nodes.first + i;
        if (block < mine.size() && mine[block] == nodes.leaves[i]) continue;
        const std::size_t place = block * 64;
        if (place < m_timeline->world().bodies().size())
            m_frozen->body = m_timeline->world().bodies()[place].id;
        m_frozen->field = "block " + std::to_string(block) + " of 64 bodies";
        return Done{};
    }
    return Done{};
}

void Replica::noteCommitted(std::uint64_t committed) {
    m_committed = std::max(m_committed, committed);
    m_commands.committed(m_committed);
}

// Snapshots --------------------------------------------------------------------------------------

Status Replica::on(const protocol::SnapshotBegin& begin) {
    if (begin.bytes == 0 || begin.bytes > protocol::maxSnapshotBytes) {
        return refuse(ByeReason::BadMessage, "a snapshot of " + std::to_string(begin.bytes) +
                                                 " bytes, at most " +
                                                 std::to_string(protocol::maxSnapshotBytes));
    }
    m_state = State::Waiting;
    m_incoming = Incoming{begin, {}};
    return Done{};
}

Status Replica::on(protocol::SnapshotChunk chunk) {
    if (!m_incoming) {
        return refuse(ByeReason::UnexpectedMessage, "a piece of no snapshot");
    }
    std::vector<std::byte>& bytes = m_incoming->bytes;
    if (chunk.offset != bytes.size() ||
        chunk.data.size() > m_incoming->begin.bytes - bytes.size()) {
        return refuse(ByeReason::BadMessage, "a piece of a snapshot at byte " +
                                                 std::to_string(chunk.offset) + " where byte " +
                                                 std::to_string(bytes.size()) + " is next");
    }
    bytes.insert(bytes.end(), chunk.data.begin(), chunk.data.end());
    return Done{};
}

Status Replica::on(const protocol::SnapshotEnd& end) {
    if (!m_incoming || end.tick != m_incoming->begin.tick) {
        return refuse(ByeReason::UnexpectedMessage, "the end of no snapshot");
    }
    const Incoming incoming = std::move(*m_incoming);
    m_incoming.reset();
    if (incoming.bytes.size() != incoming.begin.bytes ||
        hash64(incoming.bytes) != incoming.begin.hash) {
        return refuse(ByeReason::BadMessage, "a snapshot that is not the one announced");
    }
    Result<World> theirs = World::restore(incoming.bytes);
    if (!theirs) return refuse(ByeReason::BadMessage, "snapshot: " + theirs.error().message);
    if (theirs->tick() != end.tick) {
        return refuse(ByeReason::BadMessage, "a snapshot of another tick than announced");
    }
    if (m_frozen) reportDifference(*theirs);
    adopt(std::move(*theirs));
    return Done{};
}

void Replica::reportDifference(const World& theirs) {
    protocol::DesyncReport report = std::move(*m_frozen);
    m_frozen.reset();
    if (theirs.tick() == report.tick) {
        const std::optional<Difference> difference = firstDifference(m_timeline->world(), theirs);
        if (difference) {
            report.body = difference->body;
            // A body's own fields go by their names; others say what of the body's it is.
            const bool own = difference->record == "body" || difference->record == "motion";
            report.field =
                shortened(own ? difference->field : difference->name + " " + difference->field);
            report.here = shortened(difference->left);
            report.there = shortened(difference->right);
        } else {
            report.field = "none: the snapshot equals this world";
        }
    }
    ++m_statistics.corrections;
    m_statistics.lastDesync = report;
    send(std::move(report));
}

void Replica::adopt(World world) {
    if (m_timeline && world.tick() < m_timeline->confirmed()) {
        m_statistics.rolledBack += m_timeline->confirmed() - world.tick();
    }
    m_timeline.emplace(std::move(world));
    if (m_prediction) m_prediction->adopted();
    m_lastCheckpoint = m_timeline->confirmed();
    m_commands.adopted(m_timeline->world(), m_statistics);
    ++m_statistics.snapshots;
    m_state = State::Following;
}

// Play -------------------------------------------------------------------------------------------

Status Replica::act(Action action, Instant now) {
    if (m_state != State::Following || m_statistics.player == 0) {
        return Error{"this client does not play now"};
    }
    const std::uint64_t tick =
        m_prediction ? m_prediction->pacer().commandTick(m_timeline->head()) : 0;
    return m_commands.ask(std::move(action), tick, now, m_statistics);
}

void Replica::advance(Instant now) {
    if (!m_prediction || m_state != State::Following || m_statistics.player == 0) return;
    if (const std::optional<protocol::Ping> ping = m_prediction->pacer().ask(now)) send(*ping);
    m_prediction->advance(*m_timeline, m_commands, m_statistics.player, now, m_config.resources);
}

void Replica::leave() {
    if (m_state == State::Apart) return;
    flush();
    send(protocol::Bye{ByeReason::Done, "leaves", false});
    m_token.reset();
    m_state = State::Apart;
}

void Replica::flush() {
    if (m_state == State::Following || m_state == State::Waiting) m_commands.send(m_outgoing);
}

std::vector<protocol::Message> Replica::takeOutgoing() {
    flush();
    return std::exchange(m_outgoing, {});
}

Status Replica::on(const protocol::Ping& ping, Instant now) {
    if (!ping.reply) send(protocol::Ping{ping.nonce, true});
    if (ping.reply && m_prediction) m_prediction->pacer().answered(ping, now);
    return Done{};
}

Status Replica::on(const protocol::Bye& bye) {
    m_bye = bye;
    if (bye.reason == ByeReason::ResumeRefused) m_token.reset();
    m_state = State::Apart;
    m_outgoing.clear();
    return Done{};
}

Statistics Replica::statistics() const {
    Statistics out = m_statistics;
    if (m_timeline) {
        out.tick = m_timeline->confirmed();
        out.root = m_timeline->confirmedRoot();
        out.score = m_timeline->world().score();
    }
    if (m_prediction) out.prediction = m_prediction->figures(m_timeline ? &*m_timeline : nullptr);
    m_commands.describe(out);
    return out;
}

}  // namespace huestep::client
