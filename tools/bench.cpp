/// `huestep bench`: engines side by side on the same scenes.
///
/// Absolute times drift by a third on a busy machine, so the repeats of all rows of a scene are
/// interleaved: each row meets the same weather. Errors and hash are taken in a pass of their own,
/// because measuring between ticks would empty the caches that the ticks are timed with.
#include "tools/bench.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>

#include "tools/bench_modes.h"
#include "tools/clock.h"
#include "tools/command.h"
#include "tools/engines.h"
#include "tools/files.h"
#include "tools/interrupt.h"
#include "tools/lists.h"
#include "tools/progress.h"
#include "tools/scene_source.h"
#include "tools/whole_number.h"

namespace huestep::tools {
namespace {

struct Options {
    std::vector<std::string> scenes = {"pyramid",  "many_pyramids", "joint_grid", "tumbler",
                                       "spinner",  "washer",        "smash",      "compounds",
                                       "junkyard", "rain",          "small"};
    std::string threads = "1,2";
    std::string engines = "huestep,box2d";
    std::uint64_t ticks = 0;  // 0: the scene's own
    int repeats = 6;
    std::string csv;
    bool rollback = false;
    bool scale = false;
    bool quick = false;
    bool json = false;
};

Result<std::vector<std::string>> parseEngines(const std::string& text) {
    std::vector<std::string> names = splitAtCommas(text);
    for (const std::string& name : names) {
        if (const Status known = checkBenchEngine(name); !known) return known.error();
        if (std::count(names.begin(), names.end(), name) > 1)
            return Error{"--engine: " + name + " is given twice"};
    }
    return names;
}

/// One row an engine and thread count; one for those that have no threads.
std::vector<BenchResult> rowsOf(const NamedScene& scene, std::uint64_t ticks,
                                const std::vector<std::string>& engines,
                                const std::vector<int>& threads) {
    std::vector<BenchResult> rows;
    for (const std::string& engine : engines)
        for (const int count : threads) {
            if (!takesThreads(engine) && count != threads.front()) continue;
            BenchResult row;
            row.scene = scene.name;
            row.engine = engine;
            row.threads = takesThreads(engine) ? count : 1;
            row.ticks = ticks;
            rows.push_back(row);
        }
    return rows;
}

Status measureErrors(const NamedScene& scene, BenchResult& row, Progress& progress) {
    const Result<World> start = World::create(scene.scene);
    if (!start) return Error{scene.name + ": " + start.error().message};
    Result<std::unique_ptr<Engine>> engine =
        makeEngine(row.engine, scene.scene, {row.threads}, &row.notes);
    if (!engine) return engine.error();
    Accuracy accuracy(*start);
    for (std::uint64_t tick = 1; tick <= row.ticks && !interrupted(); ++tick) {
        const std::vector<Command> commands = scene.script.commands(tick - 1);
        if (const Status stepped = (*engine)->step(commands); !stepped) return stepped;
        accuracy.watch(tick, commands, (*engine)->motions(), (*engine)->contactCount() > 0);
        progress.advance();
    }
    row.errors = accuracy.finish((*engine)->motions());
    row.hash = (*engine)->hash();
    for (std::string& note : (*engine)->notes()) row.notes.push_back(std::move(note));
    return Done{};
}

Status measureTime(const NamedScene& scene, BenchResult& row, Progress& progress) {
    Result<std::unique_ptr<Engine>> engine = makeEngine(row.engine, scene.scene, {row.threads});
    if (!engine) return engine.error();
    row.leastByTick.resize(row.ticks, ~std::uint64_t{0});
    std::uint64_t sum = 0;
    for (std::uint64_t tick = 0; tick < row.ticks && !interrupted(); ++tick) {
        const std::vector<Command> commands = scene.script.commands(tick);
        const std::uint64_t begin = nanoseconds();
        if (const Status stepped = (*engine)->step(commands); !stepped) return stepped;
        const std::uint64_t time = nanoseconds() - begin;
        sum += time;
        row.leastByTick[tick] = std::min(row.leastByTick[tick], time);
        progress.advance();
    }
    row.repeats.push_back(static_cast<double>(sum) * 1e-6 / static_cast<double>(row.ticks));
    row.sameHash = row.sameHash && (*engine)->hash() == row.hash;
    return Done{};
}

/// Whether it came to its end; false: stopped by Ctrl-C.
Result<bool> benchScene(const NamedScene& scene, int repeats, std::vector<BenchResult>& rows) {
    const std::uint64_t runs = rows.size() * static_cast<std::uint64_t>(repeats + 1);
    Progress progress(scene.name, runs * rows.front().ticks);
    for (BenchResult& row : rows) {
        if (interrupted()) return false;  // a world for nothing takes time as well
        if (const Status done = measureErrors(scene, row, progress); !done) return done.error();
    }
    for (int repeat = 0; repeat < repeats; ++repeat)
        for (BenchResult& row : rows) {
            if (interrupted()) return false;
            if (const Status done = measureTime(scene, row, progress); !done) return done.error();
        }
    return !interrupted();
}

/// What an engine leaves out of a scene is said once, however many rows it has.
void showNotes(const std::vector<BenchResult>& rows) {
    std::set<std::string> said;
    for (const BenchResult& row : rows)
        for (const std::string& note : row.notes) {
            const std::string line = row.scene + " on " + row.engine + ": " + note;
            if (said.insert(line).second) std::fprintf(stderr, "note: %s\n", line.c_str());
        }
}

Answer bench(const Options& options) {
    const Result<std::vector<int>> threads = parseThreads(options.threads);
    if (!threads) return threads.error();
    if (options.rollback) return benchRollback(options.repeats, options.json);
    if (options.scale) return benchScale(*threads, options.quick, options.json);
    const Result<std::vector<std::string>> engines = parseEngines(options.engines);
    if (!engines) return engines.error();
    std::vector<NamedScene> scenes;
    for (const std::string& name : options.scenes) {
        if (std::count(options.scenes.begin(), options.scenes.end(), name) > 1)
            return Error{name + " is given twice"};
        Result<NamedScene> scene = loadScene(name);
        if (!scene) return scene.error();
        scenes.push_back(std::move(scene).value());
    }

    Result<OutputFile> csvFile = OutputFile::open(options.csv);
    if (!csvFile) return csvFile.error();

    std::vector<BenchResult> results;
    bool same = true;
    std::size_t measured = 0;  // scenes
    for (const NamedScene& scene : scenes) {
        const std::uint64_t ticks = options.ticks != 0 ? options.ticks : scene.ticks;
        std::vector<BenchResult> rows = rowsOf(scene, ticks, *engines, *threads);
        const Result<bool> done = benchScene(scene, options.repeats, rows);
        if (!done) return done.error();
        // A scene that Ctrl-C cut short has no figures worth showing; those before it have.
        if (!*done) break;
        ++measured;
        std::fprintf(stderr, "%s: measured, scene %zu of %zu\n", scene.name.c_str(), measured,
                     scenes.size());
        showNotes(rows);
        for (BenchResult& row : rows) {
            same = same && row.sameHash;
            results.push_back(std::move(row));
        }
    }
    if (options.json)
        print(benchJson(results, measured == scenes.size()));
    else if (!results.empty())
        printBench(results);
    const std::string reached =
        std::to_string(measured) + " of " + std::to_string(scenes.size()) + " scenes measured";
    if (results.empty()) return stopped("with " + reached);
    const std::string csv = benchCsv(results);
    const Status written = csvFile->write(std::as_bytes(std::span(csv)));
    if (!written) return written.error();
    if (measured != scenes.size()) return stopped("with " + reached);
    return same ? Exit::Done : Exit::Differs;
}

}  // namespace

void addBench(Menu& menu) {
    const auto o = std::make_shared<Options>();
    CLI::App* sub = menu.add("bench", "Runs engines side by side; prints times, errors, hashes.",
                             "huestep bench pyramid tumbler --threads 1,2 --engine huestep,box2d",
                             [o] { return bench(*o); });
    sub->footer(sub->get_footer() +
                "\n\npsm: mean over the ticks of the least time of each among the repeats, ms a "
                "tick; min to\n"
                "q3 are those of the repeats' means. ratio: psm over that of huestep with as many "
                "threads.\n"
                "drift: energy won or lost by the end, as a share of weight times extent;\n"
                "- where bodies came or went.");
    CLI::Option* scenes =
        sub->add_option("SCENE", o->scenes, "Scenes (default: the benchmark scenes)");
    CLI::Option* threads = sub->add_option("--threads", o->threads, "Thread counts (default: 1,2)");
    std::string names;
    for (const std::string& name : benchEngineNames()) names += (names.empty() ? "" : ", ") + name;
    CLI::Option* engines = sub->add_option(
        "--engine", o->engines, "Of " + names + ", huestep:METHOD (default: huestep,box2d)");
    CLI::Option* ticks =
        sub->add_option("--ticks", o->ticks, "Steps to take (default: each scene's own)")
            ->transform(wholeNumber(1, 1'000'000));
    CLI::Option* repeats =
        sub->add_option("--repeat", o->repeats, "Timed runs of each row (default: 6)")
            ->transform(wholeNumber(1, 1000));
    CLI::Option* csv = sub->add_option("--csv", o->csv, "Also write the rows to this file");
    CLI::Option* rollback =
        sub->add_flag("--rollback", o->rollback,
                      "Instead: what checkpoints, going back 8 ticks, snapshots and hashes cost");
    CLI::Option* scale = sub->add_flag(
        "--scale", o->scale, "Instead: time and memory a body of worlds of 100 to 100,000");
    // What would do nothing is refused.
    for (CLI::Option* other : {rollback, scale})
        for (CLI::Option* moot : {scenes, csv, engines, ticks}) other->excludes(moot);
    rollback->excludes(threads)->excludes(scale);
    scale->excludes(repeats);
    sub->add_flag("--quick", o->quick, "With --scale: up to 1,000 bodies alone")->needs(scale);
    sub->add_flag("--json", o->json, "Print one JSON document");
}

}  // namespace huestep::tools
