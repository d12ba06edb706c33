/// The commands of this client, each from the wish to the committed frame that has it.
///
/// The rules, from the network page:
///  - own commands are kept until a *committed* frame shows them, and sent again after a resume
///    if the server has not put them in order: each counts once;
///  - no more of them are under way at once than Welcome says may wait at the server.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "client/statistics.h"
#include "core/result.h"
#include "core/world/event.h"
#include "core/world/world.h"
#include "protocol/messages.h"

namespace huestep::client {

/// Own commands kept until committed; more are refused.
inline constexpr std::size_t maxPendingCommands = 1'024;

/// What becomes of commands is counted into the `Statistics` of each call.
class OwnCommands {
 public:
    /// A seat was taken: the one of before, whose commands go on, or a new one.
    void welcomed(const protocol::Welcome& welcome, bool sameSeat, Statistics& counts);

    /// Takes an action as the player's next command, which asks for the frame of `tick` (0: for
    /// none; see `protocol::Intent`) or, where the one before it asks for a later, that. A
    /// sentence, and nothing done: too many wait for their commit, or no Intent may hold this one
    /// (its size, its lists or its numbers are beyond the protocol's limits).
    Status ask(Action action, std::uint64_t tick, Instant now, Statistics& counts);

    /// Appends the commands to expect in the frame of `tick`, which no frame has shown yet: those
    /// that asked for it, and in the `next` frame to come also those that came too late for theirs.
    void expected(std::uint64_t tick, bool next, std::vector<Command>& out) const;

    /// Appends the Intents that may go out now.
    void send(std::vector<protocol::Message>& out);

    /// A frame was applied, with these outcomes of its commands: which of them are own.
    void applied(const protocol::Frame& frame, std::span<const CommandOutcome> outcomes,
                 Instant now, Statistics& counts);
    /// A snapshot took the place of frames that may never come.
    void adopted(const World& world, Statistics& counts);
    /// Frames below this tick are on disk.
    void committed(std::uint64_t below);

    /// A server whose whole queue was full let go of commands without a word, and what follows
    /// them here might wait for ever for their frames. So the oldest is said again, if for
    /// `patience` ticks up to `tick` none moved on; where it waits at the server, that lets the
    /// repetition go.
    void repeatOldest(std::uint64_t tick, std::uint64_t patience,
                      std::vector<protocol::Message>& out, Statistics& counts);

    /// Those that no committed frame has shown yet.
    [[nodiscard]] std::size_t pending() const { return m_pending.size(); }
    /// Fills in the latencies.
    void describe(Statistics& counts) const;

 private:
    struct Pending {
        Command command;
        std::uint64_t tick = 0;  ///< asked for; 0: none
        Instant given = 0;
        std::size_t bytes = 0;                ///< in an Intent
        std::optional<std::uint64_t> seenAt;  ///< tick of the frame that had it, or a later one
        bool sent = false;                    ///< over this connection or, ordered, an earlier one
        bool counted = false;                 ///< in the statistics
    };

    void resend(std::uint64_t lastSequence, Statistics& counts);
    void seen(std::uint64_t sequence, std::uint64_t tick, Instant now, Statistics& counts);
    void passedOver(std::uint64_t sequence, std::uint64_t tick, Statistics& counts);
    void noteLatency(double seconds);

    std::deque<Pending> m_pending;  ///< sequences rise
    PlayerId m_player = 0;
    std::uint64_t m_nextSequence = 1;
    std::uint64_t m_movedAt = 0;  ///< tick at which they last moved on: see `repeatOldest`
    std::uint32_t m_maxCommandsPerIntent = 16;
    std::uint32_t m_maxQueuedCommands = 0;  ///< at the server, as Welcome said
    std::uint32_t m_maxQueuedBytes = 0;
    std::vector<double> m_latencies;  ///< s, the newest 4,096
    std::size_t m_latencyAt = 0;
};

}  // namespace huestep::client
