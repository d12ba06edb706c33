/// Revolute joints as the solver streams them: structure of arrays in blocks of 16 lanes.
///
/// Scenes have thousands of them: grids and chains of plain pins, ragdolls with limits, springs and
/// motors. In lanes a pass over one costs a fraction of what `solveJoint` takes; both give the same
/// bits.
#pragma once

#include "core/joint/joint_row.h"
#include "core/solver/contact_block.h"
#include "core/solver/simd.h"

namespace huestep {

/// Fields as in `JointRow`; padding lanes have no mass and read the fixed world.
struct alignas(64) RevoluteBlock {
    using Row = float[blockLanes];
    BodyPlace bodyA[blockLanes];
    BodyPlace bodyB[blockLanes];
    Row inverseInertiaA, inverseInertiaB;  ///< 1/(kg·m²)
    Row anchorAx, anchorAy;  ///< m, from A's centre, world axes, at the start of the step
    Row anchorBx, anchorBy;
    Row centersX, centersY;  ///< m, cB − cA at the start
    Row impulseX, impulseY;  ///< N·s, accumulated
    // The parts about the axis; a block none of whose joints has any is a block of pins.
    Row springImpulse, motorImpulse, lowerImpulse, upperImpulse;  ///< N·m·s
    Row angleC, angleS;  ///< the joint's angle at the start of the step, as a rotation
    Row springBiasRate, springMassScale, springImpulseScale;
    Row motorSpeed, motorMaxEffort;
    Row lower, upper;
    std::int32_t hasSpring[blockLanes];  ///< −1: the joint has the part; 0: it has not
    std::int32_t hasMotor[blockLanes];
    std::int32_t hasLimit[blockLanes];
    std::int32_t anyPart;  ///< whether any lane has one of the three
    Row allowance;         ///< 1/m
    Row strain;            ///< squared: `strainOf` of each lane, times itself
};

/// Writes one lane. `row`: as `prepareJoint` made it, with bodies and masses set.
void setRevoluteLane(RevoluteBlock& block, std::uint32_t lane, const JointRow& row);
void clearRevoluteLane(RevoluteBlock& block, std::uint32_t lane);
/// To be called once all lanes are written.
void findParts(RevoluteBlock& block);

/// A lane's impulses in the form that the state keeps.
JointImpulses storedImpulses(const RevoluteBlock& block, std::uint32_t lane);

/// A pass over `count` joints from the start of `blocks`. Joints of one call share no body that is
/// written. Thread rule: calls on disjoint blocks of one colour may run side by side.
using RevoluteKernel = void (*)(SolverBody* bodies, RevoluteBlock* blocks, std::uint32_t count,
                                const JointPass& pass);

/// Writes how much the joints of `count` whole blocks are strained.
using RevoluteStrain = void (*)(const SolverBody* bodies, RevoluteBlock* blocks,
                                std::uint32_t count);

struct RevoluteKernels {
    RevoluteKernel warmStart = nullptr;
    RevoluteKernel solve = nullptr;    ///< with the pass's softness, or neutral in relax
    RevoluteKernel correct = nullptr;  ///< moves bodies, see `correctJoint`
    RevoluteStrain strain = nullptr;
};

/// Kernels of a width that is available; `Auto` gives the widest. All give the same bits.
const RevoluteKernels& revoluteKernels(Simd simd);

}  // namespace huestep
