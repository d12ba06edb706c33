/// Joints of a point alone as the solver streams them: structure of arrays in blocks of 16 lanes.
///
/// A plain revolute joint, without spring, motor or limit, is one constraint part (`PointPart`),
/// and scenes have thousands of them. In lanes a pass over one costs a fifth of what `solveJoint`
/// takes; both give the same bits.
#pragma once

#include "core/joint/joint_row.h"
#include "core/solver/contact_block.h"
#include "core/world/world.h"

namespace huestep {

/// Fields as in `JointRow`; padding lanes have no mass and read the fixed world.
struct alignas(64) PointBlock {
    using Row = float[blockLanes];
    BodyPlace bodyA[blockLanes];
    BodyPlace bodyB[blockLanes];
    Row mA, iA, mB, iB;      ///< inverse masses, 1/kg, and inertias, 1/(kg·m²)
    Row anchorAx, anchorAy;  ///< m, from A's centre, world axes, at the start of the step
    Row anchorBx, anchorBy;
    Row centersX, centersY;  ///< m, cB − cA at the start
    Row impulseX, impulseY;  ///< N·s, accumulated
};

/// Whether a joint is a point alone, now: its other parts neither act nor hold an impulse.
bool isPointAlone(const JointInfo& info, const JointImpulses& impulses);

/// Writes one lane. `row`: as `prepareJoint` made it, with bodies and masses set.
void setPointLane(PointBlock& block, std::uint32_t lane, const JointRow& row);
void clearPointLane(PointBlock& block, std::uint32_t lane);

/// A pass over `count` joints from the start of `blocks`. Joints of one call share no body that is
/// written. Thread rule: calls on disjoint blocks of one colour may run side by side.
using PointKernel = void (*)(SolverBody* bodies, PointBlock* blocks, std::uint32_t count,
                             const JointPass& pass);

struct PointKernels {
    PointKernel warmStart = nullptr;
    PointKernel solve = nullptr;  ///< with the pass's softness, or neutral in relax
};

/// Kernels of a width that is available; `Auto` gives the widest. All give the same bits.
const PointKernels& pointKernels(Simd simd);

}  // namespace huestep
