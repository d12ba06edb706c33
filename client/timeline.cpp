#include "client/timeline.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace huestep::client {

bool Timeline::agrees(std::span<const Command> commands) const {
    return m_ahead.empty() ||
           std::equal(commands.begin(), commands.end(), m_ahead.front().commands.begin(),
                      m_ahead.front().commands.end());
}

std::uint32_t Timeline::confirm(std::span<const Command> commands, const StepResources& with) {
    if (!m_ahead.empty() && agrees(commands)) {
        m_outcomes = std::move(m_ahead.front().outcomes);
        recycle(std::move(m_ahead.front()));
        m_ahead.pop_front();
        ++m_confirmed;
        return 0;
    }
    const std::uint32_t undone = retreat();
    m_outcomes = m_world.step(commands, with).commands;
    ++m_confirmed;
    return undone;
}

void Timeline::predict(std::vector<Command> commands, const StepResources& with) {
    assert(ahead() < mostAhead);
    Predicted next;
    if (!m_spare.empty()) {
        next.before = std::move(m_spare.back());
        m_spare.pop_back();
    }
    m_world.checkpoint(next.before);
    next.root = m_world.motionRoot();
    next.outcomes = m_world.step(commands, with).commands;
    next.commands = std::move(commands);
    m_ahead.push_back(std::move(next));
}

std::uint32_t Timeline::retreat() {
    if (m_ahead.empty()) return 0;
    const std::uint32_t undone = ahead();
    m_world.restore(m_ahead.front().before);
    for (Predicted& predicted : m_ahead) recycle(std::move(predicted));
    m_ahead.clear();
    return undone;
}

void Timeline::recycle(Predicted&& predicted) {
    m_spare.push_back(std::move(predicted.before));
}

}  // namespace huestep::client
