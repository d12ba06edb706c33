#include "core/joint/rigid_rows.h"

#include "core/math/angle_lanes.h"

namespace huestep {

namespace {

/// Anchors as turned by now, and how far that of B is from that of A.
struct Anchors {
    Vec2 rA, rB, between;
};

Anchors anchorsOf(const JointRow& row, const BodyDelta& a, const BodyDelta& b) {
    Anchors at;
    at.rA = rotate(a.turned, row.anchorA);
    at.rB = rotate(b.turned, row.anchorB);
    at.between = ((b.moved - a.moved) + row.centers) + (at.rB - at.rA);
    return at;
}

float angleOf(const JointRow& row, const BodyDelta& a, const BodyDelta& b) {
    const Rotation now = compose(relative(a.turned, b.turned), row.angle);
    return angleLanes<1>(now.c, now.s);
}

Vec2 directionOf(const Anchors& at) {
    const float l = length(at.between);
    return l > 1e-6f ? (1.0f / l) * at.between : Vec2{1.0f, 0.0f};
}

Vec2 acrossOf(const JointRow& row, const BodyDelta& a) {
    return perpLeft(rotate(a.turned, row.axis));
}

RigidRow rowOf(Vec2 n, Vec2 rA, Vec2 rB) {
    return {n, cross(rA, n), cross(rB, n)};
}

constexpr RigidRow turning{{}, 1.0f, 1.0f};

}  // namespace

std::uint32_t rigidRowCount(const JointRow& row) {
    const bool springs = (row.flags & JointInfo::spring) != 0;
    const bool ranges = (row.flags & JointInfo::limit) != 0;
    switch (row.kind) {
        case JointKind::Revolute:
        case JointKind::Prismatic:
            return 2;
        case JointKind::Weld:
            return springs ? 2 : 3;
        case JointKind::Distance:
            return springs || ranges ? 0 : 1;
        case JointKind::Mouse:
            return 0;
    }
    return 0;
}

std::uint32_t angleRow(const JointRow& row) {
    if (row.kind == JointKind::Prismatic) return 1;
    const bool held = row.kind == JointKind::Weld && (row.flags & JointInfo::spring) == 0;
    return held ? 2 : maxRigidRows;
}

std::array<RigidRow, maxRigidRows> rigidRows(const JointRow& row, const BodyDelta& a,
                                             const BodyDelta& b) {
    const Anchors at = anchorsOf(row, a, b);
    switch (row.kind) {
        case JointKind::Distance:
            return {rowOf(directionOf(at), at.rA, at.rB)};
        case JointKind::Prismatic:
            // The axis turns with A, so its arm reaches to B's anchor.
            return {rowOf(acrossOf(row, a), at.rA + at.between, at.rB), turning};
        default:
            return {rowOf({1.0f, 0.0f}, at.rA, at.rB), rowOf({0.0f, 1.0f}, at.rA, at.rB), turning};
    }
}

RigidValues rigidErrors(const JointRow& row, const BodyDelta& a, const BodyDelta& b) {
    const Anchors at = anchorsOf(row, a, b);
    switch (row.kind) {
        case JointKind::Distance:
            return {length(at.between) - row.length};
        case JointKind::Prismatic:
            return {dot(acrossOf(row, a), at.between), angleOf(row, a, b)};
        case JointKind::Weld:
            return {at.between.x, at.between.y, angleRow(row) == 2 ? angleOf(row, a, b) : 0.0f};
        default:
            return {at.between.x, at.between.y};
    }
}

RigidValues rigidImpulses(const JointRow& row) {
    const JointImpulses& l = row.impulses;
    switch (row.kind) {
        case JointKind::Distance:
            return {l.point.x};
        case JointKind::Weld:
            return {l.point.x, l.point.y, angleRow(row) == 2 ? l.spring : 0.0f};
        default:
            return {l.point.x, l.point.y};
    }
}

void setRigidImpulses(JointRow& row, const RigidValues& impulses) {
    JointImpulses& l = row.impulses;
    l.point.x = impulses[0];
    if (row.kind != JointKind::Distance) l.point.y = impulses[1];
    if (row.kind == JointKind::Weld && angleRow(row) == 2) l.spring = impulses[2];
}

/// With U = −λ·C, and λ constant:
///
/// Revolute and weld: C = xB + R(θB) rB − xA − R(θA) rA, whose second derivatives are −rB by θB
/// twice and rA by θA twice, and no other. So the stiffness is λ·rB of B and −λ·rA of A, the sum
/// over a body's joints of force times arm, and nothing is left out.
///
/// Distance: C = |d| − L, whose second derivative by d is (1 − u uᵀ)/|d|. A pull T = −λ holds
/// anchors back across the line with T/|d|, of the movement of one against the other: of two
/// bodies that swing against each other that is twice as much for each. A centre moves its anchor
/// one to one, a turn by the part of its arm along the line. The arms themselves turn: force times
/// arm as above.
///
/// Prismatic: C = n(θA)·(xB + R(θB) rB − xA) less a constant: as B turns, as above; as A turns,
/// the force follows it, and the second derivative by θA is −n·(pB − xA). What couples A's turning
/// to B's place is left out.
JointStiffness geometricStiffness(const JointRow& row, const RigidValues& impulses,
                                  const BodyDelta& a, const BodyDelta& b) {
    const Anchors at = anchorsOf(row, a, b);
    JointStiffness k;
    if (row.kind == JointKind::Prismatic) {
        const Vec2 force = impulses[0] * acrossOf(row, a);
        k.a.angular = dot(force, at.rA + at.between);
        k.b.angular = dot(force, at.rB);
    } else if (row.kind == JointKind::Distance) {
        const Vec2 u = directionOf(at);
        const float held = maxOf(-impulses[0], 0.0f) / maxOf(length(at.between), 1e-6f);
        const float alongA = dot(u, at.rA), alongB = dot(u, at.rB);
        k.a.linear = k.b.linear = 2.0f * held;
        k.a.angular = 2.0f * held * alongA * alongA - impulses[0] * alongA;
        k.b.angular = 2.0f * held * alongB * alongB + impulses[0] * alongB;
    } else {
        const Vec2 force{impulses[0], impulses[1]};
        k.a.angular = -dot(force, at.rA);
        k.b.angular = dot(force, at.rB);
    }
    return k;
}

}  // namespace huestep
