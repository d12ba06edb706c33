/// The soft step with Jacobi sweeps: every constraint is solved against the velocities that its
/// bodies had when the sweep began, and what all of them do is summed at the end of it.
///
/// Parallel without colours, locks or order, and slow to converge: a constraint does not know what
/// the others at its bodies have just done. Where a body has several, each acts as if it were
/// alone, so together they do too much; with mass splitting each gets its share of the body.
#pragma once

#include "core/solver/method.h"

namespace huestep {

/// A `BatchSolver`: every row with the whole mass of its bodies.
void solveJacobi(const BatchTask& task, const Team& team);

/// A `BatchSolver`: a body of mass m with k constraints that act is k bodies of mass m/k, one for
/// each, and their mean is what becomes of it (Tonge, Benevolenski, Voroshilov, "Mass Splitting for
/// Jitter-Free Parallel Rigid Body Simulation", 2012). Momentum is kept as without.
void solveJacobiSplit(const BatchTask& task, const Team& team);

/// `MethodTraits::fit` of both.
void fitJacobi(MethodMemory& memory, const Plan& plan);

}  // namespace huestep
