/// Commands that wait for their frame: bounded for each player and in total.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "core/world/command.h"

namespace huestep::server {

class CommandQueue {
   public:
    enum class Admission : std::uint8_t {
        Queued,
        Old,         ///< its sequence is not above the last one queued: a repetition, let go
        PlayerFull,  ///< the player's own share is used up
        QueueFull    ///< the whole queue is
    };

    CommandQueue(std::uint32_t perPlayer, std::uint32_t total)
        : m_perPlayer(perPlayer), m_total(total) {}

    /// Takes a command for a frame of `earliest` or later. `lastSequence` is that of the author's
    /// last command in the world; a queued one raises it.
    Admission push(Command command, std::uint64_t earliest, std::uint64_t lastSequence);

    /// Takes out what is due at `tick`, at most `perPlayer` of each and `total` of all; which
    /// player is served first goes round with the tick, so that none starves.
    std::vector<Command> take(std::uint64_t tick, std::uint32_t perPlayer, std::uint32_t total);

    /// Sequence of the author's last command that waits; 0: none.
    [[nodiscard]] std::uint64_t lastQueued(PlayerId player) const;
    void forget(PlayerId player);
    [[nodiscard]] std::size_t size() const { return m_size; }

   private:
    struct Waiting {
        Command command;
        std::uint64_t earliest = 0;
    };
    std::uint32_t m_perPlayer;
    std::uint32_t m_total;
    std::size_t m_size = 0;
    std::map<PlayerId, std::deque<Waiting>> m_waiting;  ///< by player; sequences rise
};

}  // namespace huestep::server
