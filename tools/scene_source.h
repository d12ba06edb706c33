/// A scene as the command line names it: built in, or a file.
#pragma once

#include <cstdint>
#include <string>

#include "core/result.h"
#include "core/scene/scene.h"
#include "core/scene/script.h"

namespace huestep::tools {

struct NamedScene {
    std::string name;         ///< as given
    Scene scene;              ///< checked
    std::uint32_t ticks = 0;  ///< how long it is run unless said
    Script script;            ///< what its host does; a file's host does nothing
};

/// From `name`, `name:parameter=value,…` or the path of a scene file.
Result<NamedScene> loadScene(const std::string& text);

}  // namespace huestep::tools
