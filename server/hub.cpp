#include "server/hub.h"

#include <algorithm>
#include <utility>

#include "server/recovery.h"

namespace huestep::server {

Hub::Hub(HubConfig config, JournalSink& journal)
    : m_resources(config.resources),
      m_journal(journal),
      m_visitors(config.limits, config.visitorsKey, 0) {
    m_context.limits = config.limits;
    m_context.fingerprint = config.fingerprint;
    m_context.log = std::move(config.log);
    m_context.strangerNotes.emplace(config.limits.strangerNotesPerSecond,
                                    config.limits.strangerNoteBurst, 0);
    if (config.tickets) m_context.tickets.emplace(std::move(*config.tickets), config.limits);
    m_context.findSession = [this](const std::string& name) { return findByName(name); };
    m_context.takeOver = [this](Session& session, PlayerId player, ConnectionId by, Instant now) {
        takeOver(session, player, by, now);
    };
}

Result<Session*> Hub::add(SessionStart start, Instant now) {
    if (Status named = checkSessionName(start.name); !named) return named.error();
    if (m_sessions.contains(start.name)) {
        return Error{"there are two sessions with the name " + start.name};
    }
    if (m_sessions.size() >= m_context.limits.sessions) {
        return Error{"more than " + std::to_string(m_context.limits.sessions) +
                     " sessions in one process; session " + start.name + " is one too many"};
    }
    const std::string name = start.name;
    auto session = std::make_unique<Session>(std::move(start), m_context.limits, now);
    LogLine("session")
        .with("session", name)
        .with("epoch", session->epoch())
        .with("tick", session->tick())
        .hex("root", session->world().motionRoot())
        .to(m_context.log);
    return m_sessions.emplace(name, std::move(session)).first->second.get();
}

std::vector<Session*> Hub::sessions() {
    std::vector<Session*> out;
    for (const auto& [name, session] : m_sessions) out.push_back(session.get());
    return out;
}
std::vector<const Session*> Hub::sessions() const {
    std::vector<const Session*> out;
    for (const auto& [name, session] : m_sessions) out.push_back(session.get());
    return out;
}

const Session* Hub::find(const std::string& name) const {
    const auto found = m_sessions.find(name);
    return found == m_sessions.end() ? nullptr : found->second.get();
}

Session* Hub::findByName(const std::string& name) {
    const auto found = m_sessions.find(name);
    const bool open = found != m_sessions.end() && !found->second->failure();
    return open ? found->second.get() : nullptr;
}

Status Hub::admit(std::span<const std::byte> ticket, const std::string& session,
                  protocol::Role role) {
    if (!m_context.tickets) return Done{};
    const TicketDesk::Answer answer = m_context.tickets->take(ticket, session, role);
    count(m_context.counters, answer.verdict);
    if (answer.verdict == TicketDesk::Verdict::Taken) return Done{};
    return Error{answer.sentence};
}

std::optional<ConnectionId> Hub::accept(std::string peer, Instant now) {
    const std::string visitor = visitorOf(peer);
    if (m_stopping || m_connections.size() >= m_context.limits.connections ||
        !m_visitors.mayCome(visitor, now) || !makeRoom(visitor, now)) {
        ++m_context.counters.refused;
        return std::nullopt;
    }
    ++m_context.counters.accepted;
    const ConnectionId id = ++m_lastConnection;
    m_connections.emplace(id, std::make_unique<Connection>(id, std::move(peer), m_context, now));
    m_halfOpen.emplace(id, visitor);
    m_visitors.came(visitor);
    return id;
}

/// Room for one more half-open connection of this visitor: where there is none, the oldest of
/// whoever has most of them goes, so that a flood cannot keep others out. False: he has too many.
bool Hub::makeRoom(const std::string& visitor, Instant now) {
    std::map<std::string, std::uint32_t> shares;
    for (const auto& [id, whose] : m_halfOpen) ++shares[whose];
    if (!isShared(visitor) && shares[visitor] >= m_context.limits.halfOpenPerAddress) return false;
    if (m_halfOpen.size() < m_context.limits.halfOpen) return true;
    std::uint32_t most = 0;
    for (const auto& [whose, share] : shares) most = std::max(most, share);
    // By age and not by name among those who have equally many.
    const auto oldest = std::find_if(m_halfOpen.begin(), m_halfOpen.end(),
                                     [&](const auto& each) { return shares[each.second] == most; });
    const ConnectionId id = oldest->first;
    m_halfOpen.erase(oldest);
    m_connections.at(id)->displace(now);
    m_displaced.push_back(id);
    return true;
}

void Hub::receive(ConnectionId id, std::span<const std::byte> bytes, Instant now) {
    const auto found = m_connections.find(id);
    if (found == m_connections.end()) return;
    found->second->receive(bytes, now);
    if (found->second->greeted()) m_halfOpen.erase(id);
}

void Hub::refusedByTls(ConnectionId id, const std::string& why, Instant now) {
    const auto found = m_connections.find(id);
    if (found != m_connections.end()) found->second->refusedByTls(why, now);
}

bool Hub::reads(ConnectionId id) const {
    const auto found = m_connections.find(id);
    return found == m_connections.end() || found->second->reads();
}

SharedBytes Hub::next(ConnectionId id, std::size_t unsent, Instant now) {
    const auto found = m_connections.find(id);
    return found == m_connections.end() ? nullptr : found->second->next(unsent, now);
}

bool Hub::finished(ConnectionId id) const {
    const auto found = m_connections.find(id);
    return found == m_connections.end() || found->second->finished();
}

bool Hub::overdue(ConnectionId id, Instant now) const {
    const auto found = m_connections.find(id);
    return found == m_connections.end() || now >= found->second->closeBy();
}

void Hub::closed(ConnectionId id, Instant now) {
    const auto found = m_connections.find(id);
    if (found == m_connections.end()) return;
    found->second->lost(now);
    m_visitors.left(visitorOf(found->second->peer()));
    m_halfOpen.erase(id);
    m_connections.erase(found);
}

std::vector<ConnectionId> Hub::connections() const {
    std::vector<ConnectionId> out;
    for (const auto& [id, connection] : m_connections) out.push_back(id);
    return out;
}

const Connection* Hub::connection(ConnectionId id) const {
    const auto found = m_connections.find(id);
    return found == m_connections.end() ? nullptr : found->second.get();
}

bool Hub::closeTick(Session& session, Instant now) {
    const bool may = !m_stopping && session.mayClose();
    if (may) m_journal.write(session.name(), session.closeTick(now, m_resources));
    for (const auto& [id, connection] : m_connections) {
        if (connection->session() == &session) connection->advance(now);
    }
    return may;
}

bool Hub::work(Session& session) {
    return session.rebuilder().work(m_resources);
}

void Hub::advance(Instant now) {
    for (const auto& [id, connection] : m_connections) connection->advance(now);
}

void Hub::committed(const std::string& session, std::uint64_t below) {
    const auto found = m_sessions.find(session);
    if (found != m_sessions.end()) found->second->committed(below);
}

void Hub::failed(const std::string& session, const std::string& sentence, Instant now) {
    const auto found = m_sessions.find(session);
    if (found == m_sessions.end() || found->second->failure()) return;
    found->second->fail(sentence);
    LogLine("journal_failed")
        .with("session", session)
        .with("text", sentence)
        .to(m_context.log, Severity::Error);
    for (const auto& [id, connection] : m_connections) {
        if (connection->session() != found->second.get()) continue;
        connection->end(protocol::ByeReason::ServerStops, "the session's journal failed", true,
                        now);
    }
}

void Hub::stop(Instant now) {
    if (m_stopping) return;
    m_stopping = true;
    for (const auto& [id, connection] : m_connections) {
        connection->end(protocol::ByeReason::ServerStops, "the server stops", true, now);
    }
    for (const auto& [name, session] : m_sessions) {
        if (!session->failure()) m_journal.write(name, session->finalRecord());
        LogLine("stopped")
            .with("session", name)
            .with("tick", session->tick())
            .hex("root", session->world().motionRoot())
            .to(m_context.log);
    }
}

void Hub::takeOver(Session& session, PlayerId player, ConnectionId by, Instant now) {
    for (const auto& [id, connection] : m_connections) {
        if (id == by || connection->session() != &session || connection->player() != player) {
            continue;
        }
        connection->loseSeat(now);
    }
}

}  // namespace huestep::server
