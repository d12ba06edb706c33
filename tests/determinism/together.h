/// Steps one world in all configurations side by side and names the first field that differs.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tests/determinism/configurations.h"

namespace huestep::test {

/// Which lists of two steps' events differ; empty if none does.
inline std::string differentEvents(const Events& a, const Events& b) {
    std::string text;
    const auto compare = [&text](const char* name, const auto& one, const auto& other) {
        if (one == other) return;
        text += std::string(name) + " (" + std::to_string(one.size()) + " and " +
                std::to_string(other.size()) + ") ";
    };
    compare("commands", a.commands, b.commands);
    compare("begins", a.begins, b.begins);
    compare("ends", a.ends, b.ends);
    compare("hits", a.hits, b.hits);
    compare("quarantined", a.quarantined, b.quarantined);
    return text;
}

/// Steps until `ticks` or the first difference. `look` sees the reference before the first step and
/// after every step; it may be empty.
inline void runTogether(const World& start, std::uint64_t ticks, const CommandsOf& commandsOf,
                        std::uint64_t seed, const std::function<void(const World&)>& look = {},
                        const std::vector<Configuration>& configurations = allConfigurations()) {
    std::vector<ConfiguredRun> runs;
    for (const Configuration& configuration : configurations) {
        runs.emplace_back(configuration, start, seed);
    }
    const World& reference = runs.front().world();
    if (look) look(reference);
    while (reference.tick() < ticks) {
        const std::vector<Command> commands = commandsOf(reference);
        for (ConfiguredRun& each : runs) each.step(commands);
        for (const ConfiguredRun& each : runs) {
            ASSERT_EQ(differentEvents(reference.events(), each.world().events()), "")
                << "tick " << reference.tick() << ", " << each.name();
            if (each.world().fullRoot() == reference.fullRoot()) continue;
            FAIL() << "tick " << reference.tick() << ", " << each.name() << ": "
                   << differenceOf(reference, each.world());
        }
        if (look) look(reference);
    }
}

}  // namespace huestep::test
