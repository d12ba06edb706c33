/// The rigid part of a joint as rows that a tree of joints is solved by at once.
///
/// A row is a constraint C(x) = 0 of two bodies with Ċ = n·(vB − vA) + armB ωB − armA ωA: what
/// parts.h solves one joint at a time, spelled out.
///
///   revolute          pB − pA, two rows along the world's axes
///   weld              the same, and the angle of B against A unless a spring holds that
///   prismatic         pB across the axis of A, and the angle
///   distance          |pB − pA| − length, unless a spring or a range has its place
///
/// Springs, motors and limits have no rows here: they push with what they have, they do not hold.
#pragma once

#include <array>

#include "core/joint/joint_row.h"

namespace huestep {

inline constexpr std::uint32_t maxRigidRows = 3;

/// Values of a joint's rows; those beyond its count are 0.
using RigidValues = std::array<float, maxRigidRows>;

struct RigidRow {
    Vec2 n;                    ///< world axes; zero for an angle
    float armA = 0, armB = 0;  ///< m; 1 for an angle
};

/// Where a body is, from where it was at the start of the step.
struct BodyDelta {
    Vec2 moved;       ///< m
    Rotation turned;  ///< since the start
};

/// How many rows the joint's rigid part has, [0, 3].
std::uint32_t rigidRowCount(const JointRow& row);

/// Which of the rows is that of the angle; `maxRigidRows` if none is.
std::uint32_t angleRow(const JointRow& row);

/// The Jacobian at the given places of both bodies.
std::array<RigidRow, maxRigidRows> rigidRows(const JointRow& row, const BodyDelta& a,
                                             const BodyDelta& b);

/// C of every row, m and rad.
RigidValues rigidErrors(const JointRow& row, const BodyDelta& a, const BodyDelta& b);

/// The joint's accumulated impulse of every row, N·s and N·m·s, and its way back.
RigidValues rigidImpulses(const JointRow& row);
void setRigidImpulses(JointRow& row, const RigidValues& impulses);

/// What a constant force in the rows does to motion: second derivatives of −λ·C by a body's place,
/// lumped, that is its diagonal with the rest bounded by it.
struct GeometricStiffness {
    float linear = 0;   ///< N·s/m, of impulses; times 1/h a stiffness in N/m
    float angular = 0;  ///< N·m·s
};

/// Of impulses λ at the given places (Tournier et al., "Stable constrained dynamics", 2015;
/// Andrews, Teichmann and Kry, "Geometric stiffness for real-time constrained multibody dynamics",
/// 2017).
struct JointStiffness {
    GeometricStiffness a, b;
};
JointStiffness geometricStiffness(const JointRow& row, const RigidValues& impulses,
                                  const BodyDelta& a, const BodyDelta& b);

}  // namespace huestep
