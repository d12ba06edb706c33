/// What happened in a step, as values, ordered by key.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"
#include "core/world/command.h"

namespace huestep {

/// Two shapes began or ceased to have contact points. Ordered by (shapeA, shapeB), shapeA < shapeB.
struct ContactChange {
    ShapeId shapeA = 0;
    ShapeId shapeB = 0;
    friend bool operator==(const ContactChange&, const ContactChange&) = default;
};

/// Two shapes met with more than `hitSpeed` of approach. Ordered by key.
struct ContactHit {
    ShapeId shapeA = 0;
    ShapeId shapeB = 0;
    Vec2 point;             ///< m, in the world
    Vec2 normal;            ///< from A to B
    float approach = 0.0f;  ///< m/s, > 0
    friend bool operator==(const ContactHit&, const ContactHit&) = default;
};

/// The key order of contact events.
template <class Event>
constexpr bool keyBefore(const Event& a, const Event& b) {
    return a.shapeA != b.shapeA ? a.shapeA < b.shapeA : a.shapeB < b.shapeB;
}

inline constexpr float hitSpeed = 1.0f;  ///< m/s

/// What became of one command, in the order applied.
struct CommandOutcome {
    PlayerId author = 0;
    std::uint64_t sequence = 0;
    Rejection reason = Rejection::None;
    BodyId firstBody = 0;  ///< of a spawn or a new player: its first new body, else 0
    friend bool operator==(const CommandOutcome&, const CommandOutcome&) = default;
};

/// Everything a step has to say. Owned by the world and valid until its next step.
struct Events {
    std::vector<CommandOutcome> commands;
    std::vector<ContactChange> begins;
    std::vector<ContactChange> ends;
    std::vector<ContactHit> hits;
    std::vector<BodyId> quarantined;  ///< bodies that turned non-finite and were stopped; by id
    friend bool operator==(const Events&, const Events&) = default;
};

}  // namespace huestep
