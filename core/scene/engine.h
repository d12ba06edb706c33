/// One face for Huestep and its peers, so that `run`, `verify` and `bench` treat them alike.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "core/state/records.h"

namespace huestep {

/// A scene that steps. Thread rule: one caller.
class Engine {
 public:
    virtual ~Engine() = default;
    virtual void step() = 0;
    /// Place i: body i of the scene by ascending id. Positions are of centres of mass.
    [[nodiscard]] virtual std::vector<BodyMotion> motions() const = 0;
    /// A hash of all motions: two runs are equal if it is. Peers: XXH3 over their `motions()`.
    [[nodiscard]] virtual std::uint64_t hash() const = 0;
    [[nodiscard]] virtual std::uint32_t contactCount() const = 0;
    [[nodiscard]] virtual std::string_view name() const = 0;
};

/// In which order, and with what noise, a peer's world is built from a scene.
struct BuildOrder {
    std::uint64_t shuffleSeed = 0;  ///< 0: the scene's own order
    bool noise = false;             ///< create and destroy other bodies first
};

}  // namespace huestep
