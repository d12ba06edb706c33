/// The soft step with constraints handed to all threads as they come: what colours spare us.
///
/// Constraints are taken in key order, each worker a share of them, and two of them may have the
/// same body at the same time. Either each holds a lock on its bodies, or bodies get what it does
/// by atomic additions. On one worker both are sequential Gauss-Seidel; on more, who comes first
/// decides the bits, so neither is deterministic. Kept to show what they cost and how far runs come
/// apart.
#pragma once

#include "core/solver/method.h"

namespace huestep {

/// A `BatchSolver`: a spin lock a body, taken in the order of places.
void solveWithLocks(const BatchTask& task, const Team& team);

/// A `BatchSolver`: a constraint reads its bodies' velocities, without waiting, and adds what it
/// does to them, a compare-exchange a float. What others did in between is not lost, but was not
/// seen: Jacobi where they meet.
void solveWithAtomics(const BatchTask& task, const Team& team);

/// `MethodTraits::fit` of locks.
void fitLocks(MethodMemory& memory, const Plan& plan);

}  // namespace huestep
