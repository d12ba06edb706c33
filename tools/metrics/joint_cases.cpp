// A3, A5, A6, A16 and A17: joints alone, none of whose bodies touch.

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/metrics/case_lists.h"
#include "tools/metrics/judges.h"
#include "tools/metrics/pendulum.h"
#include "tools/metrics/scenes.h"
#include "tools/metrics/soft_model.h"
#include "tools/reference/linkage.h"

namespace huestep::tools {
namespace {

/// Judges by `Pendulum`, which `run` prints of too.
class PendulumJudge final : public Judge {
 public:
    using Error = double (*)(const PendulumResult&);
    PendulumJudge(const World& start, Error which)
        : m_pendulum(Pendulum::find(start)),
          m_last(start.motions().begin(), start.motions().end()),
          m_error(which) {}

    void watch(std::uint64_t, std::span<const Command>, std::span<const BodyMotion> motions,
               bool) override {
        m_last.assign(motions.begin(), motions.end());
        if (m_pendulum) m_pendulum->watch(motions);
    }
    [[nodiscard]] double error() const override {
        const std::optional<PendulumResult> result =
            m_pendulum ? m_pendulum->result(m_last) : std::nullopt;
        const double size = result ? std::abs(m_error(*result)) : failed;
        return std::isfinite(size) ? size : failed;
    }

 private:
    std::optional<Pendulum> m_pendulum;
    std::vector<BodyMotion> m_last;
    Error m_error;
};

void addPendulums(std::vector<MetricCase>& cases) {
    for (const int angle : {30, 90, 150}) {
        const std::string degrees = std::to_string(angle);
        const std::string scene = "pendulum:angle=" + degrees;
        MetricCase c = caseOf("A5", "pendulum-" + degrees + "-period", scene, ticksIn(10.0));
        c.what = "mean period of a pendulum from " + degrees + " degrees over 10 s, as a share";
        c.unit = "1";
        c.reference = "closed form (agm)";
        c.judge = [](const World& start) {
            return std::make_unique<PendulumJudge>(
                start, [](const PendulumResult& r) { return r.period / r.exact - 1.0; });
        };
        cases.push_back(c);
        c.name = "pendulum-" + degrees + "-phase";
        c.what = "phase of a pendulum from " + degrees + " degrees at its last passage in 10 s";
        c.unit = "rad";
        c.judge = [](const World& start) {
            return std::make_unique<PendulumJudge>(start,
                                                   [](const PendulumResult& r) { return r.phase; });
        };
        cases.push_back(c);
    }
}

/// The largest joint error of a window.
JudgeMaker jointJudge(Window window) {
    return [window](const World& world) {
        const Start start(world);
        return folded(world, Fold::Most, window,
                      [start](const Frame& f) { return start.measured(f.motions).maxJointError; });
    };
}

constexpr Window lastSecond(std::uint64_t ticks) {
    return {ticks - ticksIn(1.0) + 1, ticks};
}

/// Of a chain that hangs from its first body, each joint's error at rest.
std::vector<double> chainFloors(const Start& start) {
    const double omega = softOmegas(start.info).joint;
    const double g = length(start.gravity());
    std::vector<double> floors(start.joints.size());
    double below = 0.0;  // kg that the joint carries
    for (std::size_t i = start.joints.size(); i-- > 0;) {
        const auto mass = static_cast<double>(start.bodies[i + 1].mass);
        const auto above = static_cast<double>(start.bodies[i].inverseMass);
        below += mass;
        floors[i] = floorLaw(below * g, 1.0 / (1.0 / mass + above), omega);
    }
    return floors;
}

/// How far apart the anchors of each joint are, m.
std::vector<double> gapsOf(const Start& start, std::span<const BodyMotion> motions) {
    std::vector<double> gaps;
    const auto anchor = [&](BodyId id, Vec2 local) {
        std::size_t place = 0;
        while (start.bodies[place].id != id) ++place;
        const BodyMotion& m = motions[place];
        return inDouble(m.position) + rotate(normalized(inDouble(m.rotation)), inDouble(local));
    };
    for (const JointInfo& joint : start.joints) {
        gaps.push_back(
            length(anchor(joint.bodyB, joint.anchorB) - anchor(joint.bodyA, joint.anchorA)));
    }
    return gaps;
}

std::unique_ptr<Judge> chainFloorJudge(const World& world) {
    const Start start(world);
    const std::vector<double> floors = chainFloors(start);
    return folded(world, Fold::Last, {}, [start, floors](const Frame& f) {
        const std::vector<double> gaps = gapsOf(start, f.motions);
        double most = 0.0;
        for (std::size_t i = 0; i < gaps.size(); ++i) {
            const double off = std::abs(gaps[i] - floors[i]);
            most = std::isfinite(off) ? std::max(most, off) : failed;
        }
        return most;
    });
}

void addJointErrors(std::vector<MetricCase>& cases) {
    MetricCase c;
    c.metric = "A3";
    c.name = "bridge-peak";
    c.what = "largest joint error of a bridge of 30 planks that falls into place, 10 s";
    c.unit = "m";
    c.reference = "0: rigid joints";
    c.charted = true;
    c.ticks = ticksIn(10.0);
    c.scene = [] { return bridge(30); };
    c.judge = jointJudge({});
    cases.push_back(c);
    c.name = "bridge-steady";
    c.what = "largest joint error of that bridge in the last of 10 s";
    c.judge = jointJudge(lastSecond(c.ticks));
    cases.push_back(c);

    c = caseOf("A3", "chain-100-floor", "chain:ratio=100", ticksIn(10.0));
    c.what = "hanging chain with a ball of 100 links: joint errors against the law of soft rows";
    c.unit = "m";
    c.reference = "floor law";
    c.truth = Truth::SoftModel;
    c.judge = chainFloorJudge;
    cases.push_back(c);
}

/// The last body of a linkage at the end, beside its equations in minimal coordinates.
void addTip(std::vector<MetricCase>& cases, std::string name, const std::string& scene,
            double seconds) {
    MetricCase c = caseOf("A6", std::move(name), scene, ticksIn(seconds));
    c.unit = "m";
    c.reference = "minimal-coordinate ODE";
    const auto solution = [seconds](const World& world) {
        return reference::solveLinkage(*reference::Linkage::find(world), seconds);
    };
    c.uncertainty = [solution, scene = c.scene] {
        return solution(*World::create(scene())).change;
    };
    c.judge = [solution](const World& world) {
        const std::size_t last = world.bodies().size() - 1;
        const Vec2d tip = solution(world).linkage.position(last);
        return folded(world, Fold::Last, {},
                      [last, tip](const Frame& f) { return length(positionOf(f, last) - tip); });
    };
    cases.push_back(c);
}

void addTips(std::vector<MetricCase>& cases) {
    addTip(cases, "double-pendulum-0.5s", "double_pendulum", 0.5);
    cases.back().what = "tip of a double pendulum, both arms horizontal at the start, after 0.5 s";
    addTip(cases, "double-pendulum-1s", "double_pendulum", 1.0);
    cases.back().what = "tip of a double pendulum, both arms horizontal at the start, after 1 s";
    addTip(cases, "chain-10-tip", "chain:ratio=10,angle=90", 0.5);
    cases.back().what = "ball of 10 kg on 10 links of 1 kg, let go horizontally, after 0.5 s";
}

/// How much energy was won at most, of what the chain has above hanging still.
std::unique_ptr<Judge> chainGainJudge(const World& world) {
    const Start start(world);
    const double before = start.measured(start.motions).energy;
    double lowest = 0.0;  // J: every body straight below the pivot
    const Vec2d pivot = inDouble(start.motions[0].position);
    for (std::size_t i = 1; i < start.bodies.size(); ++i) {
        const double depth = length(inDouble(start.motions[i].position) - pivot);
        lowest -= static_cast<double>(start.bodies[i].mass) * length(start.gravity()) * depth;
    }
    const double scale = before - lowest;
    return folded(world, Fold::Most, {}, [=](const Frame& f) {
        const double gain = (start.measured(f.motions).energy - before) / scale;
        return std::isfinite(gain) ? std::max(gain, 0.0) : failed;
    });
}

void addHeavyChains(std::vector<MetricCase>& cases) {
    for (const int ratio : {1, 10, 100, 1000, 10000}) {
        const std::string text = std::to_string(ratio);
        const std::string ball = "10 links of 1 kg and a ball of " + text + " kg";
        MetricCase c =
            caseOf("A16", "chain-" + text + "-hang", "chain:ratio=" + text, ticksIn(10.0));
        c.what = ball + ", hanging: largest joint error in the last of 10 s";
        c.unit = "m";
        c.reference = "0: rigid joints";
        c.judge = jointJudge(lastSecond(c.ticks));
        cases.push_back(c);

        c = caseOf("A16", "chain-" + text + "-swing", "chain:ratio=" + text + ",angle=90",
                   ticksIn(10.0));
        c.what = ball + ", let go horizontally: largest joint error in 10 s";
        c.unit = "m";
        c.reference = "0: rigid joints";
        c.judge = jointJudge({});
        cases.push_back(c);
        c.name = "chain-" + text + "-swing-gain";
        c.what = ball + ", let go horizontally: most energy won in 10 s, of that of the fall";
        c.unit = "1";
        c.reference = "conserved";
        c.charted = false;
        c.judge = chainGainJudge;
        cases.push_back(c);
    }
}

void addArms(std::vector<MetricCase>& cases) {
    for (const int speed : {10, 30}) {
        const std::string text = std::to_string(speed);
        MetricCase c = caseOf("A17", "arm-" + text + "-radius", "arm:speed=" + text, ticksIn(5.0));
        c.what = "a disc on a 5 m arm at " + text + " rad/s: largest change of radius in 5 s";
        c.unit = "1";
        c.reference = "constant";
        c.judge = [](const World& world) {
            return folded(world, Fold::Most, {}, [](const Frame& f) {
                return length(positionOf(f, 1) - positionOf(f, 0)) / 5.0 - 1.0;
            });
        };
        cases.push_back(c);
        c.name = "arm-" + text + "-energy";
        c.what = "a disc on a 5 m arm at " + text + " rad/s: kinetic energy lost or won in 5 s";
        c.judge = [](const World& world) {
            const Start start(world);
            const double before = start.kinetic(start.motions);
            return folded(world, Fold::Last, {},
                          [=](const Frame& f) { return start.kinetic(f.motions) / before - 1.0; });
        };
        cases.push_back(c);
    }
}

}  // namespace

void addJointCases(std::vector<MetricCase>& cases) {
    addJointErrors(cases);
    addPendulums(cases);
    addTips(cases);
    addHeavyChains(cases);
    addArms(cases);
}

}  // namespace huestep::tools
