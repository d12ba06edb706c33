/// What the rules of a game see of the world, and what they may do to it.
///
/// Both are valid within the call that hands them over. Everything stands in the order of ids or
/// keys, so whoever goes over it in order does the same on every replica. Thread rule: the step's
/// own thread alone.
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/world/world.h"

namespace huestep {

class Applier;

/// The world as it is now, to look at.
class Seen {
 public:
    explicit Seen(const World::Data& world) : m_world(world) {}

    [[nodiscard]] std::uint64_t tick() const;  ///< steps taken; after a step with that step
    [[nodiscard]] float stepSeconds() const;   ///< s
    [[nodiscard]] std::uint32_t ticksOf(float seconds) const;  ///< the nearest, at least 1

    /// The host first, who is no player; then the players by id.
    [[nodiscard]] std::span<const PlayerRecord> players() const;
    [[nodiscard]] const PlayerRecord* player(PlayerId id) const;  ///< null: there is none
    /// Those removed in this tick are still there; `find` and `motionOf` know them no more.
    [[nodiscard]] std::span<const BodyInfo> bodies() const;
    [[nodiscard]] std::span<const BodyMotion> motions() const;  ///< place i: body i
    [[nodiscard]] std::optional<std::uint32_t> find(BodyId id) const;
    [[nodiscard]] const BodyMotion* motionOf(BodyId id) const;  ///< null: there is none
    [[nodiscard]] float massOf(BodyId id) const;  ///< kg; 0: there is none, or it is not dynamic
    [[nodiscard]] std::span<const ShapeInfo> shapesOf(BodyId id) const;
    [[nodiscard]] BodyId bodyOf(ShapeId id) const;  ///< 0: there is none

    /// What this step has brought so far: after it, everything; before it, its commands' outcomes.
    [[nodiscard]] const Events& events() const;

    /// As the world's own queries.
    [[nodiscard]] std::vector<RayHit> castRay(Vec2 from, Vec2 to) const;
    [[nodiscard]] std::vector<ShapeId> overlap(const ShapeDef& shape, const Pose& pose) const;

 private:
    const World::Data& m_world;
};

/// What rules do to a world is what commands do. Players come and go at the host's word alone.
using RulesAction = std::variant<ApplyImpulse, ApplyForce, Spawn, RemoveBody, RemoveJoint, SetMotor,
                                 SetVelocity, SetTarget>;

/// What became of it.
struct RulesOutcome {
    Rejection reason = Rejection::None;
    BodyId firstBody = 0;  ///< of a spawn: its first new body
    [[nodiscard]] bool done() const { return reason == Rejection::None; }
};

/// The world before a step, to look at and to change, and the game's dice.
class Game : public Seen {
 public:
    Game(World::Data& world, Applier& applier);

    /// Does the action, or says why not, as of a command: with the rights of the host, or with
    /// those of a player, to whom then belongs what it spawns.
    RulesOutcome act(const RulesAction& action, PlayerId as = 0);

    /// Takes a player's body away and gives it a new one, as it got when it joined, with its origin
    /// at `position` (m). Fails where the scene gives players none, or the world has no room.
    RulesOutcome respawn(PlayerId player, Vec2 position);

    /// The next number of the dice: SplitMix64 (Steele, Lea and Flood 2014), whose state is the
    /// world's.
    std::uint64_t roll();
    /// In [0, count); 0 for a count of 0. Uneven by less than one in 2³².
    std::uint32_t below(std::uint32_t count);
    /// In [low, high), in steps of 2⁻²⁴ of the way.
    float between(float low, float high);

 private:
    World::Data& m_data;
    Applier& m_applier;
};

}  // namespace huestep
