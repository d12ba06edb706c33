/// Commands: the only way to change a world (law 1, "one door").
///
/// The journal, the wire frame, the replay file, a test and a bug report hold the same commands.
/// A command is checked against the state and its author's rights, then applied or rejected; both
/// are functions of (state, commands) alone, so every replica says the same.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "core/scene/scene.h"

namespace huestep {

/// A player enters: gets a record and, where the scene gives players a body, a body. Host only.
struct AddPlayer {
    PlayerId player = 0;
    friend bool operator==(const AddPlayer&, const AddPlayer&) = default;
};

/// A player leaves: its grab is released, its bodies are removed. Host only.
struct RemovePlayer {
    PlayerId player = 0;
    friend bool operator==(const RemovePlayer&, const RemovePlayer&) = default;
};

/// An impulse at a point of the world; a player's must be within 1 m of the body's reach. Wakes it.
struct ApplyImpulse {
    BodyId body = 0;
    Vec2 impulse;  ///< N·s
    Vec2 point;    ///< m, in the world
    friend bool operator==(const ApplyImpulse&, const ApplyImpulse&) = default;
};

/// A force at a point of the world, for this tick; as with an impulse. Wakes the body.
struct ApplyForce {
    BodyId body = 0;
    Vec2 force;  ///< N
    Vec2 point;  ///< m, in the world
    friend bool operator==(const ApplyForce&, const ApplyForce&) = default;
};

/// Takes hold of a body at a point and draws that point to `target`. One grab a player: a second
/// `Grab` of the same body moves the target, of another body lets the first go.
struct Grab {
    BodyId body = 0;
    Vec2 point;   ///< m, in the world, where the body is taken
    Vec2 target;  ///< m, in the world
    friend bool operator==(const Grab&, const Grab&) = default;
};

/// Moves the target of the author's grab.
struct MoveGrab {
    Vec2 target;  ///< m, in the world
    friend bool operator==(const MoveGrab&, const MoveGrab&) = default;
};

/// Lets go of what the author grabbed.
struct Release {
    friend bool operator==(const Release&, const Release&) = default;
};

/// Adds bodies and joints between them; they get the next ids in order. A player's bodies count
/// against its budget and belong to it. Players spawn at most 8 dynamic bodies a command, of at
/// most 8 shapes and 10 m of reach, overlapping the bounds of at most 64 shapes, and no joint.
struct Spawn {
    std::vector<BodyDef> bodies;
    std::vector<JointDef> joints;
    friend bool operator==(const Spawn&, const Spawn&) = default;
};

/// Removes a body with its shapes, contacts and joints. A player removes only what it spawned.
struct RemoveBody {
    BodyId body = 0;
    friend bool operator==(const RemoveBody&, const RemoveBody&) = default;
};

struct RemoveJoint {  ///< Host only.
    JointId joint = 0;
    friend bool operator==(const RemoveJoint&, const RemoveJoint&) = default;
};

/// Sets the speed of a motor that the scene enabled, and whether it runs.
struct SetMotor {
    JointId joint = 0;
    bool enabled = true;
    float speed = 0.0f;  ///< rad/s or m/s
    friend bool operator==(const SetMotor&, const SetMotor&) = default;
};

/// Sets the velocity of a kinematic body. Host only.
struct SetVelocity {
    BodyId body = 0;
    Vec2 velocity;                 ///< m/s
    float angularVelocity = 0.0f;  ///< rad/s
    friend bool operator==(const SetVelocity&, const SetVelocity&) = default;
};

/// Gives a kinematic body the velocity that brings it to a pose in this tick, by the shorter way
/// round; half a turn goes counter-clockwise. It keeps that velocity until told otherwise: to stop
/// there it needs a `SetVelocity`, or the same target again, in the next tick. Host only.
struct SetTarget {
    BodyId body = 0;
    Vec2 position;      ///< m, of the body's origin, in the world
    Rotation rotation;  ///< (cos θ, sin θ), as in `BodyDef`
    friend bool operator==(const SetTarget&, const SetTarget&) = default;
};

/// An action of the game itself: what it means, the world's rules say (core/rules/rules.h). Without
/// rules it is rejected.
struct Custom {
    std::uint32_t kind = 0;   ///< which of the rules' actions
    std::uint32_t id = 0;     ///< of a body, a player or what else the rules count
    std::int32_t number = 0;  ///< how many, which
    Vec2 vector;              ///< a place, a direction, a strength
    friend bool operator==(const Custom&, const Custom&) = default;
};

using Action =
    std::variant<AddPlayer, RemovePlayer, ApplyImpulse, ApplyForce, Grab, MoveGrab, Release, Spawn,
                 RemoveBody, RemoveJoint, SetMotor, SetVelocity, SetTarget, Custom>;

/// One action of one author. `sequence` counts the author's commands from 1; a world remembers
/// the last one applied or rejected per author as state and rejects what is not above it, so a
/// command counts once however often it is sent.
struct Command {
    PlayerId author = 0;
    std::uint64_t sequence = 0;
    Action action;
    friend bool operator==(const Command&, const Command&) = default;
};

/// Why a command was rejected. The numbers are part of the protocol: grow only at the end.
enum class Rejection : std::uint16_t {
    None = 0,
    UnknownAuthor,  ///< the author is no player of this world
    NotAllowed,     ///< only the host, or only the owner, may do this
    OldSequence,    ///< at or below the author's last sequence
    UnknownBody,
    UnknownJoint,
    WrongBodyType,  ///< such as an impulse on a static body
    NotFinite,      ///< a number is not finite or out of range
    TooStrong,      ///< an impulse or force above the scene's cap
    BadDefinition,  ///< a spawned body or joint that `check` refuses
    OverBudget,     ///< the author's spawn budget is used up
    OverLimit,      ///< a cap of the world is reached
    NothingGrabbed,
    NoMotor,  ///< the joint has no motor that the scene enabled
    PlayerExists,
    TooFar,         ///< a point not on or near the body, or a target beyond a tick at the top speed
    TooCrowded,     ///< a spawned shape would overlap too many others
    UnknownAction,  ///< the world's rules know no such action, or it has no rules
    AgainstRules,   ///< the rules do not allow it, or not now
};

/// The reason in words, for a person.
std::string_view describe(Rejection reason);

/// Orders commands by (author, sequence), the key order in which a step applies them. Of two with
/// the same key the first in the list counts and the second is rejected as old.
void sortByKey(std::vector<Command>& commands);

}  // namespace huestep
