/// A client's copy of a session: follows frames, compares every hash, repairs itself.
///
/// Sans-I/O: takes messages and time, gives messages. The rules, from the network page:
///  - frame N is applied only if its `previousRoot` is the motion root of this world at tick N;
///  - if it is not, the world is frozen at N, the server is asked for its leaves and its snapshot
///    of tick N, the first different field is reported, the server's state is adopted;
///  - whatever follows a snapshot of tick T starts with frame T: while one is awaited, frames are
///    let go;
///  - own commands count once each: see `OwnCommands`.
///
/// What a game does with it (docs/prediction.md), `now` being its clock:
///
///     replica.connected(now);                            // and what takeOutgoing() has, is sent
///     replica.receive(message, now);                     // whatever comes, as it comes
///     replica.advance(now);                              // once a picture: then
///     replica.act(Grab{body, point, target}, now);       //   what the player does,
///     for (Message& m : replica.takeOutgoing()) send(m);
///     draw(*replica.world(), replica.prediction());      //   each body at smoothing().posed(…)
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/own_commands.h"
#include "client/prediction.h"
#include "client/statistics.h"
#include "client/timeline.h"
#include "core/result.h"
#include "core/world/world.h"
#include "protocol/messages.h"

namespace huestep::client {

struct ReplicaConfig {
    std::string session;
    protocol::Role role = protocol::Role::Player;
    protocol::Fingerprint fingerprint;
    StepResources resources;
    std::uint32_t checkpointEvery = 30;  ///< ticks from one Intent with a checkpoint to the next
    /// For a player: run ahead of the frames by these rules. None: the world is where frames led.
    std::optional<PredictionRules> prediction = std::nullopt;
    std::vector<std::byte> ticket{};  ///< for the first Hello, where the server asks for one
};

class Replica {
 public:
    explicit Replica(ReplicaConfig config);

    /// A connection is up: sends Hello. The world and the seat of an earlier one are kept.
    void connected(Instant now);
    void disconnected();
    /// For the Hellos to come: the ticket that the server asks for.
    void showTicket(std::vector<std::byte> ticket) { m_config.ticket = std::move(ticket); }

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

    /// Lets time pass: with prediction, steps the world to where it is to be now, and asks the
    /// server how far it is. Call it before drawing, and at least once a tick; without prediction
    /// it does nothing. A player acts on the world that this leaves.
    void advance(Instant now);

    /// The world to show, ahead of what is confirmed by what is predicted. Null: none yet.
    [[nodiscard]] const World* world() const { return m_timeline ? &m_timeline->world() : nullptr; }
    /// The same with what is confirmed and what is predicted told apart. Null: none yet.
    [[nodiscard]] const Timeline* timeline() const { return m_timeline ? &*m_timeline : nullptr; }
    /// Null: this client does not predict.
    [[nodiscard]] const Prediction* prediction() const {
        return m_prediction ? &*m_prediction : nullptr;
    }
    [[nodiscard]] bool following() const { return m_state == State::Following; }
    [[nodiscard]] PlayerId player() const { return m_statistics.player; }
    [[nodiscard]] std::uint64_t committed() const { return m_committed; }
    /// Own commands that no committed frame has shown yet.
    [[nodiscard]] std::size_t pendingCommands() const { return m_commands.pending(); }
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
    Status on(const protocol::Ping& ping, Instant now);
    Status on(const protocol::Bye& bye);

    Status refuse(protocol::ByeReason reason, std::string sentence);
    void send(protocol::Message message) { m_outgoing.push_back(std::move(message)); }
    void flush();
    void diverged(const protocol::Frame& frame);
    void reportDifference(const World& theirs);
    void adopt(World world);
    void noteCommitted(std::uint64_t committed);

    ReplicaConfig m_config;
    State m_state = State::Apart;
    std::optional<Timeline> m_timeline;
    std::optional<Prediction> m_prediction;
    /// Set while the world is frozen by a mismatch: its tick and both roots.
    std::optional<protocol::DesyncReport> m_frozen;
    std::optional<Incoming> m_incoming;
    std::optional<protocol::ResumeToken> m_token;
    std::optional<protocol::Bye> m_bye;
    std::vector<protocol::Message> m_outgoing;
    OwnCommands m_commands;
    std::uint64_t m_committed = 0;  ///< frames below are on the server's disk
    std::uint64_t m_lastCheckpoint = 0;
    float m_ticksPerSecond = 60.0f;
    Statistics m_statistics;
};

}  // namespace huestep::client
