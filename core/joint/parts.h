/// Constraint parts: the rows that joints are composed of.
///
/// Each part knows one constraint C(x) = 0 or C(x) ≥ 0, its velocity Ċ = J v, its effective mass
/// (J M⁻¹ Jᵀ)⁻¹ and its accumulated impulse λ. A joint is a list of parts (design, "Habits" 9).
///
///   v, w         velocity of a body's centre (m/s) and rate of turn (rad/s)
///   mA, iA, …    inverse mass (1/kg) and inverse inertia (1/(kg·m²)) of A; 0: not moved
///   rA, rB       anchors from the bodies' centres, world axes, as turned by now (m)
///   soft         coefficients of the soft row, see `Softness`
///
/// The velocity step of a soft row is  Δλ = −m·massScale·(Ċ + biasRate·C) − impulseScale·λ.
#pragma once

#include "core/math/vec.h"
#include "core/solver/contact_block.h"

namespace huestep {

/// Velocities and inverse masses of the two bodies of a joint, held while its parts are solved.
struct JointBodies {
    Vec2 vA, vB;
    float wA = 0, wB = 0;
    float mA = 0, iA = 0, mB = 0, iB = 0;
};

/// A linear impulse p at the anchors: +p on B, −p on A.
inline void applyLinear(JointBodies& b, Vec2 rA, Vec2 rB, Vec2 p) {
    b.vA -= b.mA * p;
    b.wA -= b.iA * cross(rA, p);
    b.vB += b.mB * p;
    b.wB += b.iB * cross(rB, p);
}

/// An angular impulse: +l on B, −l on A.
inline void applyAngular(JointBodies& b, float l) {
    b.wA -= b.iA * l;
    b.wB += b.iB * l;
}

inline Vec2 anchorVelocity(const JointBodies& b, Vec2 rA, Vec2 rB) {
    return (b.vB + crossScalar(b.wB, rB)) - (b.vA + crossScalar(b.wA, rA));
}

/// Two points coincide: C = (cB + rB) − (cA + rA), two rows solved together.
///   K = (mA + mB) 1 + iA [ rAy², −rAx rAy; −rAx rAy, rAx² ] + iB [ likewise ]
struct PointPart {
    /// K p: by how much an impulse changes the anchors' relative velocity.
    static Vec2 change(const JointBodies& b, Vec2 rA, Vec2 rB, Vec2 p) {
        const float turnA = b.iA * cross(rA, p), turnB = b.iB * cross(rB, p);
        const float m = b.mA + b.mB;
        return {m * p.x - (turnA * rA.y + turnB * rB.y), m * p.y + (turnA * rA.x + turnB * rB.x)};
    }
    static void solve(JointBodies& b, Vec2 rA, Vec2 rB, Vec2 error, const Softness& soft,
                      Vec2& impulse, float maxImpulse = -1.0f) {
        const float m = b.mA + b.mB;
        const float k11 = m + b.iA * rA.y * rA.y + b.iB * rB.y * rB.y;
        const float k12 = -(b.iA * rA.x * rA.y) - b.iB * rB.x * rB.y;
        const float k22 = m + b.iA * rA.x * rA.x + b.iB * rB.x * rB.x;
        const float determinant = k11 * k22 - k12 * k12;
        const float inverse = inverseOrZero(determinant);
        const Vec2 rhs = anchorVelocity(b, rA, rB) + soft.biasRate * error;
        const Vec2 rigid{inverse * (k22 * rhs.x - k12 * rhs.y),
                         inverse * (k11 * rhs.y - k12 * rhs.x)};
        const Vec2 old = impulse;
        impulse = (old - soft.massScale * rigid) - soft.impulseScale * old;
        if (maxImpulse >= 0.0f) {
            const float l = length(impulse);
            if (l > maxImpulse) impulse = (maxImpulse / l) * impulse;
        }
        applyLinear(b, rA, rB, impulse - old);
    }
};

/// The relative angle of two bodies, free to turn: rows about the joint's axis.
/// Effective mass 1 / (iA + iB).
struct AxisPart {
    static float mass(const JointBodies& b) { return inverseOrZero(b.iA + b.iB); }
    static float rate(const JointBodies& b) { return b.wB - b.wA; }
    static void apply(JointBodies& b, float l) { applyAngular(b, l); }
};

/// The distance of two anchors along the unit axis u from A's to B's. An axis that turns with body
/// A takes its arm to B's anchor: rA + (pB − pA). Effective mass 1 / (mA + mB + iA (rA×u)² + iB
/// (rB×u)²).
struct LinePart {
    Vec2 rA, rB, u;
    [[nodiscard]] float mass(const JointBodies& b) const {
        const float crossA = cross(rA, u);
        const float crossB = cross(rB, u);
        return inverseOrZero(b.mA + b.mB + b.iA * crossA * crossA + b.iB * crossB * crossB);
    }
    [[nodiscard]] float rate(const JointBodies& b) const {
        return dot(u, anchorVelocity(b, rA, rB));
    }
    void apply(JointBodies& b, float l) const { applyLinear(b, rA, rB, l * u); }
};

/// A coordinate held at 0, softly: a spring, or a rigid part with the joint's softness.
template <class Coordinate>
void solveHold(JointBodies& b, const Coordinate& q, float error, const Softness& soft,
               float& impulse) {
    const float rhs = q.rate(b) + soft.biasRate * error;
    const float delta = -(q.mass(b) * soft.massScale * rhs) - soft.impulseScale * impulse;
    impulse += delta;
    q.apply(b, delta);
}

/// What is left of the inverse inertias of two bodies whose angles are held together.
inline float reducedInertia(const JointBodies& b) {
    const float k = b.iA + b.iB;
    return k > 0.0f ? b.iA * b.iB / k : 0.0f;
}

/// Two points and two angles coincide: `PointPart` and the angle, three rows solved together. One
/// after the other they would fight: of a beam held at its end, each undoes 3/4 of the other's
/// work.
///   a = rA⊥, b = rB⊥;  K = [ m 1 + iA a aᵀ + iB b bᵀ, iA a + iB b; (iA a + iB b)ᵀ, iA + iB ]
/// Without the angle (its Schur complement) the point has, with d = a − b and
/// i = iA iB / (iA + iB),  K' = m 1 + i d dᵀ,  and  K'⁻¹ x = (x − i d (d·x) / (m + i d·d)) / m
/// (Sherman and Morrison 1950), free of cancellation.
struct FixedPart {
    static void solve(JointBodies& b, Vec2 rA, Vec2 rB, Vec2 error, float angle,
                      const Softness& soft, Vec2& impulse, float& twist) {
        const float m = b.mA + b.mB;
        const float inverseMass = inverseOrZero(m);
        const float angleMass = AxisPart::mass(b);
        const Vec2 armA = perpLeft(rA), armB = perpLeft(rB);
        const Vec2 coupling = b.iA * armA + b.iB * armB;
        const float turn = AxisPart::rate(b) + soft.biasRate * angle;
        const Vec2 rhs =
            (anchorVelocity(b, rA, rB) + soft.biasRate * error) - (turn * angleMass) * coupling;
        const Vec2 d = armA - armB;
        const float i = reducedInertia(b);
        const float along = m > 0.0f ? i * dot(d, rhs) / (m + i * dot(d, d)) : 0.0f;
        const Vec2 rigid = inverseMass * (rhs - along * d);
        const float rigidTwist = angleMass * (turn - dot(coupling, rigid));
        const Vec2 old = impulse;
        const float oldTwist = twist;
        impulse = (old - soft.massScale * rigid) - soft.impulseScale * old;
        twist = (oldTwist - soft.massScale * rigidTwist) - soft.impulseScale * oldTwist;
        applyLinear(b, rA, rB, impulse - old);
        applyAngular(b, twist - oldTwist);
    }
};

/// A point of B stays on an axis of A and the angles coincide: two rows solved together.
///   n across the axis, a = rA × n with rA to B's anchor, b = rB × n;
///   K = [ m + iA a² + iB b², iA a + iB b; iA a + iB b, iA + iB ]
/// Without the angle:  K' = m + i (a − b)²,  i as above.  impulse: x along n, y of the angle.
struct SlidePart {
    static void solve(JointBodies& b, const LinePart& across, float error, float angle,
                      const Softness& soft, Vec2& impulse) {
        const float angleMass = AxisPart::mass(b);
        const float armA = cross(across.rA, across.u);
        const float armB = cross(across.rB, across.u);
        const float coupling = b.iA * armA + b.iB * armB;
        const float turn = AxisPart::rate(b) + soft.biasRate * angle;
        const float rhs = (across.rate(b) + soft.biasRate * error) - coupling * (angleMass * turn);
        const float arm = armA - armB;
        const float k = b.mA + b.mB + reducedInertia(b) * arm * arm;
        const float rigid = k > 0.0f ? rhs / k : 0.0f;
        const float rigidTwist = angleMass * (turn - coupling * rigid);
        const Vec2 old = impulse;
        impulse = (old - soft.massScale * Vec2{rigid, rigidTwist}) - soft.impulseScale * old;
        across.apply(b, impulse.x - old.x);
        applyAngular(b, impulse.y - old.y);
    }
};

/// A coordinate driven at a speed with at most `maxImpulse` a substep.
template <class Coordinate>
void solveMotor(JointBodies& b, const Coordinate& q, float speed, float maxImpulse,
                float& impulse) {
    const float old = impulse;
    impulse = clampTo(old - q.mass(b) * (q.rate(b) - speed), -maxImpulse, maxImpulse);
    q.apply(b, impulse - old);
}

/// C ≥ 0 with λ ≥ 0 in the direction `sign` of the coordinate: +1 for a lower bound, −1 for an
/// upper one. While C > 0 the bound may be reached within the substep, no faster.
template <class Coordinate>
void solveLimit(JointBodies& b, const Coordinate& q, float sign, float gap, float inverseH,
                const Softness& soft, float& impulse) {
    const bool open = gap > 0.0f;
    const float bias = open ? gap * inverseH : soft.biasRate * gap;
    const float massScale = open ? 1.0f : soft.massScale;
    const float keep = open ? 0.0f : soft.impulseScale;
    const float old = impulse;
    const float delta = -(q.mass(b) * massScale * (sign * q.rate(b) + bias)) - keep * old;
    impulse = maxOf(old + delta, 0.0f);
    q.apply(b, sign * (impulse - old));
}

}  // namespace huestep
