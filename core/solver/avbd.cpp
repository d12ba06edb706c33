#include "core/solver/avbd.h"

#include <algorithm>

#include "core/math/trig.h"
#include "core/solver/avbd_rows.h"
#include "core/solver/body_motion.h"
#include "core/solver/sweep.h"

namespace huestep {

namespace {

/// m, and rad: by how much a row's penalty gives way under the multiplier that it starts with. With
/// 5 mm the chain of ratio 1000 and 1000 kg on five boxes hold at 4 iterations; with 20 mm the peak
/// errors are twice as large, without any such part boxes of one kilogram are crushed.
constexpr float sag = 0.005f;

/// The rows of a contact, in their order.
enum ContactRow : std::uint32_t { Normal0, Tangent0, Normal1, Tangent1, Rolling, contactRows };

/// A constraint's rows among all; one without rows is padding.
struct Constraint {
    BodyPlace a = fixedWorld, b = fixedWorld;
    std::uint32_t firstRow = 0, rows = 0;
    const JointRow* joint = nullptr;  ///< else a contact
    float friction = 0, rolling = 0;  ///< of a contact
};

/// H and g of one body: H symmetric.
struct NewtonStep {
    float xx = 0, xy = 0, yy = 0, xa = 0, ya = 0, aa = 0;
    Coordinates g;

    void add(const Coordinates& j, const Coordinates& bend, float k, float f) {
        xx += k * j.x * j.x;
        xy += k * j.x * j.y;
        yy += k * j.y * j.y;
        xa += k * j.x * j.angle;
        ya += k * j.y * j.angle;
        aa += k * j.angle * j.angle;
        const float size = absoluteOf(f);
        xx += size * bend.x;
        yy += size * bend.y;
        aa += size * bend.angle;
        g.x += f * j.x;
        g.y += f * j.y;
        g.angle += f * j.angle;
    }
    /// −H⁻¹ g by H = L D Lᵀ. H is positive definite: masses alone make it so.
    [[nodiscard]] Coordinates solution() const {
        const float l1 = xy / xx, l2 = xa / xx;
        const float d1 = yy - l1 * xy;
        const float l3 = (ya - l2 * xy) / d1;
        const float d2 = (aa - l2 * xa) - l3 * l3 * d1;
        const float z1 = g.y - l1 * g.x;
        const float z2 = (g.angle - l2 * g.x) - l3 * z1;
        const float angle = z2 / d2;
        const float y = z1 / d1 - l3 * angle;
        const float x = (g.x / xx - l1 * y) - l2 * angle;
        return {-x, -y, -angle};
    }
};

/// One batch's step on one worker.
class Descent {
 public:
    explicit Descent(const BatchTask& task);
    void run();

 private:
    void addJoint(const JointRow& joint);
    void addContact(const ContactBlock& block, std::uint32_t lane);
    void begin(DescentRow& row, const Constraint& of, float impulse) const;
    void soften(DescentRow& row, const Constraint& of, const Softness& spring) const;
    void bound(const Constraint& contact);
    void refresh(const Constraint& joint);

    [[nodiscard]] const DescentPose& poseOf(BodyPlace place) const;
    [[nodiscard]] float valueOf(const DescentRow& row, const Constraint& of) const;
    void moveBody(std::uint32_t place, bool afterwards);
    void updateMultipliers(const Constraint& of);
    void storeImpulses();

    const BatchTask& m_task;
    Rows& m_rows;
    float m_h;  // s
    DescentPose m_world;
    std::vector<DescentPose> m_poses;       // from the batch's first place
    std::vector<Coordinates> m_targets;     // where forces and velocities alone lead
    std::vector<Constraint> m_constraints;  // joints, then the lanes of contacts
    std::vector<DescentRow> m_all;
    std::vector<JointPart> m_parts;  // of joints' rows
};

Descent::Descent(const BatchTask& task) : m_task(task), m_rows(task.rows), m_h(task.stepSeconds) {
    const Batch& batch = task.batch;
    m_poses.resize(batch.endPlace - batch.firstPlace);
    m_targets.resize(m_poses.size());
    const std::uint32_t joints = batch.endJoint - batch.firstJoint;
    const std::uint32_t lanes = (batch.endBlock - batch.firstBlock) * blockLanes;
    m_constraints.reserve(joints + lanes);
    for (std::uint32_t i = batch.firstJoint; i < batch.endJoint; ++i) addJoint(m_rows.joints[i]);
    m_parts.resize(m_all.size());
    for (std::uint32_t i = 0; i < lanes; ++i) {
        addContact(m_rows.blocks[batch.firstBlock + i / blockLanes], i % blockLanes);
    }
}

const DescentPose& Descent::poseOf(BodyPlace place) const {
    const auto at = static_cast<std::uint32_t>(readPlace(place));
    return at < m_task.batch.firstPlace ? m_world : m_poses[at - m_task.batch.firstPlace];
}

/// Multiplier and penalty from the impulse of the last step and the heavier body.
void Descent::begin(DescentRow& row, const Constraint& of, float impulse) const {
    const bool turns = row.b.x == 0.0f && row.b.y == 0.0f;
    float most = 0.0f;
    for (const BodyPlace place : {of.a, of.b}) {
        if (place < 0) continue;
        const auto at = static_cast<std::size_t>(place);
        most = maxOf(most, inverseOrZero(turns ? m_rows.sources[at].inverseInertia
                                               : m_rows.bodies[at].inverseMass));
    }
    row.lambda = clampTo(-impulse / m_h, row.least, row.most);
    row.k = maxOf(most / (m_h * m_h), absoluteOf(row.lambda) / sag);
}

/// A spring's own stiffness and damping. With its row's mass m and the coefficients of the soft row
/// (`Softness`), c + h k = m a₂/h and k = biasRate (c + h k); the force at the end of the step is
/// k C + c (C − C₀)/h = K (C − (1 − h·biasRate) C₀),  K = m a₂/h².
void Descent::soften(DescentRow& row, const Constraint& of, const Softness& spring) const {
    const auto inverse = [&](BodyPlace place, const Coordinates& j) {
        if (place < 0) return 0.0f;
        const auto at = static_cast<std::size_t>(place);
        return m_rows.bodies[at].inverseMass * (j.x * j.x + j.y * j.y) +
               m_rows.sources[at].inverseInertia * j.angle * j.angle;
    };
    const float mass = inverseOrZero(inverse(of.a, row.a) + inverse(of.b, row.b));
    const float a2 = spring.massScale * inverseOrZero(spring.impulseScale);
    row.soft = true;
    row.lambda = 0.0f;
    row.k = mass * a2 / (m_h * m_h);
    row.base = (1.0f - m_h * spring.biasRate) * row.c;
}

void Descent::addJoint(const JointRow& joint) {
    Constraint of;
    of.a = joint.bodyA;
    of.b = joint.bodyB;
    of.joint = &joint;
    of.firstRow = static_cast<std::uint32_t>(m_all.size());
    JointRows start = jointRowsAt(joint, m_world, m_world);
    of.rows = start.count;
    for (std::uint32_t i = 0; i < start.count; ++i) {
        DescentRow& row = start.rows[i];
        const JointPart part = start.parts[i];
        const bool mouse = joint.kind == JointKind::Mouse;
        if (mouse || (part == JointPart::Spring && (joint.flags & JointInfo::spring) != 0)) {
            if (mouse) row.most = joint.maxForce;
            if (mouse) row.least = -joint.maxForce;
            soften(row, of, joint.spring);
        } else {
            if (part == JointPart::Motor) {
                row.base = row.c + m_h * joint.motorSpeed;
                row.most = joint.motorMaxEffort;
                row.least = -joint.motorMaxEffort;
            } else if (part == JointPart::Lower || part == JointPart::Upper) {
                row.most = 0.0f;
                row.letBe = minOf(row.c, 0.0f);
            } else {
                row.letBe = row.c;
            }
            begin(row, of, impulseOf(joint.impulses, part));
        }
        m_all.push_back(row);
        m_parts.push_back(part);
    }
    m_constraints.push_back(of);
}

void Descent::addContact(const ContactBlock& block, std::uint32_t lane) {
    Constraint of;
    of.a = block.bodyA[lane];
    of.b = block.bodyB[lane];
    of.friction = block.friction[lane];
    of.rolling = block.rollingResistance[lane];
    of.firstRow = static_cast<std::uint32_t>(m_all.size());
    const Vec2 n{block.normalX[lane], block.normalY[lane]};
    const Vec2 t = perpRight(n);
    std::array<DescentRow, contactRows> rows;
    for (std::size_t i = 0; i < 2; ++i) {
        const ContactPointRows& p = block.points[i];
        if (!(p.normalMass[lane] > 0.0f)) continue;  // no point
        of.rows = contactRows;
        const Vec2 rA{p.anchorAx[lane], p.anchorAy[lane]}, rB{p.anchorBx[lane], p.anchorBy[lane]};
        DescentRow& normal = rows[2 * i + Normal0];
        normal.a = {-n.x, -n.y, -cross(rA, n)};
        normal.b = {n.x, n.y, cross(rB, n)};
        normal.c = p.separation[lane] + dot(n, rB - rA);
        normal.letBe = minOf(normal.c, 0.0f);
        normal.most = 0.0f;
        begin(normal, of, p.normalImpulse[lane]);
        if (!(of.friction > 0.0f)) continue;
        DescentRow& tangent = rows[2 * i + Tangent0];
        tangent.a = {-t.x, -t.y, -cross(rA, t)};
        tangent.b = {t.x, t.y, cross(rB, t)};
        tangent.c = m_h * block.tangentSpeed[lane];
        begin(tangent, of, p.tangentImpulse[lane]);
    }
    if (of.rolling > 0.0f && of.rows > 0) {
        rows[Rolling].a.angle = -1.0f;
        rows[Rolling].b.angle = 1.0f;
        begin(rows[Rolling], of, block.rollingImpulse[lane]);
    }
    m_all.insert(m_all.end(), rows.begin(), rows.begin() + of.rows);
    m_constraints.push_back(of);
    bound(of);
}

/// Friction and rolling resistance are bounded by the normals' multipliers.
void Descent::bound(const Constraint& contact) {
    if (contact.rows == 0) return;
    DescentRow* rows = &m_all[contact.firstRow];
    const auto within = [](DescentRow& row, float most) {
        row.most = most;
        row.least = -most;
        row.lambda = clampTo(row.lambda, row.least, row.most);
    };
    within(rows[Tangent0], -contact.friction * rows[Normal0].lambda);
    within(rows[Tangent1], -contact.friction * rows[Normal1].lambda);
    within(rows[Rolling], -contact.rolling * (rows[Normal0].lambda + rows[Normal1].lambda));
}

/// Brings a joint's rows to where its bodies are by now.
void Descent::refresh(const Constraint& of) {
    const JointRows now = jointRowsAt(*of.joint, poseOf(of.a), poseOf(of.b));
    for (std::uint32_t i = 0; i < of.rows; ++i) {
        DescentRow& row = m_all[of.firstRow + i];
        row.a = now.rows[i].a;
        row.b = now.rows[i].b;
        row.bendA = now.rows[i].bendA;
        row.bendB = now.rows[i].bendB;
        row.c = now.rows[i].c;
    }
}

/// C by now. Contacts keep the derivatives that they had when the step began.
float Descent::valueOf(const DescentRow& row, const Constraint& of) const {
    if (of.joint != nullptr) return row.c;
    return row.c + (dot(row.a, poseOf(of.a).by) + dot(row.b, poseOf(of.b).by));
}

/// A body's Newton step with all others held. `afterwards`: old errors count too.
void Descent::moveBody(std::uint32_t place, bool afterwards) {
    const auto touches = m_task.plan.incidence.touchesOf(place);
    if (touches.empty()) return;
    const std::uint32_t local = place - m_task.batch.firstPlace;
    DescentPose& pose = m_poses[local];
    const float rate = 1.0f / (m_h * m_h);
    const float mass = rate * inverseOrZero(m_rows.bodies[place].inverseMass);
    const float inertia = rate * inverseOrZero(m_rows.sources[place].inverseInertia);
    const Coordinates& target = m_targets[local];
    NewtonStep step;
    step.xx = step.yy = mass;
    step.aa = inertia;
    step.g = {mass * (pose.by.x - target.x), mass * (pose.by.y - target.y),
              inertia * (pose.by.angle - target.angle)};
    const Incidence& incidence = m_task.plan.incidence;
    const std::uint32_t joints = m_task.batch.endJoint - m_task.batch.firstJoint;
    const std::uint32_t firstLane =
        incidence.joints + incidence.revoluteLanes + m_task.batch.firstBlock * blockLanes;
    for (const std::uint32_t slot : touches) {
        const std::uint32_t row = slot / 2;
        const bool isB = slot % 2 != 0;
        const Constraint& of = m_constraints[row < incidence.joints ? row - m_task.batch.firstJoint
                                                                    : joints + (row - firstLane)];
        if (of.joint != nullptr) refresh(of);
        for (std::uint32_t i = of.firstRow; i < of.firstRow + of.rows; ++i) {
            const DescentRow& r = m_all[i];
            const float error = (valueOf(r, of) - r.base) - (afterwards ? 0.0f : r.letBe);
            const float f = clampTo(r.lambda + r.k * error, r.least, r.most);
            // A gap's penalty counts as if it were closed: without it bodies leap into each other
            // and back.
            step.add(isB ? r.b : r.a, isB ? r.bendB : r.bendA, r.k, f);
        }
    }
    if (inertia == 0.0f) {  // it never turns
        step.xa = step.ya = step.g.angle = 0.0f;
        step.aa = 1.0f;
    }
    const Coordinates change = step.solution();
    pose.by = {pose.by.x + change.x, pose.by.y + change.y, pose.by.angle + change.angle};
    pose.q = rotationOf(pose.by.angle);
}

void Descent::updateMultipliers(const Constraint& of) {
    if (of.rows == 0) return;
    if (of.joint != nullptr) refresh(of);
    for (std::uint32_t i = of.firstRow; i < of.firstRow + of.rows; ++i) {
        DescentRow& row = m_all[i];
        if (row.soft) continue;
        const float error = (valueOf(row, of) - row.base) - row.letBe;
        row.lambda = clampTo(row.lambda + row.k * error, row.least, row.most);
    }
    if (of.joint == nullptr) bound(of);
}

void Descent::storeImpulses() {
    const Batch& batch = m_task.batch;
    std::uint32_t at = 0;
    for (std::uint32_t j = batch.firstJoint; j < batch.endJoint; ++j) {
        const Constraint& of = m_constraints[at++];
        refresh(of);
        for (std::uint32_t i = of.firstRow; i < of.firstRow + of.rows; ++i) {
            const DescentRow& row = m_all[i];
            const float force =
                row.soft ? clampTo(row.k * (row.c - row.base), row.least, row.most) : row.lambda;
            setImpulse(m_rows.joints[j].impulses, m_parts[i], -m_h * force);
        }
    }
    for (; at < m_constraints.size(); ++at) {
        const Constraint& of = m_constraints[at];
        if (of.rows == 0) continue;
        const std::uint32_t lane = at - (batch.endJoint - batch.firstJoint);
        ContactBlock& block = m_rows.blocks[batch.firstBlock + lane / blockLanes];
        const std::uint32_t l = lane % blockLanes;
        const DescentRow* rows = &m_all[of.firstRow];
        for (std::size_t i = 0; i < 2; ++i) {
            ContactPointRows& p = block.points[i];
            p.normalImpulse[l] = -m_h * rows[2 * i + Normal0].lambda;
            p.tangentImpulse[l] = -m_h * rows[2 * i + Tangent0].lambda;
            p.maxNormalImpulse[l] = p.normalImpulse[l];
        }
        block.rollingImpulse[l] = -m_h * rows[Rolling].lambda;
    }
}

void Descent::run() {
    const Batch& batch = m_task.batch;
    const auto overPlaces = [&](auto&& f) {
        for (std::uint32_t p = batch.firstPlace; p < batch.endPlace; ++p) {
            f(p, m_rows.bodies[p], p - batch.firstPlace);
        }
    };
    // The first guess is where velocities lead without forces: for what rests, where it is. A guess
    // by the last step's impulses was tried: what iterations leave undone then feeds itself, and
    // chains and stacks explode with any penalty above m/Δt².
    overPlaces([&](std::uint32_t place, SolverBody& body, std::uint32_t at) {
        m_poses[at].by = {m_h * body.vx, m_h * body.vy, m_h * body.w};
        m_poses[at].q = rotationOf(m_poses[at].by.angle);
        accelerate(body, m_rows.sources[place], m_h);
        m_targets[at] = {m_h * body.vx, m_h * body.vy, m_h * body.w};
    });
    for (std::uint32_t i = 0; i < m_task.substeps; ++i) {
        for (std::uint32_t p = batch.firstPlace; p < batch.endPlace; ++p) moveBody(p, false);
        for (const Constraint& of : m_constraints) updateMultipliers(of);
    }
    const float rate = 1.0f / m_h;
    overPlaces([&](std::uint32_t, SolverBody& body, std::uint32_t at) {
        const Coordinates& by = m_poses[at].by;
        body.vx = rate * by.x;
        body.vy = rate * by.y;
        body.w = rate * by.angle;
    });
    storeImpulses();
    for (std::uint32_t p = batch.firstPlace; p < batch.endPlace; ++p) moveBody(p, true);
    overPlaces([&](std::uint32_t, SolverBody& body, std::uint32_t at) {
        body.dx = m_poses[at].by.x;
        body.dy = m_poses[at].by.y;
        body.dc = m_poses[at].q.c;
        body.ds = m_poses[at].q.s;
    });
    if (m_task.features.restitution) ColourSweeper(m_task, {}).sweep(restituteSweep, {});
}

}  // namespace

void solveAvbd(const BatchTask& task, const Team&) {
    Descent(task).run();
}

}  // namespace huestep
