/// The metrics A1 to A20 of the physics page as cases: a scene, how long it runs, and a judge that
/// says how far a run of it was from the truth.
///
/// A judge sees definitions and motions alone and reckons in double, so every engine and method is
/// judged alike. What the cases are held against stands in each of them (`reference`).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/result.h"
#include "core/scene/engine.h"
#include "core/scene/scene.h"
#include "core/scene/script.h"
#include "core/world/world.h"

namespace huestep::tools {

/// The diagrams of the chart, one a class.
enum class SceneClass : std::uint8_t { Joint, Stack, Friction, Impact, Mixed };
std::string_view nameOf(SceneClass kind);

/// Watches one run and says how far it is from the truth. Holds no reference to a world.
class Judge {
 public:
    virtual ~Judge() = default;
    /// After step number `tick`, counted from 1, with these commands. `motions` as an `Engine`
    /// gives them; `touching`: whether there is any contact.
    virtual void watch(std::uint64_t tick, std::span<const Command> commands,
                       std::span<const BodyMotion> motions, bool touching) = 0;
    /// ≥ 0, in the case's unit; infinity: the run failed, or was too short to say.
    [[nodiscard]] virtual double error() const = 0;
};

/// `start`: the world of the case's scene before its first step.
using JudgeMaker = std::function<std::unique_ptr<Judge>(const World& start)>;

/// Which truth: what rigid bodies do, or what soft rows do when nothing is lost on the way.
enum class Truth : std::uint8_t { Rigid, SoftModel };

/// What takes the steps: an engine, and of Huestep a method and its effort.
struct Setting {
    /// Makes the engine of a scene whose method and substeps are set.
    std::function<Result<std::unique_ptr<Engine>>(const Scene& scene)> make;
    std::optional<Method> method;  ///< none: an engine with one of its own
    std::uint32_t substeps = 0;    ///< or iterations; 0: planned, or an engine that takes none
};

struct MetricCase {
    std::string_view metric;  ///< "A5"
    std::string name;         ///< "pendulum-90-period"; unique
    std::string what;         ///< a sentence for people
    SceneClass kind = SceneClass::Joint;
    std::string_view unit;       ///< "m", "rad", "s", "m/s"; "1": a share; "order": no error
    std::string_view reference;  ///< what it is held against, in a few words
    Truth truth = Truth::Rigid;
    /// m, by which the reference may be off itself, where it is no closed form. Costs its solution.
    std::function<double()> uncertainty;
    bool charted = false;          ///< one run, an error that work brings down: for diagrams
    std::uint64_t ticks = 0;       ///< that the run takes
    std::function<Scene()> scene;  ///< passes `check`; of a series, its first
    Script script;                 ///< what the scene's host does
    JudgeMaker judge;              ///< of one run; none where `series` is given
    /// Where one run is not enough: all of them, and what comes out.
    std::function<Result<double>(const Setting& setting)> series;
};

/// All cases, by metric, in the order of the page.
std::span<const MetricCase> metricCases();

/// The case of this name; null: there is none.
const MetricCase* findMetricCase(std::string_view name);

/// Whether the case says something of the setting: soft-model truths know soft steps alone, and
/// they as orders of convergence need substeps that are given.
bool appliesTo(const MetricCase& metric, const Setting& setting);

/// The scene with the setting's method and substeps, stepped for `ticks` under the judge.
Result<double> judgeRun(Scene scene, const Script& script, std::uint64_t ticks,
                        const JudgeMaker& judge, const Setting& setting);

/// What `metric` says of a run in the setting, to which it applies: one run, or its series.
Result<double> errorOf(const MetricCase& metric, const Setting& setting);

/// The judges of those cases whose scene this is, whatever its name, method, need and substeps, and
/// that apply to how it is solved.
struct RunningJudge {
    const MetricCase* metric = nullptr;
    std::unique_ptr<Judge> judge;
};
std::vector<RunningJudge> judgesOf(const Scene& scene, const World& start, const Setting& setting);

}  // namespace huestep::tools
