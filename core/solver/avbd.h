/// Augmented vertex block descent: positions, body by body, of backward Euler over one step.
///
/// Source: Giles, Diaz, Yuksel, "Augmented Vertex Block Descent", ACM TOG 44(4), 2025. A step seeks
/// the poses x that minimise  ½ (x − y)ᵀ M/Δt² (x − y) + Σ augmented Lagrangian of the rows,  with
/// y where forces and velocities alone lead. An iteration goes over the bodies: each takes the
/// Newton step of its own three coordinates, H = M/Δt² + Σ k J Jᵀ + lumped geometric stiffness,
/// with the others held; then every row updates its multiplier, λ ← clamp(λ + k C). A scene's
/// substeps are the iterations.
///
/// The paper's penalties k grow from step to step, which would be history beside the state. Here k
/// follows from the masses and the multiplier alone, k = max(m/Δt², |λ|/5 mm), and multipliers
/// start from the impulses that the state holds; so does the first guess of the poses. Errors that
/// were there when the step began are no business of the iterations: one more over the bodies,
/// after velocities are known, takes them out (post-stabilisation). Restitution is that of all
/// methods.
#pragma once

#include "core/solver/method.h"

namespace huestep {

/// A `BatchSolver`. All kinds of joints, springs by the stiffness and damping of their row at the
/// start of the step; the force of a mouse joint is bounded along each axis.
void solveAvbd(const BatchTask& task, const Team& team);

}  // namespace huestep
