#include "core/joint/joint_row.h"

#include <array>

#include "core/joint/parts.h"
#include "core/math/angle_lanes.h"
#include "core/math/finite.h"
#include "core/math/trig.h"

namespace huestep {

namespace {

JointBodies load(const SolverBody* bodies, const JointRow& row) {
    const SolverBody& a = bodies[readPlace(row.bodyA)];
    const SolverBody& b = bodies[readPlace(row.bodyB)];
    return {{a.vx, a.vy}, {b.vx, b.vy}, a.w, b.w, row.mA, row.iA, row.mB, row.iB};
}

void store(SolverBody* bodies, const JointRow& row, const JointBodies& now) {
    if (row.bodyA >= 0) {
        SolverBody& a = bodies[row.bodyA];
        a.vx = now.vA.x;
        a.vy = now.vA.y;
        a.w = now.wA;
    }
    if (row.bodyB >= 0) {
        SolverBody& b = bodies[row.bodyB];
        b.vx = now.vB.x;
        b.vy = now.vB.y;
        b.w = now.wB;
    }
}

/// Where the anchors are by now. Joint rows turn their anchors every substep: with fixed ones a
/// pendulum loses a third of its energy (physics page, 5).
struct Geometry {
    Vec2 rA, rB;   // from the centres
    Vec2 between;  // anchor B less anchor A
};

Geometry geometry(const SolverBody* bodies, const JointRow& row) {
    const SolverBody& a = bodies[readPlace(row.bodyA)];
    const SolverBody& b = bodies[readPlace(row.bodyB)];
    Geometry g;
    g.rA = rotate(Rotation{a.dc, a.ds}, row.anchorA);
    g.rB = rotate(Rotation{b.dc, b.ds}, row.anchorB);
    g.between = (Vec2{b.dx - a.dx, b.dy - a.dy} + row.centers) + (g.rB - g.rA);
    return g;
}

float angleNow(const SolverBody* bodies, const JointRow& row) {
    const SolverBody& a = bodies[readPlace(row.bodyA)];
    const SolverBody& b = bodies[readPlace(row.bodyB)];
    const Rotation turned = relative(Rotation{a.dc, a.ds}, Rotation{b.dc, b.ds});
    const Rotation now = compose(turned, row.angle);
    return angleLanes<1>(now.c, now.s);
}

void solveRevolute(SolverBody* bodies, JointRow& row, const JointPass& pass) {
    JointBodies b = load(bodies, row);
    const AxisPart axis;
    const bool springs = (row.flags & JointInfo::spring) != 0;
    const bool limits = (row.flags & JointInfo::limit) != 0;
    const float angle = springs || limits ? angleNow(bodies, row) : 0.0f;
    if (springs) solveHold(b, axis, angle, row.spring, row.impulses.spring);
    if ((row.flags & JointInfo::motor) != 0) {
        solveMotor(b, axis, row.motorSpeed, pass.h * row.motorMaxEffort, row.impulses.motor);
    }
    if (limits) {
        solveLimit(b, axis, 1.0f, angle - row.lower, pass.inverseH, pass.soft, row.impulses.lower);
        solveLimit(b, axis, -1.0f, row.upper - angle, pass.inverseH, pass.soft, row.impulses.upper);
    }
    if (!row.direct) {
        const Geometry g = geometry(bodies, row);
        PointPart::solve(b, g.rA, g.rB, g.between, pass.soft, row.impulses.point);
    }
    store(bodies, row, b);
}

LinePart lineOf(const Geometry& g, float& lengthNow) {
    lengthNow = length(g.between);
    // Anchors that coincide have no direction: any will part them.
    const Vec2 u = lengthNow > 1e-6f ? (1.0f / lengthNow) * g.between : Vec2{1.0f, 0.0f};
    return {g.rA, g.rB, u};
}

void solveDistance(SolverBody* bodies, JointRow& row, const JointPass& pass) {
    JointBodies b = load(bodies, row);
    float now = 0;
    const LinePart line = lineOf(geometry(bodies, row), now);
    const bool springs = (row.flags & JointInfo::spring) != 0;
    const bool ranges = (row.flags & JointInfo::limit) != 0;
    if (springs) solveHold(b, line, now - row.length, row.spring, row.impulses.spring);
    if ((row.flags & JointInfo::motor) != 0) {
        solveMotor(b, line, row.motorSpeed, pass.h * row.motorMaxEffort, row.impulses.motor);
    }
    if (ranges) {
        solveLimit(b, line, 1.0f, now - row.lower, pass.inverseH, pass.soft, row.impulses.lower);
        solveLimit(b, line, -1.0f, row.upper - now, pass.inverseH, pass.soft, row.impulses.upper);
    }
    if (!springs && !ranges && !row.direct) {
        solveHold(b, line, now - row.length, pass.soft, row.impulses.point.x);
    }
    store(bodies, row, b);
}

void solveWeld(SolverBody* bodies, JointRow& row, const JointPass& pass) {
    JointBodies b = load(bodies, row);
    const Geometry g = geometry(bodies, row);
    const float angle = angleNow(bodies, row);
    if ((row.flags & JointInfo::spring) != 0) {
        solveHold(b, AxisPart{}, angle, row.spring, row.impulses.spring);
        if (!row.direct) {
            PointPart::solve(b, g.rA, g.rB, g.between, pass.soft, row.impulses.point);
        }
    } else {
        FixedPart::solve(b, g.rA, g.rB, g.between, angle, pass.soft, row.impulses.point,
                         row.impulses.spring);
    }
    store(bodies, row, b);
}

/// Along the axis as turned by now; the arm of A reaches to B's anchor, where the axis pushes.
LinePart slideOf(const SolverBody* bodies, const JointRow& row, const Geometry& g) {
    const SolverBody& a = bodies[readPlace(row.bodyA)];
    return {g.rA + g.between, g.rB, rotate(Rotation{a.dc, a.ds}, row.axis)};
}

LinePart acrossOf(const LinePart& along) {
    return {along.rA, along.rB, perpLeft(along.u)};
}

void solvePrismatic(SolverBody* bodies, JointRow& row, const JointPass& pass) {
    JointBodies b = load(bodies, row);
    const Geometry g = geometry(bodies, row);
    const LinePart along = slideOf(bodies, row, g);
    const LinePart across = acrossOf(along);
    const float now = dot(along.u, g.between);
    if ((row.flags & JointInfo::spring) != 0) {
        solveHold(b, along, now, row.spring, row.impulses.spring);
    }
    if ((row.flags & JointInfo::motor) != 0) {
        solveMotor(b, along, row.motorSpeed, pass.h * row.motorMaxEffort, row.impulses.motor);
    }
    if ((row.flags & JointInfo::limit) != 0) {
        solveLimit(b, along, 1.0f, now - row.lower, pass.inverseH, pass.soft, row.impulses.lower);
        solveLimit(b, along, -1.0f, row.upper - now, pass.inverseH, pass.soft, row.impulses.upper);
    }
    if (row.direct) return store(bodies, row, b);
    SlidePart::solve(b, across, dot(across.u, g.between), angleNow(bodies, row), pass.soft,
                     row.impulses.point);
    store(bodies, row, b);
}

void solveMouse(SolverBody* bodies, JointRow& row, const JointPass& pass) {
    JointBodies b = load(bodies, row);
    const Geometry g = geometry(bodies, row);
    PointPart::solve(b, g.rA, g.rB, g.between, row.spring, row.impulses.point,
                     pass.h * row.maxForce);
    store(bodies, row, b);
}

}  // namespace

bool hasParts(const JointRow& row) {
    return (row.flags & (JointInfo::spring | JointInfo::motor | JointInfo::limit)) != 0;
}

JointRow prepareJoint(const JointInfo& info, const JointImpulses& impulses, std::uint32_t place,
                      const Pose& poseA, const Pose& poseB, float h) {
    JointRow row;
    row.kind = info.kind();
    row.flags = info.flags;
    row.joint = place;
    row.anchorA = rotate(poseA.q, info.anchorA);
    row.anchorB = rotate(poseB.q, info.anchorB);
    row.centers = poseB.p - (row.kind == JointKind::Mouse ? info.target : poseA.p);
    row.angle = relative(info.reference, relative(poseA.q, poseB.q));
    row.axis = rotate(poseA.q, info.axis());
    row.length = info.length;
    row.lower = info.lower;
    row.upper = info.upper;
    row.motorSpeed = info.motorSpeed;
    row.motorMaxEffort = info.motorMaxEffort;
    row.maxForce = info.maxForce;
    row.spring = softness(info.springHertz, info.springDamping, h);
    row.impulses = impulses;
    return row;
}

void warmStartJoint(SolverBody* bodies, const JointRow& row) {
    if (row.direct && !hasParts(row)) return;
    JointBodies b = load(bodies, row);
    const Geometry g = geometry(bodies, row);
    JointImpulses l = row.impulses;
    if (row.direct) l.point = {};
    const float axial = l.spring + l.motor + l.lower - l.upper;
    if (row.kind == JointKind::Distance) {
        float now = 0;
        const LinePart line = lineOf(g, now);
        line.apply(b, axial + l.point.x);
    } else if (row.kind == JointKind::Prismatic) {
        const LinePart along = slideOf(bodies, row, g);
        along.apply(b, axial);
        acrossOf(along).apply(b, l.point.x);
        applyAngular(b, l.point.y);
    } else {
        applyLinear(b, g.rA, g.rB, l.point);
        applyAngular(b, axial);
    }
    store(bodies, row, b);
}

void solveJoint(SolverBody* bodies, JointRow& row, const JointPass& pass) {
    if (row.direct && !hasParts(row)) return;
    switch (row.kind) {
        case JointKind::Revolute:
            return solveRevolute(bodies, row, pass);
        case JointKind::Distance:
            return solveDistance(bodies, row, pass);
        case JointKind::Mouse:
            return solveMouse(bodies, row, pass);
        case JointKind::Weld:
            return solveWeld(bodies, row, pass);
        case JointKind::Prismatic:
            return solvePrismatic(bodies, row, pass);
    }
}

float strainOf(const JointRow& row) {
    const JointBodies b{{}, {}, 0, 0, row.mA, row.iA, row.mB, row.iB};
    const Vec2 p = row.impulses.point;
    const Vec2 between = row.centers + (row.anchorB - row.anchorA);
    Vec2 change;
    switch (row.kind) {
        case JointKind::Mouse:
            break;
        case JointKind::Distance: {
            const float now = length(between);
            const Vec2 u = now > 0.0f ? (1.0f / now) * between : Vec2{1.0f, 0.0f};
            change.x = p.x * inverseOrZero(LinePart{row.anchorA, row.anchorB, u}.mass(b));
            break;
        }
        case JointKind::Prismatic: {
            const LinePart across{row.anchorA + between, row.anchorB, perpLeft(row.axis)};
            change.x = p.x * inverseOrZero(across.mass(b));
            break;
        }
        case JointKind::Revolute:
        case JointKind::Weld:
            change = PointPart::change(b, row.anchorA, row.anchorB, p);
            break;
    }
    return length(change) * row.allowance;
}

void scale(JointImpulses& impulses, float by) {
    impulses.point = by * impulses.point;
    impulses.spring *= by;
    impulses.motor *= by;
    impulses.lower *= by;
    impulses.upper *= by;
}

void correctJoint(SolverBody* bodies, const JointRow& row) {
    if (row.kind == JointKind::Mouse) return;
    std::array<SolverBody, 2> moved{bodies[readPlace(row.bodyA)], bodies[readPlace(row.bodyB)]};
    for (SolverBody& body : moved) body.vx = body.vy = body.w = 0.0f;
    // The joint's own parts, with what they would do to velocities as displacements.
    JointRow rigid = row;
    rigid.bodyA = row.bodyA < 0 ? ~BodyPlace{0} : BodyPlace{0};
    rigid.bodyB = row.bodyB < 0 ? ~BodyPlace{1} : BodyPlace{1};
    rigid.impulses = {};
    rigid.spring = {0.0f, 0.0f, 0.0f};
    rigid.flags &= ~JointInfo::motor;
    solveJoint(moved.data(), rigid, correctionPass);
    const auto displace = [](SolverBody& body, const SolverBody& by) {
        body.dx += by.vx;
        body.dy += by.vy;
        const Rotation q = compose(cayley(0.5f * by.w), Rotation{body.dc, body.ds});
        body.dc = q.c;
        body.ds = q.s;
    };
    if (row.bodyA >= 0) displace(bodies[row.bodyA], moved[0]);
    if (row.bodyB >= 0) displace(bodies[row.bodyB], moved[1]);
}

JointImpulses storedImpulses(const JointRow& row) {
    const JointImpulses& l = row.impulses;
    return {{finiteOrZero(l.point.x), finiteOrZero(l.point.y)},
            finiteOrZero(l.spring),
            finiteOrZero(l.motor),
            finiteOrZero(l.lower),
            finiteOrZero(l.upper)};
}

}  // namespace huestep
