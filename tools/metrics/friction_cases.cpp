// A8 to A13: Coulomb's law on slopes and level ground, g = 10 m/s².

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "tools/metrics/case_lists.h"
#include "tools/metrics/judges.h"
#include "tools/metrics/scenes.h"

namespace huestep::tools {
namespace {

constexpr double g = 10.0;
constexpr double slope = 20.0 * std::numbers::pi / 180.0;  // rad, downwards to the right
constexpr double radius = 0.5;                             // m, of the disc

const double slopeSine = std::sin(slope);
const double slopeCosine = std::cos(slope);

/// How far body 1 has come down the slope since the start, m.
Measure downhill(const World& world) {
    const Vec2d from = inDouble(world.motions()[1].position);
    return [from](const Frame& f) {
        return dot(positionOf(f, 1) - from, Vec2d{slopeCosine, -slopeSine});
    };
}

/// The same from where it was after a second, when it has sat down.
Measure later(Measure way) {
    const auto seat = std::make_shared<double>(0.0);
    return [way = std::move(way), seat](const Frame& f) {
        if (f.tick <= ticksIn(1.0)) *seat = way(f);
        return way(f) - *seat;
    };
}

/// Off s(t) at the end, as a share of it.
JudgeMaker slidJudge(double acceleration) {
    return [acceleration](const World& world) {
        return folded(world, Fold::Last, {}, [way = downhill(world), acceleration](const Frame& f) {
            return way(f) / (0.5 * acceleration * f.seconds * f.seconds) - 1.0;
        });
    };
}

MetricCase frictionCase(std::string_view metric, std::string name, const std::string& scene,
                        double seconds) {
    MetricCase c = caseOf(metric, std::move(name), scene, ticksIn(seconds));
    c.kind = SceneClass::Friction;
    c.unit = "1";
    c.reference = "closed form";
    return c;
}

void addRamps(std::vector<MetricCase>& cases) {
    MetricCase c = frictionCase("A8", "ramp-slide", "ramp:angle=20,friction=0.3", 2.0);
    c.what = "a box that slides down 20 degrees with friction 0.3: its way in 2 s, as a share";
    c.judge = slidJudge(g * (slopeSine - 0.3 * slopeCosine));
    cases.push_back(c);

    c = frictionCase("A9", "ramp-stick", "ramp:angle=20,friction=0.5", 10.0);
    c.what = "a box that sticks on 20 degrees with friction 0.5: how far it creeps in 10 s";
    c.unit = "m";
    c.reference = "0";
    c.judge = [](const World& world) { return folded(world, Fold::Last, {}, downhill(world)); };
    cases.push_back(c);
    c.name = "ramp-stick-later";
    c.what = "that box: how far it creeps from the end of the first second to the tenth";
    c.charted = false;
    c.judge = [](const World& world) {
        return folded(world, Fold::Last, {}, later(downhill(world)));
    };
    cases.push_back(c);
    c.judge = [](const World& world) { return folded(world, Fold::Last, {}, downhill(world)); };
    c.name = "ramp-stick-barely";
    c.what = "a box that sticks on 20 degrees with friction 1 % above the tangent, 10 s";
    c.scene = [] { return catalogScene("ramp:angle=20,friction=0.367609937"); };
    cases.push_back(c);

    c = frictionCase("A10", "stop-distance", "slide:speed=5,friction=0.4", 2.0);
    c.what = "a box at 5 m/s on friction 0.4: its way until it stops, as a share of 3.125 m";
    c.judge = [](const World& world) {
        return folded(world, Fold::Last, {}, [](const Frame& f) {
            return positionOf(f, 1).x / (5.0 * 5.0 / (2.0 * 0.4 * g)) - 1.0;
        });
    };
    cases.push_back(c);
}

/// How far the box comes after the first second.
std::unique_ptr<Judge> holdsJudge(const World& world) {
    return folded(world, Fold::Last, {}, later(downhill(world)));
}

/// The smallest friction that holds a box on 20 degrees, against the tangent.
Result<double> threshold(const Setting& setting) {
    constexpr double holds = 1e-3;  // m
    const double exact = slopeSine / slopeCosine;
    double slips = 0.5 * exact;
    double sticks = 2.0 * exact;
    for (int i = 0; i < 16; ++i) {
        const double middle = 0.5 * (slips + sticks);
        const Scene scene = catalogScene("ramp:angle=20,friction=" + std::to_string(middle));
        const Result<double> way = judgeRun(scene, {}, ticksIn(10.0), holdsJudge, setting);
        if (!way) return way.error();
        (*way < holds ? sticks : slips) = middle;
    }
    return std::abs(0.5 * (slips + sticks) / exact - 1.0);
}

void addThreshold(std::vector<MetricCase>& cases) {
    MetricCase c = frictionCase("A11", "ramp-threshold", "ramp:angle=20,friction=0.36397", 10.0);
    c.what = "smallest friction that holds a box on 20 degrees, by bisection, as a share";
    c.charted = false;
    c.series = threshold;
    cases.push_back(c);
}

double slipOf(const Frame& f, Vec2d along) {
    const BodyMotion& disc = f.motions[1];
    // Rolling forwards it turns clockwise: the point that touches rests if v = −ω r.
    return dot(inDouble(disc.velocity), along) + static_cast<double>(disc.angularVelocity) * radius;
}

void addRolling(std::vector<MetricCase>& cases) {
    MetricCase c = frictionCase("A12", "rolling-way", "ramp:angle=20,friction=0.6,disc=1", 2.0);
    c.what = "a disc that rolls down 20 degrees: its way in 2 s, as a share of 4.56027 m";
    c.judge = slidJudge(g * slopeSine * 2.0 / 3.0);
    cases.push_back(c);
    c.name = "rolling-slip";
    c.what = "the speed of the point that touches, at most in the second second";
    c.unit = "m/s";
    c.reference = "0: it rolls";
    c.judge = [](const World& world) {
        return folded(world, Fold::Most, {ticksIn(1.0), ticksIn(2.0)}, [](const Frame& f) {
            return slipOf(f, {slopeCosine, -slopeSine});
        });
    };
    cases.push_back(c);
}

/// When the slip of a disc that slides ends, found by the straight line through its last two ticks
/// above a hundredth of its speed: exact, as the slip falls evenly to its end.
class RollsAfter final : public Judge {
 public:
    RollsAfter(const World& start, double friction)
        : m_step(static_cast<double>(start.info().stepSeconds)),
          m_slip(static_cast<double>(start.motions()[1].velocity.x)),
          m_below(0.01 * m_slip),
          m_exact(m_slip / (3.0 * friction * g)) {}

    void watch(std::uint64_t tick, std::span<const Command>, std::span<const BodyMotion> motions,
               bool) override {
        if (m_rolls) return;
        const double slip = slipOf({tick, 0.0, motions}, {1.0, 0.0});
        if (slip < m_below) m_rolls = m_step * (static_cast<double>(tick) - 1.0 + m_slip / m_fall);
        m_fall = m_slip - slip;
        m_slip = slip;
    }
    [[nodiscard]] double error() const override {
        const double off = m_rolls ? std::abs(*m_rolls / m_exact - 1.0) : failed;
        return std::isfinite(off) ? off : failed;
    }

 private:
    double m_step;        // s
    double m_slip;        // m/s, at the last tick
    double m_below;       // m/s
    double m_exact;       // s
    double m_fall = 0.0;  // m/s, of the slip in the last tick
    std::optional<double> m_rolls;
};

void addSlidingToRolling(std::vector<MetricCase>& cases) {
    const std::string scene = "slide:speed=5,friction=0.3,disc=1";
    MetricCase c = frictionCase("A13", "slide-to-roll-speed", scene, 1.0);
    c.what = "a disc at 5 m/s without spin on friction 0.3: speed when it rolls, of 2/3 of that";
    c.judge = [](const World& world) {
        return folded(world, Fold::Last, {}, [](const Frame& f) {
            return static_cast<double>(f.motions[1].velocity.x) / (5.0 * 2.0 / 3.0) - 1.0;
        });
    };
    cases.push_back(c);
    c.name = "slide-to-roll-time";
    c.what = "that disc: when it rolls, as a share of v / (3 μ g)";
    c.judge = [](const World& start) { return std::make_unique<RollsAfter>(start, 0.3); };
    cases.push_back(c);
}

}  // namespace

void addFrictionCases(std::vector<MetricCase>& cases) {
    addRamps(cases);
    addThreshold(cases);
    addRolling(cases);
    addSlidingToRolling(cases);
}

}  // namespace huestep::tools
