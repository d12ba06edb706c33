/// Every session and every connection of a process, without I/O: the whole server for a test, and
/// all of it but sockets, files and clocks for `Host`.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/connection.h"
#include "server/session.h"
#include "server/visitors.h"

namespace huestep::server {

/// Where closed ticks go. What became of them is told by `Hub::committed` and `Hub::failed`.
class JournalSink {
 public:
    virtual ~JournalSink() = default;
    /// Must not block and must not call back into the hub.
    virtual void write(const std::string& session, ClosedTick closed) = 0;
};

struct HubConfig {
    Limits limits;
    protocol::Fingerprint fingerprint;
    LogSink log;
    StepResources resources;
    std::optional<TicketRules> tickets{};  ///< none: anyone may enter
    ResumeKey visitorsKey{};               ///< random: see `Visitors`
};

class Hub {
 public:
    Hub(HubConfig config, JournalSink& journal);
    Hub(const Hub&) = delete;
    Hub& operator=(const Hub&) = delete;

    /// Hosts one more session. The sentence says which limit or name stands against it.
    Result<Session*> add(SessionStart start, Instant now);
    [[nodiscard]] std::vector<Session*> sessions();
    [[nodiscard]] std::vector<const Session*> sessions() const;
    [[nodiscard]] const Session* find(const std::string& name) const;
    [[nodiscard]] const Counters& counters() const { return m_context.counters; }
    [[nodiscard]] const Limits& limits() const { return m_context.limits; }

    [[nodiscard]] bool asksForTickets() const { return m_context.tickets.has_value(); }
    /// For those who watch over another way than a connection: whether a ticket lets them in. The
    /// sentence says why not.
    Status admit(std::span<const std::byte> ticket, const std::string& session,
                 protocol::Role role);

    /// None: over a limit; the caller closes the socket without a word. `peer`: HOST:PORT. Others
    /// may have had to make room: see `displaced`.
    std::optional<ConnectionId> accept(std::string peer, Instant now);
    /// Connections that the last `accept` ended; told once, for the transport to close at once.
    std::vector<ConnectionId> displaced() { return std::exchange(m_displaced, {}); }
    /// Whether to go on reading from it.
    [[nodiscard]] bool reads(ConnectionId id) const;
    /// What came over it is not what the transport speaks: it is logged, and the caller closes it.
    void refusedByTls(ConnectionId id, const std::string& why, Instant now);
    void receive(ConnectionId id, std::span<const std::byte> bytes, Instant now);
    /// See `Connection::next`. Null for an unknown id too.
    SharedBytes next(ConnectionId id, std::size_t unsent, Instant now);
    /// Nothing more will come for it: once what was handed out is sent, the transport says so to
    /// the client, who then closes.
    [[nodiscard]] bool finished(ConnectionId id) const;
    /// It had its time to close: the transport does.
    [[nodiscard]] bool overdue(ConnectionId id, Instant now) const;
    /// The transport is closed; the id is forgotten.
    void closed(ConnectionId id, Instant now);
    [[nodiscard]] std::vector<ConnectionId> connections() const;
    [[nodiscard]] const Connection* connection(ConnectionId id) const;

    /// Closes a tick of a session, if it may; then everyone's time passes.
    bool closeTick(Session& session, Instant now);
    /// One step of work that no tick waits for. False: there is none.
    bool work(Session& session);
    /// Lets time pass for all connections.
    void advance(Instant now);
    void noteLetGo(std::uint64_t ticks) { m_context.counters.ticksLetGo += ticks; }

    void committed(const std::string& session, std::uint64_t below);
    /// Ends the session's connections: nothing it does could be kept.
    void failed(const std::string& session, const std::string& sentence, Instant now);

    /// Bye to all, and a last record of each session to the journal.
    void stop(Instant now);

 private:
    bool makeRoom(const std::string& visitor, Instant now);
    Session* findByName(const std::string& name);
    void takeOver(Session& session, PlayerId player, ConnectionId by, Instant now);

    ConnectionContext m_context;
    StepResources m_resources;
    JournalSink& m_journal;
    std::map<std::string, std::unique_ptr<Session>> m_sessions;
    std::map<ConnectionId, std::unique_ptr<Connection>> m_connections;
    ConnectionId m_lastConnection = 0;
    Visitors m_visitors;
    /// Connections without a finished Hello, and whose they are; the oldest first.
    std::map<ConnectionId, std::string> m_halfOpen;
    std::vector<ConnectionId> m_displaced;
    bool m_stopping = false;
};

}  // namespace huestep::server
