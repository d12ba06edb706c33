#include "tools/chart/run.h"

#include <algorithm>
#include <numeric>

#include "core/solver/method.h"
#include "core/world/world.h"
#include "tools/clock.h"
#include "tools/engines.h"
#include "tools/interrupt.h"
#include "tools/statistics.h"

namespace huestep::tools::chart {
namespace {

Result<std::unique_ptr<Engine>> engineOf(const Run& run, Clock clock) {
    EngineSetup setup;
    setup.threads = run.threads;
    setup.clock = clock;
    setup.shareAll = run.shareAll;
    return makeEngine(run.contender.engine, run.contender.applied(run.scene->scene), setup);
}

Status stepTo(Engine& engine, const Run& run, std::uint64_t from, std::uint64_t to) {
    for (std::uint64_t tick = from; tick < to && !interrupted(); ++tick) {
        const Status stepped = engine.step(run.scene->script.commands(tick));
        if (!stepped) return stepped;
    }
    return Done{};
}

Status timeOne(Run& run) {
    Result<std::unique_ptr<Engine>> made = engineOf(run, nullptr);
    if (!made) return Error{run.scene->name + ": " + made.error().message};
    Engine& engine = **made;
    if (const Status done = stepTo(engine, run, 0, run.settle); !done) return done;
    // One thread's time does not hold what the program's other threads do; several have only the
    // whole program's.
    const auto processor =
        run.threads == 1 ? &threadProcessorNanoseconds : &programProcessorNanoseconds;
    const std::uint64_t cpu = processor();
    const std::uint64_t wall = nanoseconds();
    if (const Status done = stepTo(engine, run, run.settle, run.settle + run.ticks); !done)
        return done;
    const double perStep = 1e-3 / static_cast<double>(run.ticks);
    run.wall.push_back(static_cast<double>(nanoseconds() - wall) * perStep);
    run.cpu.push_back(static_cast<double>(processor() - cpu) * perStep);
    run.hash = engine.hash();
    run.hashes.insert(run.hash);
    return Done{};
}

}  // namespace

int repeatsOf(Extent extent) {
    return extent == Extent::Full ? 7 : extent == Extent::Quick ? 3 : 1;
}

Spread spreadOf(std::span<const double> samples) {
    return {quantile(samples, 0.0), quantile(samples, 0.25), quantile(samples, 0.5),
            quantile(samples, 0.75)};
}

std::string Contender::name() const {
    return engine == "huestep" ? std::string(traitsOf(method).name) : engine;
}

bool Contender::standard() const {
    if (engine != "huestep" || product()) return true;
    return method != Method::SoftStep && substeps == standardSubsteps;
}

bool Contender::product() const {
    return engine == "huestep" && method == Method::SoftStep && substeps == 0;
}

Scene Contender::applied(Scene scene) const {
    if (engine == "huestep") {
        scene.method = method;
        scene.substeps = substeps;
    }
    scene.sleep = false;
    return scene;
}

std::vector<Contender> allContenders(std::span<const std::uint32_t> substeps) {
    std::vector<Contender> all = {{}};
    for (const MethodTraits& traits : allMethods())
        for (const std::uint32_t n : substeps) all.push_back({"huestep", traits.method, n});
    all.push_back({"box2d", Method::SoftStep, 0});
    return all;
}

Result<bool> timeOnce(std::span<Run* const> runs) {
    for (Run* run : runs) {
        if (const Status done = timeOne(*run); !done) return done.error();
        if (interrupted()) return false;
    }
    return true;
}

Result<bool> timeRepeatedly(std::span<Run* const> runs, int repeats) {
    for (int i = 0; i < repeats; ++i) {
        const Result<bool> done = timeOnce(runs);
        if (!done || !*done) return done;
    }
    return true;
}

Result<double> waitedShare(const Run& run) {
    Result<std::unique_ptr<Engine>> made = engineOf(run, &nanoseconds);
    if (!made) return made.error();
    const auto* engine = dynamic_cast<HuestepEngine*>(made->get());
    if (engine == nullptr) return 0.0;
    if (const Status done = stepTo(**made, run, 0, run.settle); !done) return done.error();
    const auto waited = [&] {
        const std::vector<std::uint64_t> all = engine->executor().waited();
        return std::accumulate(all.begin(), all.end(), std::uint64_t{0});
    };
    const std::uint64_t before = waited();
    const std::uint64_t begin = nanoseconds();
    if (const Status done = stepTo(**made, run, run.settle, run.settle + run.ticks); !done)
        return done.error();
    const auto whole = static_cast<double>(nanoseconds() - begin) * run.threads;
    return static_cast<double>(waited() - before) / std::max(whole, 1.0);
}

Json asJson(const Run& run) {
    const Spread cpu = spreadOf(run.cpu);
    const Spread wall = spreadOf(run.wall);
    return {{"scene", run.scene->name},
            {"method", run.contender.name()},
            {"substeps", run.contender.substeps},
            {"standard", run.contender.standard()},
            {"threads", run.threads},
            {"share_all", run.shareAll},
            {"settle_ticks", run.settle},
            {"ticks", run.ticks},
            {"repeats", run.cpu.size()},
            {"cpu_us_min", cpu.min},
            {"cpu_us_q1", cpu.q1},
            {"cpu_us_median", cpu.median},
            {"cpu_us_q3", cpu.q3},
            {"wall_us_min", wall.min},
            {"wall_us_q1", wall.q1},
            {"wall_us_median", wall.median},
            {"wall_us_q3", wall.q3},
            {"hash", hex(run.hash)},
            {"different_hashes", run.hashes.size()}};
}

}  // namespace huestep::tools::chart
