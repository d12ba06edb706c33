#include "core/solver/avbd_rows.h"

#include "core/math/angle_lanes.h"

namespace huestep {

namespace {

/// Where a joint's anchors are by now.
struct Arms {
    Vec2 rA, rB;   // from the centres
    Vec2 between;  // anchor B less anchor A
    Rotation turnedA;
    float angle;  // rad, of the joint
};

Arms armsOf(const JointRow& joint, const DescentPose& a, const DescentPose& b) {
    Arms arms;
    arms.rA = rotate(a.q, joint.anchorA);
    arms.rB = rotate(b.q, joint.anchorB);
    const Vec2 moved{b.by.x - a.by.x, b.by.y - a.by.y};
    arms.between = (moved + joint.centers) + (arms.rB - arms.rA);
    arms.turnedA = a.q;
    // What turns on within the step does not jump from π to −π.
    arms.angle = angleLanes<1>(joint.angle.c, joint.angle.s) + (b.by.angle - a.by.angle);
    return arms;
}

/// How far B's anchor is along u, counted in the direction `sign`. A coordinate that turns with A
/// has A's arm to B's anchor.
void alongLine(DescentRow& row, const Arms& arms, Vec2 armA, Vec2 u, float sign) {
    const Vec2 d = sign * u;
    row.b = {d.x, d.y, cross(arms.rB, d)};
    row.a = {-d.x, -d.y, -cross(armA, d)};
    row.bendB.angle = absoluteOf(dot(arms.rB, d));
    row.bendA.angle = absoluteOf(dot(armA, d));
}

void aboutAxis(DescentRow& row, float sign) {
    row.b.angle = sign;
    row.a.angle = -sign;
}

void addPoint(JointRows& rows, const Arms& arms) {
    DescentRow& x = rows.add(JointPart::PointX);
    alongLine(x, arms, arms.rA, {1.0f, 0.0f}, 1.0f);
    x.c = arms.between.x;
    DescentRow& y = rows.add(JointPart::PointY);
    alongLine(y, arms, arms.rA, {0.0f, 1.0f}, 1.0f);
    y.c = arms.between.y;
}

/// Spring, motor and limits of a coordinate q; `shape(row, sign)` sets a row's derivatives.
template <class Shape>
void addDrives(JointRows& rows, const JointRow& joint, float q, float rest, Shape&& shape) {
    const auto add = [&](JointPart part, float c, float sign) {
        DescentRow& row = rows.add(part);
        shape(row, sign);
        row.c = c;
    };
    if ((joint.flags & JointInfo::spring) != 0) add(JointPart::Spring, q - rest, 1.0f);
    if ((joint.flags & JointInfo::motor) != 0) add(JointPart::Motor, q, 1.0f);
    if ((joint.flags & JointInfo::limit) != 0) {
        add(JointPart::Lower, q - joint.lower, 1.0f);
        add(JointPart::Upper, joint.upper - q, -1.0f);
    }
}

void addDistance(JointRows& rows, const JointRow& joint, const Arms& arms) {
    const float now = length(arms.between);
    const Vec2 u = now > 1e-6f ? (1.0f / now) * arms.between : Vec2{1.0f, 0.0f};
    const float bend = now > 1e-6f ? 1.0f / now : 0.0f;
    const auto shape = [&](DescentRow& row, float sign) {
        alongLine(row, arms, arms.rA, u, sign);
        // Across the line its direction turns: (1 − u uᵀ)/length.
        for (Coordinates* c : {&row.bendA, &row.bendB}) {
            c->x += bend;
            c->y += bend;
        }
        const float acrossA = dot(arms.rA, u), acrossB = dot(arms.rB, u);
        row.bendA.angle += bend * acrossA * acrossA;
        row.bendB.angle += bend * acrossB * acrossB;
    };
    addDrives(rows, joint, now, joint.length, shape);
    if ((joint.flags & (JointInfo::spring | JointInfo::limit)) != 0) return;
    DescentRow& rigid = rows.add(JointPart::PointX);
    shape(rigid, 1.0f);
    rigid.c = now - joint.length;
}

void addPrismatic(JointRows& rows, const JointRow& joint, const Arms& arms) {
    const Vec2 axis = rotate(arms.turnedA, joint.axis);
    const Vec2 armA = arms.rA + arms.between;
    addDrives(rows, joint, dot(axis, arms.between), 0.0f,
              [&](DescentRow& row, float sign) { alongLine(row, arms, armA, axis, sign); });
    DescentRow& across = rows.add(JointPart::PointX);
    alongLine(across, arms, armA, perpLeft(axis), 1.0f);
    across.c = dot(perpLeft(axis), arms.between);
    DescentRow& turn = rows.add(JointPart::PointY);
    aboutAxis(turn, 1.0f);
    turn.c = arms.angle;
}

}  // namespace

JointRows jointRowsAt(const JointRow& joint, const DescentPose& a, const DescentPose& b) {
    const Arms arms = armsOf(joint, a, b);
    JointRows rows;
    switch (joint.kind) {
        case JointKind::Revolute:
            addDrives(rows, joint, arms.angle, 0.0f, aboutAxis);
            addPoint(rows, arms);
            break;
        case JointKind::Distance:
            addDistance(rows, joint, arms);
            break;
        case JointKind::Mouse:
            addPoint(rows, arms);
            break;
        case JointKind::Weld: {
            DescentRow& turn = rows.add(JointPart::Spring);
            aboutAxis(turn, 1.0f);
            turn.c = arms.angle;
            addPoint(rows, arms);
            break;
        }
        case JointKind::Prismatic:
            addPrismatic(rows, joint, arms);
            break;
    }
    return rows;
}

float impulseOf(const JointImpulses& impulses, JointPart part) {
    switch (part) {
        case JointPart::PointX:
            return impulses.point.x;
        case JointPart::PointY:
            return impulses.point.y;
        case JointPart::Spring:
            return impulses.spring;
        case JointPart::Motor:
            return impulses.motor;
        case JointPart::Lower:
            return impulses.lower;
        case JointPart::Upper:
            return impulses.upper;
    }
    return 0.0f;
}

void setImpulse(JointImpulses& impulses, JointPart part, float value) {
    switch (part) {
        case JointPart::PointX:
            impulses.point.x = value;
            return;
        case JointPart::PointY:
            impulses.point.y = value;
            return;
        case JointPart::Spring:
            impulses.spring = value;
            return;
        case JointPart::Motor:
            impulses.motor = value;
            return;
        case JointPart::Lower:
            impulses.lower = value;
            return;
        case JointPart::Upper:
            impulses.upper = value;
            return;
    }
}

}  // namespace huestep
