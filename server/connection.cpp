#include "server/connection.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/rules/rules.h"
#include "protocol/codec.h"
#include "protocol/fingerprint.h"
#include "protocol/plain_text.h"

namespace huestep::server {

using protocol::ByeReason;

void count(Counters& counters, TicketDesk::Verdict verdict) {
    switch (verdict) {
        case TicketDesk::Verdict::Taken:
            ++counters.ticketsTaken;
            break;
        case TicketDesk::Verdict::Missing:
            ++counters.ticketsMissing;
            break;
        case TicketDesk::Verdict::Forged:
            ++counters.ticketsForged;
            break;
        case TicketDesk::Verdict::Misplaced:
            ++counters.ticketsMisplaced;
            break;
        case TicketDesk::Verdict::Expired:
            ++counters.ticketsExpired;
            break;
        case TicketDesk::Verdict::Used:
            ++counters.ticketsUsed;
            break;
        case TicketDesk::Verdict::TooMany:
            ++counters.ticketsTooMany;
            break;
    }
}

Connection::Connection(ConnectionId id, std::string peer, ConnectionContext& context, Instant now)
    : m_id(id),
      m_peer(std::move(peer)),
      m_context(context),
      m_splitter(&Connection::gate, this),
      m_accepted(now),
      m_heard(now),
      m_drained(now),
      m_bytes(context.limits.bytesPerSecond, context.limits.byteBurst, now),
      m_messages(context.limits.messagesPerSecond, context.limits.messageBurst, now),
      m_heavy(context.limits.heavyPerSecond, context.limits.heavyBurst, now),
      m_notes(context.limits.notesPerSecond, context.limits.noteBurst, now) {}

bool Connection::gate(protocol::MessageType, std::uint32_t bytes, const void* self) {
    const auto* connection = static_cast<const Connection*>(self);
    const Limits& limits = connection->m_context.limits;
    const bool known = connection->m_phase == Phase::Live || connection->m_phase == Phase::Ending;
    return bytes <= (known ? limits.messageBytes : limits.helloBytes);
}

// Input ------------------------------------------------------------------------------------------

void Connection::receive(std::span<const std::byte> bytes, Instant now) {
    m_context.counters.bytesIn += bytes.size();
    if (m_phase == Phase::Ending) m_letGo += bytes.size();
    if (m_phase == Phase::Ending || bytes.empty()) return;
    m_heard = now;
    if (!m_bytes.take(now, static_cast<double>(bytes.size()))) {
        return end(ByeReason::TooFast, "more bytes than the agreed rate", true, now);
    }
    std::vector<protocol::Message> messages;
    const Status fed = m_splitter.feed(bytes, messages);
    for (protocol::Message& message : messages) {
        if (m_phase == Phase::Ending) return;
        if (!m_messages.take(now)) {
            end(ByeReason::TooFast, "more messages than the agreed rate", true, now);
            return;
        }
        handle(std::move(message), now);
    }
    if (!fed && m_phase != Phase::Ending) {
        ++m_context.counters.badMessages;
        end(ByeReason::BadMessage, fed.error().message, false, now);
        return;
    }
    if (m_splitter.buffered() == 0) {
        m_partialSince = 0;
    } else if (m_partialSince == 0 || !messages.empty()) {
        m_partialSince = now;
    }
}

void Connection::handle(protocol::Message message, Instant now) {
    if (m_session && m_player != 0) m_session->seats().heard(m_player, m_session->tick());
    if (auto* hello = std::get_if<protocol::Hello>(&message)) {
        if (m_phase == Phase::Greeting) return on(*hello, now);
    } else if (auto* bye = std::get_if<protocol::Bye>(&message)) {
        return on(*bye, now);
    } else if (auto* ping = std::get_if<protocol::Ping>(&message)) {
        if (m_phase != Phase::Greeting) return on(*ping, now);
    } else if (m_phase == Phase::Live) {
        if (auto* intent = std::get_if<protocol::Intent>(&message)) return on(*intent, now);
        if (auto* want = std::get_if<protocol::SnapshotRequest>(&message)) return on(*want, now);
        if (auto* query = std::get_if<protocol::HashQuery>(&message)) return on(*query, now);
        if (auto* report = std::get_if<protocol::DesyncReport>(&message)) return on(*report, now);
    }
    ++m_context.counters.badMessages;
    end(ByeReason::UnexpectedMessage, "this message has no place here now", false, now);
}

namespace {

/// Why the client's build cannot step the session's game; empty: it can.
std::string lackedRules(const World& world, const protocol::Hello& hello) {
    const Rules* const rules = world.rules();
    if (rules == nullptr) return {};
    const std::uint64_t mark = protocol::rulesMark(rules->name(), rules->version());
    if (std::find(hello.rules.begin(), hello.rules.end(), mark) != hello.rules.end()) return {};
    return "this session is played by the rules " + std::string(rules->name()) + " " +
           std::to_string(rules->version()) +
           ", which the client's build does not have: it may only watch, on the page that the "
           "server shows with --web";
}

}  // namespace

void Connection::on(const protocol::Hello& hello, Instant now) {
    if (hello.version != protocol::protocolVersion) {
        return end(ByeReason::VersionMismatch,
                   "this server speaks version " + std::to_string(protocol::protocolVersion) +
                       " of the protocol, the client version " + std::to_string(hello.version),
                   false, now);
    }
    // A spectator too: over this protocol whoever watches steps the frames. Views go to the page.
    if (hello.fingerprint != m_context.fingerprint) {
        return end(ByeReason::FingerprintMismatch,
                   "the client's build does not step the same bits as the server's: it may only "
                   "watch, on the page that the server shows with --web",
                   false, now);
    }
    Session* session = m_context.findSession(hello.session);
    if (!session) {
        return end(ByeReason::UnknownSession, "there is no session of that name here", false, now);
    }
    const bool plays = hello.role == protocol::Role::Player && session->hasPlayers();
    const bool resumes = plays && hello.resume;  // a token was given to a holder of a ticket
    if (!resumes && !admit(hello, now)) return;
    if (const std::string lack = lackedRules(session->world(), hello); !lack.empty()) {
        return end(ByeReason::FingerprintMismatch, lack, false, now);
    }
    m_session = session;
    m_hello = hello;
    if (!plays) return enter(*session, 0, now);
    if (hello.resume) {
        const Result<Seats::Resumed> seat = session->seats().resume(*hello.resume, now);
        if (!seat) return end(ByeReason::ResumeRefused, seat.error().message, false, now);
        m_mayHaveTail = seat->sameEpoch;
        m_context.takeOver(*session, seat->player, m_id, now);
        return enter(*session, seat->player, now);
    }
    takeSeat(*session, now);
}

/// Whether the ticket lets it in, where tickets are asked for; else it is ended.
bool Connection::admit(const protocol::Hello& hello, Instant now) {
    if (!m_context.tickets) return true;
    TicketDesk::Answer answer = m_context.tickets->take(hello.ticket, hello.session, hello.role);
    count(m_context.counters, answer.verdict);
    m_holder = std::move(answer.player);
    if (answer.verdict == TicketDesk::Verdict::Taken) return true;
    end(ByeReason::TicketRefused, answer.sentence, false, now);
    return false;
}

void Connection::takeSeat(Session& session, Instant now) {
    Seats& seats = session.seats();
    if (!m_holder.empty()) {
        if (seats.joining(m_holder)) {
            return end(ByeReason::TicketRefused, "this player is joining already", false, now);
        }
        if (const PlayerId player = seats.reclaim(m_holder, now)) {
            m_context.takeOver(session, player, m_id, now);
            return enter(session, player, now);
        }
    }
    const std::optional<JoinId> join = seats.join(m_holder);
    if (!join) return end(ByeReason::SessionFull, "every seat is taken", false, now);
    m_join = *join;
    m_phase = Phase::Joining;
}

void Connection::enter(Session& session, PlayerId player, Instant now) {
    m_phase = Phase::Live;
    m_player = player;
    protocol::Welcome welcome;
    welcome.session = session.name();
    welcome.player = player;
    welcome.epoch = session.epoch();
    welcome.tick = session.tick();
    welcome.ticksPerSecond = static_cast<float>(session.ticksPerSecond());
    welcome.inputDelay = m_context.limits.inputDelay;
    welcome.maxCommandsPerIntent = m_context.limits.commandsPerIntent;
    welcome.lastSequence = player == 0 ? 0 : session.lastSequence(player);
    if (player != 0) welcome.resume = session.seats().issue(player);
    welcome.maxInputDelay = m_context.limits.maxInputDelay;
    welcome.maxQueuedCommands = m_context.limits.queuedPerPlayer;
    welcome.maxQueuedBytes = static_cast<std::uint32_t>(m_context.limits.queuedBytesPerPlayer);
    send(welcome);
    line("welcome").with("resumed", std::uint64_t{m_hello->resume.has_value()}).to(m_context.log);
    startFeed(now);
}

void Connection::startFeed(Instant now) {
    m_behindSince = now;
    m_resynced = true;
    const std::uint64_t have = m_hello->haveTick;
    const bool here = m_mayHaveTail && have != 0 && m_session->rootAt(have) == m_hello->haveHash;
    if (!here) return startSnapshot(m_session->snapshotForJoin(have), have, now);
    m_feed = Feed::Frames;
    m_cursor = have;
}

void Connection::on(protocol::Intent& intent, Instant now) {
    if (intent.checkpoint) checkCheckpoint(*intent.checkpoint, now);
    if (intent.commands.empty()) return;
    if (m_player == 0) {
        ++m_context.counters.badMessages;
        return end(ByeReason::UnexpectedMessage, "a spectator has no commands", false, now);
    }
    if (intent.commands.size() > m_context.limits.commandsPerIntent) {
        ++m_context.counters.badMessages;
        return end(ByeReason::BadMessage, "more commands in an intent than Welcome allows", false,
                   now);
    }
    for (Command& command : intent.commands) {
        switch (m_session->queue(m_player, std::move(command), intent.tick)) {
            case CommandQueue::Admission::Queued:
                ++m_context.counters.commandsQueued;
                break;
            case CommandQueue::Admission::Old:
                ++m_context.counters.commandsOld;
                break;
            case CommandQueue::Admission::QueueFull:
                ++m_context.counters.commandsDropped;
                break;
            case CommandQueue::Admission::PlayerFull:
                return end(ByeReason::TooFast, "too many commands wait for their tick", true, now);
        }
    }
}

void Connection::checkCheckpoint(const protocol::Checkpoint& checkpoint, Instant now) {
    const std::optional<std::uint64_t> mine = m_session->rootAt(checkpoint.tick);
    if (!mine) return;
    ++m_context.counters.checkpointsChecked;
    if (*mine == checkpoint.motionRoot) return;
    ++m_context.counters.checkpointMismatches;
    if (!m_notes.take(now)) return;
    line("checkpoint_mismatch")
        .with("tick", checkpoint.tick)
        .hex("client", checkpoint.motionRoot)
        .hex("server", *mine)
        .to(m_context.log, Severity::Warning);
}

bool Connection::mayCost(Instant now) {
    if (m_heavy.take(now)) return true;
    end(ByeReason::TooFast, "too many requests that cost work", true, now);
    return false;
}

void Connection::on(const protocol::SnapshotRequest& request, Instant now) {
    if (!mayCost(now)) return;
    m_feed = Feed::Rebuild;
    m_exactTick = request.tick;
    m_exactSince = now;
    m_snapshot = nullptr;
    answerQueries(now);
}

void Connection::on(const protocol::HashQuery& query, Instant now) {
    if (!mayCost(now)) return;
    if (m_queries.size() >= m_context.limits.queriesWaiting) {
        return end(ByeReason::TooFast, "too many hash queries wait", true, now);
    }
    m_queries.emplace_back(query.tick, now);
    answerQueries(now);
}

void Connection::on(const protocol::DesyncReport& report, Instant now) {
    if (!mayCost(now)) return;
    ++m_context.counters.desyncReports;
    line("desync")
        .with("tick", report.tick)
        .with("body", report.body)
        .with("field", report.field)
        .with("client_value", report.here)
        .with("server_value", report.there)
        .hex("client", report.mine)
        .hex("server", report.yours)
        .to(m_context.log, Severity::Warning);
}

void Connection::on(const protocol::Ping& ping, Instant now) {
    if (ping.reply) return;
    // With it a client that predicts learns how early what it sends comes here.
    const Instant since = std::min<Instant>((now - m_session->closedAt()) / 1'000, 0xffff'ffffu);
    send(protocol::Ping{ping.nonce, true, m_session->tick(), static_cast<std::uint32_t>(since)});
}

void Connection::on(const protocol::Bye& bye, Instant now) {
    if (mayNote(now)) line("left").with("text", bye.text).to(m_context.log);
    leaveSeat(bye.reason == ByeReason::Done, now);
    m_phase = Phase::Ending;
    m_outbox.clear();
    m_outboxBytes = 0;
    m_closeBy = now;
}

// Time -------------------------------------------------------------------------------------------

void Connection::advance(Instant now) {
    if (m_phase == Phase::Ending) return;
    checkDeadlines(now);
    if (m_phase == Phase::Joining) {
        const Seats::Outcome outcome = m_session->seats().outcome(m_join, now);
        if (outcome.kind == Seats::Outcome::Kind::Pending) return;
        m_join = 0;
        if (outcome.kind == Seats::Outcome::Kind::Refused) {
            return end(ByeReason::SessionFull, "no seat: " + outcome.reason, false, now);
        }
        enter(*m_session, outcome.player, now);
    }
    if (m_phase != Phase::Live) return;
    answerQueries(now);
    if (m_feed == Feed::Snapshot && !m_snapshot) {
        startSnapshot(m_session->snapshotForJoin(m_snapshotNotBefore), m_snapshotNotBefore, now);
    }
    checkPace(now);
}

void Connection::checkDeadlines(Instant now) {
    const Limits& limits = m_context.limits;
    const bool slowHello = m_phase == Phase::Greeting && now > m_accepted + limits.helloTime;
    const bool slowMessage = m_partialSince != 0 && now > partialBy();
    const bool silent = now > m_heard + limits.silenceTime;
    if (slowHello || slowMessage || silent) {
        ++m_context.counters.timeouts;
        return end(ByeReason::Timeout,
                   slowHello     ? "no Hello in time"
                   : slowMessage ? "a message was begun and not finished in time"
                                 : "nothing was heard for too long",
                   true, now);
    }
    if (m_phase == Phase::Live && now > std::max(m_heard, m_pinged) + limits.pingEvery) {
        m_pinged = now;
        send(protocol::Ping{++m_pingNonce, false});
    }
}

Instant Connection::partialBy() const {
    const Limits& limits = m_context.limits;
    const double pace = static_cast<double>(m_splitter.expected()) / limits.partialBytesPerSecond;
    return m_partialSince + limits.partialTime + static_cast<Instant>(pace * 1e9);
}

void Connection::checkPace(Instant now) {
    const Limits& limits = m_context.limits;
    if (m_lastUnsent > 0 && now > m_drained + limits.dropBehind) {
        ++m_context.counters.tooSlow;
        return end(ByeReason::TooSlow, "nothing was read for too long", true, now);
    }
    if (m_feed == Feed::Snapshot && m_snapshot) return checkSnapshotPace(now);
    if (m_feed != Feed::Frames) return;
    const double behind =
        static_cast<double>(m_session->tick() - m_cursor) / m_session->ticksPerSecond();
    if (behind * 1e9 <= static_cast<double>(limits.resyncBehind)) {
        m_behindSince = 0;
        m_resynced = false;
        return;
    }
    if (m_behindSince == 0) m_behindSince = now;
    if (!m_resynced) {
        m_resynced = true;
        ++m_context.counters.resyncs;
        line("resync").with("behind_ticks", m_session->tick() - m_cursor).to(m_context.log);
        return startSnapshot(m_session->snapshotForJoin(m_cursor), m_cursor, now);
    }
    if (now > m_behindSince + limits.dropBehind) {
        ++m_context.counters.tooSlow;
        end(ByeReason::TooSlow, "too far behind for too long", true, now);
    }
}

/// A reader that takes a byte now and then is never idle, and would hold its snapshot for good.
void Connection::checkSnapshotPace(Instant now) {
    const Limits& limits = m_context.limits;
    if (now <= m_snapshotSince + limits.snapshotGrace) return;
    const double seconds = static_cast<double>(now - m_snapshotSince - limits.snapshotGrace) * 1e-9;
    const std::size_t sent = m_snapshotAt - std::min(m_snapshotAt, m_lastUnsent);
    if (static_cast<double>(sent) >= seconds * limits.snapshotBytesPerSecond) return;
    ++m_context.counters.tooSlow;
    end(ByeReason::TooSlow, "the snapshot is read too slowly", true, now);
}

void Connection::answerQueries(Instant now) {
    Rebuilder& rebuilder = m_session->rebuilder();
    while (!m_queries.empty()) {
        const auto [tick, since] = m_queries.front();
        const Rebuilder::Answer answer = rebuilder.ask(tick);
        if (answer == Rebuilder::Answer::Coming && now <= since + m_context.limits.rebuildPatience)
            break;
        std::vector<std::uint64_t> leaves;
        const bool full = m_lastUnsent + m_outboxBytes >= m_context.limits.lowWater;
        const World* world = rebuilder.find(tick);
        if (world && full) ++m_context.counters.hashesLetGo;
        if (world && !full) leaves = world->motionLeaves();
        std::size_t first = 0;
        do {
            const std::size_t count = std::min(protocol::maxLeaves, leaves.size() - first);
            const auto from = leaves.begin() + static_cast<std::ptrdiff_t>(first);
            send(protocol::HashNodes{tick,
                                     {from, from + static_cast<std::ptrdiff_t>(count)},
                                     static_cast<std::uint32_t>(first)});
            first += count;
        } while (first < leaves.size());
        m_queries.pop_front();
    }
    if (m_feed != Feed::Rebuild) return;
    const Rebuilder::Answer answer = rebuilder.ask(m_exactTick);
    const Instant until = m_exactSince + m_context.limits.rebuildPatience;
    if (answer == Rebuilder::Answer::Coming && now <= until) return;
    const World* world = rebuilder.find(m_exactTick);
    SharedSnapshot exact = world ? m_session->snapshotOf(*world) : nullptr;
    if (!exact) exact = m_session->snapshotForJoin(m_exactTick);
    startSnapshot(std::move(exact), m_exactTick, now);
}

// Output -----------------------------------------------------------------------------------------

void Connection::send(const protocol::Message& message) {
    if (m_phase == Phase::Ending) return;
    auto bytes = std::make_shared<const std::vector<std::byte>>(protocol::encode(message));
    m_outboxBytes += bytes->size();
    m_outbox.push_back(std::move(bytes));
}

void Connection::startSnapshot(SharedSnapshot snapshot, std::uint64_t notBefore, Instant now) {
    m_feed = Feed::Snapshot;
    m_snapshot = std::move(snapshot);
    m_snapshotNotBefore = notBefore;
    m_snapshotSince = now;
    m_snapshotAt = 0;
    m_snapshotBegun = false;
    m_behindSince = now;
    m_resynced = true;
    if (m_snapshot) ++m_context.counters.snapshots;
}

SharedBytes Connection::next(std::size_t unsent, Instant now) {
    if (unsent < m_lastUnsent || unsent == 0) m_drained = now;
    m_lastUnsent = unsent;
    const Limits& limits = m_context.limits;
    if (m_phase != Phase::Ending && unsent + m_outboxBytes > limits.clientBytes) {
        ++m_context.counters.tooSlow;
        end(ByeReason::TooSlow, "too much lies unread", true, now);
    }
    if (unsent >= limits.lowWater) return nullptr;
    SharedBytes out;
    if (!m_outbox.empty()) {
        out = std::move(m_outbox.front());
        m_outbox.pop_front();
        m_outboxBytes -= out->size();
    } else if (m_phase == Phase::Live) {
        out = m_feed == Feed::Snapshot ? nextOfSnapshot(now)
              : m_feed == Feed::Frames ? nextFrame(now)
                                       : nullptr;
    }
    if (out) {
        m_lastUnsent = unsent + out->size();
        m_context.counters.bytesOut += out->size();
    }
    return out;
}

SharedBytes Connection::nextOfSnapshot(Instant now) {
    if (!m_snapshot) return nullptr;  // it waits for one
    const std::vector<std::byte>& bytes = m_snapshot->bytes;
    protocol::Message message;
    if (!m_snapshotBegun) {
        m_snapshotBegun = true;
        message = protocol::SnapshotBegin{m_snapshot->tick, bytes.size(), m_snapshot->hash};
    } else if (m_snapshotAt < bytes.size()) {
        const std::size_t count = std::min(protocol::maxChunkBytes, bytes.size() - m_snapshotAt);
        const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(m_snapshotAt);
        message = protocol::SnapshotChunk{m_snapshotAt,
                                          {from, from + static_cast<std::ptrdiff_t>(count)}};
        m_snapshotAt += count;
    } else {
        message = protocol::SnapshotEnd{m_snapshot->tick};
        m_cursor = m_snapshot->tick;
        m_snapshot = nullptr;
        m_feed = Feed::Frames;
        m_behindSince = now;  // the time to catch up starts when the transfer has ended
    }
    return std::make_shared<const std::vector<std::byte>>(protocol::encode(message));
}

SharedBytes Connection::nextFrame(Instant now) {
    if (m_cursor >= m_session->tick()) return nullptr;
    if (SharedBytes frame = m_session->frames().encoded(m_cursor)) {
        ++m_cursor;
        return frame;
    }
    // The ring has gone past it.
    if (m_resynced) {
        ++m_context.counters.tooSlow;
        end(ByeReason::TooSlow, "the frames it needs are gone", true, now);
    } else {
        ++m_context.counters.resyncs;
        startSnapshot(m_session->snapshotForJoin(m_cursor), m_cursor, now);
    }
    return nullptr;
}

// The end ----------------------------------------------------------------------------------------

bool Connection::finished() const {
    return m_phase == Phase::Ending && m_outbox.empty();
}

void Connection::end(ByeReason reason, std::string text, bool mayResume, Instant now) {
    if (m_phase == Phase::Ending) return;
    if (reason == ByeReason::TooFast) ++m_context.counters.tooFast;
    if (mayNote(now)) {
        line("bye")
            .with("reason", static_cast<std::uint64_t>(reason))
            .with("text", text)
            .to(m_context.log,
                reason == ByeReason::ServerStops ? Severity::Info : Severity::Warning);
    }
    text = protocol::cutText(std::move(text), protocol::maxByeText);
    // Whatever was to be said before is moot; the Bye alone goes out.
    m_outbox.clear();
    m_outboxBytes = 0;
    send(protocol::Bye{reason, std::move(text), mayResume});
    leaveSeat(false, now);
    m_phase = Phase::Ending;
    m_closeBy = now + m_context.limits.byeTime;
}

void Connection::leaveSeat(bool forGood, Instant now) {
    if (!m_session) return;
    if (m_join != 0) m_session->seats().abandon(m_join);
    if (m_player != 0) m_session->seats().vacate(m_player, forGood, now);
    m_join = 0;
    m_player = 0;
}

void Connection::lost(Instant now) {
    leaveSeat(false, now);
    m_phase = Phase::Ending;
    m_outbox.clear();
    m_outboxBytes = 0;
    m_closeBy = now;
}

void Connection::refusedByTls(const std::string& why, Instant now) {
    ++m_context.counters.badTls;
    if (mayNote(now)) line("tls").with("text", why).to(m_context.log, Severity::Warning);
    lost(now);
}

void Connection::displace(Instant now) {
    ++m_context.counters.displaced;
    lost(now);
}

/// Whoever comes in by the thousand must not fill the log.
bool Connection::mayNote(Instant now) {
    if (m_phase == Phase::Live || !m_context.strangerNotes) return true;
    if (m_context.strangerNotes->take(now)) return true;
    ++m_context.counters.notesLetGo;
    return false;
}

void Connection::loseSeat(Instant now) {
    m_player = 0;  // without vacating it: it has a new holder
    end(ByeReason::Done, "this seat was taken up by another connection", false, now);
}

LogLine Connection::line(std::string_view event) const {
    LogLine out(event);
    out.with("connection", m_id).with("peer", m_peer);
    if (m_session) out.with("session", m_session->name());
    if (m_player != 0) out.with("player", m_player);
    if (!m_holder.empty()) out.with("holder", m_holder);
    return out;
}

}  // namespace huestep::server
