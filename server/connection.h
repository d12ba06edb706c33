/// The protocol with one client, as a state machine: bytes and time in, bytes out.
///
///     Greeting --Hello--> Joining --its frame is on disk--> Live --> Ending
///         |                                                  ^
///         +--Hello of a spectator, or with a resume token ---+
///
/// Output is pulled: the transport asks `next` while little of what it got is unsent. So a client
/// that does not read costs the server nothing but a place in the ring of frames, which all share,
/// and no message of one client can delay another's. What a slow client meets:
///  - behind by `resyncBehind`: it gets a snapshot in place of the frames it missed;
///  - still behind after `dropBehind`, or not a byte taken for so long, or a snapshot read at less
///    than `snapshotBytesPerSecond`: Bye TooSlow, may resume.
/// Every byte from outside meets a limit; whatever is wrong ends in a Bye that says so.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "protocol/frame.h"
#include "protocol/messages.h"
#include "server/history.h"
#include "server/limits.h"
#include "server/log.h"
#include "server/session.h"
#include "server/ticket_desk.h"
#include "server/token_bucket.h"

namespace huestep::server {

using ConnectionId = std::uint64_t;

/// What happened since the start, for the log and for tests.
struct Counters {
    std::uint64_t accepted = 0;
    std::uint64_t refused = 0;    ///< connections over a limit
    std::uint64_t displaced = 0;  ///< half-open ones that made room for others
    std::uint64_t bytesIn = 0;
    std::uint64_t bytesOut = 0;
    std::uint64_t badMessages = 0;
    std::uint64_t badTls = 0;
    std::uint64_t tooSlow = 0;
    std::uint64_t tooFast = 0;
    std::uint64_t timeouts = 0;
    std::uint64_t notesLetGo = 0;   ///< log lines about strangers, over their rate
    std::uint64_t hashesLetGo = 0;  ///< hash queries answered without hashes: much lay unread
    std::uint64_t resyncs = 0;
    std::uint64_t snapshots = 0;
    std::uint64_t commandsQueued = 0;
    std::uint64_t commandsOld = 0;      ///< repetitions, let go
    std::uint64_t commandsDropped = 0;  ///< the session's queue was full
    std::uint64_t checkpointsChecked = 0;
    std::uint64_t checkpointMismatches = 0;
    std::uint64_t desyncReports = 0;
    std::uint64_t ticksLetGo = 0;
    std::uint64_t ticketsTaken = 0;
    std::uint64_t ticketsMissing = 0;
    std::uint64_t ticketsForged = 0;
    std::uint64_t ticketsMisplaced = 0;  ///< for another session or role
    std::uint64_t ticketsExpired = 0;    ///< or not yet valid, or of before this server's start
    std::uint64_t ticketsUsed = 0;       ///< shown a second time
    std::uint64_t ticketsTooMany = 0;    ///< no room to remember one more
};

void count(Counters& counters, TicketDesk::Verdict verdict);

/// What a connection needs of the process around it.
struct ConnectionContext {
    Limits limits;
    protocol::Fingerprint fingerprint;
    LogSink log;
    Counters counters;
    std::optional<TicketDesk> tickets;         ///< none: anyone may enter
    std::optional<TokenBucket> strangerNotes;  ///< none: whatever they do is logged
    std::function<Session*(const std::string& name)> findSession;
    /// Another connection that holds this seat must let go of it.
    std::function<void(Session& session, PlayerId player, ConnectionId by, Instant now)> takeOver;
};

class Connection {
 public:
    Connection(ConnectionId id, std::string peer, ConnectionContext& context, Instant now);
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    [[nodiscard]] ConnectionId id() const { return m_id; }
    [[nodiscard]] const std::string& peer() const { return m_peer; }
    [[nodiscard]] const Session* session() const { return m_session; }
    [[nodiscard]] PlayerId player() const { return m_player; }
    [[nodiscard]] bool greeted() const { return m_phase != Phase::Greeting; }
    [[nodiscard]] bool live() const { return m_phase == Phase::Live; }
    /// Whether the transport should go on reading. What comes behind a Bye is read and let go, or
    /// closing would take the Bye with it; but not without end.
    [[nodiscard]] bool reads() const {
        return m_phase != Phase::Ending || m_letGo < m_context.limits.byeBytes;
    }

    /// Takes bytes as they came.
    void receive(std::span<const std::byte> bytes, Instant now);
    /// Lets time pass: deadlines, joins, answers that had to wait. After each tick, and now and
    /// then.
    void advance(Instant now);
    /// The next bytes to write, or null. `unsent`: what the transport still holds.
    SharedBytes next(std::size_t unsent, Instant now);
    /// Nothing more comes. The transport closes once the client does, or at `closeBy`.
    [[nodiscard]] bool finished() const;
    [[nodiscard]] Instant closeBy() const { return m_closeBy; }

    /// Ends the connection with a Bye.
    void end(protocol::ByeReason reason, std::string text, bool mayResume, Instant now);
    /// The transport is gone.
    void lost(Instant now);
    /// What the transport got was not of its kind; it closes.
    void refusedByTls(const std::string& why, Instant now);
    /// Ends it without a word, for another that comes: the transport closes at once.
    void displace(Instant now);
    /// The seat belongs to another connection now.
    void loseSeat(Instant now);

 private:
    enum class Phase : std::uint8_t { Greeting, Joining, Live, Ending };
    /// What a live client gets besides answers.
    enum class Feed : std::uint8_t {
        Frames,
        Snapshot,
        Rebuild  ///< waits for the snapshot of the tick it asked for
    };

    static bool gate(protocol::MessageType type, std::uint32_t bytes, const void* self);
    void handle(protocol::Message message, Instant now);
    void on(const protocol::Hello& hello, Instant now);
    void on(protocol::Intent& intent, Instant now);
    void on(const protocol::SnapshotRequest& request, Instant now);
    void on(const protocol::HashQuery& query, Instant now);
    void on(const protocol::DesyncReport& report, Instant now);
    void on(const protocol::Ping& ping, Instant now);
    void on(const protocol::Bye& bye, Instant now);

    bool admit(const protocol::Hello& hello, Instant now);
    void takeSeat(Session& session, Instant now);
    void enter(Session& session, PlayerId player, Instant now);
    void startFeed(Instant now);
    /// Null: waits for one at or after `notBefore`.
    void startSnapshot(SharedSnapshot snapshot, std::uint64_t notBefore, Instant now);
    void checkCheckpoint(const protocol::Checkpoint& checkpoint, Instant now);
    bool mayCost(Instant now);
    void answerQueries(Instant now);
    void checkDeadlines(Instant now);
    void checkPace(Instant now);
    void checkSnapshotPace(Instant now);
    void leaveSeat(bool forGood, Instant now);
    void send(const protocol::Message& message);
    SharedBytes nextOfSnapshot(Instant now);
    SharedBytes nextFrame(Instant now);
    LogLine line(std::string_view event) const;
    bool mayNote(Instant now);
    [[nodiscard]] Instant partialBy() const;

    ConnectionId m_id;
    std::string m_peer;
    ConnectionContext& m_context;
    protocol::FrameSplitter m_splitter;
    Phase m_phase = Phase::Greeting;
    Session* m_session = nullptr;
    PlayerId m_player = 0;
    JoinId m_join = 0;
    std::optional<protocol::Hello> m_hello;
    std::string m_holder;        ///< by its ticket
    bool m_mayHaveTail = false;  ///< its world is surely one of this server's

    // Output.
    std::deque<SharedBytes> m_outbox;
    std::size_t m_outboxBytes = 0;
    Feed m_feed = Feed::Frames;
    std::uint64_t m_cursor = 0;  ///< tick of the next frame
    SharedSnapshot m_snapshot;
    std::size_t m_snapshotAt = 0;
    bool m_snapshotBegun = false;
    std::uint64_t m_snapshotNotBefore = 0;
    Instant m_snapshotSince = 0;
    std::uint64_t m_exactTick = 0;
    Instant m_exactSince = 0;
    std::deque<std::pair<std::uint64_t, Instant>> m_queries;  ///< ticks of hash queries, since when

    // Time.
    Instant m_accepted;
    Instant m_heard;
    Instant m_partialSince = 0;  ///< 0: no message is incomplete
    Instant m_drained;           ///< when the transport last took or sent something
    std::size_t m_lastUnsent = 0;
    Instant m_pinged = 0;
    Instant m_behindSince = 0;  ///< 0: up to date
    bool m_resynced = false;    ///< since it fell behind
    Instant m_closeBy = ~Instant{0};
    std::size_t m_letGo = 0;  ///< bytes that came behind the end
    TokenBucket m_bytes;
    TokenBucket m_messages;
    TokenBucket m_heavy;
    TokenBucket m_notes;
    std::uint64_t m_pingNonce = 0;
};

}  // namespace huestep::server
