// Rows of a step: from contacts, joints and motions before it, and back into them after it.

#include "core/solver/rows.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/math/finite.h"
#include "core/solver/body_lanes.h"
#include "core/solver/contact_kernels.h"
#include "core/solver/effort.h"

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

/// Whether an island is small enough for more than the standard effort.
bool mayTakeMore(const Plan& plan, const ConstraintBodies& places) {
    const auto place = static_cast<std::size_t>(places.b >= 0 ? places.b : readPlace(places.a));
    const std::uint32_t island = plan.islandOf[plan.bodyOfPlace[place]];
    return affordableEffort(plan.constraintsOf[island]) > standardEffort;
}

/// What impulses of substeps of one level are in those of another: exact, a power of two.
float impulseScale(std::uint8_t from, std::uint8_t to) {
    return static_cast<float>(substepsOf(from)) / static_cast<float>(substepsOf(to));
}

/// One lane of it.
template <template <class> class Fields>
void writeLane(const Fields<float>& record, Fields<LaneRow>& rows, std::uint32_t lane) {
    const float* from = reinterpret_cast<const float*>(&record);
    float* to = rowsOf<Fields>(rows) + lane;
    for (std::size_t k = 0; k < sizeof(record) / sizeof(float); ++k) to[k * blockLanes] = from[k];
}

}  // namespace

void Rows::fit(const Plan& plan) {
    bodies.resize(plan.bodyOfPlace.size());
    poses.resize(plan.bodyOfPlace.size());
    sources.resize(plan.bodyOfPlace.size());
    pushed.resize(plan.bodyOfPlace.size());
    joints.resize(plan.jointOrder.size());
    revolutes.resize(plan.revoluteOfLane.size() / blockLanes);
    blocks.resize(plan.contactOfLane.size() / blockLanes);
    blockFeatures.resize(blocks.size());
    trees.resize(std::max(trees.size(), plan.batches.size()));
    bodies[0] = {};
    poses[0] = {};
    sources[0] = {};
}

void Rows::prepareBodies(const Plan& plan, const SolverWorld& world, float h, Range places) {
    for (std::uint32_t place = places.begin; place < places.end; ++place) {
        const std::uint32_t body = plan.bodyOfPlace[place];
        const BodyMotion& motion = world.motions[body];
        const BodyInfo& info = world.bodies[body];
        SolverBody moving;
        if (info.type() != BodyType::Static) {
            moving.vx = motion.velocity.x;
            moving.vy = motion.velocity.y;
            moving.w = motion.angularVelocity;
        }
        moving.inverseMass = info.inverseMass;
        bodies[place] = moving;
        poses[place] = {motion.position.x, motion.position.y, motion.rotation.c, motion.rotation.s};
        BodySource source;
        source.inverseInertia = info.inverseInertia;
        source.effort = levelOf(motion.effort);
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
            if (!source.carries && plan.hasContact[place] == 0)
                source.lag = (0.5f * h) * source.acceleration;
            source.linearFactor = 1.0f / (1.0f + h * info.linearDamping);
            source.angularFactor = 1.0f / (1.0f + h * info.angularDamping);
        }
        sources[place] = source;
    }
}

/// The level that a constraint's impulses are of: that of whichever body moves; both had the same
/// when they were solved.
std::uint8_t Rows::effortOf(const ConstraintBodies& places) const {
    return sources[static_cast<std::size_t>(places.b >= 0 ? places.b : readPlace(places.a))].effort;
}

JointRow Rows::jointRow(const SolverWorld& world, const Batch& batch, std::uint32_t joint,
                        const ConstraintBodies& places, float h) const {
    const JointInfo& info = world.joints[joint];
    const ConstraintPlaces& of = world.jointBodies[joint];
    JointRow row = prepareJoint(info, world.jointImpulses[joint], joint, world.motions[of.a].pose(),
                                world.motions[of.b].pose(), h);
    row.bodyA = info.kind() == JointKind::Mouse ? fixedWorld : places.a;
    row.bodyB = places.b;
    const auto a = static_cast<std::size_t>(readPlace(row.bodyA));
    const auto b = static_cast<std::size_t>(readPlace(row.bodyB));
    row.mA = bodies[a].inverseMass;
    row.iA = sources[a].inverseInertia;
    row.mB = bodies[b].inverseMass;
    row.iB = sources[b].inverseInertia;
    if (world.planned) {
        scale(row.impulses, impulseScale(effortOf({row.bodyA, row.bodyB}), batch.effort));
        row.allowance = 1.0f / allowedError(world.need.joint, world.reach[of.a], world.reach[of.b]);
    }
    return row;
}

void Rows::prepareJoints(const Plan& plan, const SolverWorld& world, const Batch& batch, float h,
                         Range range) {
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        joints[i] = jointRow(world, batch, plan.jointOrder[i], plan.jointPlaces[i], h);
    }
}

void Rows::prepareRevolutes(const Plan& plan, const SolverWorld& world, const Batch& batch, float h,
                            Range range) {
    for (std::uint32_t index = range.begin; index < range.end; ++index) {
        RevoluteBlock& block = revolutes[index];
        for (std::uint32_t lane = 0; lane < blockLanes; ++lane) {
            const std::uint32_t at = index * blockLanes + lane;
            const std::uint32_t joint = plan.revoluteOfLane[at];
            if (joint == none) {
                clearRevoluteLane(block, lane);
            } else {
                setRevoluteLane(block, lane,
                                jointRow(world, batch, joint, plan.revolutePlaces[at], h));
            }
        }
        findParts(block);
    }
}

void Rows::prefetchContacts(const Plan& plan, const SolverWorld& world, std::uint32_t block) {
    for (std::uint32_t at = block * blockLanes; at < (block + 1) * blockLanes; ++at) {
        const std::uint32_t place = plan.contactOfLane[at];
        if (place != none) prefetch(world.contacts[place]);
    }
}

void Rows::prepareContacts(const Plan& plan, const SolverWorld& world, const Batch& batch,
                           const ContactKernels& kernels, Range range, ContactFeatures& features) {
    for (std::uint32_t block = range.begin; block < range.end; ++block) {
        if (!world.rowsHold) {
            // Contacts lie anywhere: those of the next block are on their way while this is made.
            if (block + 1 < range.end) prefetchContacts(plan, world, block + 1);
            makeBlock(plan, world, block);
            if (world.planned) fitToEffort(plan, world, batch, block);
        }
        blocks[block].shares = 0;
        features = features | blockFeatures[block];
    }
    if (range.begin == range.end) return;
    kernels.refresh(bodies.data(), poses.data(), &blocks[range.begin], range.end - range.begin);
}

void Rows::makeBlock(const Plan& plan, const SolverWorld& world, std::uint32_t block) {
    ContactBlock& rows = blocks[block];
    ContactFeatures features;
    bool anyWarm = false;
    rows.anyCold = 0;
    std::array<const Contact*, blockLanes> contacts{};
    for (std::uint32_t lane = 0; lane < blockLanes; ++lane) {
        const std::uint32_t at = block * blockLanes + lane;
        const std::uint32_t place = plan.contactOfLane[at];
        // Padding reads the world and writes to nowhere.
        const Contact& contact = place == none ? nothing : world.contacts[place];
        contacts[lane] = &contact;
        const ConstraintBodies places = plan.lanePlaces[at];
        rows.bodyA[lane] = places.a;
        rows.bodyB[lane] = places.b;
        rows.warmA[lane] = warmPlace(plan, places.a);
        rows.warmB[lane] = warmPlace(plan, places.b);
        anyWarm = anyWarm || rows.warmA[lane] >= 0 || rows.warmB[lane] >= 0;
        rows.motionA[lane] = static_cast<std::int32_t>(contact.bodyA);
        rows.motionB[lane] = static_cast<std::int32_t>(contact.bodyB);
        rows.boundsA[lane] = static_cast<std::int32_t>(contact.placeA);
        rows.boundsB[lane] = static_cast<std::int32_t>(contact.placeB);
        rows.cold[lane] = contact.began != 0 && mayTakeMore(plan, places) ? -1 : 0;
        rows.anyCold |= rows.cold[lane];
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
    features.cold = rows.anyCold != 0;
    blockFeatures[block] = features;
}

/// Brings impulses of another level to this one, and says how far each lane may be off.
void Rows::fitToEffort(const Plan& plan, const SolverWorld& world, const Batch& batch,
                       std::uint32_t block) {
    ContactBlock& rows = blocks[block];
    for (std::uint32_t lane = 0; lane < blockLanes; ++lane) {
        const std::uint32_t at = block * blockLanes + lane;
        rows.allowance[lane] = 0.0f;
        if (plan.contactOfLane[at] == none) continue;
        const ConstraintBodies places{rows.bodyA[lane], rows.bodyB[lane]};
        const std::uint8_t made = effortOf(places);
        if (made != batch.effort) scaleLane(rows, lane, impulseScale(made, batch.effort));
        const auto bodyA = static_cast<std::size_t>(rows.motionA[lane]);
        const auto bodyB = static_cast<std::size_t>(rows.motionB[lane]);
        const float most =
            allowedError(world.need.penetration, world.reach[bodyA], world.reach[bodyB]);
        // Rows against fixed bodies have twice the frequency.
        const bool fixed = places.a < 0 || places.b < 0;
        rows.allowance[lane] = (fixed ? 0.25f : 1.0f) / most;
    }
}

void Rows::writeRow(std::uint32_t lane, const Contact& contact) {
    ContactBlock& rows = blocks[lane / blockLanes];
    writeLane<ContactFields>(contact.row, rows, lane % blockLanes);
    for (std::size_t i = 0; i < 2; ++i) {
        writeLane<ContactPointFields>(contact.points[i], rows.points[i], lane % blockLanes);
    }
}

void Rows::storeImpulses(std::uint32_t block, std::span<const std::uint32_t> recordOfLane,
                         std::span<ContactState> records) const {
    static_assert(offsetof(ContactState, tangentImpulse) ==
                  offsetof(ContactState, normalImpulse) + 2 * sizeof(float));
    const ContactBlock& rows = blocks[block];
    ContactState nowhere{};
    for (std::uint32_t lane = 0; lane < blockLanes; lane += 4) {
        std::array<F4, 4> of;
        transpose4(rows.points[0].normalImpulse + lane, rows.points[1].normalImpulse + lane,
                   rows.points[0].tangentImpulse + lane, rows.points[1].tangentImpulse + lane,
                   of[0], of[1], of[2], of[3]);
        for (std::uint32_t k = 0; k < 4; ++k) {
            const std::uint32_t record = recordOfLane[lane + k];
            ContactState& to = record == none ? nowhere : records[record];
            // Both pairs lie side by side: one store.
            storeLanes<4>(reinterpret_cast<float*>(&to) +
                              offsetof(ContactState, normalImpulse) / sizeof(float),
                          of[k]);
            to.rollingImpulse = rows.rollingImpulse[lane + k];
        }
    }
}

void Rows::check(std::span<const BodyMotion> motions, std::span<const Bounds> bounds, Simd simd,
                 Range range) {
    contactKernels(simd).check(motions.data(), bounds.data(), &blocks[range.begin],
                               range.end - range.begin);
}

std::uint64_t Rows::bytes() const {
    const auto of = [](const auto& array) { return array.size() * sizeof(array[0]); };
    return of(bodies) + of(poses) + of(pushed) + of(sources) + of(blocks) + of(blockFeatures) +
           of(joints) + of(revolutes) + of(memory.changes) + of(memory.shares) + of(memory.locks);
}

bool Rows::allKept(std::uint32_t block) const {
    std::int32_t all = -1;
    for (const std::int32_t kept : blocks[block].kept) all &= kept;
    return all != 0;
}

/// Rows go on from what the state holds, to the bit: settled impulses are both.
void Rows::settleContacts(const Plan& plan, const SolverWorld& world, const ContactKernels& kernels,
                          Range range, std::vector<ContactHit>& hits) {
    if (range.begin == range.end) return;
    for (std::uint32_t block = range.begin; block < range.end; ++block) {
        if (blocks[block].anyCold == 0) continue;
        std::fill_n(blocks[block].cold, blockLanes, 0);
        blocks[block].anyCold = 0;
        blockFeatures[block].cold = false;
    }
    bool anyHit = false;
    for (std::uint32_t block = range.begin; block < range.end; ++block) {
        if (world.planned) kernels.strain(&blocks[block], 1);
        anyHit = kernels.settle(&blocks[block], 1) || anyHit;
    }
    if (!anyHit) return;
    for (std::uint32_t at = range.begin * blockLanes; at < range.end * blockLanes; ++at) {
        const std::uint32_t place = plan.contactOfLane[at];
        const ContactBlock& rows = blocks[at / blockLanes];
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

void Rows::storeJoints(const SolverWorld& world, Range range) {
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        if (world.planned) joints[i].strain = strainOf(joints[i]);
        world.jointImpulses[joints[i].joint] = storedImpulses(joints[i]);
    }
}

void Rows::storeRevolutes(const Plan& plan, const SolverWorld& world,
                          const RevoluteKernels& kernels, Range range) {
    if (world.planned && range.begin < range.end) {
        kernels.strain(bodies.data(), &revolutes[range.begin], range.end - range.begin);
    }
    for (std::uint32_t at = range.begin * blockLanes; at < range.end * blockLanes; ++at) {
        const std::uint32_t joint = plan.revoluteOfLane[at];
        if (joint == none) continue;
        world.jointImpulses[joint] = storedImpulses(revolutes[at / blockLanes], at % blockLanes);
    }
}

}  // namespace huestep
