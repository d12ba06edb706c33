#include "tools/engines.h"

#include <algorithm>

#include "core/box2d/engine.h"
#include "core/solver/method.h"
#include "tools/clock.h"
#ifdef HUESTEP_HAS_BOX2D3
#include "core/box2d/engine3.h"
#endif

namespace huestep::tools {

HuestepEngine::HuestepEngine(World world, const EngineSetup& setup)
    : m_world(std::move(world)),
      m_executor(std::make_unique<Executor>(setup.threads, 0, setup.clock,
                                            setup.shareAll ? nullptr : nanoseconds)),
      m_resources{m_executor.get(), setup.simd, setup.clock, setup.shareAll} {}

Status HuestepEngine::step(std::span<const Command> commands) {
    for (const CommandOutcome& outcome : m_world.step(commands, m_resources).commands)
        if (outcome.reason != Rejection::None) ++m_rejected[outcome.reason];
    return Done{};
}

std::vector<std::string> HuestepEngine::notes() const {
    std::vector<std::string> sentences;
    for (const auto& [reason, count] : m_rejected)
        sentences.push_back("commands rejected: " + std::to_string(count) + ", as " +
                            std::string(describe(reason)));
    return sentences;
}

std::vector<BodyMotion> HuestepEngine::motions() const {
    return {m_world.motions().begin(), m_world.motions().end()};
}

std::vector<std::string> engineNames() {
    return {"huestep", "box2d"};
}

std::vector<std::string> benchEngineNames() {
    std::vector<std::string> names = engineNames();
#ifdef HUESTEP_HAS_BOX2D3
    names.emplace_back("box2d3");
#endif
    return names;
}

namespace {

constexpr std::string_view methodPrefix = "huestep:";

}  // namespace

Status checkBenchEngine(const std::string& name) {
    if (!name.starts_with(methodPrefix)) return checkEngine(name, benchEngineNames());
    const Result<Method> method = parseMethod(name.substr(methodPrefix.size()));
    return method ? Status{Done{}} : Status{method.error()};
}

Status checkEngine(const std::string& name, const std::vector<std::string>& names) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return Done{};
    std::string list;
    for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
    return Error{"--engine: there is no '" + name + "' here; there is " + list};
}

Status checkOwnWay(const std::string& engine, bool methodGiven, bool substepsGiven) {
    if (engine == "huestep") return Done{};
    if (substepsGiven)
        return Error{"--substeps: " + engine +
                     (engine == "box2d" ? " takes 8 velocity and 3 position iterations"
                                        : " takes substeps of its own number")};
    if (methodGiven) return Error{"--method: " + engine + " has its own; only huestep can choose"};
    return Done{};
}

Result<Method> parseMethod(const std::string& name) {
    if (const std::optional<Method> method = methodNamed(name)) return *method;
    std::string list;
    for (const MethodTraits& known : allMethods()) {
        list += (list.empty() ? "" : ", ") + std::string(known.name);
    }
    return Error{"--method: there is no '" + name + "'; there is " + list};
}

bool takesThreads(const std::string& name) {
    return name != "box2d";
}

Result<std::unique_ptr<Engine>> makeEngine(const std::string& name, const Scene& scene,
                                           const EngineSetup& setup,
                                           std::vector<std::string>* notes) {
#ifdef HUESTEP_HAS_BOX2D3
    if (name == "box2d3") return makeBox2d3Engine(scene, setup.threads);
#endif
    if (name == "box2d") return makeBox2dEngine(scene, setup.order, notes);
    Scene own = scene;
    if (name.starts_with(methodPrefix)) {
        const Result<Method> method = parseMethod(name.substr(methodPrefix.size()));
        if (!method) return method.error();
        own.method = *method;
    }
    Result<World> world = World::create(own);
    if (!world) return world.error();
    return std::unique_ptr<Engine>(std::make_unique<HuestepEngine>(std::move(*world), setup));
}

}  // namespace huestep::tools
