#include "tools/chart/effort.h"

#include <algorithm>
#include <cmath>

#include "core/scene/in_double.h"
#include "core/scene/measure.h"
#include "core/world/world.h"
#include "tools/engines.h"
#include "tools/interrupt.h"

namespace huestep::tools::chart {
namespace {

struct Sample {
    const char* scene;
    std::uint64_t ticks;
    bool benchmark;
};

std::vector<Sample> samplesOf(Extent extent) {
    if (extent == Extent::Smoke) return {{"stack:n=5", 20, false}, {"small:n=12", 20, true}};
    if (extent == Extent::Quick)
        return {{"ballistic", 60, false},        {"pendulum", 240, false},
                {"stack:n=10", 240, false},      {"stack:n=40", 240, false},
                {"chain:ratio=100", 240, false}, {"chain:ratio=1000", 240, false},
                {"pyramid:base=24", 120, true},  {"joint_grid:n=24", 120, true},
                {"tumbler:count=14", 180, true}, {"small", 240, true}};
    return {{"ballistic", 60, false},
            {"pendulum", 600, false},
            {"stack:n=10", 600, false},
            {"stack:n=40", 600, false},
            {"stack:n=100", 600, false},
            {"chain:ratio=10", 600, false},
            {"chain:ratio=100", 600, false},
            {"chain:ratio=1000", 600, false},
            {"chain:ratio=100,angle=90", 600, false},
            {"small", 600, true},
            {"pyramid", 120, true},
            {"many_pyramids", 60, true},
            {"joint_grid", 120, true},
            {"tumbler", 300, true},
            {"spinner", 200, true},
            {"washer", 200, true},
            {"smash", 120, true},
            {"compounds", 200, true},
            {"junkyard", 200, true},
            {"rain", 300, true}};
}

/// m: the side of a square as large as the body's shapes together.
double sizeOf(const BodyDef& body) {
    Vec2T<double> low{1e300, 1e300};
    Vec2T<double> high{-1e300, -1e300};
    for (const ShapeDef& shape : body.shapes)
        for (int i = 0; i < shape.vertexCount; ++i) {
            const Vec2T<double> v = inDouble(shape.vertices[static_cast<std::size_t>(i)]);
            const auto r = static_cast<double>(shape.radius);
            low = minOf(low, v - Vec2T<double>{r, r});
            high = maxOf(high, v + Vec2T<double>{r, r});
        }
    return std::max(high.x - low.x, high.y - low.y);
}

/// Errors of the second half of the run: what a load that has come to bear leaves.
Status judge(EffortRow& row) {
    const NamedScene& named = *row.run.scene;
    Result<World> made = World::create(row.run.contender.applied(named.scene));
    if (!made) return made.error();
    World& world = *made;
    const std::uint64_t every = world.bodies().size() > 256 ? 30 : 1;
    for (std::uint64_t tick = 1; tick <= row.run.ticks && !interrupted(); ++tick) {
        world.step(named.script.commands(tick - 1));
        if (2 * tick < row.run.ticks || (tick % every != 0 && tick != row.run.ticks)) continue;
        const Measures now =
            measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions());
        row.penetration = std::max(row.penetration, now.maxPenetration);
        row.jointError = std::max(row.jointError, now.maxJointError);
    }
    return Done{};
}

std::vector<EffortRow> rowsOf(const Sample& sample, Extent extent,
                              const std::shared_ptr<const NamedScene>& scene) {
    std::vector<EffortRow> rows;
    for (const std::uint32_t substeps : {0u, 1u, 2u, 4u, 8u, 16u, 32u}) {
        // Large scenes are there to be held against the standard.
        if (sample.benchmark && extent == Extent::Full && (substeps == 1 || substeps > 8)) continue;
        EffortRow row;
        row.run.scene = scene;
        row.run.contender.substeps = substeps;
        row.run.ticks = sample.ticks;
        row.benchmark = sample.benchmark;
        row.need = visualNeed(scene->scene);
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace

double visualNeed(const Scene& scene) {
    double smallest = 1e300;
    for (const BodyDef& body : scene.bodies)
        if (body.type == BodyType::Dynamic) smallest = std::min(smallest, sizeOf(body));
    return smallest < 1e300 ? std::max(0.005, 0.01 * smallest) : 0.005;
}

Result<bool> measureEffort(Extent extent, std::vector<EffortRow>& rows) {
    for (const Sample& sample : samplesOf(extent)) {
        Result<NamedScene> named = loadScene(sample.scene);
        if (!named) return named.error();
        const auto scene = std::make_shared<const NamedScene>(std::move(*named));
        std::vector<EffortRow> these = rowsOf(sample, extent, scene);
        std::vector<Run*> runs;
        for (EffortRow& row : these) {
            if (const Status done = judge(row); !done) return done.error();
            if (interrupted()) return false;
            runs.push_back(&row.run);
        }
        const Result<bool> done = timeRepeatedly(runs, repeatsOf(extent));
        if (!done || !*done) return done;
        for (EffortRow& row : these) rows.push_back(std::move(row));
    }
    return true;
}

std::vector<EffortAnswer> answersOf(std::span<const EffortRow> rows) {
    std::vector<EffortAnswer> answers;
    for (const EffortRow& row : rows) {
        if (answers.empty() || answers.back().scene != row.run.scene->name)
            answers.push_back({row.run.scene->name, row.benchmark});
        EffortAnswer& answer = answers.back();
        const double time = spreadOf(row.run.cpu).min;
        const std::uint32_t substeps = row.run.contender.substeps;
        if (row.planned()) {
            answer.plannedMet = row.met();
            answer.plannedTime = time;
        } else if (row.met() && (answer.leastFixed == 0 || substeps < answer.leastFixed)) {
            answer.leastFixed = substeps;
            answer.leastFixedTime = time;
        }
        if (substeps == standardSubsteps) answer.standardTime = time;
    }
    return answers;
}

Json asJson(const EffortRow& row) {
    Json json = {{"benchmark", row.benchmark},
                 {"planned", row.planned()},
                 {"need_m", row.need},
                 {"max_penetration_m", row.penetration},
                 {"max_joint_error_m", row.jointError},
                 {"met", row.met()}};
    json.update(asJson(row.run));
    return json;
}

Json asJson(const EffortAnswer& answer) {
    const auto orNull = [](bool there, const Json& value) { return there ? value : Json(); };
    const bool fixed = answer.leastFixed != 0;
    return {{"scene", answer.scene},
            {"benchmark", answer.benchmark},
            {"least_fixed_substeps", orNull(fixed, answer.leastFixed)},
            {"least_fixed_cpu_us", orNull(fixed, answer.leastFixedTime)},
            {"standard_cpu_us", answer.standardTime},
            {"planned_met", answer.plannedMet},
            {"planned_cpu_us", answer.plannedTime}};
}

}  // namespace huestep::tools::chart
