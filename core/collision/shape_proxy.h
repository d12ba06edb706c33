/// What the broad phase knows of a shape before any geometry.
#pragma once

#include <cstdint>
#include <span>

#include "core/scene/scene.h"

namespace huestep {

/// What decides, before any geometry, whether two shapes may form a pair.
struct ShapeProxy {
    std::uint32_t body = 0;  ///< place of the body
    Filter filter;
    bool dynamic = false;
    bool jointed = false;  ///< the body has a joint that forbids contact with its other body
    bool alone = false;    ///< no other shape may pair with it: it stays out of the broad phase
    std::uint8_t kind = unknownKind;  ///< equal filter, `dynamic` and `jointed`: equal kind

    static constexpr std::uint8_t unknownKind = 64;
};

/// Numbers the kinds of shapes, below `unknownKind`, and marks the shapes that filters and types
/// keep from every other shape. Where there are very many kinds all stay unknown and nobody alone.
void sortIntoKinds(std::span<ShapeProxy> proxies);

}  // namespace huestep
