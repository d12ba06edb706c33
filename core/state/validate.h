/// Whether a world could be in a state: what a snapshot from outside must satisfy to be stepped.
#pragma once

#include <string>

#include "core/result.h"
#include "core/state/state.h"

namespace huestep {

/// Ids rise and are below their counters, references hold, numbers are finite and in the ranges of
/// the scene's definitions, shapes are convex. The sentence names record and field.
Status validate(const WorldState& state);

/// What is wrong with one record by itself, field first; empty: nothing.
std::string faultOf(const BodyMotion& motion);
std::string faultOf(const BodyInfo& body);
std::string faultOf(const ShapeInfo& shape);
std::string faultOf(const JointInfo& joint);

}  // namespace huestep
