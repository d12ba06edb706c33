// A14: Newton's law of impact.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "tools/metrics/case_lists.h"
#include "tools/metrics/judges.h"
#include "tools/metrics/scenes.h"

namespace huestep::tools {
namespace {

constexpr double rest = 0.5;  // m, height of the disc's centre on the ground

/// How high body 1 comes after its first bounce, against e² of its fall, as a share of the fall.
/// Between ticks a parabola through three heights finds the apex, exactly where flight is exact.
class ApexJudge final : public Judge {
 public:
    ApexJudge(const World& start, double restitution)
        : m_fall(static_cast<double>(start.motions()[1].position.y) - rest),
          m_expected(restitution * restitution) {
        m_heights.push_back(m_fall);
    }
    void watch(std::uint64_t, std::span<const Command>, std::span<const BodyMotion> motions,
               bool) override {
        m_heights.push_back(static_cast<double>(motions[1].position.y) - rest);
    }
    [[nodiscard]] double error() const override {
        bool bounced = false;
        for (std::size_t i = 1; i + 1 < m_heights.size(); ++i) {
            const double before = m_heights[i - 1];
            const double now = m_heights[i];
            const double after = m_heights[i + 1];
            if (before > now && after > now) bounced = true;
            if (!bounced || before >= now || after > now) continue;
            const double slope = 0.5 * (after - before);
            const double bend = before - 2.0 * now + after;
            const double apex = now - 0.5 * slope * slope / bend;
            return std::abs(apex / m_fall - m_expected);
        }
        return failed;
    }

 private:
    double m_fall;
    double m_expected;
    std::vector<double> m_heights;  // m above rest
};

MetricCase impactCase(std::string name, const std::string& scene, double seconds) {
    MetricCase c = caseOf("A14", std::move(name), scene, ticksIn(seconds));
    c.kind = SceneClass::Impact;
    c.unit = "1";
    c.reference = "closed form";
    return c;
}

std::unique_ptr<Judge> headOnJudge(const World& world) {
    const Start start(world);
    const auto v = [](const BodyMotion& m) { return static_cast<double>(m.velocity.x); };
    const auto mA = static_cast<double>(start.bodies[0].mass);
    const auto mB = static_cast<double>(start.bodies[1].mass);
    const double e = static_cast<double>(start.shapes[0].restitution);
    const double middle = (mA * v(start.motions[0]) + mB * v(start.motions[1])) / (mA + mB);
    const double closing = v(start.motions[0]) - v(start.motions[1]);
    const double afterA = middle - e * closing * mB / (mA + mB);
    const double afterB = middle + e * closing * mA / (mA + mB);
    return folded(world, Fold::Last, {}, [=](const Frame& f) {
        return std::max(std::abs(v(f.motions[0]) - afterA), std::abs(v(f.motions[1]) - afterB));
    });
}

}  // namespace

void addImpactCases(std::vector<MetricCase>& cases) {
    for (const char* text : {"0.5", "0.8", "1"}) {
        const double e = std::stod(text);
        MetricCase c = impactCase(std::string("bounce-") + text,
                                  std::string("bounce:restitution=") + text + ",height=2", 2.0);
        c.what = std::string("apex after the first bounce with restitution ") + text +
                 ", off e² of the fall, as a share of the fall of 2 m";
        c.judge = [e](const World& start) { return std::make_unique<ApexJudge>(start, e); };
        cases.push_back(c);
    }
    // A fall of 0.5 m takes √0.1 s, so that 20 bounces take 12.65 s.
    MetricCase c = impactCase("bounce-energy", "bounce:restitution=1,height=0.5", 12.65);
    c.what = "energy lost or won in 20 bounces with restitution 1, as a share";
    c.reference = "conserved";
    c.judge = [](const World& world) {
        const Start start(world);
        const auto mass = static_cast<double>(start.bodies[1].mass);
        const double floor = mass * length(start.gravity()) * rest;
        const double before = start.measured(start.motions).energy - floor;
        return folded(world, Fold::Last, {}, [=](const Frame& f) {
            return (start.measured(f.motions).energy - floor) / before - 1.0;
        });
    };
    cases.push_back(c);

    c = impactCase("head-on", "bounce", 1.0);
    c.what = "two discs, 1 : 3, that meet at 6 m/s with restitution 0.5: speeds after it";
    c.unit = "m/s";
    c.scene = [] { return headOn(0.5f); };
    c.judge = headOnJudge;
    cases.push_back(c);
}

}  // namespace huestep::tools
