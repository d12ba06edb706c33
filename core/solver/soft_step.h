/// The soft step: substeps of warm start, biased solve, motion and relaxation over the plan.
///
/// Source: the physics page, "Starting point"; the scheme is the one known as Soft Step (Catto,
/// "Solver2D", 2024): h = Δt/n; a substep integrates velocities, applies the last impulses, solves
/// normals and joints with a soft bias, moves, and solves again without bias ("relax"), where
/// friction and rolling resistance are solved too. Restitution comes once, at the end.
#pragma once

#include "core/solver/sweep.h"

namespace huestep {

/// All substeps of a batch, its constraints taken as `sweeper` does. With several workers every
/// stage is shared out and ends in a barrier; with one the same stages run through without.
void softStep(const BatchTask& task, const Team& team, Sweeper& sweeper);

/// A `BatchSolver`: the soft step colour by colour.
void solveSoftStep(const BatchTask& task, const Team& team);

}  // namespace huestep
