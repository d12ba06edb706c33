/// Pins as the solver streams them: structure of arrays in blocks of 16 lanes.
///
/// A pin is a revolute joint whose spring, motor and limit are off: one constraint part
/// (`PointPart`), and scenes have thousands of them. In lanes a pass over one costs a fraction of
/// what `solveJoint` takes; both give the same bits.
#pragma once

#include "core/joint/joint_row.h"
#include "core/solver/contact_block.h"
#include "core/solver/simd.h"

namespace huestep {

/// Fields as in `JointRow`; padding lanes have no mass and read the fixed world.
struct alignas(64) PinBlock {
    using Row = float[blockLanes];
    BodyPlace bodyA[blockLanes];
    BodyPlace bodyB[blockLanes];
    Row inverseMassA, inverseInertiaA;  ///< 1/kg, 1/(kg·m²)
    Row inverseMassB, inverseInertiaB;
    Row anchorAx, anchorAy;  ///< m, from A's centre, world axes, at the start of the step
    Row anchorBx, anchorBy;
    Row centersX, centersY;  ///< m, cB − cA at the start
    Row impulseX, impulseY;  ///< N·s, accumulated
};

/// Whether a joint is a pin, now: its other parts neither act nor hold an impulse.
bool isPin(const JointInfo& info, const JointImpulses& impulses);

/// Writes one lane. `row`: as `prepareJoint` made it, with bodies and masses set.
void setPinLane(PinBlock& block, std::uint32_t lane, const JointRow& row);
void clearPinLane(PinBlock& block, std::uint32_t lane);

/// A pass over `count` joints from the start of `blocks`. Joints of one call share no body that is
/// written. Thread rule: calls on disjoint blocks of one colour may run side by side.
using PinKernel = void (*)(SolverBody* bodies, PinBlock* blocks, std::uint32_t count,
                           const JointPass& pass);

struct PinKernels {
    PinKernel warmStart = nullptr;
    PinKernel solve = nullptr;  ///< with the pass's softness, or neutral in relax
};

/// Kernels of a width that is available; `Auto` gives the widest. All give the same bits.
const PinKernels& pinKernels(Simd simd);

}  // namespace huestep
