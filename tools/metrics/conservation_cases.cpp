// A1, A2 and A7: energy, momentum, and free flight.

#include <cmath>
#include <cstdlib>

#include "tools/metrics/ballistic.h"
#include "tools/metrics/case_lists.h"
#include "tools/metrics/judges.h"
#include "tools/metrics/scenes.h"

namespace huestep::tools {
namespace {

/// Energy lost or won at the end, as a share of `scale` J of a start.
JudgeMaker energyJudge(double (*scale)(const Start&)) {
    return [scale](const World& world) {
        const Start start(world);
        const double before = start.measured(start.motions).energy;
        const double whole = scale(start);
        return folded(world, Fold::Last, {}, [=](const Frame& f) {
            return (start.measured(f.motions).energy - before) / whole;
        });
    };
}

/// Of bodies that hang by arms of 1 m, horizontal at the start: the height of each above its lowest
/// place times its weight.
double armScale(const Start& start) {
    double sum = 0.0;
    double depth = 0.0;
    for (const BodyInfo& body : start.bodies) {
        if (!body.dynamic()) continue;
        depth += 1.0;
        sum += static_cast<double>(body.mass) * length(start.gravity()) * depth;
    }
    return sum;
}

struct Momenta {
    Vec2d linear;          // kg·m/s
    double angular = 0.0;  // kg·m²/s, about the origin
    double size = 0.0;     // Σ m |v|, kg·m/s
};

Momenta momentaOf(const Start& start, std::span<const BodyMotion> motions) {
    Momenta sum;
    for (std::size_t i = 0; i < start.bodies.size(); ++i) {
        const auto mass = static_cast<double>(start.bodies[i].mass);
        const Vec2d push = mass * inDouble(motions[i].velocity);
        sum.linear += push;
        sum.angular += cross(inDouble(motions[i].position), push) +
                       static_cast<double>(start.bodies[i].inertia) *
                           static_cast<double>(motions[i].angularVelocity);
        sum.size += length(push);
    }
    return sum;
}

MetricCase kickCase(std::string name, std::string what, bool angular) {
    MetricCase c;
    c.metric = "A2";
    c.name = std::move(name);
    c.what = std::move(what);
    c.kind = SceneClass::Mixed;
    c.unit = "1";
    c.reference = "conserved";
    c.ticks = ticksIn(10.0);
    c.scene = kickedBodies;
    c.judge = [angular](const World& world) {
        const Start start(world);
        const Momenta before = momentaOf(start, start.motions);
        return folded(world, Fold::Last, {}, [=](const Frame& f) {
            const Momenta now = momentaOf(start, f.motions);
            return angular ? (now.angular - before.angular) / before.angular
                           : length(now.linear - before.linear) / before.size;
        });
    };
    return c;
}

/// Judges by `Ballistic`, which `run` prints of too.
class FlightJudge final : public Judge {
 public:
    explicit FlightJudge(const World& start) : m_flight(Ballistic::find(start)) {}
    void watch(std::uint64_t, std::span<const Command>, std::span<const BodyMotion> motions,
               bool touching) override {
        if (m_flight) m_flight->watch(motions, touching);
    }
    [[nodiscard]] double error() const override {
        const std::optional<BallisticResult> result = m_flight ? m_flight->result() : std::nullopt;
        return result && std::isfinite(result->maxError) ? result->maxError : failed;
    }

 private:
    std::optional<Ballistic> m_flight;
};

}  // namespace

void addConservationCases(std::vector<MetricCase>& cases) {
    MetricCase c = caseOf("A1", "pendulum-90-energy", "pendulum:angle=90", ticksIn(10.0));
    c.what = "energy lost or won by a pendulum from 90 degrees in 10 s, of m g L";
    c.unit = "1";
    c.reference = "conserved";
    c.judge = energyJudge(armScale);
    cases.push_back(c);

    c = caseOf("A1", "double-pendulum-energy", "double_pendulum", ticksIn(10.0));
    c.what = "energy lost or won by a double pendulum in 10 s, of what it has above hanging still";
    c.unit = "1";
    c.reference = "conserved";
    c.judge = energyJudge(armScale);
    cases.push_back(c);

    cases.push_back(kickCase("kicked-momentum",
                             "momentum that 100 colliding bodies win in 10 s, of the sum of m |v|",
                             false));
    cases.push_back(kickCase("kicked-angular-momentum",
                             "angular momentum that 100 colliding bodies win in 10 s, as a share",
                             true));

    c = caseOf("A7", "ballistic", "ballistic", ticksIn(1.0));
    c.what = "a disc in free flight from the origin after 1 s";
    c.kind = SceneClass::Mixed;
    c.unit = "m";
    c.reference = "parabola";
    c.judge = [](const World& start) { return std::make_unique<FlightJudge>(start); };
    cases.push_back(c);
}

}  // namespace huestep::tools
