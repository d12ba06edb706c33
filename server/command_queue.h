/// Commands that wait for their frame: bounded for each player and in total, by number and bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "core/world/command.h"
#include "server/limits.h"

namespace huestep::server {

class CommandQueue {
 public:
    enum class Admission : std::uint8_t {
        Queued,
        Old,         ///< its sequence is not above the last one queued: a repetition, let go
        PlayerFull,  ///< the player's own share is used up
        QueueFull    ///< the whole queue is
    };

    explicit CommandQueue(const Limits& limits) : m_limits(limits) {}

    /// Takes a command for a frame of `earliest` or later. `lastSequence` is that of the author's
    /// last command in the world; a queued one raises it. `late`: it asked for a frame before.
    Admission push(Command command, std::uint64_t earliest, std::uint64_t lastSequence,
                   bool late = false);

    struct Due {
        std::vector<Command> commands;
        std::vector<PlayerId> late;  ///< authors of those that came late, by id, each once
    };
    /// Takes out what is due at `tick`: at most `most` commands and `frameCommandBytes` of all,
    /// and each player's share. Who is served first goes round with the tick: none starves.
    Due take(std::uint64_t tick, std::uint32_t most);

    /// Sequence of the author's last command that waits; 0: none.
    [[nodiscard]] std::uint64_t lastQueued(PlayerId player) const;
    void forget(PlayerId player);
    [[nodiscard]] std::size_t size() const { return m_size; }
    [[nodiscard]] std::size_t bytes() const { return m_bytes; }

 private:
    struct Waiting {
        Command command;
        std::uint64_t earliest = 0;
        std::size_t bytes = 0;
        bool late = false;
    };
    struct Line {
        std::deque<Waiting> commands;  ///< sequences rise
        std::size_t bytes = 0;
    };
    void takeFrom(Line& line, std::uint64_t tick, std::uint32_t most, std::size_t& room, Due& out);

    Limits m_limits;
    std::size_t m_size = 0;
    std::size_t m_bytes = 0;
    std::map<PlayerId, Line> m_lines;
};

}  // namespace huestep::server
