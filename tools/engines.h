/// Huestep and its peers behind one face, by the names that `--engine` takes.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/scene/engine.h"
#include "core/world/world.h"

namespace huestep::tools {

/// Engines that a scene can be run and verified with.
std::vector<std::string> engineNames();

/// Those, and the peers that are here to be measured alone.
std::vector<std::string> benchEngineNames();

/// Refuses a name that is not in the list, with a sentence that shows the list.
Status checkEngine(const std::string& name, const std::vector<std::string>& names);

/// The same for `bench`: those to be measured, and Huestep by another method, as `huestep:pgs`.
Status checkBenchEngine(const std::string& name);

/// Refuses what an engine of its own way cannot be told: a method, substeps. `given`: whether the
/// user said so. Of Huestep all is well.
Status checkOwnWay(const std::string& engine, bool methodGiven, bool substepsGiven);

/// A method by its name; fails with a sentence that shows the list.
Result<Method> parseMethod(const std::string& name);

/// Whether an engine can be told how many threads to use.
bool takesThreads(const std::string& name);

/// With what an engine is made; what does not concern it is left alone.
struct EngineSetup {
    int threads = 1;         ///< `takesThreads`
    Simd simd = Simd::Auto;  ///< Huestep
    BuildOrder order{};      ///< Box2D 2.4
    Clock clock = nullptr;   ///< Huestep: for stage times and waiting; none: neither is measured
    bool shareAll = false;   ///< Huestep: see `StepResources::shareAll`
};

/// A scene in an engine, by a name of the lists or `huestep:METHOD`. `scene` must have passed
/// `check`. `notes`, if given, gets a sentence for each thing that a peer leaves out or
/// approximates.
Result<std::unique_ptr<Engine>> makeEngine(const std::string& name, const Scene& scene,
                                           const EngineSetup& setup = {},
                                           std::vector<std::string>* notes = nullptr);

/// A scene in Huestep with a team of threads of its own.
class HuestepEngine final : public Engine {
 public:
    HuestepEngine(World world, const EngineSetup& setup);

    /// Never fails.
    Status step(std::span<const Command> commands) override;
    [[nodiscard]] std::vector<BodyMotion> motions() const override;
    [[nodiscard]] std::uint64_t hash() const override { return m_world.motionRoot(); }
    [[nodiscard]] std::uint32_t contactCount() const override { return m_world.report().contacts; }
    [[nodiscard]] std::string_view name() const override { return "huestep"; }
    [[nodiscard]] std::vector<std::string> notes() const override;

    [[nodiscard]] const World& world() const { return m_world; }
    [[nodiscard]] const Executor& executor() const { return *m_executor; }

 private:
    World m_world;
    std::unique_ptr<Executor> m_executor;
    StepResources m_resources;
    std::map<Rejection, std::uint64_t> m_rejected;  ///< commands, by why
};

}  // namespace huestep::tools
