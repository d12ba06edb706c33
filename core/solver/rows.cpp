// Rows of a step: from contacts, joints and motions before it, and back into them after it.

#include <algorithm>
#include <array>

#include "core/math/finite.h"
#include "core/solver/body_lanes.h"
#include "core/solver/contact_kernels.h"
#include "core/solver/soft_step.h"

namespace huestep {

namespace {

/// What padding is made of: no mass and no point, so every row of it does nothing.
const Contact nothing{};

/// Writes 16 records side by side: row k of `rows` gets float k of each.
void transpose(const std::array<const float*, blockLanes>& records, std::size_t floats,
               float* rows) {
    for (std::size_t lane = 0; lane < blockLanes; lane += 4) {
        for (std::size_t field = 0; field < floats; field += 4) {
            // The last four may overlap those before.
            const std::size_t at = std::min(field, floats - 4);
            F4 c0, c1, c2, c3;
            transpose4(records[lane] + at, records[lane + 1] + at, records[lane + 2] + at,
                       records[lane + 3] + at, c0, c1, c2, c3);
            float* to = rows + at * blockLanes + lane;
            storeLanes<4>(to, c0);
            storeLanes<4>(to + blockLanes, c1);
            storeLanes<4>(to + 2 * blockLanes, c2);
            storeLanes<4>(to + 3 * blockLanes, c3);
        }
    }
}

template <template <class> class Fields>
float* rowsOf(Fields<LaneRow>& fields) {
    static_assert(sizeof(Fields<LaneRow>) == sizeof(Fields<float>) * blockLanes);
    return reinterpret_cast<float*>(&fields);
}

/// The block as the transpose of its contacts' records.
template <template <class> class Fields, class Of>
void transposeFields(const std::array<const Contact*, blockLanes>& contacts, Fields<LaneRow>& rows,
                     Of&& fieldsOf) {
    std::array<const float*, blockLanes> records{};
    for (std::size_t lane = 0; lane < blockLanes; ++lane) {
        const Fields<float>& record = fieldsOf(*contacts[lane]);
        records[lane] = reinterpret_cast<const float*>(&record);
    }
    transpose(records, sizeof(Fields<float>) / sizeof(float), rowsOf<Fields>(rows));
}

/// The place of a body whose warm start a later substep has to repeat; of any other one that is
/// read and not written.
BodyPlace warmPlace(const Plan& plan, BodyPlace place) {
    return place < 0 || plan.hasJoint[static_cast<std::size_t>(place)] != 0 ? place : ~place;
}

/// One lane of it.
template <template <class> class Fields>
void writeLane(const Fields<float>& record, Fields<LaneRow>& rows, std::uint32_t lane) {
    const float* from = reinterpret_cast<const float*>(&record);
    float* to = rowsOf<Fields>(rows) + lane;
    for (std::size_t k = 0; k < sizeof(record) / sizeof(float); ++k) to[k * blockLanes] = from[k];
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
        moving.inverseMass = info.inverseMass;
        m_bodies[place] = moving;
        m_poses[place] = {motion.position.x, motion.position.y, motion.rotation.c,
                          motion.rotation.s};
        Source source;
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
            source.carries = plan.hasJoint[place] == 0;
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
    const auto a = static_cast<std::size_t>(readPlace(row.bodyA));
    const auto b = static_cast<std::size_t>(readPlace(row.bodyB));
    row.mA = m_bodies[a].inverseMass;
    row.iA = m_sources[a].inverseInertia;
    row.mB = m_bodies[b].inverseMass;
    row.iB = m_sources[b].inverseInertia;
    return row;
}

void SoftStep::prepareJoints(const Plan& plan, const SolverWorld& world, Range joints) {
    for (std::uint32_t i = joints.begin; i < joints.end; ++i) {
        m_joints[i] = jointRow(world, plan.jointOrder[i], plan.jointPlaces[i]);
    }
}

void SoftStep::prepareRevolutes(const Plan& plan, const SolverWorld& world, Range blocks) {
    for (std::uint32_t index = blocks.begin; index < blocks.end; ++index) {
        RevoluteBlock& block = m_revolutes[index];
        for (std::uint32_t lane = 0; lane < blockLanes; ++lane) {
            const std::uint32_t at = index * blockLanes + lane;
            const std::uint32_t joint = plan.revoluteOfLane[at];
            if (joint == none) {
                clearRevoluteLane(block, lane);
            } else {
                setRevoluteLane(block, lane, jointRow(world, joint, plan.revolutePlaces[at]));
            }
        }
        findParts(block);
    }
}

void SoftStep::prefetchContacts(const Plan& plan, const SolverWorld& world, std::uint32_t block) {
    for (std::uint32_t at = block * blockLanes; at < (block + 1) * blockLanes; ++at) {
        const std::uint32_t place = plan.contactOfLane[at];
        if (place != none) prefetch(world.contacts[place]);
    }
}

void SoftStep::prepareBlocks(const Plan& plan, const SolverWorld& world,
                             const ContactKernels& kernels, Range blocks,
                             ContactFeatures& features) {
    for (std::uint32_t block = blocks.begin; block < blocks.end; ++block) {
        if (!world.rowsHold) {
            // Contacts lie anywhere: those of the next block are on their way while this is made.
            if (block + 1 < blocks.end) prefetchContacts(plan, world, block + 1);
            makeBlock(plan, world, block);
        }
        m_blocks[block].shares = 0;
        features = features | m_blockFeatures[block];
    }
    if (blocks.begin == blocks.end) return;
    kernels.refresh(m_bodies.data(), m_poses.data(), &m_blocks[blocks.begin],
                    blocks.end - blocks.begin);
}

void SoftStep::makeBlock(const Plan& plan, const SolverWorld& world, std::uint32_t block) {
    ContactBlock& rows = m_blocks[block];
    ContactFeatures features;
    bool anyWarm = false;
    std::array<const Contact*, blockLanes> contacts{};
    for (std::uint32_t lane = 0; lane < blockLanes; ++lane) {
        const std::uint32_t at = block * blockLanes + lane;
        const std::uint32_t place = plan.contactOfLane[at];
        // Padding reads the world and writes to nowhere.
        const Contact& contact = place == none ? nothing : world.contacts[place];
        contacts[lane] = &contact;
        const ConstraintBodies bodies = plan.lanePlaces[at];
        rows.bodyA[lane] = bodies.a;
        rows.bodyB[lane] = bodies.b;
        rows.warmA[lane] = warmPlace(plan, bodies.a);
        rows.warmB[lane] = warmPlace(plan, bodies.b);
        anyWarm = anyWarm || rows.warmA[lane] >= 0 || rows.warmB[lane] >= 0;
        rows.motionA[lane] = static_cast<std::int32_t>(contact.bodyA);
        rows.motionB[lane] = static_cast<std::int32_t>(contact.bodyB);
        rows.boundsA[lane] = static_cast<std::int32_t>(contact.placeA);
        rows.boundsB[lane] = static_cast<std::int32_t>(contact.placeB);
        features.friction |= contact.row.friction > 0.0f;
        features.restitution |= contact.row.restitution > 0.0f;
        features.tangentSpeed |= contact.row.tangentSpeed != 0.0f;
        features.rolling |= contact.row.rollingResistance > 0.0f;
    }
    transposeFields<ContactFields>(
        contacts, rows, [](const Contact& c) -> auto& { return c.row; });
    for (std::size_t i = 0; i < 2; ++i) {
        transposeFields<ContactPointFields>(
            contacts, rows.points[i], [i](const Contact& c) -> auto& { return c.points[i]; });
    }
    rows.anyWarm = anyWarm ? -1 : 0;
    m_blockFeatures[block] = features;
}

void SoftStep::writeRow(std::uint32_t lane, const Contact& contact) {
    ContactBlock& rows = m_blocks[lane / blockLanes];
    writeLane<ContactFields>(contact.row, rows, lane % blockLanes);
    for (std::size_t i = 0; i < 2; ++i) {
        writeLane<ContactPointFields>(contact.points[i], rows.points[i], lane % blockLanes);
    }
}

void SoftStep::check(std::span<const BodyMotion> motions, std::span<const Bounds> bounds, Simd simd,
                     Range blocks) {
    contactKernels(simd).check(motions.data(), bounds.data(), &m_blocks[blocks.begin],
                               blocks.end - blocks.begin);
}

std::uint64_t SoftStep::bytes() const {
    const auto of = [](const auto& rows) { return rows.size() * sizeof(rows[0]); };
    return of(m_bodies) + of(m_poses) + of(m_sources) + of(m_blocks) + of(m_joints) +
           of(m_revolutes);
}

bool SoftStep::allKept(std::uint32_t block) const {
    std::int32_t all = -1;
    for (const std::int32_t kept : m_blocks[block].kept) all &= kept;
    return all != 0;
}

/// Rows go on from what the state holds, to the bit: settled impulses are both.
void SoftStep::settleBlocks(const Plan& plan, const SolverWorld& world,
                            const ContactKernels& kernels, Range blocks,
                            std::vector<ContactHit>& hits) {
    if (blocks.begin == blocks.end) return;
    if (!kernels.settle(&m_blocks[blocks.begin], blocks.end - blocks.begin)) return;
    for (std::uint32_t at = blocks.begin * blockLanes; at < blocks.end * blockLanes; ++at) {
        const std::uint32_t place = plan.contactOfLane[at];
        const ContactBlock& rows = m_blocks[at / blockLanes];
        const std::uint32_t lane = at % blockLanes;
        if (place == none || rows.hit[lane] == 0) continue;
        const Contact& contact = world.contacts[place];
        ContactHit hit;
        for (std::size_t i = 0; i < contact.pointCount; ++i) {
            const ContactPointRows& p = rows.points[i];
            const float approach = -p.approach[lane];
            if (!(p.maxNormalImpulse[lane] > 0.0f && approach > hitSpeed)) continue;
            if (!(approach > hit.approach)) continue;
            hit.shapeA = world.shapes[contact.placeA].id;
            hit.shapeB = world.shapes[contact.placeB].id;
            hit.point = world.motions[contact.bodyA].position + contact.anchorA(i);
            hit.normal = contact.normal();
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

void SoftStep::storeRevolutes(const Plan& plan, const SolverWorld& world, Range blocks) const {
    for (std::uint32_t at = blocks.begin * blockLanes; at < blocks.end * blockLanes; ++at) {
        const std::uint32_t joint = plan.revoluteOfLane[at];
        if (joint == none) continue;
        world.jointImpulses[joint] = storedImpulses(m_revolutes[at / blockLanes], at % blockLanes);
    }
}

}  // namespace huestep
