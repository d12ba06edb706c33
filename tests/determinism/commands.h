/// Who says what in a run: commands as a function of the world.
#pragma once

#include <cassert>
#include <functional>
#include <string>
#include <vector>

#include "core/scene/catalog.h"
#include "core/world/world.h"

namespace huestep::test {

using CommandsOf = std::function<std::vector<Command>(const World&)>;

/// The commands of nobody.
inline std::vector<Command> silence(const World&) {
    return {};
}

/// What the host of a scene of the catalogue does.
inline CommandsOf hostOf(const std::string& catalogText) {
    const Result<Script> script = scriptFromCatalog(catalogText);
    assert(script.ok());
    return [script = *script](const World& world) { return script.commands(world.tick()); };
}

}  // namespace huestep::test
