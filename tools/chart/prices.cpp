#include "core/scene/in_double.h"
#include "core/scene/measure.h"
#include "core/solver/method.h"
#include "core/world/world.h"
#include "tools/chart/colouring.h"
#include "tools/engines.h"
#include "tools/interrupt.h"

namespace huestep::tools::chart {
namespace {

constexpr double fastest = 100.0;  // m/s, as in the stability suite: none of these scenes has cause

struct Shared {
    const char* scene;
    std::uint64_t ticks;
};

/// Scenes of one large island, so that threads have to share it.
std::vector<Shared> sharedScenes(Extent extent) {
    if (extent == Extent::Smoke) return {{"pyramid:base=12", 5}};
    if (extent == Extent::Quick)
        return {{"pyramid:base=24", 60}, {"joint_grid:n=32", 60}, {"tumbler:count=16", 120}};
    return {{"pyramid:base=60", 300}, {"joint_grid:n=64", 300}, {"tumbler:count=32", 450}};
}

/// Errors at the end of the run that is timed: from its beginning, for they add up.
Status judge(PriceRow& row) {
    const Scene applied = row.run.contender.applied(row.run.scene->scene);
    const Result<World> start = World::create(applied);
    if (!start) return start.error();
    EngineSetup setup;
    setup.threads = row.run.threads;
    setup.shareAll = row.run.shareAll;
    Result<std::unique_ptr<Engine>> engine = makeEngine(row.run.contender.engine, applied, setup);
    if (!engine) return engine.error();
    for (std::uint64_t tick = 0; tick < row.run.ticks && !interrupted(); ++tick)
        if (const Status done = (*engine)->step({}); !done) return done;
    const Measures end = measure(start->info(), start->bodies(), start->shapes(), start->joints(),
                                 (*engine)->motions());
    row.penetration = end.maxPenetration;
    row.jointError = end.maxJointError;
    for (const BodyMotion& motion : (*engine)->motions())
        if (!(length(inDouble(motion.velocity)) < fastest)) row.failure = "bodies fly apart";
    return Done{};
}

std::vector<PriceRow> rowsOf(const Shared& shared, const std::shared_ptr<const NamedScene>& scene) {
    std::vector<PriceRow> rows;
    for (const Contender& contender : allContenders(std::span(&standardSubsteps, 1)))
        for (const int threads : {1, 2}) {
            if (contender.product()) continue;  // the same number of substeps for all
            const bool teams = contender.engine == "huestep" && traitsOf(contender.method).teams;
            if (threads > 1 && !teams) continue;
            PriceRow row;
            row.run.scene = scene;
            row.run.contender = contender;
            row.run.threads = threads;
            row.run.shareAll = threads > 1;
            row.run.ticks = shared.ticks;
            rows.push_back(std::move(row));
        }
    return rows;
}

}  // namespace

Result<bool> measurePrices(Extent extent, std::vector<PriceRow>& rows) {
    for (const Shared& shared : sharedScenes(extent)) {
        Result<NamedScene> named = loadScene(shared.scene);
        if (!named) return named.error();
        const auto scene = std::make_shared<const NamedScene>(std::move(*named));
        std::vector<PriceRow> these = rowsOf(shared, scene);
        std::vector<Run*> runs;
        for (PriceRow& row : these) {
            if (const Status done = judge(row); !done) return done.error();
            if (interrupted()) return false;
            runs.push_back(&row.run);
        }
        const Result<bool> done = timeRepeatedly(runs, repeatsOf(extent));
        if (!done || !*done) return done;
        for (PriceRow& row : these) rows.push_back(std::move(row));
    }
    return true;
}

Json asJson(const PriceRow& row) {
    Json json = {{"max_penetration_m", row.failure.empty() ? Json(row.penetration) : Json()},
                 {"max_joint_error_m", row.failure.empty() ? Json(row.jointError) : Json()},
                 {"failure", row.failure},
                 {"deterministic", row.run.contender.engine != "huestep" ||
                                       traitsOf(row.run.contender.method).deterministic}};
    json.update(asJson(row.run));
    return json;
}

}  // namespace huestep::tools::chart
