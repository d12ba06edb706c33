/// The solver's part of a step: rows, a method over every batch, and where bodies went.
#pragma once

#include <vector>

#include "core/solver/method.h"
#include "core/world/stage_timer.h"

namespace huestep {

/// Rows from contacts, joints and motions; the method; joints' impulses back into joints; contacts'
/// stay in their rows. A giant batch goes through each stage on all threads; any other goes through
/// all of them on one thread, while its rows are in that core's cache. `hits` gets contacts that
/// met hard, by key.
void solve(Rows& rows, const Plan& plan, const SolverWorld& world, const MethodTraits& method,
           Simd simd, Executor* executor, std::vector<ContactHit>& hits, StageTimer& timer);

/// Poses and velocities back into motions, free flight included. Bodies that turned non-finite
/// or left the world stay where they were, at rest.
Moved finish(const Rows& rows, const Plan& plan, const SolverWorld& world, Executor* executor);

}  // namespace huestep
