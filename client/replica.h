/// A client's copy of a session: follows frames, compares every hash, repairs itself.
///
/// Sans-I/O: takes messages and time, gives messages. The rules, from the network page:
///  - frame N is applied only if its `previousRoot` is the motion root of this world at tick N;
///  - if it is not, the world is frozen at N, the server is asked for its leaves and its snapshot
///    of tick N, the first different field is reported, the server's state is adopted;
///  - whatever follows a snapshot of tick T starts with frame T: while one is awaited, frames are
///    let go;
///  - own commands are kept until a *committed* frame shows them, and sent again after a resume
///    if the server has not put them in order: each counts once;
///  - no more own commands are under way at once than Welcome says may wait at the server.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/world/world.h"
#include "protocol/messages.h"

namespace huestep::client {

/// ns since some fixed moment; an argument, never a clock.
using Instant = std::uint64_t;

/// Own commands kept until committed; more are refused.
inline constexpr std::size_t maxPendingCommands = 1'024;

/// Numbers of a client's life, over all its connections.
struct Statistics {
    PlayerId player = 0;
    std::uint64_t tick = 0;   ///< of the world now
    std::uint64_t root = 0;   ///< its motion root
    std::uint64_t ticks = 0;  ///< frames applied
    std::uint64_t hashesCompared = 0;
    std::uint64_t mismatches = 0;
    std::uint64_t corrections = 0;    ///< snapshots adopted because of a mismatch
    std::uint64_t snapshots = 0;      ///< all snapshots adopted
    std::uint64_t connections = 0;    ///< Welcomes
    std::uint64_t resumes = 0;        ///< of them into the old seat
    std::uint64_t rolledBack = 0;     ///< ticks undone because the server lost them uncommitted
    std::uint64_t committedLost = 0;  ///< committed ticks the server did not have: must be 0
    std::uint64_t commandsSent = 0;
    std::uint64_t commandsResent = 0;
    std::uint64_t commandsSeen = 0;      ///< own commands found in frames
    std::uint64_t commandsLost = 0;      ///< never ordered: a later one was, so they never will be
    std::uint64_t commandsRejected = 0;  ///< of them rejected by the world
    std::uint64_t bytesIn = 0;           ///< set by the connection
    std::uint64_t bytesOut = 0;
    double latencyMedian = 0.0;  ///< s, from own command to the frame that has it
    double latencyP99 = 0.0;
    std::optional<protocol::DesyncReport> lastDesync;
};

struct ReplicaConfig {
    std::string session;
    protocol::Role role = protocol::Role::Player;
    protocol::Fingerprint fingerprint;
    StepResources resources;
    std::uint32_t checkpointEvery = 30;  ///< ticks from one Intent with a checkpoint to the next
};

class Replica {
 public:
    explicit Replica(ReplicaConfig config);

    /// A connection is up: sends Hello. The world and the seat of an earlier one are kept.
    void connected(Instant now);
    void disconnected();

    /// Takes one message of the server. A sentence: the connection must end (a Bye is queued).
    Status receive(protocol::Message message, Instant now);

    /// Asks for an action; it becomes a command with the next own sequence. A sentence, and
    /// nothing done: not playing, too many commands wait for their commit, or no Intent may hold
    /// this one (its size, its lists or its numbers are beyond the protocol's limits).
    Status act(Action action, Instant now);

    /// Leaves for good: the seat is given up.
    void leave();

    /// Messages to send, in order. Takes them out.
    std::vector<protocol::Message> takeOutgoing();

    [[nodiscard]] const World* world() const { return m_world ? &*m_world : nullptr; }
    [[nodiscard]] bool following() const { return m_state == State::Following; }
    [[nodiscard]] PlayerId player() const { return m_statistics.player; }
    [[nodiscard]] std::uint64_t committed() const { return m_committed; }
    /// Own commands that no committed frame has shown yet.
    [[nodiscard]] std::size_t pendingCommands() const { return m_pending.size(); }
    [[nodiscard]] float ticksPerSecond() const { return m_ticksPerSecond; }
    [[nodiscard]] const std::optional<protocol::Bye>& bye() const { return m_bye; }
    /// The counts, without tick, root and latencies: cheap.
    [[nodiscard]] const Statistics& counts() const { return m_statistics; }
    /// All of it.
    [[nodiscard]] Statistics statistics() const;

 private:
    enum class State : std::uint8_t {
        Apart,     ///< no connection
        Greeting,  ///< Hello sent
        Waiting,   ///< for a snapshot
        Following
    };
    struct Pending {
        Command command;
        Instant asked = 0;
        std::size_t bytes = 0;                ///< in an Intent
        std::optional<std::uint64_t> seenAt;  ///< tick of the frame that had it, or a later one
        bool sent = false;                    ///< over this connection or, ordered, an earlier one
        bool counted = false;                 ///< in the statistics
    };
    struct Incoming {
        protocol::SnapshotBegin begin;
        std::vector<std::byte> bytes;
    };

    Status on(const protocol::Welcome& welcome, Instant now);
    Status on(const protocol::Frame& frame, Instant now);
    Status on(const protocol::SnapshotBegin& begin);
    Status on(protocol::SnapshotChunk chunk);
    Status on(const protocol::SnapshotEnd& end);
    Status on(const protocol::HashNodes& nodes);
    Status on(const protocol::Ping& ping);
    Status on(const protocol::Bye& bye);

    Status refuse(protocol::ByeReason reason, std::string sentence);
    void send(protocol::Message message) { m_outgoing.push_back(std::move(message)); }
    void flushIntents();
    void resendPending(std::uint64_t lastSequence);
    void repeatOldest();
    void diverged(const protocol::Frame& frame);
    void reportDifference(const World& theirs);
    void adopt(World world);
    void noteOwnCommands(const protocol::Frame& frame, Instant now);
    void notePassedOver(std::uint64_t sequence, std::uint64_t tick);
    void noteSnapshot();
    void noteCommitted(std::uint64_t committed);

    ReplicaConfig m_config;
    State m_state = State::Apart;
    std::optional<World> m_world;
    /// Set while the world is frozen by a mismatch: its tick and both roots.
    std::optional<protocol::DesyncReport> m_frozen;
    std::optional<Incoming> m_incoming;
    std::optional<protocol::ResumeToken> m_token;
    std::optional<protocol::Bye> m_bye;
    std::vector<protocol::Message> m_outgoing;
    std::deque<Pending> m_pending;  ///< own commands, sequences rising
    std::uint64_t m_nextSequence = 1;
    std::uint64_t m_committed = 0;  ///< frames below are on the server's disk
    std::uint64_t m_lastCheckpoint = 0;
    std::uint64_t m_movedAt = 0;  ///< tick at which own commands last moved on: see `repeatOldest`
    std::uint32_t m_maxCommandsPerIntent = 16;
    std::uint32_t m_maxQueuedCommands = 0;  ///< at the server, as Welcome said
    std::uint32_t m_maxQueuedBytes = 0;
    float m_ticksPerSecond = 60.0f;
    std::vector<double> m_latencies;  ///< s, the newest 4,096
    std::size_t m_latencyAt = 0;
    Statistics m_statistics;
};

}  // namespace huestep::client
