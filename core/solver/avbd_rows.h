/// Rows as the descent evaluates them: C, its derivatives, and what its force may be.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "core/joint/joint_row.h"
#include "core/math/vec.h"

namespace huestep {

/// A body's coordinates, or derivatives by them: m, m, rad.
struct Coordinates {
    float x = 0, y = 0, angle = 0;
};
constexpr float dot(const Coordinates& a, const Coordinates& b) {
    return (a.x * b.x + a.y * b.y) + a.angle * b.angle;
}

inline constexpr float unbounded = std::numeric_limits<float>::infinity();

/// One row. Its force is f = clamp(λ + k (C − base − letBe), least, most); its bodies feel −Jᵀ f.
struct DescentRow {
    Coordinates a, b;          ///< J = ∂C/∂x of body A and B
    Coordinates bendA, bendB;  ///< lumped |∂²C/∂x²|, by coordinate
    float c = 0;               ///< C: of a contact at the start of the step, of a joint by now
    float base = 0;            ///< of C, where it rests
    float letBe = 0;           ///< of C, an error from before the step
    float lambda = 0;          ///< N or N·m
    float k = 0;               ///< N/m or N·m/rad
    float least = -unbounded, most = unbounded;
    bool soft = false;  ///< a spring: k is its own, and there is no multiplier
};

/// Which impulse of a joint a row has.
enum class JointPart : std::uint8_t { PointX, PointY, Spring, Motor, Lower, Upper };
float impulseOf(const JointImpulses& impulses, JointPart part);
void setImpulse(JointImpulses& impulses, JointPart part, float value);

/// The rows of a joint, in an order that its kind and flags decide.
struct JointRows {
    std::array<DescentRow, 6> rows;
    std::array<JointPart, 6> parts{};
    std::uint32_t count = 0;

    DescentRow& add(JointPart part) {
        parts[count] = part;
        return rows[count++];
    }
};

/// Where a body is by now, from the start of the step.
struct DescentPose {
    Coordinates by;
    Rotation q;  ///< of `by.angle`
};

/// C and its derivatives at the poses given, of all rows of the joint: no multipliers, stiffness or
/// bounds. A motor's C is the coordinate itself.
JointRows jointRowsAt(const JointRow& joint, const DescentPose& a, const DescentPose& b);

}  // namespace huestep
