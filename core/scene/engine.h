/// One face for Huestep and its peers, so that `run`, `verify` and `bench` treat them alike.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "core/scene/scene.h"
#include "core/state/records.h"
#include "core/world/command.h"

namespace huestep {

/// A scene that steps. Thread rule: one caller.
class Engine {
 public:
    virtual ~Engine() = default;
    /// One tick with the host's commands, in the order of their sequences. They name bodies and
    /// joints by the ids that these have in Huestep, spawned ones too. A peer does not judge: it
    /// takes commands that Huestep applies, ignores ids that it does not have, and leaves out what
    /// it cannot do (`notes`). Fails where it cannot have a spawned body; the engine is then spent.
    virtual Status step(std::span<const Command> commands) = 0;
    /// Place i: body i of those that are there, by ascending id. Positions are of centres of mass.
    [[nodiscard]] virtual std::vector<BodyMotion> motions() const = 0;
    /// A hash of all motions: two runs are equal if it is. Peers: XXH3 over their `motions()`.
    [[nodiscard]] virtual std::uint64_t hash() const = 0;
    [[nodiscard]] virtual std::uint32_t contactCount() const = 0;
    [[nodiscard]] virtual std::string_view name() const = 0;
    /// What became of commands otherwise than they say: left out, approximated, rejected; a
    /// sentence for each kind.
    [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }
};

/// In which order, and with what noise, a peer's world is built from a scene.
struct BuildOrder {
    std::uint64_t shuffleSeed = 0;  ///< 0: the scene's own order
    bool noise = false;             ///< create and destroy other bodies first
};

}  // namespace huestep
