/// `huestep run`: steps a scene without a network.
#include <cstdio>
#include <memory>

#include "tools/accuracy.h"
#include "tools/clock.h"
#include "tools/command.h"
#include "tools/engines.h"
#include "tools/files.h"
#include "tools/interrupt.h"
#include "tools/lists.h"
#include "tools/metrics/metric.h"
#include "tools/progress.h"
#include "tools/run_report.h"
#include "tools/scene_source.h"
#include "tools/whole_number.h"

namespace huestep::tools {
namespace {

constexpr std::uint64_t maxJsonHashes = 1'000'000;  // they are kept until the end

struct Options {
    std::string scene;
    std::string engine = "huestep";
    std::uint64_t ticks = 0;  // 0: the scene's own
    int threads = 1;
    std::string simd = "auto";
    std::uint32_t substeps = 0;   // 0: the scene's own
    std::string method;           // empty: the scene's own
    std::uint64_t hashEvery = 0;  // 0: never
    std::string snapshot;
    bool explain = false;
    bool json = false;
};

Status checkOptions(const Options& o) {
    if (const Status known = checkEngine(o.engine, engineNames()); !known) return known;
    if (o.engine == "huestep") return Done{};
    const Status own = checkOwnWay(o.engine, !o.method.empty(), o.substeps != 0);
    if (!own) return own;
    if (o.explain) return Error{"--explain: only huestep says how its steps are laid out"};
    if (o.threads != 1 || o.simd != "auto")
        return Error{"--threads and --simd: " + o.engine +
                     " has one thread and its own arithmetic"};
    if (!o.snapshot.empty())
        return Error{"--snapshot: only a world of huestep has a snapshot, not one of " + o.engine};
    return Done{};
}

/// What looks at the motions between ticks.
struct Watchers {
    Accuracy accuracy;
    std::vector<RunningJudge> judges;  ///< of the metrics whose scene this is

    void watch(std::uint64_t tick, std::span<const Command> commands,
               std::span<const BodyMotion> motions, bool touching) {
        accuracy.watch(tick, commands, motions, touching);
        for (const RunningJudge& judge : judges)
            if (tick <= judge.metric->ticks) judge.judge->watch(tick, commands, motions, touching);
    }
    void finish(std::span<const BodyMotion> last, RunReport& report) {
        report.accuracy = accuracy.finish(last);
        for (const RunningJudge& judge : judges)
            if (report.ticks >= judge.metric->ticks)
                report.metrics.push_back({judge.metric, judge.judge->error()});
    }
};

/// Takes the ticks, each timed; what watches them is not.
Status stepAll(Engine& engine, const Script& script, const Options& options, Watchers& watchers,
               RunReport& report) {
    const auto* huestep = dynamic_cast<const HuestepEngine*>(&engine);
    Progress progress("stepping", report.ticksAsked);
    std::vector<BodyMotion> motions = engine.motions();
    while (report.ticks < report.ticksAsked && !interrupted()) {
        const std::vector<Command> commands = script.commands(report.ticks);
        const std::uint64_t begin = nanoseconds();
        if (const Status stepped = engine.step(commands); !stepped) return stepped;
        report.tickNanoseconds.add(nanoseconds() - begin);
        ++report.ticks;
        motions = engine.motions();
        watchers.watch(report.ticks, commands, motions, engine.contactCount() > 0);
        if (huestep != nullptr) report.add(huestep->world().report());
        if (options.hashEvery != 0 && report.ticks % options.hashEvery == 0) {
            const RunReport::TickHash hash{report.ticks, engine.hash(),
                                           huestep ? huestep->world().fullRoot() : 0};
            progress.clear();
            if (options.json)
                report.hashes.push_back(hash);
            else
                RunReport::print(hash, huestep != nullptr);
        }
        progress.advance();
    }
    watchers.finish(motions, report);
    return Done{};
}

Status checkHashes(std::uint64_t every, std::uint64_t ticks, bool json) {
    if (every > ticks)
        return Error{"--hash-every: " + std::to_string(every) + " is more than the " +
                     std::to_string(ticks) + " ticks of the run"};
    if (json && every != 0 && ticks / every > maxJsonHashes)
        return Error{"--hash-every: one JSON document takes " + std::to_string(maxJsonHashes) +
                     " hashes at most; without --json they are printed as they come"};
    return Done{};
}

void showNotes(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) std::fprintf(stderr, "note: %s\n", note.c_str());
}

Answer run(const Options& options) {
    if (const Status fine = checkOptions(options); !fine) return fine.error();
    const Result<Simd> simd = parseSimd(options.simd);
    if (!simd) return simd.error();
    Result<NamedScene> named = loadScene(options.scene);
    if (!named) return named.error();
    Scene& scene = named->scene;
    if (options.substeps != 0) scene.substeps = options.substeps;
    if (!options.method.empty()) {
        const Result<Method> method = parseMethod(options.method);
        if (!method) return method.error();
        scene.method = *method;
    }
    const std::uint64_t ticks = options.ticks != 0 ? options.ticks : named->ticks;
    if (const Status fine = checkHashes(options.hashEvery, ticks, options.json); !fine)
        return fine.error();
    Result<OutputFile> snapshot = OutputFile::open(options.snapshot);
    if (!snapshot) return snapshot.error();

    const Result<World> start = World::create(scene);
    if (!start) return Error{options.scene + ": " + start.error().message};
    std::vector<std::string> notes;
    Result<std::unique_ptr<Engine>> engine =
        makeEngine(options.engine, scene, {options.threads, *simd, {}, nanoseconds}, &notes);
    if (!engine) return engine.error();
    showNotes(notes);

    RunReport report;
    report.scene = options.scene;
    report.engine = options.engine;
    report.threads = options.threads;
    report.simd = std::string(nameOf(*simd));
    report.ticksAsked = ticks;
    Setting setting;
    if (options.engine == "huestep") setting = {{}, scene.method, scene.substeps};
    Watchers watchers{Accuracy(*start), judgesOf(scene, *start, setting)};
    if (const Status done = stepAll(**engine, named->script, options, watchers, report); !done)
        return Error{options.scene + ": " + done.error().message};
    report.close(**engine, options.explain);
    showNotes((*engine)->notes());

    if (options.json)
        print(report.asJson());
    else
        report.print();
    if (snapshot->named()) {
        const auto& world = static_cast<const HuestepEngine&>(**engine).world();
        if (const Status written = snapshot->write(world.save()); !written) return written.error();
    }
    if (report.ticks == ticks) return Exit::Done;
    return stopped("after " + std::to_string(report.ticks) + " of " + std::to_string(ticks) +
                   " ticks");
}

}  // namespace

void addRun(Menu& menu) {
    const auto o = std::make_shared<Options>();
    CLI::App* sub =
        menu.add("run", "Steps a scene without a network; prints hash, times, errors.",
                 "huestep run pyramid:base=20 --ticks 300 --threads 2", [o] { return run(*o); });
    sub->add_option("SCENE", o->scene, "Built-in scene, as in pyramid:base=20, or a scene file")
        ->required();
    sub->add_option("--engine", o->engine, "Who steps it (default: huestep)");
    sub->add_option("--ticks", o->ticks, "Steps to take (default: the scene's own)")
        ->transform(wholeNumber(1, 1'000'000'000));
    sub->add_option("--threads", o->threads, "Threads, 1 to 64 (default: 1)")
        ->transform(wholeNumber(1, maxThreads));
    sub->add_option("--simd", o->simd, "auto, scalar, sse2, avx2, avx512 or neon (default: auto)");
    sub->add_option("--substeps", o->substeps, "Substeps a tick (default: the scene's own)")
        ->transform(wholeNumber(1, 64));
    sub->add_option("--method", o->method, "How constraints are solved (default: the scene's own)");
    sub->add_option("--hash-every", o->hashEvery, "Print the hashes after every K ticks")
        ->transform(wholeNumber(1));
    sub->add_option("--snapshot", o->snapshot, "Write the state after the last tick to this file");
    sub->add_flag("--explain", o->explain,
                  "Also say how the last step was laid out: stages, islands, threads, bytes");
    sub->add_flag("--json", o->json, "Print one JSON document");
}

}  // namespace huestep::tools
