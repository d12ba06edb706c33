#include "core/scene/script.h"

#include <cassert>
#include <utility>

namespace huestep {

Script::Script(Rule rule, std::vector<double> values, const Placement& placement)
    : m_rule(rule), m_values(std::move(values)), m_placement(placement) {}

std::vector<Action> Script::actions(std::uint64_t tick) const {
    std::vector<Action> actions;
    if (m_rule != nullptr) m_rule(m_values, tick, actions);
    assert(actions.size() <= caps::maxCommands);
    for (Action& action : actions) place(action, m_placement);
    return actions;
}

std::vector<Command> Script::commands(std::uint64_t tick) const {
    std::vector<Command> commands;
    for (Action& action : actions(tick)) {
        commands.push_back({0, hostSequence(tick, commands.size()), std::move(action)});
    }
    return commands;
}

}  // namespace huestep
