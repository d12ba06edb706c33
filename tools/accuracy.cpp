#include "tools/accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace huestep::tools {
namespace {

constexpr std::size_t smallScene = 256;   // bodies up to which every tick is measured
constexpr std::uint64_t largeEvery = 30;  // ticks between measures of larger scenes

}  // namespace

Accuracy::Accuracy(const World& start)
    : m_definitions(start),
      m_every(start.bodies().size() <= smallScene ? 1 : largeEvery),
      m_scale(energyScale(start.info(), start.bodies(), start.motions())),
      m_pendulum(Pendulum::find(start)),
      m_ballistic(Ballistic::find(start)) {
    m_startEnergy =
        measure(start.info(), start.bodies(), start.shapes(), start.joints(), start.motions())
            .energy;
}

void Accuracy::watch(std::uint64_t tick, std::span<const Command> commands,
                     std::span<const BodyMotion> motions, bool touching) {
    m_definitions.apply(commands);
    if (m_definitions.changed()) {
        // Closed forms know the bodies of the start alone.
        m_pendulum.reset();
        m_ballistic.reset();
    }
    if (m_pendulum) m_pendulum->watch(motions);
    if (m_ballistic) m_ballistic->watch(motions, touching);
    if (tick % m_every == 0) take(motions);
}

void Accuracy::take(std::span<const BodyMotion> motions) {
    const Definitions& d = m_definitions;
    const Measures now = measure(d.info(), d.bodies(), d.shapes(), d.joints(), motions);
    if (d.changed()) {
        m_result.energyDrift = m_result.energyInjection = std::nullopt;
    } else {
        m_result.energyDrift = (now.energy - m_startEnergy) / m_scale;
        m_result.energyInjection =
            std::max(m_result.energyInjection.value_or(0.0), *m_result.energyDrift);
    }
    m_result.maxPenetration = std::max(m_result.maxPenetration, now.maxPenetration);
    m_result.meanPenetration = now.meanPenetration;
    m_result.maxJointError = std::max(m_result.maxJointError, now.maxJointError);
}

AccuracyResult Accuracy::finish(std::span<const BodyMotion> last) {
    take(last);
    if (m_pendulum) m_result.pendulum = m_pendulum->result(last);
    if (m_ballistic) m_result.ballistic = m_ballistic->result();
    return m_result;
}

Json asJson(const AccuracyResult& r) {
    const auto orNull = [](const std::optional<double>& value) {
        return value ? Json(*value) : Json();
    };
    Json json = {{"energy_drift", orNull(r.energyDrift)},
                 {"energy_injection", orNull(r.energyInjection)},
                 {"max_penetration_m", r.maxPenetration},
                 {"mean_penetration_m", r.meanPenetration},
                 {"max_joint_error_m", r.maxJointError}};
    if (r.pendulum)
        json["pendulum"] = {{"period_s", r.pendulum->period},
                            {"exact_period_s", r.pendulum->exact},
                            {"energy_loss", r.pendulum->energyLoss}};
    if (r.ballistic)
        json["ballistic"] = {{"seconds", r.ballistic->seconds},
                             {"max_error_m", r.ballistic->maxError}};
    return json;
}

void print(const AccuracyResult& r) {
    if (r.energyDrift && r.energyInjection)
        std::printf("energy       drift %s, injection %s (of weight times extent)\n",
                    number(*r.energyDrift).c_str(), number(*r.energyInjection).c_str());
    else
        std::printf("energy       - (bodies came or went)\n");
    std::printf("penetration  max %s m, mean at the end %s m\n", number(r.maxPenetration).c_str(),
                number(r.meanPenetration).c_str());
    std::printf("joint error  max %s m\n", number(r.maxJointError).c_str());
    for (const std::string& line : closedForms(r)) std::printf("%s\n", line.c_str());
}

std::vector<std::string> closedForms(const AccuracyResult& r) {
    std::vector<std::string> lines;
    if (r.pendulum) {
        char periods[96];
        std::snprintf(periods, sizeof periods, "pendulum     period %.7f s, exact %.7f s",
                      r.pendulum->period, r.pendulum->exact);
        lines.push_back(
            periods +
            (", error " + number(std::abs(r.pendulum->period / r.pendulum->exact - 1.0))) +
            "; energy loss " + number(100.0 * r.pendulum->energyLoss) + " %");
    }
    if (r.ballistic)
        lines.push_back("ballistic    off the parabola by " + number(r.ballistic->maxError) +
                        " m after " + number(r.ballistic->seconds) + " s");
    return lines;
}

}  // namespace huestep::tools
