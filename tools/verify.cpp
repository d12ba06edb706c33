/// `huestep verify`: runs every combination and compares the hash of every tick.
///
/// A scene is told as several stories: as given; with its bodies and joints listed in other
/// orders; and with noise, far-away bodies with contacts and joints of their own, which host
/// commands remove in the middle of the run. The reference of the last is the scene with the same
/// ids and counters but without the noise, given the same commands: there they name bodies that do
/// not exist and are rejected, which leaves the same mark on the host's sequence. From the tick
/// after the removal both states must be the same to the last bit.
///
/// As given, a scene is played with every thread count and every width, and restored and disturbed
/// with every thread count; other stories take the widths in turn, so that the number of
/// combinations stays a sum and not a product.
#include "tools/verify.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "tools/engines.h"
#include "tools/journal_story.h"
#include "tools/lists.h"
#include "tools/reorder.h"
#include "tools/text.h"
#include "tools/whole_number.h"

namespace huestep::tools {
namespace {

constexpr std::uint64_t shuffleSeeds[] = {1, 2};
constexpr std::uint64_t maxTicks = 10'000'000;  // the reference's hash of every tick is kept
constexpr std::uint64_t noiseTicks = 60;  // how long noise lives, in a run that is long enough

using CommandsOf = std::function<std::vector<Command>(std::uint64_t tick)>;

struct Plan {
    std::vector<Story> stories;
    std::vector<Combination> combinations;
};

Result<Story> storyOf(const std::string& name, const Scene& scene, std::uint64_t ticks) {
    Result<World> world = World::create(scene);
    if (!world) return Error{name + ": " + world.error().message};
    Story story;
    story.name = name;
    story.start = std::make_shared<const World>(std::move(world).value());
    story.end = story.start->tick() + ticks;
    return story;
}

/// Adds a story that must equal the story at place `reference` from tick `from` on.
Status addStory(Plan& plan, const std::string& name, const Scene& scene, std::uint64_t ticks,
                std::size_t reference, std::uint64_t from, CommandsOf script,
                std::map<std::uint64_t, std::vector<Command>> commands = {}) {
    Result<Story> story = storyOf(name, scene, ticks);
    if (!story) return story.error();
    story->reference = reference;
    story->comparedFrom = from;
    story->script = std::move(script);
    story->commands = std::move(commands);
    plan.stories.push_back(std::move(story).value());
    return Done{};
}

/// The script as a function; none if the scene has none.
CommandsOf hostOf(const Script& script) {
    if (!script) return {};
    return [script](std::uint64_t tick) { return script.commands(tick); };
}

/// The same host in worlds with and without noise, where the scene's ids are other ones.
CommandsOf hostOf(const Script& script, const NoisePair& noise) {
    if (!script) return {};
    return [script, ids = noise.ids](std::uint64_t tick) {
        std::vector<Command> commands = script.commands(tick);
        for (Command& command : commands) command = ids.renamed(std::move(command));
        return commands;
    };
}

Status addReordered(Plan& plan, const Scene& scene, const Script& script, std::uint64_t ticks) {
    for (const std::uint64_t seed : shuffleSeeds) {
        const std::string name = "listed in order " + std::to_string(seed);
        const Status added =
            addStory(plan, name, shuffled(scene, seed), ticks, 0, 0, hostOf(script));
        if (!added) return added;
    }
    Result<NoisePair> noise = withNoise(scene);
    if (!noise) return noise.error();
    const std::uint64_t removal = std::min(noiseTicks, ticks / 2);
    for (std::size_t i = 0; i < noise->removal.size(); ++i)
        noise->removal[i].sequence = hostSequence(removal, caps::maxCommands + i);
    const CommandsOf host = hostOf(script, *noise);
    const std::size_t reference = plan.stories.size();
    const Status added = addStory(plan, "without the noise", noise->quiet, ticks, reference, 0,
                                  host, {{removal, noise->removal}});
    if (!added) return added;
    return addStory(plan, "after noise", noise->noisy, ticks, reference, removal + 1, host,
                    {{removal, noise->removal}});
}

/// Every thread count and width for story 0, with its disturbances; the widths in turn elsewhere.
void combine(Plan& plan, const std::vector<int>& threads, const std::vector<Simd>& widths,
             std::uint64_t restoreEvery) {
    std::size_t turn = 0;
    for (const int count : threads)
        for (const Simd width : widths) plan.combinations.push_back({0, {count, width, 0, 0}});
    const auto nextWidth = [&] { return widths[turn++ % widths.size()]; };
    for (const int count : threads) {
        if (restoreEvery != 0)
            plan.combinations.push_back({0, {count, nextWidth(), restoreEvery, 0}});
        plan.combinations.push_back(
            {0, {count, nextWidth(), 0, static_cast<std::uint64_t>(count) + 100}});
    }
    for (std::size_t story = 1; story < plan.stories.size(); ++story)
        for (const int count : threads)
            plan.combinations.push_back({story, {count, nextWidth(), 0, 0}});
}

Result<Plan> planScene(const VerifyOptions& options, const NamedScene& named) {
    Plan plan;
    const std::uint64_t ticks = options.ticks != 0 ? options.ticks : named.ticks;
    const Status added = addStory(plan, "as given", named.scene, ticks, 0, 0, hostOf(named.script));
    if (!added) return Error{named.name + ": " + added.error().message};
    if (options.reorder) {
        const Status more = addReordered(plan, named.scene, named.script, ticks);
        if (!more) return more.error();
    }
    return plan;
}

Result<Plan> planJournal(const VerifyOptions& options) {
    if (options.reorder)
        return Error{
            "--reorder: a journal starts from one state; give a scene to build it in "
            "other orders"};
    Result<JournalStory> journal = loadJournal(options.source);
    if (!journal) return journal.error();
    Story& story = journal->story;
    story.name = "as recorded";
    if (options.ticks != 0) story.end = std::min(story.end, story.start->tick() + options.ticks);
    Plan plan;
    plan.stories.push_back(std::move(story));
    return plan;
}

/// The first combination that differs, in the order of the list.
std::optional<std::size_t> firstUnequal(const Comparison& comparison) {
    for (std::size_t i = 0; i < comparison.outcomes.size(); ++i)
        if (comparison.outcomes[i].fails()) return i;
    return std::nullopt;
}

std::string nameOf(const Plan& plan, std::size_t i) {
    const Combination& c = plan.combinations[i];
    return plan.stories[c.story].name + ", " + c.way.sentence();
}

/// In words: where combination `i` left what it must equal.
std::string explain(const Plan& plan, const Comparison& comparison, std::size_t i) {
    const Outcome& outcome = comparison.outcomes[i];
    if (!outcome.failure.empty()) return nameOf(plan, i) + ": " + outcome.failure;
    const std::uint64_t tick = *outcome.differsAt;
    const std::string at = nameOf(plan, i) + ": differs at tick " + std::to_string(tick);
    const std::size_t story = plan.stories[plan.combinations[i].story].reference;
    const auto leads = std::find_if(plan.combinations.begin(), plan.combinations.end(),
                                    [&](const Combination& c) { return c.story == story; });
    const auto reference = static_cast<std::size_t>(leads - plan.combinations.begin());
    if (reference == i) return at + " from the hash that was recorded";
    const auto difference =
        nameDifference(plan.stories, plan.combinations[reference], plan.combinations[i], tick);
    if (!difference) return at + "; " + difference.error().message;
    if (!*difference)
        return at + (outcome.recordDiffers ? " from the recorded hash, as the first does"
                                           : " in its hash, but in no field when run again");
    return at + " from " + nameOf(plan, reference) + ": " + (*difference)->sentence();
}

Json asJson(const VerifyOptions& options, const Plan& plan, const Comparison& comparison,
            const std::string& difference) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < comparison.outcomes.size(); ++i) {
        const Combination& c = plan.combinations[i];
        const Outcome& o = comparison.outcomes[i];
        Json row = {{"story", plan.stories[c.story].name},
                    {"threads", c.way.threads},
                    {"simd", huestep::nameOf(c.way.simd)},
                    {"restore_every", c.way.restoreEvery},
                    {"disturbed", c.way.disturbSeed != 0},
                    {"hashes_compared", o.rootsCompared},
                    {"equal", o.decided() ? Json(o.equal()) : Json()},
                    {"tick", o.tick}};
        if (o.tick != 0) {
            row["motion"] = hex(o.motionRoot);
            row["full"] = hex(o.fullRoot);
        }
        if (o.differsAt) row["differs_at"] = *o.differsAt;
        rows.push_back(row);
    }
    Json json = {{"source", options.source},
                 {"engine", "huestep"},
                 {"combinations", rows},
                 {"finished", comparison.finished()},
                 {"equal", firstUnequal(comparison) ? Json(false)
                           : comparison.finished()  ? Json(true)
                                                    : Json()}};
    if (!difference.empty()) json["difference"] = difference;
    return json;
}

void printText(const Plan& plan, const Comparison& comparison, const std::string& difference) {
    Table table({"story", "threads", "simd", "disturbed by", "compared", "final full root", ""});
    std::uint64_t compared = 0;
    for (std::size_t i = 0; i < comparison.outcomes.size(); ++i) {
        const Combination& c = plan.combinations[i];
        const Outcome& o = comparison.outcomes[i];
        if (o.tick == 0) continue;  // stopped before its turn
        std::string by = c.way.disturbSeed != 0 ? "drops, shuffled blocks" : "";
        if (c.way.restoreEvery != 0) by = "restore every " + std::to_string(c.way.restoreEvery);
        std::string verdict = o.rootsCompared == 0 ? "reference" : "equal";
        if (!o.decided()) verdict = "stopped at " + std::to_string(o.tick);
        if (o.fails()) verdict = "fails";
        if (o.differsAt) verdict = "differs at " + std::to_string(*o.differsAt);
        table.add({plan.stories[c.story].name, std::to_string(c.way.threads),
                   std::string(huestep::nameOf(c.way.simd)), by, std::to_string(o.rootsCompared),
                   hex(o.fullRoot), verdict});
        compared += o.rootsCompared;
    }
    table.print();
    if (!comparison.finished())
        std::printf("stopped before all was compared\n");
    else if (difference.empty())
        std::printf("equal: %zu combinations, %llu hashes compared\n", comparison.outcomes.size(),
                    static_cast<unsigned long long>(compared));
    else
        std::printf("different: %s\n", difference.c_str());
}

int jobsOf(const VerifyOptions& options) {
    if (options.jobs != 0) return options.jobs;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Answer verifyWorlds(const VerifyOptions& options, Result<Plan> plan) {
    if (!plan) return plan.error();
    const Result<std::vector<int>> threads = parseThreads(options.threads);
    if (!threads) return threads.error();
    const Result<std::vector<Simd>> widths = parseSimdList(options.simd);
    if (!widths) return widths.error();
    const std::uint64_t steps = plan->stories.front().steps();
    if (options.restoreEvery > steps)
        return Error{"--restore-every: " + std::to_string(options.restoreEvery) +
                     " is more than the " + std::to_string(steps) +
                     " ticks of the run, so nothing would be restored"};
    combine(*plan, *threads, *widths, options.restoreEvery);

    const Comparison comparison = playAll(plan->stories, plan->combinations, jobsOf(options));
    std::string difference;
    if (comparison.finished())
        if (const auto i = firstUnequal(comparison)) difference = explain(*plan, comparison, *i);
    if (options.json)
        print(asJson(options, *plan, comparison, difference));
    else
        printText(*plan, comparison, difference);
    if (!comparison.finished())
        return stopped("with " + std::to_string(comparison.decided()) + " of " +
                       std::to_string(comparison.outcomes.size()) + " combinations compared");
    return difference.empty() ? Exit::Done : Exit::Differs;
}

Answer verify(const VerifyOptions& options, bool threadsGiven) {
    if (const Status known = checkEngine(options.engine, engineNames()); !known)
        return known.error();
    const bool peer = options.engine != "huestep";
    if (peer && !options.method.empty())
        return Error{"--method: " + options.engine + " has its own; only huestep can choose"};
    if (looksLikeJournal(options.source)) {
        if (!options.method.empty())
            return Error{"--method: a journal was made by one method and is replayed by it"};
        if (peer)
            return Error{"--engine: a journal is of huestep and cannot be played by " +
                         options.engine};
        return verifyWorlds(options, planJournal(options));
    }
    std::error_code wrong;
    Result<NamedScene> named = loadScene(options.source);
    if (!named && !std::filesystem::exists(options.source, wrong))
        return Error{named.error().message + ", nor a folder with a journal"};
    if (!named) return named.error();
    if (!options.method.empty()) {
        const Result<Method> method = parseMethod(options.method);
        if (!method) return method.error();
        named->scene.method = *method;
    }
    if (!peer) return verifyWorlds(options, planScene(options, *named));
    if (threadsGiven || options.restoreEvery != 0)
        return Error{"--threads, --simd and --restore-every: " + options.engine +
                     " has one thread, its own arithmetic and no snapshots"};
    if (options.jobs != 0)
        return Error{"--jobs: runs of " + options.engine + " cannot be made side by side"};
    return verifyPeer(options, *named);
}

}  // namespace

void addVerify(Menu& menu) {
    const auto o = std::make_shared<VerifyOptions>();
    const auto given = std::make_shared<bool>(false);
    CLI::App* sub = menu.add(
        "verify", "Runs every combination and compares the hash of every tick.",
        "huestep verify pyramid:base=20 --ticks 300 --threads 1,2,8 --restore-every 37 --reorder",
        [o, given] { return verify(*o, *given); });
    sub->add_option("SCENE|LOG", o->source, "Scene, scene file, or the folder of a journal")
        ->required();
    sub->add_option("--engine", o->engine, "Whose runs to compare (default: huestep)");
    sub->add_option("--method", o->method, "How constraints are solved (default: the scene's own)");
    sub->add_option("--ticks", o->ticks, "Steps to take (default: the scene's own)")
        ->transform(wholeNumber(1, maxTicks));
    const auto note = [given](const std::string&) { *given = true; };
    sub->add_option("--threads", o->threads, "Thread counts (default: 1,2,3,8)")->each(note);
    sub->add_option("--simd", o->simd, "Widths, or all that this machine has (default: all)")
        ->each(note);
    sub->add_option("--restore-every", o->restoreEvery, "Also save and restore after every K ticks")
        ->transform(wholeNumber(1));
    sub->add_flag("--reorder", o->reorder, "Also build the scene in other orders and after noise");
    sub->add_option("--jobs", o->jobs, "Combinations side by side (default: one a core)")
        ->transform(wholeNumber(1, 256));
    sub->add_flag("--json", o->json, "Print one JSON document");
}

}  // namespace huestep::tools
