/// All the ways in which one and the same run may be computed. None may be seen in a hash.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/world/world.h"
#include "tests/core/spoil.h"
#include "tests/core/support.h"
#include "tests/determinism/commands.h"

namespace huestep::test {

struct Configuration {
    std::string name;
    int threads = 1;
    Simd simd = Simd::Auto;
    std::uint64_t shuffleSeed = 0;   ///< of the executor
    std::uint32_t restoreEvery = 0;  ///< ticks; 0: never
    std::uint32_t copyEvery = 0;     ///< ticks; 0: never
    std::uint32_t dropOnceIn = 0;    ///< accelerators are dropped about once in so many ticks
    bool withoutExecutor = false;
    PlanLimits limits{};
};

inline Configuration everythingAtOnce() {
    return {.name = "all at once",
            .threads = 3,
            .simd = Simd::Scalar,
            .shuffleSeed = 99,
            .restoreEvery = 41,
            .dropOnceIn = 5,
            .limits = {.batchSize = 50, .sharedFrom = 40, .parallelFrom = 0}};
}

inline std::vector<Configuration> allConfigurations() {
    std::vector<Configuration> all{{.name = "no executor", .withoutExecutor = true}};
    for (const int threads : {1, 2, 3, 8}) {
        all.push_back({.name = std::to_string(threads) + " threads",
                       .threads = threads,
                       .limits = {.sharedFrom = threads > 3 ? 192u : 1u, .parallelFrom = 0}});
    }
    for (const Simd simd : availableSimd()) {
        all.push_back({.name = std::string(nameOf(simd)), .simd = simd});
    }
    all.push_back({.name = "restored every 37 ticks", .restoreEvery = 37});
    all.push_back({.name = "copied every 11 ticks",
                   .threads = 2,
                   .copyEvery = 11,
                   .limits = {.parallelFrom = 0}});
    all.push_back({.name = "accelerators dropped", .dropOnceIn = 7});
    all.push_back({.name = "blocks shuffled",
                   .threads = 3,
                   .shuffleSeed = 12345,
                   .limits = {.sharedFrom = 1, .parallelFrom = 0}});
    all.push_back({.name = "a batch an island, all shared",
                   .threads = 2,
                   .limits = {.batchSize = 0, .sharedFrom = 1, .parallelFrom = 0}});
    all.push_back({.name = "one batch for all",
                   .threads = 2,
                   .limits = {.batchSize = 1'000'000, .parallelFrom = 0}});
    all.push_back(everythingAtOnce());
    return all;
}

/// The fewest that tell widths, threads and restored copies apart: where a run is slow.
inline std::vector<Configuration> fewConfigurations() {
    std::vector<Configuration> few;
    for (const Simd simd : availableSimd()) {
        few.push_back({.name = std::string(nameOf(simd)), .simd = simd});
    }
    few.push_back(everythingAtOnce());
    return few;
}

/// A world and the way it is stepped.
class ConfiguredRun {
 public:
    ConfiguredRun(Configuration configuration, World world, std::uint64_t seed)
        : m_configuration(std::move(configuration)), m_world(std::move(world)), m_random(seed) {
        pack();
        if (m_configuration.withoutExecutor) return;
        m_executor =
            std::make_unique<Executor>(m_configuration.threads, m_configuration.shuffleSeed);
    }

    void step(std::span<const Command> commands) {
        const auto due = [this](std::uint32_t every) {
            return every != 0 && m_world.tick() % every == every - 1;
        };
        if (due(m_configuration.restoreEvery)) m_world = restored(m_world);
        if (due(m_configuration.copyEvery)) m_world = World(m_world);
        if (due(m_configuration.restoreEvery) || due(m_configuration.copyEvery)) pack();
        if (m_configuration.dropOnceIn != 0 && m_random.once(m_configuration.dropOnceIn)) {
            m_world.dropAccelerators();
        }
        m_world.step(commands, {m_executor.get(), m_configuration.simd, nullptr});
    }

    [[nodiscard]] const std::string& name() const { return m_configuration.name; }
    [[nodiscard]] const World& world() const { return m_world; }

 private:
    void pack() { WorldSpoiler::limitPlans(m_world, m_configuration.limits); }

    Configuration m_configuration;
    World m_world;
    Random m_random;
    std::unique_ptr<Executor> m_executor;
};

}  // namespace huestep::test
