/// The first measures of accuracy of a run (A1, A3, A4, A5 and A7 of the physics page), printed
/// beside its times so that speed is never bought with error unseen. Everything is in double, from
/// definitions and motions alone, so every engine is judged alike.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene/measure.h"
#include "core/world/world.h"
#include "tools/definitions.h"
#include "tools/metrics/ballistic.h"
#include "tools/metrics/pendulum.h"
#include "tools/text.h"

namespace huestep::tools {

struct AccuracyResult {
    /// (E − E₀) / E_scale at the end, and the largest of the run, ≥ 0; none where bodies came or
    /// went, for what they brought and took is no drift.
    std::optional<double> energyDrift;
    std::optional<double> energyInjection;
    double maxPenetration = 0.0;   ///< m, peak
    double meanPenetration = 0.0;  ///< m, over the overlapping pairs at the end
    double maxJointError = 0.0;    ///< m, peak
    std::optional<PendulumResult> pendulum;
    std::optional<BallisticResult> ballistic;
};

/// Watches one run. E_scale is the weight of the dynamic bodies times the diagonal of the box
/// around all centres at the start, plus the kinetic energy then.
class Accuracy {
 public:
    /// `start`: the world of the scene before its first step, whose definitions, and those of what
    /// comes later, are what motions are judged by.
    explicit Accuracy(const World& start);

    /// After step number `tick`, counted from 1, with these commands. The narrow phase in double is
    /// run on every tick of a small scene and on every 30th of a large one.
    void watch(std::uint64_t tick, std::span<const Command> commands,
               std::span<const BodyMotion> motions, bool touching);

    /// `last`: what the last `watch` saw.
    AccuracyResult finish(std::span<const BodyMotion> last);

 private:
    void take(std::span<const BodyMotion> motions);

    Definitions m_definitions;
    std::uint64_t m_every;       ///< ticks between narrow phases in double
    double m_scale = 1.0;        ///< J
    double m_startEnergy = 0.0;  ///< J
    AccuracyResult m_result;
    std::optional<Pendulum> m_pendulum;
    std::optional<Ballistic> m_ballistic;
};

Json asJson(const AccuracyResult& result);

/// The comparisons with closed forms that the scene allows, a line each.
std::vector<std::string> closedForms(const AccuracyResult& result);

void print(const AccuracyResult& result);  ///< lines of text on standard output

}  // namespace huestep::tools
