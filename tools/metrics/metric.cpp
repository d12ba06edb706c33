#include "tools/metrics/metric.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>

#include "core/scene/catalog.h"
#include "tools/metrics/case_lists.h"

namespace huestep::tools {
namespace {

/// "A", 5 of "A5", so that A10 comes after A9.
std::pair<char, int> placeOf(std::string_view metric) {
    int number = 0;
    std::from_chars(metric.data() + 1, metric.data() + metric.size(), number);
    return {metric[0], number};
}

std::vector<MetricCase> makeCases() {
    std::vector<MetricCase> cases;
    addConservationCases(cases);
    addJointCases(cases);
    addFrictionCases(cases);
    addImpactCases(cases);
    addRestCases(cases);
    addFrameCases(cases);
    addTrajectoryCases(cases);
    addOrderCases(cases);
    std::stable_sort(cases.begin(), cases.end(), [](const MetricCase& a, const MetricCase& b) {
        return placeOf(a.metric) < placeOf(b.metric);
    });
    return cases;
}

/// Whether the method goes over the soft step's rows, in whatever order.
bool hasSoftRows(Method method) {
    switch (method) {
        case Method::SoftStep:
        case Method::Sequential:
        case Method::Jacobi:
        case Method::JacobiSplit:
        case Method::Locks:
        case Method::Atomics:
            return true;
        default:
            return false;
    }
}

/// What decides motion, apart from how it is solved.
Scene withoutSolver(Scene scene) {
    const Scene standard;
    scene.name = standard.name;
    scene.method = standard.method;
    scene.substeps = standard.substeps;
    scene.need = standard.need;
    return scene;
}

constexpr std::uint32_t mostSubsteps = 64;  // that a scene may have: check.cpp

}  // namespace

std::string_view nameOf(SceneClass kind) {
    constexpr std::array<std::string_view, 5> names{"joint", "stack", "friction", "impact",
                                                    "mixed"};
    return names[static_cast<std::size_t>(kind)];
}

std::span<const MetricCase> metricCases() {
    static const std::vector<MetricCase> cases = makeCases();
    return cases;
}

const MetricCase* findMetricCase(std::string_view name) {
    for (const MetricCase& metric : metricCases()) {
        if (metric.name == name) return &metric;
    }
    return nullptr;
}

bool appliesTo(const MetricCase& metric, const Setting& setting) {
    const bool given = setting.substeps != 0;
    // An order is found by doubling the substeps.
    if (metric.unit == "order") return given && setting.substeps <= mostSubsteps / 2;
    return metric.truth == Truth::Rigid ||
           (given && setting.method && hasSoftRows(*setting.method));
}

Result<double> judgeRun(Scene scene, const Script& script, std::uint64_t ticks,
                        const JudgeMaker& judge, const Setting& setting) {
    if (setting.method) scene.method = *setting.method;
    if (setting.substeps != 0) scene.substeps = setting.substeps;
    const Result<World> start = World::create(scene);
    if (!start) return start.error();
    const Result<std::unique_ptr<Engine>> engine = setting.make(scene);
    if (!engine) return engine.error();
    const std::unique_ptr<Judge> watching = judge(*start);
    for (std::uint64_t tick = 1; tick <= ticks; ++tick) {
        const std::vector<Command> commands = script.commands(tick - 1);
        if (const Status stepped = (*engine)->step(commands); !stepped) return stepped.error();
        watching->watch(tick, commands, (*engine)->motions(), (*engine)->contactCount() > 0);
    }
    return watching->error();
}

Result<double> errorOf(const MetricCase& metric, const Setting& setting) {
    assert(appliesTo(metric, setting));
    if (metric.series) return metric.series(setting);
    return judgeRun(metric.scene(), metric.script, metric.ticks, metric.judge, setting);
}

std::vector<RunningJudge> judgesOf(const Scene& scene, const World& start, const Setting& setting) {
    const Scene wanted = withoutSolver(scene);
    std::vector<RunningJudge> judges;
    for (const MetricCase& metric : metricCases()) {
        if (!metric.judge || !appliesTo(metric, setting)) continue;
        if (withoutSolver(metric.scene()) != wanted) continue;
        judges.push_back({&metric, metric.judge(start)});
    }
    return judges;
}

Scene catalogScene(const std::string& text) {
    Result<Scene> scene = sceneFromCatalog(text);
    assert(scene.ok());
    return std::move(scene).value();
}

MetricCase caseOf(std::string_view metric, std::string name, const std::string& scene,
                  std::uint64_t ticks) {
    MetricCase result;
    result.metric = metric;
    result.name = std::move(name);
    result.ticks = ticks;
    result.charted = true;
    result.scene = [scene] { return catalogScene(scene); };
    return result;
}

}  // namespace huestep::tools
