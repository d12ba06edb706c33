#include "client/prediction.h"

#include <algorithm>
#include <utility>

namespace huestep::client {

namespace {

/// Whether a player's commands in the frame asked for one before. Of a player who is silent a frame
/// says the same, but has no commands.
bool hasLate(const protocol::Frame& frame, PlayerId player) {
    return std::binary_search(frame.substituted.begin(), frame.substituted.end(), player) &&
           std::any_of(frame.commands.begin(), frame.commands.end(),
                       [player](const Command& command) { return command.author == player; });
}

}  // namespace

Prediction::Prediction(PredictionRules rules)
    : m_rules(std::move(rules)), m_pacer(m_rules.pacing), m_smoothing(m_rules.smoothing) {}

void Prediction::welcomed(const protocol::Welcome& welcome, Instant now) {
    m_self = welcome.player;
    m_now = now;
    m_pacer.start(welcome, now);
}

void Prediction::adopted() {
    m_smoothing.forget();
    m_last.clear();
    m_again = 0;
    m_wayBack = 0;
}

void Prediction::confirm(Timeline& timeline, const protocol::Frame& frame,
                         const StepResources& with) {
    const std::uint64_t head = timeline.head();
    const bool agrees = timeline.agrees(frame.commands);
    if (!agrees) m_smoothing.shown(timeline.world());
    const std::uint64_t since = agrees ? 0 : time();
    const std::uint32_t undone = timeline.confirm(frame.commands, with);
    if (undone != 0) wentBack(since, undone, head);
    noteCorrection(timeline.world());
    if (hasLate(frame, m_self)) ++m_figures.late;
    m_last = frame.commands;
}

void Prediction::wentBack(std::uint64_t since, std::uint32_t undone, std::uint64_t head) {
    ++m_figures.rollbacks;
    m_figures.undone += undone;
    m_figures.deepest = std::max(m_figures.deepest, undone);
    m_again = std::max(m_again, head);
    m_wayBack += time() - since;
}

void Prediction::noteCorrection(const World& world) {
    if (!m_smoothing.awaits(world.tick())) return;
    const auto error = static_cast<double>(m_smoothing.corrected(world));
    m_figures.errorSum += error;
    m_figures.errorMost = std::max(m_figures.errorMost, error);
}

void Prediction::advance(Timeline& timeline, const OwnCommands& own, PlayerId self, Instant now,
                         const StepResources& with) {
    m_self = self;
    m_smoothing.decay(now > m_now ? 1e-9f * static_cast<float>(now - m_now) : 0.0f);
    m_now = std::max(m_now, now);
    m_pacer.advance(now, timeline.confirmed());
    if (!m_pacer.measured()) return;
    // The world is not seen to go back: what was stepped is stepped again, whatever the clock says.
    const std::uint32_t most = std::min(m_rules.pacing.mostAhead, Timeline::mostAhead);
    const std::uint64_t goal =
        std::min(std::max(m_pacer.head(), m_again), timeline.confirmed() + most);
    const std::uint64_t since = m_wayBack != 0 ? time() : 0;
    while (timeline.head() < std::min(goal, m_again)) {
        step(timeline, own, self, with);
        ++m_figures.again;
    }
    if (m_wayBack != 0) {
        m_wayBack += time() - since;
        m_figures.nanoseconds += m_wayBack;
        m_figures.nanosecondsMost = std::max(m_figures.nanosecondsMost, m_wayBack);
        m_wayBack = 0;
    }
    m_again = 0;
    while (timeline.head() < goal) {
        step(timeline, own, self, with);
        ++m_figures.predicted;
    }
}

void Prediction::step(Timeline& timeline, const OwnCommands& own, PlayerId self,
                      const StepResources& with) {
    std::vector<Command> commands;
    if (m_rules.guess) {
        const GuessInput input{timeline.world(), self, m_last, timeline.ahead()};
        commands = m_rules.guess(input);
    }
    own.expected(timeline.head(), timeline.ahead() == 0, commands);
    sortByKey(commands);
    timeline.predict(std::move(commands), with);
    noteCorrection(timeline.world());
}

PredictionFigures Prediction::figures(const Timeline* timeline) const {
    PredictionFigures out = m_figures;
    out.lead = timeline ? timeline->ahead() : 0;
    out.inputDelay = m_pacer.inputDelay();
    out.roundTrip = m_pacer.roundTrip();
    out.jitter = m_pacer.jitter();
    return out;
}

}  // namespace huestep::client
