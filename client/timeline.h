/// A world, the ticks it has run ahead of what is confirmed, and the way back.
///
///     0 ........ confirmed() ........ head()
///     frames     predicted ticks      the world
///
/// There is one world, at `head()`. Before each predicted tick a checkpoint is taken and the tick's
/// commands are kept: a frame that has the same commands confirms the tick as it was stepped, at no
/// cost; one that has others takes the world back to the tick's checkpoint and steps it with those.
/// What was predicted after it is gone then, and is predicted anew by whoever predicts. So
///  - the confirmed world is never a matter of opinion: it is what the frames alone lead to;
///  - a tick that was predicted rightly is stepped once, and a wrong guess costs the ticks from
///    there, however many frames came at once.
/// The alternative, a confirmed and a predicted world side by side, steps every tick twice even
/// where all is guessed rightly, and pays for each way back with a copy of a whole world.
///
/// Memory: a checkpoint for each tick ahead, at most `mostAhead`.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/world/world.h"

namespace huestep::client {

class Timeline {
 public:
    /// Ticks that may be predicted; a second at 60 a second.
    static constexpr std::uint32_t mostAhead = 60;

    /// Begins with a confirmed world.
    explicit Timeline(World world) : m_world(std::move(world)), m_confirmed(m_world.tick()) {}

    /// At `head()`.
    [[nodiscard]] const World& world() const { return m_world; }
    [[nodiscard]] std::uint64_t head() const { return m_confirmed + m_ahead.size(); }
    /// Frames below this tick are applied.
    [[nodiscard]] std::uint64_t confirmed() const { return m_confirmed; }
    [[nodiscard]] std::uint32_t ahead() const { return static_cast<std::uint32_t>(m_ahead.size()); }
    /// Motion root of the world at `confirmed()`.
    [[nodiscard]] std::uint64_t confirmedRoot() const {
        return m_ahead.empty() ? m_world.motionRoot() : m_ahead.front().root;
    }
    /// The commands that tick `confirmed() + place` was predicted with. `place` < `ahead()`.
    [[nodiscard]] std::span<const Command> predicted(std::uint32_t place) const {
        return m_ahead[place].commands;
    }

    /// Whether the tick `confirmed()` is not predicted otherwise than with these commands.
    [[nodiscard]] bool agrees(std::span<const Command> commands) const;

    /// Applies the frame of tick `confirmed()`. Returns how many predicted ticks it undid.
    std::uint32_t confirm(std::span<const Command> commands, const StepResources& with);
    /// What became of the commands of the frame applied last.
    [[nodiscard]] std::span<const CommandOutcome> outcomes() const { return m_outcomes; }

    /// Steps one tick further with a guess: commands in key order. Requires
    /// `ahead() < mostAhead`.
    void predict(std::vector<Command> commands, const StepResources& with);

    /// Goes back to what is confirmed. Returns how many predicted ticks that undid.
    std::uint32_t retreat();

 private:
    struct Predicted {
        Checkpoint before;
        std::uint64_t root = 0;  ///< motion root before
        std::vector<Command> commands;
        std::vector<CommandOutcome> outcomes;
    };
    void recycle(Predicted&& predicted);

    World m_world;
    std::uint64_t m_confirmed;
    std::deque<Predicted> m_ahead;
    /// Checkpoints of this world out of use: a new one made over an old costs what changed since.
    std::vector<Checkpoint> m_spare;
    std::vector<CommandOutcome> m_outcomes;
};

}  // namespace huestep::client
