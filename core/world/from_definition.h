/// From definitions, as scenes and commands give them, to the records of the state.
#pragma once

#include <vector>

#include "core/collision/mass.h"
#include "core/result.h"
#include "core/scene/scene.h"
#include "core/state/records.h"

namespace huestep {

/// Mass, centre and inertia of a body's shapes about its origin's frame; nothing is rounded.
MassProperties massOf(const BodyDef& def);

/// The records of one body, its ids still 0. Mass is summed in double and rounded once.
struct BodyRecords {
    BodyInfo info{};
    BodyMotion motion{};
    std::vector<ShapeInfo> shapes;
};

/// Requires a definition that `check` lets pass.
BodyRecords recordsOf(const BodyDef& def);

/// Whether the records may be in a state. `check` judges a definition as it was given; turned into
/// floats about its centre of mass it may still be too far out or too flat.
Status validate(const BodyRecords& records);

/// A shape about `localCenter`, its ids still 0.
ShapeInfo shapeInfo(const ShapeDef& def, Vec2 localCenter);

/// A joint between two bodies of the state, `a` null for a mouse joint; its ids still 0.
JointInfo jointInfo(const JointDef& def, const BodyInfo* a, const BodyInfo& b);

}  // namespace huestep
