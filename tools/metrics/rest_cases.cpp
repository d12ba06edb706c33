// A4, A15 and A18: bodies at rest upon each other.

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/metrics/case_lists.h"
#include "tools/metrics/judges.h"
#include "tools/metrics/scenes.h"
#include "tools/metrics/soft_model.h"

namespace huestep::tools {
namespace {

MetricCase restCase(std::string_view metric, std::string name, const std::string& scene,
                    double seconds) {
    MetricCase c = caseOf(metric, std::move(name), scene, ticksIn(seconds));
    c.kind = SceneClass::Stack;
    c.unit = "m";
    c.reference = "0: rigid bodies";
    return c;
}

JudgeMaker penetrationJudge(Fold fold, double Measures::*which) {
    return [fold, which](const World& world) {
        const Start start(world);
        return folded(world, fold, {},
                      [start, which](const Frame& f) { return start.measured(f.motions).*which; });
    };
}

void addPenetrations(std::vector<MetricCase>& cases) {
    MetricCase c = restCase("A4", "pyramid-peak", "pyramid:base=10", 5.0);
    c.what = "a pyramid of base 10: deepest overlap in 5 s";
    c.judge = penetrationJudge(Fold::Most, &Measures::maxPenetration);
    cases.push_back(c);
    c.name = "pyramid-mean";
    c.what = "a pyramid of base 10: mean overlap of those there are, after 5 s";
    c.judge = penetrationJudge(Fold::Last, &Measures::meanPenetration);
    cases.push_back(c);
}

/// By how much each box of a straight stack has come nearer to what it stands on, the lowest first.
std::vector<double> squeezes(const Start& start, std::span<const BodyMotion> now) {
    std::vector<double> levels;
    double before = 0.0;
    for (std::size_t i = 1; i < start.bodies.size(); ++i) {
        const double sunk = static_cast<double>(start.motions[i].position.y) -
                            static_cast<double>(now[i].position.y);
        levels.push_back(sunk - before);
        before = sunk;
    }
    return levels;
}

/// What the law of soft rows says of them. Each level rests on two points at half a metre from the
/// centres, which share the load. With I = m/6 of a unit box, one such row has the effective mass
/// 1 / (1/m + r²/I) = 0.4 m on the ground and half of that between two boxes.
std::vector<double> squeezeFloors(const Start& start) {
    std::vector<double> floors;
    const std::size_t boxes = start.bodies.size() - 1;
    const double g = length(start.gravity());
    const SoftOmegas omegas = softOmegas(start.info);
    for (std::size_t level = 0; level < boxes; ++level) {
        const auto mass = static_cast<double>(start.bodies[level + 1].mass);
        const double load = 0.5 * mass * g * static_cast<double>(boxes - level);
        const bool ground = level == 0;
        const double omega = ground ? omegas.ground : omegas.contact;
        floors.push_back(floorLaw(load, (ground ? 0.4 : 0.2) * mass, omega));
    }
    return floors;
}

double farthest(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double off = std::abs(a[i] - b[i]);
        most = std::isfinite(off) ? std::max(most, off) : failed;
    }
    return most;
}

void addStacks(std::vector<MetricCase>& cases) {
    MetricCase c = restCase("A15", "stack-10-sink", "stack:n=10", 10.0);
    c.what = "ten boxes exactly upon each other: the level that is squeezed most, after 10 s";
    c.scene = [] { return straightStack(10); };
    c.judge = [](const World& world) {
        const Start start(world);
        const std::vector<double> none(start.bodies.size() - 1, 0.0);
        return folded(world, Fold::Last, {},
                      [=](const Frame& f) { return farthest(squeezes(start, f.motions), none); });
    };
    cases.push_back(c);
    c.name = "stack-10-floor";
    c.what = "that stack: the level that is farthest off the law of soft rows, after 10 s";
    c.reference = "floor law";
    c.truth = Truth::SoftModel;
    c.judge = [](const World& world) {
        const Start start(world);
        const std::vector<double> floors = squeezeFloors(start);
        return folded(world, Fold::Last, {},
                      [=](const Frame& f) { return farthest(squeezes(start, f.motions), floors); });
    };
    cases.push_back(c);
}

double speedSquared(const Start& start, const Frame& f) {
    double sum = 0.0;
    double moving = 0.0;
    for (std::size_t i = 0; i < start.bodies.size(); ++i) {
        if (!start.bodies[i].dynamic()) continue;
        sum += lengthSquared(inDouble(f.motions[i].velocity));
        moving += 1.0;
    }
    return sum / moving;
}

/// When everything that can sleep slept for the first time, s.
class SleepJudge final : public Judge {
 public:
    explicit SleepJudge(const World& world) : m_start(world) {}
    void watch(std::uint64_t tick, std::span<const Command>, std::span<const BodyMotion> motions,
               bool) override {
        if (m_asleep) return;
        for (std::size_t i = 0; i < m_start.bodies.size(); ++i) {
            if (m_start.bodies[i].dynamic() && !motions[i].asleep()) return;
        }
        m_asleep = static_cast<double>(tick) * static_cast<double>(m_start.info.stepSeconds);
    }
    [[nodiscard]] double error() const override { return m_asleep.value_or(failed); }

 private:
    Start m_start;
    std::optional<double> m_asleep;
};

void addRest(std::vector<MetricCase>& cases) {
    MetricCase c = restCase("A18", "pyramid-jitter", "pyramid:base=10", 20.0);
    c.what = "a pyramid of base 10: rms speed in the last of 20 s";
    c.unit = "m/s";
    c.reference = "0: at rest";
    c.judge = [](const World& world) {
        const Start start(world);
        return folded(world, Fold::Rms, {ticksIn(19.0) + 1, ticksIn(20.0)},
                      [start](const Frame& f) { return std::sqrt(speedSquared(start, f)); });
    };
    cases.push_back(c);
    c.name = "pyramid-sleep";
    c.what = "a pyramid of base 10 that may sleep: after how long it does";
    c.unit = "s";
    c.reference = "0";
    c.charted = false;
    c.scene = [] {
        Scene scene = catalogScene("pyramid:base=10");
        scene.sleep = true;
        return scene;
    };
    c.judge = [](const World& start) { return std::make_unique<SleepJudge>(start); };
    cases.push_back(c);
}

}  // namespace

void addRestCases(std::vector<MetricCase>& cases) {
    addPenetrations(cases);
    addStacks(cases);
    addRest(cases);
}

}  // namespace huestep::tools
