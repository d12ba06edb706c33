/// What a scene's host does to it by itself: commands as a pure function of the tick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/placement.h"
#include "core/world/command.h"

namespace huestep {

/// A sequence for command number `place` of the host in the step that leads from `tick`. It rises
/// with both. Places below `caps::maxCommands` are a script's; as many above them are free for
/// whoever else speaks as the host in the same tick.
constexpr std::uint64_t hostSequence(std::uint64_t tick, std::uint64_t place) {
    return 2 * std::uint64_t{caps::maxCommands} * tick + place + 1;
}

/// A value; thread rule: plain. It names bodies and joints by the ids that they have in a world of
/// its scene to which nobody else adds any: ids come from counters, so those of what it spawns
/// are known beforehand.
class Script {
 public:
    /// Appends what the host does in the step that leads from `tick`; `values` are those of the
    /// scene's parameters. A function of its arguments alone.
    using Rule = void (*)(std::span<const double> values, std::uint64_t tick,
                          std::vector<Action>& actions);

    /// Of a host that does nothing.
    Script() = default;
    /// `rule` may be null, and then does nothing. What it does is placed as its scene is.
    Script(Rule rule, std::vector<double> values, const Placement& placement = {});

    /// Whether it ever does anything.
    explicit operator bool() const { return m_rule != nullptr; }

    [[nodiscard]] std::vector<Action> actions(std::uint64_t tick) const;

    /// The same as the host's commands, numbered by `hostSequence`.
    [[nodiscard]] std::vector<Command> commands(std::uint64_t tick) const;

 private:
    Rule m_rule = nullptr;
    std::vector<double> m_values;
    Placement m_placement;
};

}  // namespace huestep
