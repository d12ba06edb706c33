#include "client/replica.h"

#include <algorithm>
#include <utility>

#include "core/state/hash.h"
#include "protocol/codec.h"
#include "protocol/frame.h"

namespace huestep::client {

using protocol::ByeReason;

namespace {

std::string shortened(const std::string& text) {
    return text.substr(0, protocol::maxReportText);
}

}  // namespace

Replica::Replica(ReplicaConfig config) : m_config(std::move(config)) {}

void Replica::connected(Instant) {
    m_state = State::Greeting;
    m_outgoing.clear();
    m_incoming.reset();
    m_frozen.reset();
    m_bye.reset();
    protocol::Hello hello;
    hello.fingerprint = m_config.fingerprint;
    hello.session = m_config.session;
    hello.role = m_config.role;
    hello.resume = m_token;
    if (m_world) {
        hello.haveTick = m_world->tick();
        hello.haveHash = m_world->motionRoot();
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
    if (const auto* ping = std::get_if<Ping>(&message)) return on(*ping);
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

Status Replica::on(const protocol::Welcome& welcome, Instant) {
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
    m_state = m_world ? State::Following : State::Waiting;
    m_commands.welcomed(welcome, sameSeat, m_statistics);
    return Done{};
}

// Frames -----------------------------------------------------------------------------------------

Status Replica::on(const protocol::Frame& frame, Instant now) {
    if (m_state != State::Following) return Done{};  // a snapshot comes, and its own tail
    if (frame.tick != m_world->tick()) {
        return refuse(ByeReason::UnexpectedMessage,
                      "frame of tick " + std::to_string(frame.tick) + " where tick " +
                          std::to_string(m_world->tick()) + " is next");
    }
    ++m_statistics.hashesCompared;
    if (frame.previousRoot != m_world->motionRoot()) {
        diverged(frame);
        return Done{};
    }
    m_world->step(frame.commands, m_config.resources);
    ++m_statistics.ticks;
    m_commands.applied(frame, m_world->events().commands, now, m_statistics);
    noteCommitted(frame.committed);
    const auto patience = static_cast<std::uint64_t>(std::max(m_ticksPerSecond, 1.0f));
    m_commands.repeatOldest(m_world->tick(), patience, m_outgoing, m_statistics);
    if (m_world->tick() >= m_lastCheckpoint + m_config.checkpointEvery) {
        m_lastCheckpoint = m_world->tick();
        protocol::Intent intent;
        intent.checkpoint = protocol::Checkpoint{m_world->tick(), m_world->motionRoot()};
        send(std::move(intent));
    }
    return Done{};
}

void Replica::diverged(const protocol::Frame& frame) {
    ++m_statistics.mismatches;
    protocol::DesyncReport report;
    report.tick = frame.tick;
    report.mine = m_world->motionRoot();
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
    const std::vector<std::uint64_t> mine = m_world->motionLeaves();
    for (std::size_t i = 0; i < nodes.leaves.size(); ++i) {
        const std::size_t block = nodes.first + i;
        if (block < mine.size() && mine[block] == nodes.leaves[i]) continue;
        const std::size_t place = block * 64;
        if (place < m_world->bodies().size()) m_frozen->body = m_world->bodies()[place].id;
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
        const std::optional<Difference> difference = firstDifference(*m_world, theirs);
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
    if (m_world && world.tick() < m_world->tick()) {
        m_statistics.rolledBack += m_world->tick() - world.tick();
    }
    m_world = std::move(world);
    m_lastCheckpoint = m_world->tick();
    m_commands.adopted(*m_world, m_statistics);
    ++m_statistics.snapshots;
    m_state = State::Following;
}

// Play -------------------------------------------------------------------------------------------

Status Replica::act(Action action, Instant now) {
    if (m_state != State::Following || m_statistics.player == 0) {
        return Error{"this client does not play now"};
    }
    return m_commands.ask(std::move(action), now, m_statistics);
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

Status Replica::on(const protocol::Ping& ping) {
    if (!ping.reply) send(protocol::Ping{ping.nonce, true});
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
    if (m_world) {
        out.tick = m_world->tick();
        out.root = m_world->motionRoot();
    }
    m_commands.describe(out);
    return out;
}

}  // namespace huestep::client
