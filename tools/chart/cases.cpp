// The metrics that are made for diagrams, as work-precision cases.
#include <algorithm>
#include <cmath>

#include "tools/chart/work.h"
#include "tools/engines.h"
#include "tools/metrics/metric.h"
#include "tools/text.h"

namespace huestep::tools::chart {
namespace {

/// In any unit: scenes are some metres large and run for seconds.
constexpr double beyondAllBounds = 100.0;

/// How closely `float` can say where something is, as far from the origin as the scene reaches: no
/// method can be expected to be nearer to the truth.
Floor floatFloor(const Scene& scene, std::string_view unit) {
    double farthest = 1.0;
    for (const BodyDef& body : scene.bodies)
        farthest = std::max({farthest, static_cast<double>(std::abs(body.position.x)),
                             static_cast<double>(std::abs(body.position.y))});
    if (unit != "m") farthest = 1.0;
    return {"resolution of float", std::ldexp(farthest, -24)};
}

Setting settingOf(const Contender& contender) {
    Setting setting;
    setting.make = [engine = contender.engine](const Scene& scene) {
        return makeEngine(engine, scene);
    };
    if (contender.engine == "huestep") {
        setting.method = contender.method;
        setting.substeps = contender.substeps;
    }
    return setting;
}

Result<Verdict> judge(const MetricCase& metric, const NamedScene& scene,
                      const Contender& contender) {
    const Result<double> error = judgeRun(contender.applied(scene.scene), metric.script,
                                          metric.ticks, metric.judge, settingOf(contender));
    if (!error) return error.error();
    if (std::isfinite(*error) && *error > beyondAllBounds)
        return Verdict{*error, "off by " + number(*error) + ' ' + std::string(metric.unit)};
    return Verdict{*error, ""};
}

/// "pendulum-90-period": "pendulum 90 period".
std::string titleOf(std::string name) {
    std::replace(name.begin(), name.end(), '-', ' ');
    name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
    return name;
}

}  // namespace

std::vector<Case> workCases(Extent extent) {
    std::vector<Case> cases;
    for (const std::string& group : workGroups())
        for (const MetricCase& metric : metricCases()) {
            if (!metric.charted || !metric.judge || nameOf(metric.kind) != group) continue;
            if (extent == Extent::Smoke && !cases.empty() && cases.back().group == group) continue;
            Case one;
            one.id = metric.name;
            one.group = group;
            one.metric = metric.metric;
            one.title = titleOf(metric.name);
            one.what = metric.what;
            one.reference = metric.reference;
            one.unit = metric.unit;
            const Scene scene = metric.scene();
            const auto ticks = static_cast<std::uint32_t>(metric.ticks);
            one.scene = std::make_shared<const NamedScene>(
                NamedScene{metric.name, scene, ticks, metric.script});
            one.ticks = metric.ticks;
            one.floors = {floatFloor(scene, metric.unit)};
            one.applies = [&metric](const Contender& c) { return appliesTo(metric, settingOf(c)); };
            one.judge = [&metric, named = one.scene](const Contender& c) {
                return judge(metric, *named, c);
            };
            cases.push_back(std::move(one));
        }
    return cases;
}

}  // namespace huestep::tools::chart
