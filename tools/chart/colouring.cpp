#include "tools/chart/colouring.h"

#include <algorithm>

#include "core/scene/measure.h"
#include "core/solver/method.h"
#include "core/world/world.h"
#include "tools/engines.h"
#include "tools/interrupt.h"

namespace huestep::tools::chart {
namespace {

constexpr const char* wayNames[wayCount] = {"key order, 1 thread", "colours, 1 thread",
                                            "colours, 2 threads where worth while",
                                            "colours, 2 threads always"};

struct Family {
    const char* name;
    const char* parameter;  // of its scenes: "pyramid:base="
    std::vector<int> sizes;
};

std::vector<Family> familiesOf(Extent extent) {
    if (extent == Extent::Smoke) return {{"pyramid", "pyramid:base=", {2, 8}}};
    if (extent == Extent::Quick)
        return {{"pyramid", "pyramid:base=", {2, 4, 8, 12, 17, 24, 34, 48}},
                {"net", "joint_grid:n=", {4, 8, 12, 17, 24, 34, 48}}};
    return {
        {"pyramid", "pyramid:base=", {2, 3, 4, 6, 8, 10, 12, 14, 17, 20, 24, 29, 34, 48, 68, 100}},
        {"net", "joint_grid:n=", {4, 6, 8, 10, 12, 14, 17, 20, 24, 29, 34, 48, 68, 100}}};
}

struct Sample {
    const char* scene;
    std::uint64_t settle;  // until it is as it stays
};

std::vector<Sample> benchmarksOf(Extent extent) {
    if (extent == Extent::Smoke) return {{"small:n=12", 10}, {"pyramid:base=12", 10}};
    if (extent == Extent::Quick)
        return {{"small", 60},
                {"pyramid:base=40", 30},
                {"many_pyramids:rows=5,columns=5,base=8", 30},
                {"joint_grid:n=40", 30},
                {"tumbler:count=20", 120},
                {"spinner:bodies=300", 120},
                {"compounds:columns=12,rows=20", 120}};
    return {{"small", 120},     {"pyramid", 60},   {"many_pyramids", 60}, {"joint_grid", 60},
            {"tumbler", 200},   {"spinner", 120},  {"washer", 120},       {"smash", 120},
            {"compounds", 120}, {"junkyard", 120}, {"rain", 330}};
}

/// More ticks of small worlds, whose clock is coarse.
std::uint64_t ticksFor(std::uint32_t constraints, Extent extent) {
    const std::uint64_t work = extent == Extent::Smoke   ? 500
                               : extent == Extent::Quick ? 40'000
                                                         : 400'000;
    return std::clamp<std::uint64_t>(work / std::max(constraints, 1u),
                                     extent == Extent::Smoke ? 3 : 20, 1000);
}

/// How the world of the scene is laid out once it has settled.
Result<WaysRow> laidOut(const std::string& scene, std::uint64_t settle, Extent extent) {
    Result<NamedScene> named = loadScene(scene);
    if (!named) return named.error();
    WaysRow row;
    row.scene = std::make_shared<const NamedScene>(std::move(*named));
    Result<World> world =
        World::create(Contender{.substeps = standardSubsteps}.applied(row.scene->scene));
    if (!world) return world.error();
    for (std::uint64_t tick = 0; tick < settle && !interrupted(); ++tick)
        world->step(row.scene->script.commands(tick));
    const StepReport& report = world->report();
    row.bodies = world->bodies().size();
    row.contacts = report.contacts;
    row.joints = report.joints;
    row.islands = report.islands;
    row.colours = report.colours;
    row.overflow = report.overflow;
    row.inBuckets = report.inBuckets;
    for (std::size_t way = 0; way < wayCount; ++way) {
        Run& run = row.runs[way];
        run.scene = row.scene;
        run.contender.substeps = standardSubsteps;  // the same work for all
        run.contender.method = way == keyOrder ? Method::Sequential : Method::SoftStep;
        run.threads = way == coloursChosen || way == coloursAlways ? 2 : 1;
        run.shareAll = way == coloursAlways;
        run.settle = settle;
        run.ticks = ticksFor(row.constraints(), extent);
    }
    return row;
}

/// False: interrupted.
Result<bool> measure(const std::string& scene, std::uint64_t settle, Extent extent,
                     std::vector<WaysRow>& rows, const char* family = "") {
    Result<WaysRow> row = laidOut(scene, settle, extent);
    if (!row) return row.error();
    row->family = family;
    std::vector<Run*> runs;
    for (Run& run : row->runs) runs.push_back(&run);
    const Result<bool> done = timeRepeatedly(runs, repeatsOf(extent));
    if (!done || !*done) return done;
    const Result<double> waited = waitedShare(row->runs[coloursChosen]);
    if (!waited) return waited.error();
    row->waited = *waited;
    rows.push_back(std::move(*row));
    return !interrupted();
}

double leastWall(const Run& run) {
    return spreadOf(run.wall).min;
}

}  // namespace

double WaysRow::ratio(Way way, Way other) const {
    return leastWall(runs[way]) / leastWall(runs[other]);
}

Result<bool> measureSizes(Extent extent, std::vector<WaysRow>& rows) {
    for (const Family& family : familiesOf(extent))
        for (const int size : family.sizes) {
            const std::string scene = family.parameter + std::to_string(size);
            const Result<bool> done = measure(scene, 20, extent, rows, family.name);
            if (!done || !*done) return done;
        }
    return true;
}

Result<bool> measureScenes(Extent extent, std::vector<WaysRow>& rows) {
    for (const Sample& sample : benchmarksOf(extent)) {
        const Result<bool> done = measure(sample.scene, sample.settle, extent, rows);
        if (!done || !*done) return done;
    }
    return true;
}

void addRows(Json& rows, const WaysRow& row) {
    const double all = std::max(row.constraints(), 1u);
    for (std::size_t way = 0; way < wayCount; ++way) {
        Json json = {{"family", row.family},
                     {"way", wayNames[way]},
                     {"bodies", row.bodies},
                     {"contacts", row.contacts},
                     {"joints", row.joints},
                     {"constraints", row.constraints()},
                     {"islands", row.islands},
                     {"colours", row.colours},
                     {"overflow_share", row.overflow / all},
                     {"hub_share", row.inBuckets / all},
                     {"waited_share", way == coloursChosen ? Json(row.waited) : Json()}};
        json.update(asJson(row.runs[way]));
        rows.push_back(std::move(json));
    }
}

}  // namespace huestep::tools::chart
