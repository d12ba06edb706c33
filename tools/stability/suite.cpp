#include "tools/stability/suite.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/solver/method.h"
#include "tools/engines.h"
#include "tools/stability/jobs.h"
#include "tools/stability/ladder.h"
#include "tools/stability/run.h"
#include "tools/stability/save.h"
#include "tools/text.h"

namespace huestep::tools {

using namespace stability;

namespace {

constexpr std::uint64_t ticksBetweenCalls = 64;

/// Body-ticks over which hashes are compared, a scene.
double hashBudget(StabilityEffort effort) {
    switch (effort) {
        case StabilityEffort::Quick:
            return 2.0e4;
        case StabilityEffort::Standard:
            return 2.5e5;
        case StabilityEffort::Full:
            break;
    }
    return 2.5e6;
}

/// One call of `runStability`.
class Suite {
 public:
    Suite(const StabilityOptions& options, const StabilityProgress& progress)
        : m_options(options), m_progress(progress) {}

    Status run(const std::vector<Job>& jobs, StabilityResult& result);

 private:
    /// What a run of a job's scene came to, with how it was set up.
    struct Examined {
        Setup setup;
        Judgement judgement;
    };
    Result<Examined> examine(const Job& job, StabilityVerdict& verdict);
    Status plain(const Job& job, StabilityVerdict& verdict);
    Status far(const Job& job, StabilityVerdict& verdict);
    Status ladder(const Job& job, StabilityVerdict& verdict);

    /// What fails far away passes if it fails at the origin too.
    Status compareWithOrigin(const Job& job, StabilityVerdict& verdict);
    Result<RunOutcome> judged(const Setup& setup, RunOptions options);
    Result<bool> passes(const Trial& trial, const Placing& placing,
                        const StabilityConfiguration& configuration);
    Status compare(const Setup& setup, const RunOutcome& run, StabilityVerdict& verdict);
    Status findFrontier(const Job& job, StabilityVerdict& verdict);
    Status save(const Setup& setup, const Judgement& judgement, StabilityVerdict& verdict);

    /// A tick has been taken: whether to go on.
    bool goOn();
    [[nodiscard]] bool stopped() const { return m_stopped; }

    const StabilityOptions& m_options;
    const StabilityProgress& m_progress;
    /// Row, scene and substeps, of scenes at the origin in the configuration.
    using Known = std::tuple<int, std::string, std::uint32_t>;
    static Known keyOf(const Trial& trial, const std::string& text) {
        return {trial.row, text, trial.substeps};
    }
    std::map<Known, bool> m_passed;
    double m_done = 0.0, m_all = 1.0;  ///< cost
    std::uint64_t m_calls = 0;
    bool m_stopped = false;
};

bool Suite::goOn() {
    if (!m_stopped && m_progress && ++m_calls % ticksBetweenCalls == 0)
        m_stopped = !m_progress(nullptr, m_done / m_all);
    return !m_stopped;
}

Status Suite::run(const std::vector<Job>& jobs, StabilityResult& result) {
    m_all = 0.0;
    for (const Job& job : jobs) m_all += job.cost;
    for (const Job& job : jobs) {
        StabilityVerdict verdict;
        verdict.row = job.row;
        verdict.judged = job.judged;
        verdict.frontier = -1;
        verdict.method = isHuestep(m_options.configuration) ? m_options.configuration.method
                                                            : m_options.configuration.engine;
        const Status done = job.kind == Job::Kind::Plain ? plain(job, verdict)
                            : job.kind == Job::Kind::Far ? far(job, verdict)
                                                         : ladder(job, verdict);
        if (!done) return done;
        if (stopped()) break;
        m_done += job.cost;
        result.verdicts.push_back(std::move(verdict));
        if (m_progress && !m_progress(&result.verdicts.back(), m_done / m_all)) m_stopped = true;
        if (stopped()) break;
    }
    result.finished = result.verdicts.size() == jobs.size();
    return Done{};
}

Result<RunOutcome> Suite::judged(const Setup& setup, RunOptions options) {
    options.threads = m_options.threads;
    options.onTick = [this] { return goOn(); };
    return runAsAsked(setup, options);
}

Result<bool> Suite::passes(const Trial& trial, const Placing& placing,
                           const StabilityConfiguration& configuration) {
    const Result<Setup> setup = setUp(trial, placing, configuration);
    if (!setup) return setup.error();
    RunOptions options;
    options.untilBroken = true;
    const Result<RunOutcome> outcome = judged(*setup, options);
    if (!outcome) return outcome.error();
    return outcome->judgement.pass;
}

Status Suite::compare(const Setup& setup, const RunOutcome& run, StabilityVerdict& verdict) {
    if (run.roots.empty() || !isHuestep(setup.configuration)) return Done{};
    const Result<HashesCompared> compared = compareHashes(setup, run, [this] { return goOn(); });
    if (!compared) return compared.error();
    verdict.hashes = compared->said;
    if (compared->equal) return Done{};
    verdict.pass = false;
    verdict.why = verdict.why.empty() ? compared->said : verdict.why + "; " + compared->said;
    return Done{};
}

/// The smallest number of substeps that passes, what the verdict says of its own taken as known.
Status Suite::findFrontier(const Job& job, StabilityVerdict& verdict) {
    StabilityConfiguration configuration = m_options.configuration;
    if (!isHuestep(configuration)) return Done{};
    if (!m_options.frontier || job.trial.substeps != 0) return Done{};
    for (const std::uint32_t substeps : frontierSubsteps) {
        configuration.substeps = substeps;
        const bool known = substeps == m_options.configuration.substeps;
        const Result<bool> passed =
            known ? Result<bool>(verdict.pass) : passes(job.trial, job.placing, configuration);
        if (!passed) return passed.error();
        if (stopped()) return Done{};
        if (!*passed) continue;
        verdict.frontier = static_cast<int>(substeps);
        return Done{};
    }
    verdict.frontier = 0;
    return Done{};
}

Status Suite::save(const Setup& setup, const Judgement& judgement, StabilityVerdict& verdict) {
    verdict.replay = commandFor(setup);
    if (stopped() || verdict.pass || m_options.saveTo.empty()) return Done{};
    const Result<Saved> saved = saveFailure(m_options.saveTo, setup, judgement);
    if (!saved) return saved.error();
    verdict.savedTo = saved->folder;
    verdict.replay = saved->command;
    return Done{};
}

Result<Suite::Examined> Suite::examine(const Job& job, StabilityVerdict& verdict) {
    Result<Setup> setup = setUp(job.trial, job.placing, m_options.configuration);
    if (!setup) return setup.error();
    RunOptions options;
    const bool deterministic =
        isHuestep(setup->configuration) && traitsOf(setup->scene.method).deterministic;
    if (deterministic) {
        const auto bodies = static_cast<double>(setup->scene.bodies.size());
        const double most = hashBudget(m_options.effort) / std::max(bodies, 1.0);
        options.hashTicks =
            std::min(std::max<std::uint64_t>(static_cast<std::uint64_t>(most), 2), setup->ticks);
    }
    const Result<RunOutcome> outcome = judged(*setup, options);
    if (!outcome) return outcome.error();
    const Judgement& judgement = outcome->judgement;
    if (stopped()) return Examined{std::move(setup).value(), judgement};
    verdict.scene = setup->text;
    verdict.pass = judgement.pass;
    verdict.value = judgement.value;
    verdict.limit = judgement.limit;
    verdict.unit = judgement.unit;
    verdict.what = judgement.what;
    verdict.why = judgement.why;
    if (const Status compared = compare(*setup, *outcome, verdict); !compared)
        return compared.error();
    m_passed[keyOf(job.trial, setup->text)] = verdict.pass;
    if (const Status found = findFrontier(job, verdict); !found) return found.error();
    return Examined{std::move(setup).value(), judgement};
}

Status Suite::plain(const Job& job, StabilityVerdict& verdict) {
    const Result<Examined> examined = examine(job, verdict);
    if (!examined) return examined.error();
    return save(examined->setup, examined->judgement, verdict);
}

Status Suite::far(const Job& job, StabilityVerdict& verdict) {
    const Result<Examined> examined = examine(job, verdict);
    if (!examined) return examined.error();
    if (!verdict.pass) {
        const Status compared = compareWithOrigin(job, verdict);
        if (!compared) return compared;
    }
    return save(examined->setup, examined->judgement, verdict);
}

Status Suite::compareWithOrigin(const Job& job, StabilityVerdict& verdict) {
    Placing origin = job.placing;
    origin.far = 0.0;
    const Known key = keyOf(job.trial, textOf(job.trial, origin));
    if (!m_passed.contains(key)) {
        const Result<bool> passed = passes(job.trial, origin, m_options.configuration);
        if (!passed) return passed.error();
        m_passed[key] = *passed;
    }
    if (m_passed[key]) return Done{};
    verdict.pass = true;
    verdict.what += ", which fails at the origin too";
    verdict.why.clear();
    return Done{};
}

Status Suite::ladder(const Job& job, StabilityVerdict& verdict) {
    const bool substeps = isHuestep(m_options.configuration);
    LadderGrid grid{std::size(ladderRates), substeps ? std::size(ladderSubsteps) : 1, {}};
    for (const double hz : ladderRates)
        for (std::size_t effort = 0; effort < grid.efforts; ++effort) {
            StabilityConfiguration configuration = m_options.configuration;
            if (substeps) configuration.substeps = ladderSubsteps[effort];
            Placing placing = job.placing;
            placing.hz = hz;
            const Result<bool> pass = passes(job.trial, placing, configuration);
            if (!pass) return pass.error();
            if (stopped()) return Done{};
            grid.passed.push_back(*pass);
        }
    const auto place = [&](std::size_t rate, std::size_t effort) {
        std::string text = number(ladderRates[rate]) + " Hz";
        if (substeps) text += ", n = " + std::to_string(ladderSubsteps[effort]);
        return text;
    };
    const std::vector<LadderFault> faults = faultsOf(grid);
    for (const LadderFault& fault : faults)
        verdict.why += (verdict.why.empty() ? "" : "; ") +
                       ("passes at " + place(fault.lessRate, fault.lessEffort)) + " and fails at " +
                       place(fault.rate, fault.effort);
    verdict.scene = textOf(job.trial, job.placing);
    verdict.what = "steps up the ladder after which it fails";
    verdict.unit = "steps";
    verdict.value = static_cast<double>(faults.size());
    verdict.pass = faults.empty();
    return Done{};
}

Status checkConfiguration(const StabilityConfiguration& configuration) {
    if (const Status known = checkEngine(configuration.engine, benchEngineNames()); !known)
        return known;
    if (!isHuestep(configuration)) return Done{};
    const Result<Method> method = parseMethod(configuration.method);
    return method ? Status(Done{}) : method.error();
}

}  // namespace

Result<StabilityResult> runStability(const StabilityOptions& options,
                                     const StabilityProgress& progress) {
    if (const Status fine = checkConfiguration(options.configuration); !fine) return fine.error();
    const Result<std::vector<Job>> jobs = jobsOf(options);
    if (!jobs) return jobs.error();
    StabilityResult result;
    Suite suite(options, progress);
    if (const Status done = suite.run(*jobs, result); !done) return done.error();
    return result;
}

std::string_view stabilityRowName(int row) {
    for (const Row& known : sceneRows())
        if (known.number == row) return known.name;
    if (row == farRow) return "far";
    return row == ladderRow ? "ladder" : "";
}

bool rowPasses(const std::vector<StabilityVerdict>& verdicts, int row) {
    bool any = false;
    for (const StabilityVerdict& verdict : verdicts) {
        if (verdict.row != row || !verdict.judged) continue;
        any = true;
        if (!verdict.pass) return false;
    }
    return any;
}

}  // namespace huestep::tools
