/// Joints as the solver works on them: prepared once a step, passed over every substep.
#pragma once

#include <cstdint>

#include "core/solver/contact_block.h"
#include "core/state/records.h"

namespace huestep {

/// A joint with everything a pass needs beside the two bodies.
struct JointRow {
    JointKind kind = JointKind::Revolute;
    std::uint32_t flags = 0;  ///< of JointInfo
    std::uint32_t joint = 0;  ///< place in the world's joints
    bool direct = false;      ///< its rigid part is solved with its tree (solver/joint_trees.h)
    BodyPlace bodyA = fixedWorld;
    BodyPlace bodyB = fixedWorld;
    float mA = 0, iA = 0, mB = 0, iB = 0;
    Vec2 anchorA, anchorB;  ///< from the centres, world axes, at the start of the step
    Vec2 centers;           ///< cB − cA at the start; mouse: cB − target
    Rotation angle;         ///< B's less A's less the reference at the start, as a rotation
    Vec2 axis;              ///< prismatic: world axes, at the start
    float length = 0, lower = 0, upper = 0;
    float motorSpeed = 0, motorMaxEffort = 0, maxForce = 0;
    Softness spring;
    JointImpulses impulses;
    float allowance = 0;  ///< 1/m, of what its anchors may be off; 0: nobody asks
    float strain = 0;     ///< see `strainOf`
};

/// Constants of a pass over joints.
struct JointPass {
    float h = 0;
    float inverseH = 0;
    Softness soft;  ///< of rigid parts; as it begins, neutral: that is relax
};

/// `poseA`, `poseB`: at the start of the step; the fixed world's pose is the identity.
JointRow prepareJoint(const JointInfo& info, const JointImpulses& impulses, std::uint32_t place,
                      const Pose& poseA, const Pose& poseB, float h);

/// Whether the joint has a spring, a running motor or a limit.
bool hasParts(const JointRow& row);

void warmStartJoint(SolverBody* bodies, const JointRow& row);
void solveJoint(SolverBody* bodies, JointRow& row, const JointPass& pass);

/// The speed by which the joint's last impulse changes its point rows, times the allowance: s⁻¹.
/// What it means: core/solver/effort.h. Springs, motors and limits give way as they should.
float strainOf(const JointRow& row);

/// Impulses of substeps of another length.
void scale(JointImpulses& impulses, float by);

/// A pass over displacements instead of velocities: the whole error of rigid parts and violated
/// limits, over one unit of time.
inline constexpr JointPass correctionPass{1.0f, 1.0f, {1.0f, 1.0f, 0.0f}};

/// Moves the bodies, as far as their deltas have them by now, to where the joint's rigid parts and
/// limits hold: nonlinear Gauss-Seidel, P = −K⁻¹ C with the K of where they are. Velocities and
/// impulses stay; springs, motors and mouse joints have nothing to hold.
void correctJoint(SolverBody* bodies, const JointRow& row);

/// Turns impulses into canonical form for the state; a non-finite one becomes 0.
JointImpulses storedImpulses(const JointRow& row);

}  // namespace huestep
