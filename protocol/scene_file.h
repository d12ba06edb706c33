/// Scene files: JSON text of the scene schema, or its binary form. Both carry a version.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/scene/scene.h"

namespace huestep::protocol {

inline constexpr std::uint32_t sceneVersion = 1;
inline constexpr std::size_t maxSceneFileBytes = 64u << 20;

/// Reads either form, told apart by the first byte. A validating walk of the JSON document comes
/// first: an unknown field, a non-finite number, a concave polygon, a joint to a missing body or a
/// value out of range is refused with its path (`bodies[3].shapes[0].vertices[2].x`).
Result<Scene> readScene(std::span<const std::byte> bytes);

std::string writeSceneJson(const Scene& scene);  ///< stable order, reads back equal
std::vector<std::byte> writeSceneBinary(const Scene& scene);

}  // namespace huestep::protocol
