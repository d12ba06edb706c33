/// What the solver reads and writes of the world, and what it says of a step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/contact.h"
#include "core/state/records.h"

namespace huestep {

/// An external force of one tick.
struct BodyForce {
    Vec2 force;           ///< N
    float torque = 0.0f;  ///< N·m
};

/// Places of a joint's bodies in the world's arrays. A mouse joint has body B in both.
struct ConstraintPlaces {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
};

/// How far a body may go in a step before it could pass something unseen.
struct Stride {
    float most = 0;   ///< m, that no point of it may move by; half of its thickness
    float reach = 0;  ///< m, farthest vertex of its shapes from its centre
};

/// A body that went somewhere, and where it was before. Places of the world.
struct Leap {
    std::uint32_t body = 0;
    Pose from;
};

/// What became of the bodies of a step.
struct Moved {
    std::vector<std::uint32_t> broken;  ///< turned non-finite or left the world; sorted
    std::vector<Leap> leaps;            ///< went beyond their stride; in no order that matters
    std::vector<Leap> driven;           ///< kinematic bodies that moved; sorted
};

/// What the solver reads and writes of the world.
struct SolverWorld {
    std::span<const BodyInfo> bodies;
    std::span<BodyMotion> motions;
    std::span<const BodyForce> forces;         ///< by body; empty: none
    std::span<const std::uint32_t> kinematic;  ///< places of kinematic bodies
    std::span<const Stride> strides;           ///< by body
    std::span<const JointInfo> joints;
    std::span<const ConstraintPlaces> jointBodies;  ///< places of each joint's two bodies
    std::span<JointImpulses> jointImpulses;
    std::span<const ShapeInfo> shapes;
    std::span<const Contact> contacts;
    bool rowsHold = false;  ///< contact rows are those of the last solve, which had this very plan
    Vec2 gravity;
    float stepSeconds = 0;
    /// Whether substeps follow need: rows then say how much they are strained.
    bool planned = false;
    Need need;
    std::span<const float> reach;  ///< by body, m: farthest point of a shape from the centre
};

}  // namespace huestep
