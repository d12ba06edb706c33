#include "tools/stability/jobs.h"

#include <algorithm>
#include <set>

#include "core/scene/catalog.h"
#include "tools/stability/run.h"

namespace huestep::tools::stability {

namespace {

constexpr double quickCost = 65'000.0;     // body-ticks of a scene that is quick
constexpr double quickFarCost = 25'000.0;  // … and once more far away
constexpr std::size_t quickLadderBodies = 4;
constexpr std::size_t ladderBodies = 200;               // of a scene that is in the standard ladder
constexpr double farAway[] = {1.0, 10.0, 20.0, 100.0};  // km
constexpr double farthestJudged = 20.0;                 // km

std::size_t bodiesOf(const Trial& trial) {
    const Result<Scene> scene = sceneFromCatalog(trial.scene);
    return scene ? scene->bodies.size() : 0;
}

/// Whether a scene's text begins with whole words of another: "stack", "stack:n=10".
bool beginsWith(const std::string& text, const std::string& words) {
    if (!text.starts_with(words)) return false;
    return text.size() == words.size() || text[words.size()] == ':' || text[words.size()] == ',';
}

/// A row's scenes with how many bodies they have.
struct Sized {
    const Trial* trial = nullptr;
    double bodies = 0.0;
    [[nodiscard]] double bodyTicks() const { return bodies * trial->seconds * 60.0; }
};

std::vector<Sized> sizedTrials(const Row& row) {
    std::vector<Sized> sized;
    for (const Trial& trial : row.trials)
        sized.push_back({&trial, static_cast<double>(bodiesOf(trial))});
    return sized;
}

/// Upright, and turned unless it must be quick.
std::vector<double> turnsOf(StabilityEffort effort) {
    if (effort == StabilityEffort::Quick) return {0.0};
    return {0.0, turnedBy};
}

/// Those of the configuration, or about what is planned.
double substepsOf(const StabilityOptions& options) {
    const std::uint32_t substeps = options.configuration.substeps;
    return substeps == 0 ? 6.0 : static_cast<double>(substeps);
}

class Planner {
 public:
    explicit Planner(const StabilityOptions& options) : m_options(options) {}

    std::vector<Job> jobs() {
        for (const Row& row : sceneRows()) {
            const std::vector<Sized> sized = sizedTrials(row);
            addPlain(row.number, sized);
            if (wanted(farRow) && (row.number == 1 || row.number == 11 || row.number == 20))
                addFar(sized);
            if (wanted(ladderRow)) addLadder(row.number, sized);
        }
        std::stable_sort(m_jobs.begin(), m_jobs.end(),
                         [](const Job& a, const Job& b) { return a.row < b.row; });
        return std::move(m_jobs);
    }

 private:
    [[nodiscard]] bool wanted(int row) const {
        const std::vector<int>& rows = m_options.rows;
        if (rows.empty()) return m_options.scenes.empty();
        return std::find(rows.begin(), rows.end(), row) != rows.end();
    }
    /// Of rows 1 to 26: the whole row, or one of the scenes by name.
    [[nodiscard]] bool wanted(const Trial& trial) const {
        const std::vector<std::string>& scenes = m_options.scenes;
        return wanted(trial.row) ||
               std::any_of(scenes.begin(), scenes.end(), [&](const std::string& scene) {
                   return beginsWith(trial.scene, scene);
               });
    }
    [[nodiscard]] bool quick() const { return m_options.effort == StabilityEffort::Quick; }

    void add(Job job, double cost) {
        job.cost = std::max(cost * (job.trial.againstKeyOrder ? 2.0 : 1.0), 1.0);
        m_jobs.push_back(std::move(job));
    }

    void addPlain(int row, const std::vector<Sized>& sized) {
        const double substeps = substepsOf(m_options) + 2.0;
        for (const Sized& s : sized) {
            if (!wanted(*s.trial) || (quick() && s.bodyTicks() > quickCost)) continue;
            for (const double turn : turnsOf(m_options.effort))
                add({Job::Kind::Plain, row, *s.trial, {turn}, s.trial->judged, 0.0},
                    s.bodyTicks() * substeps);
        }
    }

    void addFar(const std::vector<Sized>& sized) {
        const double substeps = substepsOf(m_options) + 2.0;
        for (const Sized& s : sized) {
            if (!s.trial->judged || (quick() && s.bodyTicks() > quickFarCost)) continue;
            for (const double far : farAway) {
                if (quick() && far != farthestJudged) continue;
                for (const double turn : turnsOf(m_options.effort))
                    add({Job::Kind::Far, farRow, *s.trial, {turn, far}, far <= farthestJudged, 0.0},
                        s.bodyTicks() * substeps);
            }
        }
    }

    void addLadder(int row, const std::vector<Sized>& sized) {
        const double most = quick()                                         ? quickLadderBodies
                            : m_options.effort == StabilityEffort::Standard ? ladderBodies
                                                                            : 1e9;
        for (const Sized& s : sized) {
            if (!s.trial->judged || s.bodies > most) continue;
            Job job{Job::Kind::Ladder, ladderRow, *s.trial, {}, true, 0.0};
            job.trial.row = row;
            job.trial.substeps = 0;
            const std::string& scene = job.trial.scene;
            if (!m_laddered.insert(scene).second) continue;  // a row of one scene and many efforts
            add(std::move(job), s.bodyTicks() * 3.5 * (31.0 + 2.0 * 5.0));
        }
    }

    const StabilityOptions& m_options;
    std::vector<Job> m_jobs;
    std::set<std::string> m_laddered;
};

/// What was asked for by number or by name must not pass unseen because nothing of it is left.
Status checkAllHaveJobs(const StabilityOptions& options, const std::vector<Job>& jobs) {
    const auto any = [&](auto&& of) { return std::any_of(jobs.begin(), jobs.end(), of); };
    const auto none = [&](const std::string& whose) {
        const bool quick = options.effort == StabilityEffort::Quick;
        return Error{whose + " has no scene" +
                     (quick ? " for --quick; leave --quick out" : " of this effort")};
    };
    for (const int row : options.rows)
        if (!any([&](const Job& job) { return job.row == row; }))
            return none("row " + std::to_string(row));
    for (const std::string& scene : options.scenes)
        if (!any([&](const Job& job) { return beginsWith(job.trial.scene, scene); }))
            return none("'" + scene + "'");
    return Done{};
}

}  // namespace

Result<std::vector<Job>> jobsOf(const StabilityOptions& options) {
    for (const int row : options.rows)
        if (row < 1 || row > stabilityRows)
            return Error{"there is no row " + std::to_string(row) + "; there are 1 to " +
                         std::to_string(stabilityRows)};
    const auto known = [](const std::string& scene) {
        for (const Row& row : sceneRows())
            for (const Trial& trial : row.trials)
                if (beginsWith(trial.scene, scene)) return true;
        return false;
    };
    for (const std::string& scene : options.scenes)
        if (!known(scene)) return Error{"no row has a scene '" + scene + "'"};
    std::vector<Job> jobs = Planner(options).jobs();
    if (const Status something = checkAllHaveJobs(options, jobs); !something)
        return something.error();
    return jobs;
}

}  // namespace huestep::tools::stability
