/// Projected Gauss-Seidel over one step: what most engines did before substeps.
///
/// Velocities after the step's forces, the last impulses, then sweeps of joints, normals and
/// friction with clamped sums, then one move; a scene's substeps are the iterations. Colours and
/// lanes are those of the soft step, so that times compare methods alone. How positions are kept
/// is what the two differ in (reference: Catto, "Iterative Dynamics with Temporal Coherence", 2005,
/// and "Solver2D", 2024).
#pragma once

#include "core/solver/method.h"

namespace huestep {

/// A `BatchSolver`: errors go into the velocity rows, 0.2/Δt of them (Baumgarte 1972): overlap
/// beyond 5 mm is pushed out at most at 4 m/s.
void solvePgs(const BatchTask& task, const Team& team);

/// A `BatchSolver`: velocity rows know no errors; half as many sweeps over positions follow the
/// move: joints whole, 0.2 of the overlap beyond 5 mm, at most 0.2 m (nonlinear Gauss-Seidel, as in
/// Box2D 2.4). They change no velocity. Other than there, gaps are rows too: what would overlap at
/// the end of the step meets.
void solvePgsNgs(const BatchTask& task, const Team& team);

}  // namespace huestep
