// Rows of a step: from contacts, joints and motions before it, and back into them after it.

#include "core/math/finite.h"
#include "core/solver/soft_step.h"

namespace huestep {

namespace {

/// What padding is made of.
const Contact nothing{};

/// A point that is not there: no mass, no impulse, so every row of it does nothing.
void clearPoint(ContactPointRows& p, std::uint32_t lane) {
    p.anchorAx[lane] = p.anchorAy[lane] = p.anchorBx[lane] = p.anchorBy[lane] = 0.0f;
    p.madeSeparation[lane] = p.normalMass[lane] = p.tangentMass[lane] = 0.0f;
    p.normalImpulse[lane] = p.tangentImpulse[lane] = 0.0f;
}

float inverseOf(float k) {
    return k > 0.0f ? 1.0f / k : 0.0f;
}

}  // namespace

void SoftStep::prepareBodies(const Plan& plan, const SolverWorld& world, Range places) {
    const float h = world.stepSeconds / static_cast<float>(world.substeps);
    for (std::uint32_t place = places.begin; place < places.end; ++place) {
        const std::uint32_t body = plan.bodyOfPlace[place];
        if (body == none) {
            m_bodies[place] = {};
            m_poses[place] = {};
            m_sources[place] = {};
            continue;
        }
        const BodyMotion& motion = world.motions[body];
        const BodyInfo& info = world.bodies[body];
        SolverBody moving;
        if (info.type() != BodyType::Static) {
            moving.vx = motion.velocity.x;
            moving.vy = motion.velocity.y;
            moving.w = motion.angularVelocity;
        }
        m_bodies[place] = moving;
        m_poses[place] = {motion.position.x, motion.position.y, motion.rotation.c,
                          motion.rotation.s};
        Source source;
        source.inverseMass = info.inverseMass;
        source.inverseInertia = info.inverseInertia;
        if (info.dynamic()) {
            source.acceleration = info.gravityScale * world.gravity;
            if (!world.forces.empty()) {
                source.acceleration += info.inverseMass * world.forces[body].force;
                source.angularAcceleration = info.inverseInertia * world.forces[body].torque;
            }
            // Under a constant force a body moves with the mean of the velocities at both ends of
            // the substep. A body at rest on a contact must not: it would hover by h²g/2. Joints
            // have no such rest to lose, and a pendulum's period gets twice as exact (1.2e-4 →
            // 6e-5 at n = 4).
            if (plan.hasContact[place] == 0) source.lag = (0.5f * h) * source.acceleration;
            source.linearFactor = 1.0f / (1.0f + h * info.linearDamping);
            source.angularFactor = 1.0f / (1.0f + h * info.angularDamping);
        }
        m_sources[place] = source;
    }
}

JointRow SoftStep::jointRow(const SolverWorld& world, std::uint32_t joint,
                            const ConstraintBodies& places) const {
    const float h = world.stepSeconds / static_cast<float>(world.substeps);
    const JointInfo& info = world.joints[joint];
    const ConstraintPlaces& bodies = world.jointBodies[joint];
    JointRow row = prepareJoint(info, world.jointImpulses[joint], joint,
                                world.motions[bodies.a].pose(), world.motions[bodies.b].pose(), h);
    row.bodyA = info.kind() == JointKind::Mouse ? fixedWorld : places.a;
    row.bodyB = places.b;
    const Source& a = m_sources[static_cast<std::size_t>(readPlace(row.bodyA))];
    const Source& b = m_sources[static_cast<std::size_t>(readPlace(row.bodyB))];
    row.mA = a.inverseMass;
    row.iA = a.inverseInertia;
    row.mB = b.inverseMass;
    row.iB = b.inverseInertia;
    return row;
}

void SoftStep::prepareJoints(const Plan& plan, const SolverWorld& world, Range joints) {
    for (std::uint32_t i = joints.begin; i < joints.end; ++i) {
        m_joints[i] = jointRow(world, plan.jointOrder[i], plan.jointPlaces[i]);
    }
}

void SoftStep::preparePins(const Plan& plan, const SolverWorld& world, Range blocks) {
    for (std::uint32_t at = blocks.begin * blockLanes; at < blocks.end * blockLanes; ++at) {
        PinBlock& block = m_pins[at / blockLanes];
        const std::uint32_t joint = plan.pinOfLane[at];
        if (joint == none) {
            clearPinLane(block, at % blockLanes);
        } else {
            setPinLane(block, at % blockLanes, jointRow(world, joint, plan.pinPlaces[at]));
        }
    }
}

void SoftStep::prepareBlocks(const Plan& plan, const SolverWorld& world,
                             const ContactKernels& kernels, Range blocks,
                             ContactFeatures& features) {
    const auto isKept = [&](std::uint32_t block) {
        if (world.recycled.empty()) return false;
        for (std::uint32_t lane = 0; lane < blockLanes; ++lane) {
            const std::uint32_t contact = plan.contactOfLane[block * blockLanes + lane];
            if (contact != none && !world.recycled[contact]) return false;
        }
        return true;
    };
    for (std::uint32_t block = blocks.begin; block < blocks.end; ++block) {
        if (!isKept(block)) makeBlock(plan, world, block);
        features = features | m_blockFeatures[block];
    }
    if (blocks.begin == blocks.end) return;
    kernels.refresh(m_bodies.data(), m_poses.data(), &m_blocks[blocks.begin],
                    blocks.end - blocks.begin);
}

void SoftStep::makeBlock(const Plan& plan, const SolverWorld& world, std::uint32_t block) {
    ContactBlock& rows = m_blocks[block];
    ContactFeatures features;
    for (std::uint32_t lane = 0; lane < blockLanes; ++lane) {
        const std::uint32_t at = block * blockLanes + lane;
        const std::uint32_t place = plan.contactOfLane[at];
        // Padding reads the world and writes to nowhere.
        const Contact& contact = place == none ? nothing : world.contacts[place];
        makeLane(contact, plan.lanePlaces[at], rows, lane);
        features.friction |= contact.friction > 0.0f;
        features.restitution |= contact.restitution > 0.0f;
        features.tangentSpeed |= contact.tangentSpeed != 0.0f;
        features.rolling |= contact.rollingResistance > 0.0f;
    }
    m_blockFeatures[block] = features;
}

void SoftStep::makeLane(const Contact& contact, const ConstraintBodies& places, ContactBlock& rows,
                        std::uint32_t lane) const {
    const Source& a = m_sources[static_cast<std::size_t>(readPlace(places.a))];
    const Source& b = m_sources[static_cast<std::size_t>(readPlace(places.b))];
    const float mA = a.inverseMass, iA = a.inverseInertia;
    const float mB = b.inverseMass, iB = b.inverseInertia;
    const Vec2 n = contact.normal;
    rows.bodyA[lane] = places.a;
    rows.bodyB[lane] = places.b;
    rows.inverseMassA[lane] = mA;
    rows.inverseInertiaA[lane] = iA;
    rows.inverseMassB[lane] = mB;
    rows.inverseInertiaB[lane] = iB;
    rows.normalX[lane] = n.x;
    rows.normalY[lane] = n.y;
    rows.cosineA[lane] = contact.rotationA.c;
    rows.sineA[lane] = contact.rotationA.s;
    rows.cosineB[lane] = contact.rotationB.c;
    rows.sineB[lane] = contact.rotationB.s;
    rows.friction[lane] = contact.friction;
    rows.restitution[lane] = contact.restitution;
    rows.tangentSpeed[lane] = contact.tangentSpeed;
    rows.rollingResistance[lane] = contact.rollingResistance;
    rows.rollingMass[lane] = inverseOf(iA + iB);
    rows.rollingImpulse[lane] = contact.state.rollingImpulse;
    for (std::size_t i = 0; i < 2; ++i) {
        ContactPointRows& p = rows.points[i];
        if (i >= contact.pointCount) {
            clearPoint(p, lane);
            continue;
        }
        const Vec2 rA = contact.anchorA[i];
        const Vec2 rB = contact.anchorB[i];
        p.anchorAx[lane] = rA.x;
        p.anchorAy[lane] = rA.y;
        p.anchorBx[lane] = rB.x;
        p.anchorBy[lane] = rB.y;
        p.madeSeparation[lane] = contact.separation[i];
        const float rnA = cross(rA, n), rnB = cross(rB, n);
        const float rtA = dot(rA, n), rtB = dot(rB, n);  // r × t = −r·n for t = (ny, −nx)
        p.normalMass[lane] = inverseOf(mA + mB + iA * rnA * rnA + iB * rnB * rnB);
        p.tangentMass[lane] = inverseOf(mA + mB + iA * rtA * rtA + iB * rtB * rtB);
        p.normalImpulse[lane] = contact.state.normalImpulse[i];
        p.tangentImpulse[lane] = contact.state.tangentImpulse[i];
    }
}

void SoftStep::storeBlocks(const Plan& plan, const SolverWorld& world, Range blocks,
                           std::vector<ContactHit>& hits) {
    for (std::uint32_t at = blocks.begin * blockLanes; at < blocks.end * blockLanes; ++at) {
        const std::uint32_t place = plan.contactOfLane[at];
        if (place == none) continue;
        ContactBlock& rows = m_blocks[at / blockLanes];
        const std::uint32_t lane = at % blockLanes;
        Contact& contact = world.contacts[place];
        // Rows that stay go on from what the state holds, to the bit.
        const auto settled = [lane](ContactBlock::Row& row) {
            return row[lane] = finiteOrZero(row[lane]);
        };
        contact.state.rollingImpulse = settled(rows.rollingImpulse);
        ContactHit hit;
        for (std::size_t i = 0; i < contact.pointCount; ++i) {
            ContactPointRows& p = rows.points[i];
            contact.state.normalImpulse[i] = settled(p.normalImpulse);
            contact.state.tangentImpulse[i] = settled(p.tangentImpulse);
            const float approach = -p.approach[lane];
            if (!(p.maxNormalImpulse[lane] > 0.0f && approach > hitSpeed)) continue;
            if (!(approach > hit.approach)) continue;
            hit.shapeA = contact.state.shapeA;
            hit.shapeB = contact.state.shapeB;
            hit.point = world.motions[contact.bodyA].position + contact.anchorA[i];
            hit.normal = contact.normal;
            hit.approach = approach;
        }
        if (hit.approach > 0.0f) hits.push_back(hit);
    }
}

void SoftStep::storeJoints(const SolverWorld& world, Range joints) const {
    for (std::uint32_t i = joints.begin; i < joints.end; ++i) {
        world.jointImpulses[m_joints[i].joint] = storedImpulses(m_joints[i]);
    }
}

void SoftStep::storePins(const Plan& plan, const SolverWorld& world, Range blocks) const {
    for (std::uint32_t at = blocks.begin * blockLanes; at < blocks.end * blockLanes; ++at) {
        const std::uint32_t joint = plan.pinOfLane[at];
        if (joint == none) continue;
        const PinBlock& block = m_pins[at / blockLanes];
        world.jointImpulses[joint].point = {finiteOrZero(block.impulseX[at % blockLanes]),
                                            finiteOrZero(block.impulseY[at % blockLanes])};
    }
}

}  // namespace huestep
