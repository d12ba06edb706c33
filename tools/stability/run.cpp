#include "tools/stability/run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/scene/catalog.h"
#include "core/solver/method.h"
#include "tools/engines.h"
#include "tools/story.h"
#include "tools/text.h"

namespace huestep::tools::stability {

namespace {

std::vector<Criterion> rulesOf(const Trial& trial) {
    std::vector<Criterion> rules;
    if (trial.speedRule) rules.push_back(speedRule());
    if (trial.energyRule) rules.push_back(energyRule());
    return rules;
}

/// A peer that cannot have a scene does not pass it; that Huestep cannot is an error of ours.
Result<RunOutcome> withoutScene(const Setup& setup, const Error& why) {
    if (isHuestep(setup.configuration)) return Error{setup.text + ": " + why.message};
    RunOutcome outcome;
    outcome.judgement.value = std::numeric_limits<double>::infinity();
    outcome.judgement.what = "a scene that the engine cannot have";
    outcome.judgement.why = why.message;
    return outcome;
}

/// The run that others are compared with. Its own value has no limit: what it is says nothing
/// alone.
Setup inKeyOrder(const Setup& setup) {
    Setup ordered = setup;
    ordered.configuration = {"huestep", "sequential", setup.configuration.substeps};
    ordered.scene.method = Method::Sequential;
    ordered.scene.substeps = setup.configuration.substeps;
    ordered.trial.criteria.front().limit = std::numeric_limits<double>::infinity();
    ordered.trial.criteria.front().mayReach = true;
    return ordered;
}

RunOutcome notComparable(const RunOutcome& reference) {
    const Judgement& judged = reference.judgement;
    RunOutcome outcome;
    outcome.judgement.value = std::numeric_limits<double>::infinity();
    outcome.judgement.what = "a ratio to a run in key order that is none";
    outcome.judgement.why =
        "the run in key order, to compare with, came to nothing: " +
        (judged.why.empty() ? judged.what + ": " + number(judged.value) + " " + judged.unit
                            : judged.why);
    return outcome;
}

/// Plays the run once more in a way; says in words where its hashes differ, or nothing.
Result<std::string> playAgain(const Story& story, const Way& way, const RunOutcome& run,
                              const Tick& onTick, bool& finished) {
    Playback playback(story, way);
    for (const std::uint64_t root : run.roots) {
        if (onTick && !onTick()) {
            finished = false;
            return std::string();
        }
        if (const Status stepped = playback.step(); !stepped) return stepped.error();
        if (playback.world().motionRoot() == root) continue;
        return "hashes differ after tick " + std::to_string(playback.world().tick()) + ": " +
               way.sentence();
    }
    if (playback.world().fullRoot() == run.fullRoot) return std::string();
    return "full roots differ after tick " + std::to_string(playback.world().tick()) + ": " +
           way.sentence();
}

}  // namespace

bool isHuestep(const StabilityConfiguration& configuration) {
    return configuration.engine == "huestep";
}

Result<Setup> setUp(const Trial& trial, const Placing& placing,
                    const StabilityConfiguration& configuration) {
    Setup setup;
    setup.trial = trial;
    setup.text = textOf(trial, placing);
    setup.configuration = configuration;
    if (trial.substeps != 0) setup.configuration.substeps = trial.substeps;
    Result<Scene> scene = sceneFromCatalog(setup.text);
    if (!scene) return scene.error();
    setup.scene = std::move(scene).value();
    setup.script = *scriptFromCatalog(setup.text);
    setup.placement = *placementFromCatalog(setup.text);
    setup.ticks = static_cast<std::uint64_t>(std::llround(trial.seconds * placing.hz));
    if (!isHuestep(configuration)) return setup;
    const Result<Method> method = parseMethod(configuration.method);
    if (!method) return method.error();
    setup.scene.method = *method;
    setup.scene.substeps = setup.configuration.substeps;
    return setup;
}

Result<RunOutcome> runOnce(const Setup& setup, const RunOptions& options) {
    const Result<World> start = World::create(setup.scene);
    if (!start) return Error{setup.text + ": " + start.error().message};
    Result<std::unique_ptr<Engine>> engine =
        makeEngine(setup.configuration.engine, setup.scene, {options.threads});
    if (!engine) return withoutScene(setup, engine.error());
    const auto* huestep = dynamic_cast<const HuestepEngine*>(engine->get());
    Judge judge(*start, setup.placement, setup.trial.criteria, rulesOf(setup.trial));
    RunOutcome outcome;
    for (std::uint64_t tick = 1; tick <= setup.ticks; ++tick) {
        if (options.onTick && !options.onTick()) {
            outcome.finished = false;
            break;
        }
        const std::vector<Command> commands = setup.script.commands(tick - 1);
        if (const Status stepped = (*engine)->step(commands); !stepped)
            return Error{setup.text + ": " + stepped.error().message};
        if (huestep != nullptr)
            for (const BodyId body : huestep->world().events().quarantined) judge.lost(tick, body);
        judge.watch(tick, commands, (*engine)->motions());
        if (tick <= options.hashTicks) {
            outcome.roots.push_back((*engine)->hash());
            if (huestep != nullptr && tick == std::min(options.hashTicks, setup.ticks))
                outcome.fullRoot = huestep->world().fullRoot();
        }
        if (judge.hopeless() || (options.untilBroken && judge.broken())) {
            if (huestep != nullptr && tick < options.hashTicks)
                outcome.fullRoot = huestep->world().fullRoot();
            break;
        }
    }
    outcome.judgement = judge.judgement();
    return outcome;
}

Result<RunOutcome> runAsAsked(const Setup& setup, const RunOptions& options) {
    if (!setup.trial.againstKeyOrder) return runOnce(setup, options);
    Result<RunOutcome> reference =
        runOnce(inKeyOrder(setup), {options.threads, false, 0, options.onTick});
    if (!reference) return reference.error();
    const double unit = reference->judgement.value;
    if (!reference->finished) return reference;
    if (!reference->judgement.pass || !std::isfinite(unit) || unit <= 0.0)
        return notComparable(*reference);
    Setup scaled = setup;
    const Measure plain = setup.trial.criteria.front().measure;
    scaled.trial.criteria.front().measure = [plain, unit](const Moment& moment) {
        return plain(moment) / unit;
    };
    return runOnce(scaled, options);
}

Result<HashesCompared> compareHashes(const Setup& setup, const RunOutcome& run,
                                     const Tick& onTick) {
    Result<World> start = World::create(setup.scene);
    if (!start) return Error{setup.text + ": " + start.error().message};
    const std::uint64_t ticks = run.roots.size();
    Story story;
    story.start = std::make_shared<const World>(std::move(start).value());
    story.end = ticks;
    if (setup.script)
        story.script = [&setup](std::uint64_t tick) { return setup.script.commands(tick); };
    const std::uint64_t half = std::max<std::uint64_t>(ticks / 2, 1);
    HashesCompared result;
    for (const Way& way : {Way{2, Simd::Scalar, half, 0}, Way{3, Simd::Auto, 0, 0}}) {
        const Result<std::string> differs = playAgain(story, way, run, onTick, result.finished);
        if (!differs) return Error{setup.text + ": " + differs.error().message};
        if (!result.finished) return result;
        if (differs->empty()) continue;
        result.equal = false;
        result.said = *differs;
        return result;
    }
    result.said = std::to_string(ticks) + " of " + std::to_string(setup.ticks) +
                  " ticks equal on 2 threads with scalar lanes and a restore at tick " +
                  std::to_string(half) + " and on 3 with the widest";
    return result;
}

}  // namespace huestep::tools::stability
