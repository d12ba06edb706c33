/// `huestep stability`: the suite of scenes that solvers fall over.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>
#include <set>

#include "core/solver/method.h"
#include "tools/command.h"
#include "tools/engines.h"
#include "tools/interrupt.h"
#include "tools/lists.h"
#include "tools/progress.h"
#include "tools/stability/report.h"
#include "tools/stability/run.h"
#include "tools/stability/save.h"
#include "tools/whole_number.h"

namespace huestep::tools {

using namespace stability;

namespace {

constexpr std::uint64_t progressSteps = 10'000;

struct Options {
    std::vector<std::string> words;  // rows and scenes
    std::string methods = "soft-step";
    std::string substeps = "auto";
    int threads = 1;
    bool quick = false;
    bool full = false;
    bool noFrontier = false;
    std::string save;
    bool json = false;
};

/// Methods of ours and peers, by the names that users give them.
Result<std::vector<StabilityConfiguration>> configurationsOf(const Options& options) {
    std::uint32_t substeps = 0;
    if (options.substeps != "auto") {
        const char* end = options.substeps.data() + options.substeps.size();
        const auto read = std::from_chars(options.substeps.data(), end, substeps);
        if (read.ec != std::errc() || read.ptr != end || substeps < 1 || substeps > 64)
            return Error{"--substeps: '" + options.substeps + "' is neither auto nor 1 to 64"};
    }
    std::vector<std::string> names = splitAtCommas(options.methods);
    if (options.methods == "all") {
        names.clear();
        for (const MethodTraits& method : allMethods()) names.emplace_back(method.name);
        for (const std::string& engine : benchEngineNames())
            if (engine != "huestep") names.push_back(engine);
    }
    const std::vector<std::string> engines = benchEngineNames();
    std::vector<StabilityConfiguration> all;
    for (const std::string& name : names) {
        const bool peer =
            name != "huestep" && std::find(engines.begin(), engines.end(), name) != engines.end();
        if (!peer && !methodNamed(name)) {
            std::string list;
            for (const MethodTraits& known : allMethods()) list += std::string(known.name) + ", ";
            for (const std::string& engine : engines)
                if (engine != "huestep") list += engine + ", ";
            return Error{"--method: there is no '" + name + "'; there is " + list + "all"};
        }
        all.push_back({peer ? name : "huestep", peer ? "" : name, substeps});
        if (std::count(names.begin(), names.end(), name) > 1)
            return Error{"--method: " + name + " is given twice"};
    }
    if (std::none_of(all.begin(), all.end(), isHuestep)) {
        const std::string& peer = all.front().engine;
        if (const Status own = checkOwnWay(peer, false, substeps != 0); !own) return own.error();
        if (options.threads != 1) return Error{"--threads: " + peer + " is run on one thread here"};
    }
    return all;
}

/// Numbers are rows, other words scenes.
StabilityOptions suiteOptions(const Options& options) {
    StabilityOptions suite;
    suite.effort = options.quick  ? StabilityEffort::Quick
                   : options.full ? StabilityEffort::Full
                                  : StabilityEffort::Standard;
    for (const std::string& word : options.words) {
        const bool digits =
            !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
        if (digits && word.size() < 4)
            suite.rows.push_back(std::stoi(word));
        else
            suite.scenes.push_back(word);
    }
    suite.frontier = !options.noFrontier && !options.quick;
    suite.threads = options.threads;
    suite.saveTo = options.save;
    return suite;
}

/// Shows how far the work has come.
class Teller {
 public:
    explicit Teller(const std::string& method) : m_bar(method, progressSteps) {}

    /// Whether to go on.
    bool operator()(double share) {
        const auto reached = static_cast<std::uint64_t>(share * progressSteps);
        if (reached > m_reached) m_bar.advance(reached - m_reached);
        m_reached = std::max(m_reached, reached);
        return !interrupted();
    }

 private:
    Progress m_bar;
    std::uint64_t m_reached = 0;
};

/// Rows of which nothing was run, where all were asked for.
void printRowsLeftOut(const std::vector<StabilityVerdict>& verdicts) {
    std::set<int> run;
    for (const StabilityVerdict& verdict : verdicts) run.insert(verdict.row);
    std::string list;
    for (int row = 1; row <= stabilityRows; ++row)
        if (!run.contains(row)) list += (list.empty() ? "" : ", ") + std::to_string(row);
    if (!list.empty()) std::printf("rows without a scene for --quick: %s\n", list.c_str());
}

std::string nameOf(const StabilityConfiguration& configuration) {
    return isHuestep(configuration) ? configuration.method : configuration.engine;
}

Answer runSuite(const Options& options) {
    const Result<std::vector<StabilityConfiguration>> configurations = configurationsOf(options);
    if (!configurations) return configurations.error();
    if (!options.save.empty())
        if (const Status ready = prepareFolder(options.save); !ready) return ready.error();
    StabilityOptions suite = suiteOptions(options);
    std::vector<Configured> all;
    bool finished = true;
    bool passed = true;
    for (const StabilityConfiguration& configuration : *configurations) {
        suite.configuration = configuration;
        Teller teller(nameOf(configuration));
        Result<StabilityResult> result = runStability(
            suite, [&](const StabilityVerdict*, double share) { return teller(share); });
        if (!result) return result.error();
        finished = finished && result->finished;
        for (const StabilityVerdict& verdict : result->verdicts)
            passed = passed && (verdict.pass || !verdict.judged);
        all.push_back({configuration, std::move(result).value()});
        if (!options.json) print(all.back());
        if (!finished) break;
    }
    if (options.json) print(asJson(all, finished));
    if (!options.json && finished && options.quick && options.words.empty())
        printRowsLeftOut(all.front().result.verdicts);
    if (!finished) {
        std::size_t scenes = 0;
        for (const Configured& configured : all) scenes += configured.result.verdicts.size();
        return stopped("with " + std::to_string(scenes) + " scenes judged");
    }
    return passed ? Exit::Done : Exit::Differs;
}

}  // namespace

void addStability(Menu& menu) {
    const auto o = std::make_shared<Options>();
    CLI::App* sub = menu.add(
        "stability", "Runs scenes that solvers fall over; prints who passes, by what margin.",
        "huestep stability 4 chain --method soft-step,box2d", [o] { return runSuite(*o); });
    sub->footer(sub->get_footer() +
                "\n\nEvery scene is run upright and turned by 37 degrees with gravity, from bodies "
                "that a seed\n"
                "moves by up to 1 mm. margin: what is left to the limit. frontier: the fewest "
                "substeps of\n"
                "1, 2, 4, 8, 16, 32 that pass. Each run of huestep is also compared, hash by hash, "
                "with one on\n"
                "2 threads, scalar, restored half way, and one on 3 with the widest lanes (--json "
                "says how long).\n"
                "Exit status 1: a row fails.");
    sub->add_option("SCENE", o->words, "Rows by number, or scenes by name (default: all)");
    sub->add_option("--method", o->methods,
                    "Methods, box2d, or all, as in soft-step,box2d (default: soft-step)");
    sub->add_option("--substeps", o->substeps,
                    "Substeps, or iterations, a tick, 1 to 64, or auto: as needed (default)");
    sub->add_option("--threads", o->threads, "Threads, 1 to 64 (default: 1)")
        ->transform(wholeNumber(1, maxThreads));
    CLI::Option* quick = sub->add_flag(
        "--quick", o->quick, "Small scenes alone, upright, without frontiers: some seconds");
    sub->add_flag("--full", o->full, "Also the ladder of large scenes, and hashes for longer")
        ->excludes(quick);
    sub->add_flag("--no-frontier", o->noFrontier, "Leave the frontiers out, which take most time");
    sub->add_option("--save", o->save,
                    "Save failures in this folder, which must be new, to be played again");
    sub->add_flag("--json", o->json, "Print one JSON document");
}

}  // namespace huestep::tools
