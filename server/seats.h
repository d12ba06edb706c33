/// Who plays: seats, from the wish to join to the end of the time a seat is kept.
///
/// A seat begins with a join. The player's id is chosen when the frame with its AddPlayer closes,
/// as the number of players that ever joined plus one, which is state: so an id is never used
/// twice, whatever is lost in a crash. The seat is handed over only once that frame is on disk:
/// a client never holds a token of a player that the journal might not know.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/world/world.h"
#include "server/limits.h"
#include "server/resume_token.h"

namespace huestep::server {

using JoinId = std::uint64_t;  ///< a wish to join; 0 is none

class Seats {
 public:
    Seats(std::string session, std::uint32_t epoch, const ResumeKey& key, const Limits& limits);

    /// Seats of a world that was recovered: all empty, kept as if they had just become so.
    void recover(const World& world, Instant now);

    /// None: every seat is taken or asked for. `holder`: who it is for, where tickets say so.
    std::optional<JoinId> join(std::string holder = {});
    /// Whether a seat for this holder is asked for and not yet handed over.
    [[nodiscard]] bool joining(const std::string& holder) const;
    struct Outcome {
        enum class Kind : std::uint8_t { Pending, Seated, Refused } kind = Kind::Pending;
        PlayerId player = 0;
        std::string reason;  ///< of a refusal, in words
    };
    /// What became of a join. Seated and Refused are told once.
    Outcome outcome(JoinId join, Instant now);
    /// The connection went before the outcome.
    void abandon(JoinId join);

    /// A seat for the holder of a token: the newest issued for it, the one before (its answer may
    /// have been lost), or one of an earlier epoch while at most one was issued in this one.
    /// The sentence says why not.
    struct Resumed {
        PlayerId player = 0;
        /// The token is of this epoch, so what its holder stepped is what this server closed. A
        /// holder from before a restart may have stepped frames that were lost with it, and its
        /// motion root need not show that: a command that moved nothing yet is state too.
        bool sameEpoch = false;
    };
    Result<Resumed> resume(const protocol::ResumeToken& token, Instant now);
    /// The seat that a holder got by an earlier ticket, for whoever shows a new one of his; 0: he
    /// has none. It is known as long as this server runs.
    PlayerId reclaim(const std::string& holder, Instant now);
    /// The token of a taken seat that goes out now: a fresh one, or after a `resume` by the one
    /// before the newest, the newest again.
    protocol::ResumeToken issue(PlayerId player);
    /// The connection of a seat ended: kept for a while, or given up `forGood`.
    void vacate(PlayerId player, bool forGood, Instant now);
    /// Something arrived from a player: it is not late.
    void heard(PlayerId player, std::uint64_t tick);

    /// The host's commands for the frame of `tick`: players to add and to remove.
    /// `sequence`: the host's last one.
    std::vector<Command> commandsFor(const World& world, std::uint64_t sequence, Instant now);
    /// Learns from the step what became of them. `removed` get their seats cleared.
    void applied(const World& world, std::uint64_t tick);
    void committed(std::uint64_t below);

    /// Players with a seat whose connection has been silent for more than `lateTicks`.
    [[nodiscard]] std::vector<PlayerId> late(std::uint64_t tick) const;
    [[nodiscard]] bool has(PlayerId player) const { return m_seats.contains(player); }
    [[nodiscard]] std::size_t taken() const { return m_seats.size(); }
    [[nodiscard]] std::size_t connected() const;

 private:
    struct Seat {
        std::string holder;  ///< empty: not known
        bool connected = false;
        bool leaving = false;  ///< its RemovePlayer comes next
        Instant emptySince = 0;
        std::uint64_t heardAt = 0;  ///< tick
        std::uint16_t issued = 0;   ///< newest token of this epoch that went out
        int next = 1;               ///< the token that goes out next
    };
    struct Join {
        std::string holder;
        PlayerId player = 0;            ///< once its frame is closed
        std::uint64_t committedAt = 0;  ///< the seat is handed over at this tick
        bool asked = false;             ///< its AddPlayer is in the frame being closed
        std::string refusal;
    };

    std::string m_session;
    std::uint32_t m_epoch;
    ResumeKey m_key;
    Limits m_limits;
    std::map<PlayerId, Seat> m_seats;
    std::map<JoinId, Join> m_joins;
    JoinId m_lastJoin = 0;
    std::uint64_t m_committed = 0;
    std::uint64_t m_tick = 0;  ///< of the newest closed frame
};

}  // namespace huestep::server
