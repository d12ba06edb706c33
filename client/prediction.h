/// Prediction of one client: the world it shows runs ahead by the way to the server and back.
///
/// What the player does is seen at once, or after the input delay, because the world is stepped
/// with it before any frame has it. When a frame comes that has other commands than its tick was
/// stepped with, the world goes back and is stepped again (`Timeline`), when the game next asks for
/// the present: frames that come together cost one way back, however many they are. At which tick
/// the world is to be is the `Pacer`'s; what others do meanwhile a `Guess`; that bodies are not
/// seen to jump, `Smoothing`'s.
///
/// Sans-I/O; one thread.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "client/guess.h"
#include "client/own_commands.h"
#include "client/pacer.h"
#include "client/smoothing.h"
#include "client/statistics.h"
#include "client/timeline.h"

namespace huestep::client {

struct PredictionRules {
    PacerRules pacing;
    Guess guess;  ///< none: others do nothing new
    SmoothingRules smoothing;
    Clock clock = nullptr;  ///< to measure what going back costs; none: no times
};

class Prediction {
 public:
    explicit Prediction(PredictionRules rules);

    void welcomed(const protocol::Welcome& welcome, Instant now);
    /// The world is another one than before, from a snapshot.
    void adopted();

    /// Applies a frame to the timeline, whose next tick it is.
    void confirm(Timeline& timeline, const protocol::Frame& frame, const StepResources& with);
    /// Lets time pass: steps the world to where it is to be now.
    void advance(Timeline& timeline, const OwnCommands& own, PlayerId self, Instant now,
                 const StepResources& with);

    Pacer& pacer() { return m_pacer; }
    [[nodiscard]] const Pacer& pacer() const { return m_pacer; }
    [[nodiscard]] const Smoothing& smoothing() const { return m_smoothing; }
    [[nodiscard]] PredictionFigures figures(const Timeline* timeline) const;

 private:
    [[nodiscard]] std::uint64_t time() const { return m_rules.clock ? m_rules.clock() : 0; }
    void wentBack(std::uint64_t since, std::uint32_t undone, std::uint64_t head);
    void noteCorrection(const World& world);
    void step(Timeline& timeline, const OwnCommands& own, PlayerId self, const StepResources& with);

    PredictionRules m_rules;
    Pacer m_pacer;
    Smoothing m_smoothing;
    PredictionFigures m_figures;
    std::vector<Command> m_last;  ///< commands of the newest frame
    PlayerId m_self = 0;
    Instant m_now = 0;
    std::uint64_t m_again = 0;    ///< head before the world last went back: stepped before
    std::uint64_t m_wayBack = 0;  ///< ns of the way back that is not yet made up for
};

}  // namespace huestep::client
