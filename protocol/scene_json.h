/// The JSON form of a scene file, without the check of the scene as a whole.
///
/// Cap'n Proto has a JSON codec that would need no such code, and it is refused: it turns 1e999
/// into infinity, takes "NaN" for a number, skips fields it does not know, and its sentences name
/// no path. A person who writes scenes by hand needs the opposite of each.
#pragma once

#include <span>
#include <string>

#include "core/result.h"
#include "core/scene/scene.h"

namespace huestep::protocol {

Result<Scene> readSceneJson(std::span<const std::byte> text);

}  // namespace huestep::protocol
