#include "core/solver/soft_step.h"

#include <algorithm>

#include "core/math/finite.h"
#include "core/math/trig.h"
#include "core/solver/contact_kernels.h"

namespace huestep {

namespace {

// Frequencies follow the substep; at n = 4 and 60 Hz they are the 30 and 60 Hz that the field has
// settled on (physics page, 2 and "Starting point"). Damping of joints by measurement: with 2 a
// pendulum loses 0.34 % of its energy in 10 s, with 1 it loses 0.16 %.
constexpr float contactFrequency = 0.125f;  // of the substep rate
constexpr float jointFrequency = 0.25f;
constexpr float contactDamping = 10.0f;
constexpr float jointDamping = 1.0f;
constexpr float pushSpeed = 3.0f;  // m/s

constexpr std::uint32_t bodyGrain = 256;
constexpr std::uint32_t blockGrain = 16;
constexpr std::uint32_t jointGrain = 128;

/// Calls f(begin, end) over blocks of the range: in the caller, or on the team.
template <class F>
void overRange(Executor* executor, std::uint32_t count, std::uint32_t grain, F&& f) {
    if (executor != nullptr && executor->threads() > 1) {
        executor->forBlocks(count, grain, f);
    } else if (count > 0) {
        f(0u, count);
    }
}

/// A point that is not there: no mass, no impulse, so every row of it does nothing.
void clearPoint(ContactPointRows& p, std::uint32_t lane) {
    p.anchorAx[lane] = p.anchorAy[lane] = p.anchorBx[lane] = p.anchorBy[lane] = 0.0f;
    p.separation[lane] = p.normalMass[lane] = p.tangentMass[lane] = 0.0f;
    p.normalImpulse[lane] = p.tangentImpulse[lane] = 0.0f;
    p.maxNormalImpulse[lane] = p.approach[lane] = 0.0f;
}

/// Padding: it reads the fixed world and writes to nowhere.
void clearLane(ContactBlock& rows, std::uint32_t lane) {
    clearPoint(rows.points[0], lane);
    clearPoint(rows.points[1], lane);
    rows.rollingMass[lane] = rows.rollingImpulse[lane] = 0.0f;
}

ContactFeatures operator|(ContactFeatures a, ContactFeatures b) {
    return {a.friction || b.friction, a.rolling || b.rolling, a.tangentSpeed || b.tangentSpeed,
            a.restitution || b.restitution};
}

/// A place for the findings of each block of a range, so that none waits for another.
template <class T>
std::vector<T> perBlock(std::uint32_t count, std::uint32_t grain) {
    return std::vector<T>((count + grain - 1) / grain);
}

/// Worker's share of [begin, end): contiguous, sizes differing by at most one.
struct Share {
    std::uint32_t begin, end;
    Share(std::uint32_t count, int worker, int workers) {
        const auto w = static_cast<std::uint64_t>(worker);
        const auto n = static_cast<std::uint64_t>(workers);
        begin = static_cast<std::uint32_t>(count * w / n);
        end = static_cast<std::uint32_t>(count * (w + 1) / n);
    }
};

}  // namespace

/// Constants of all passes of one step.
struct SoftStep::Pass {
    const ContactKernels& kernels;
    const ContactKernels& serial;
    float h;
    std::uint32_t substeps;
    ContactPass moving;  // between two bodies that move
    ContactPass fixed;   // against a body that does not
    JointPass joint;
};

void SoftStep::prepareBody(const Plan& plan, const SolverWorld& world, std::uint32_t place) {
    if (place == 0) {
        m_bodies[0] = {};
        m_drives[0] = {};
        return;
    }
    const std::uint32_t body = plan.bodyOfPlace[place];
    const BodyMotion& motion = world.motions[body];
    const BodyInfo& info = world.bodies[body];
    SolverBody s;
    s.vx = motion.velocity.x;
    s.vy = motion.velocity.y;
    s.w = motion.angularVelocity;
    m_bodies[place] = s;
    Drive drive;
    if (info.dynamic()) {
        const float h = world.stepSeconds / static_cast<float>(world.substeps);
        drive.acceleration = info.gravityScale * world.gravity;
        if (!world.forces.empty()) {
            drive.acceleration += info.inverseMass * world.forces[body].force;
            drive.angular = info.inverseInertia * world.forces[body].torque;
        }
        // Under a constant force a body moves with the mean of the velocities at both ends of the
        // substep. A body at rest on a contact must not: it would hover by h²g/2. Joints have no
        // such rest to lose, and a pendulum's period gets twice as exact (1.2e-4 → 6e-5 at n = 4).
        if (plan.hasContact[place] == 0) drive.lag = (0.5f * h) * drive.acceleration;
        drive.linearFactor = 1.0f / (1.0f + h * info.linearDamping);
        drive.angularFactor = 1.0f / (1.0f + h * info.angularDamping);
    }
    m_drives[place] = drive;
}

void SoftStep::prepareBlock(const Plan& plan, const SolverWorld& world, std::uint32_t block,
                            ContactFeatures& features) {
    ContactBlock& rows = m_blocks[block];
    for (std::uint32_t lane = 0; lane < blockLanes; ++lane) {
        const std::uint32_t at = block * blockLanes + lane;
        const std::uint32_t place = plan.contactOfLane[at];
        rows.bodyA[lane] = plan.lanePlaces[at].a;
        rows.bodyB[lane] = plan.lanePlaces[at].b;
        if (place == none) {
            clearLane(rows, lane);
            continue;
        }
        const Contact& contact = world.contacts[place];
        const BodyInfo& a = world.bodies[contact.bodyA];
        const BodyInfo& b = world.bodies[contact.bodyB];
        const BodyMotion& motionA = world.motions[contact.bodyA];
        const BodyMotion& motionB = world.motions[contact.bodyB];
        const float mA = a.inverseMass, iA = a.inverseInertia;
        const float mB = b.inverseMass, iB = b.inverseInertia;
        rows.inverseMassA[lane] = mA;
        rows.inverseInertiaA[lane] = iA;
        rows.inverseMassB[lane] = mB;
        rows.inverseInertiaB[lane] = iB;
        const Vec2 n = contact.normal;
        rows.normalX[lane] = n.x;
        rows.normalY[lane] = n.y;
        rows.friction[lane] = contact.friction;
        rows.restitution[lane] = contact.restitution;
        rows.tangentSpeed[lane] = contact.tangentSpeed;
        rows.rollingResistance[lane] = contact.rollingResistance;
        rows.rollingMass[lane] = iA + iB > 0.0f ? 1.0f / (iA + iB) : 0.0f;
        rows.rollingImpulse[lane] = contact.state.rollingImpulse;
        features.friction |= contact.friction > 0.0f;
        features.restitution |= contact.restitution > 0.0f;
        features.tangentSpeed |= contact.tangentSpeed != 0.0f;
        features.rolling |= contact.rollingResistance > 0.0f;
        const Vec2 centers = motionB.position - motionA.position;
        const Rotation turnedA = relative(contact.rotationA, motionA.rotation);
        const Rotation turnedB = relative(contact.rotationB, motionB.rotation);
        const auto points = static_cast<std::size_t>(contact.pointCount);
        for (std::size_t i = 0; i < 2; ++i) {
            ContactPointRows& p = rows.points[i];
            if (i >= points) {
                clearPoint(p, lane);
                continue;
            }
            const Vec2 rA = contact.anchorA[i];
            const Vec2 rB = contact.anchorB[i];
            p.anchorAx[lane] = rA.x;
            p.anchorAy[lane] = rA.y;
            p.anchorBx[lane] = rB.x;
            p.anchorBy[lane] = rB.y;
            // How far the anchors have come apart since the manifold was made, when they met; the
            // pass adds n·(rB − rA) and how they move from here on.
            const Vec2 apart = centers + (rotate(turnedB, rB) - rotate(turnedA, rA));
            p.separation[lane] = contact.separation[i] + dot(n, apart) - dot(n, rB - rA);
            const float rnA = cross(rA, n), rnB = cross(rB, n);
            const float rtA = dot(rA, n), rtB = dot(rB, n);  // rA × t = −rA·n for t = (ny, −nx)
            const float kn = mA + mB + iA * rnA * rnA + iB * rnB * rnB;
            const float kt = mA + mB + iA * rtA * rtA + iB * rtB * rtB;
            p.normalMass[lane] = kn > 0.0f ? 1.0f / kn : 0.0f;
            p.tangentMass[lane] = kt > 0.0f ? 1.0f / kt : 0.0f;
            p.normalImpulse[lane] = contact.state.normalImpulse[i];
            p.tangentImpulse[lane] = contact.state.tangentImpulse[i];
            p.maxNormalImpulse[lane] = 0.0f;
            const Vec2 dv = (motionB.velocity + crossScalar(motionB.angularVelocity, rB)) -
                            (motionA.velocity + crossScalar(motionA.angularVelocity, rA));
            p.approach[lane] = dot(dv, n);
        }
    }
}

void SoftStep::prepare(const Plan& plan, const SolverWorld& world, Executor* executor) {
    const auto places = static_cast<std::uint32_t>(plan.bodyOfPlace.size());
    m_bodies.resize(places);
    m_drives.resize(places);
    overRange(executor, places, bodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) prepareBody(plan, world, i);
    });

    m_joints.resize(plan.jointOrder.size());
    overRange(
        executor, static_cast<std::uint32_t>(m_joints.size()), jointGrain,
        [&](std::uint32_t begin, std::uint32_t end) { prepareJoints(plan, world, begin, end); });

    const auto blocks = static_cast<std::uint32_t>(plan.contactOfLane.size() / blockLanes);
    m_blocks.resize(blocks);
    auto found = perBlock<ContactFeatures>(blocks, blockGrain);
    overRange(executor, blocks, blockGrain, [&](std::uint32_t begin, std::uint32_t end) {
        ContactFeatures& mine = found[begin / blockGrain];
        for (std::uint32_t i = begin; i < end; ++i) prepareBlock(plan, world, i, mine);
    });
    m_features = {};
    for (const ContactFeatures& f : found) m_features = m_features | f;
}

void SoftStep::prepareJoints(const Plan& plan, const SolverWorld& world, std::uint32_t begin,
                             std::uint32_t end) {
    const float h = world.stepSeconds / static_cast<float>(world.substeps);
    const auto bodyAt = [&](BodyPlace p) {
        return plan.bodyOfPlace[static_cast<std::size_t>(readPlace(p))];
    };
    for (std::uint32_t i = begin; i < end; ++i) {
        const std::uint32_t place = plan.jointOrder[i];
        const JointInfo& info = world.joints[place];
        ConstraintBodies at = plan.jointPlaces[i];
        if (info.kind() == JointKind::Mouse) at.a = fixedWorld;
        // A static body has no solver place: its pose comes from the world.
        const std::uint32_t a = world.jointBodies[place].a;
        const std::uint32_t b = world.jointBodies[place].b;
        m_joints[i] = prepareJoint(info, world.jointImpulses[place], place, world.motions[a].pose(),
                                   world.motions[b].pose(), h);
        JointRow& row = m_joints[i];
        row.bodyA = at.a;
        row.bodyB = at.b;
        if (at.a >= 0) {
            row.mA = world.bodies[bodyAt(at.a)].inverseMass;
            row.iA = world.bodies[bodyAt(at.a)].inverseInertia;
        }
        if (at.b >= 0) {
            row.mB = world.bodies[bodyAt(at.b)].inverseMass;
            row.iB = world.bodies[bodyAt(at.b)].inverseInertia;
        }
    }
}

/// The substeps of one batch. With several workers every stage is shared out and ends in a barrier;
/// with one the same stages run through without.
void SoftStep::solveBatch(const Plan& plan, const Batch& batch, const Pass& pass, int worker,
                          int workers, Executor* executor) {
    const auto barrier = [&] {
        if (workers > 1) executor->barrier(worker);
    };
    const Share places(batch.endPlace - batch.firstPlace, worker, workers);
    const auto overBodies = [&](auto&& f) {
        for (std::uint32_t i = places.begin; i < places.end; ++i) {
            f(m_bodies[batch.firstPlace + i], m_drives[batch.firstPlace + i]);
        }
        barrier();
    };
    const auto overColours = [&](auto&& onJoint, ContactKernel ContactKernels::*kernel) {
        for (std::uint32_t c = batch.firstColour; c < batch.endColour; ++c) {
            const ColourRun& run = plan.runs[c];
            // Constraints of the overflow share bodies: one worker, one by one, in key order.
            const bool serial = run.colour == overflowColour;
            if (!serial || worker == 0) {
                const Share joints(run.jointCount, serial ? 0 : worker, serial ? 1 : workers);
                for (std::uint32_t i = joints.begin; i < joints.end; ++i) {
                    onJoint(m_joints[run.firstJoint + i]);
                }
                const std::uint32_t blocks = (run.contactCount + blockLanes - 1) / blockLanes;
                const Share share(blocks, serial ? 0 : worker, serial ? 1 : workers);
                if (share.begin < share.end) {
                    const std::uint32_t first = share.begin * blockLanes;
                    const std::uint32_t last = std::min(share.end * blockLanes, run.contactCount);
                    ((serial ? pass.serial : pass.kernels).*kernel)(
                        m_bodies.data(), m_blocks.data() + run.firstBlock + share.begin,
                        last - first, run.colour >= firstFixedColour ? pass.fixed : pass.moving);
                }
            }
            barrier();
        }
    };
    JointPass biased = pass.joint;
    biased.bias = true;
    JointPass relaxed = pass.joint;
    relaxed.bias = false;
    const float h = pass.h;
    for (std::uint32_t substep = 0; substep < pass.substeps; ++substep) {
        overBodies([h](SolverBody& b, const Drive& d) {
            b.vx = (b.vx + h * d.acceleration.x) * d.linearFactor;
            b.vy = (b.vy + h * d.acceleration.y) * d.linearFactor;
            b.w = (b.w + h * d.angular) * d.angularFactor;
        });
        overColours([&](const JointRow& row) { warmStartJoint(m_bodies.data(), row); },
                    &ContactKernels::warmStart);
        overColours([&](JointRow& row) { solveJoint(m_bodies.data(), row, biased); },
                    &ContactKernels::solve);
        overBodies([h](SolverBody& b, const Drive& d) {
            b.dx += h * (b.vx - d.lag.x);
            b.dy += h * (b.vy - d.lag.y);
            const Rotation q = compose(cayley(0.5f * h * b.w), Rotation{b.dc, b.ds});
            b.dc = q.c;
            b.ds = q.s;
        });
        overColours([&](JointRow& row) { solveJoint(m_bodies.data(), row, relaxed); },
                    &ContactKernels::relax);
    }
    if (m_features.restitution) {
        overColours([](const JointRow&) {}, &ContactKernels::restitute);
    }
}

void SoftStep::solve(const Plan& plan, const SolverWorld& world, const ContactKernels& kernels,
                     Executor* executor) {
    const float h = world.stepSeconds / static_cast<float>(world.substeps);
    const float rate = 1.0f / h;
    ContactPass moving;
    moving.soft = softness(contactFrequency * rate, contactDamping, h);
    moving.inverseH = rate;
    moving.pushSpeed = pushSpeed;
    moving.features = m_features;
    ContactPass fixed = moving;
    fixed.soft = softness(2.0f * contactFrequency * rate, contactDamping, h);
    JointPass joint;
    joint.h = h;
    joint.inverseH = rate;
    joint.soft = softness(jointFrequency * rate, jointDamping, h);
    const Pass pass{kernels, contactKernels(Simd::Scalar), h, world.substeps, moving, fixed, joint};

    // Giant islands first, each on all threads; then the batches, whoever is free takes the next.
    const int workers = executor != nullptr ? executor->threads() : 1;
    std::vector<std::uint32_t> small;
    for (std::uint32_t i = 0; i < plan.batches.size(); ++i) {
        if (!plan.batches[i].giant) {
            small.push_back(i);
        } else if (workers == 1) {
            solveBatch(plan, plan.batches[i], pass, 0, 1, nullptr);
        } else {
            executor->onAllWorkers([&](int worker) {
                solveBatch(plan, plan.batches[i], pass, worker, workers, executor);
            });
        }
    }
    overRange(executor, static_cast<std::uint32_t>(small.size()), 1,
              [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::uint32_t i = begin; i < end; ++i) {
                      solveBatch(plan, plan.batches[small[i]], pass, 0, 1, nullptr);
                  }
              });
}

void SoftStep::store(const Plan& plan, const SolverWorld& world, Executor* executor,
                     std::vector<ContactHit>& hits) {
    const auto storeLane = [&](const ContactBlock& rows, std::uint32_t lane, Contact& contact,
                               std::vector<ContactHit>& out) {
        contact.state.rollingImpulse = finiteOrZero(rows.rollingImpulse[lane]);
        ContactHit hit;
        for (std::size_t i = 0; i < contact.pointCount; ++i) {
            const ContactPointRows& p = rows.points[i];
            contact.state.normalImpulse[i] = finiteOrZero(p.normalImpulse[lane]);
            contact.state.tangentImpulse[i] = finiteOrZero(p.tangentImpulse[lane]);
            const float approach = -p.approach[lane];
            if (p.maxNormalImpulse[lane] > 0.0f && approach > hitSpeed && approach > hit.approach) {
                const Vec2 rA{p.anchorAx[lane], p.anchorAy[lane]};
                hit.shapeA = contact.state.shapeA;
                hit.shapeB = contact.state.shapeB;
                hit.point = world.motions[contact.bodyA].position + rA;
                hit.normal = {rows.normalX[lane], rows.normalY[lane]};
                hit.approach = approach;
            }
        }
        if (hit.approach > 0.0f) out.push_back(hit);
    };
    const auto blocks = static_cast<std::uint32_t>(m_blocks.size());
    auto found = perBlock<std::vector<ContactHit>>(blocks, blockGrain);
    overRange(executor, blocks, blockGrain, [&](std::uint32_t begin, std::uint32_t end) {
        std::vector<ContactHit>& mine = found[begin / blockGrain];
        for (std::uint32_t block = begin; block < end; ++block) {
            for (std::uint32_t lane = 0; lane < blockLanes; ++lane) {
                const std::uint32_t place = plan.contactOfLane[block * blockLanes + lane];
                if (place == none) break;
                storeLane(m_blocks[block], lane, world.contacts[place], mine);
            }
        }
    });
    for (const auto& part : found) hits.insert(hits.end(), part.begin(), part.end());
    std::sort(hits.begin(), hits.end(), [](const ContactHit& a, const ContactHit& b) {
        return a.shapeA != b.shapeA ? a.shapeA < b.shapeA : a.shapeB < b.shapeB;
    });
    const auto joints = static_cast<std::uint32_t>(m_joints.size());
    overRange(executor, joints, jointGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            world.jointImpulses[m_joints[i].joint] = storedImpulses(m_joints[i]);
        }
    });
}

namespace {

/// Moves a body to where it went, unless that is nowhere: then it stays, at rest.
bool settle(BodyMotion& motion, const BodyMotion& next) {
    const bool whole = isFinite(next.position) && isFinite(next.velocity) &&
                       isFinite(next.angularVelocity) && isFinite(next.rotation.c) &&
                       isFinite(next.rotation.s);
    const auto outside = [](float x) { return x > maxCoordinate || x < -maxCoordinate; };
    if (!whole || outside(next.position.x) || outside(next.position.y)) {
        motion.velocity = {};
        motion.angularVelocity = 0.0f;
        return false;
    }
    motion.position = {canonicalZero(next.position.x), canonicalZero(next.position.y)};
    motion.rotation = {canonicalZero(next.rotation.c), canonicalZero(next.rotation.s)};
    motion.velocity = {canonicalZero(next.velocity.x), canonicalZero(next.velocity.y)};
    motion.angularVelocity = canonicalZero(next.angularVelocity);
    return true;
}

/// A body without constraints moves with the mean of its old and new velocity: exact for constant
/// acceleration, the parabola (physics page, 7). It turns by ω Δt, exactly.
BodyMotion freeFlight(const BodyMotion& motion, const BodyInfo& info, const BodyForce* force,
                      Vec2 gravity, float dt) {
    BodyMotion next = motion;
    Vec2 acceleration = info.gravityScale * gravity;
    float angular = 0.0f;
    if (force != nullptr) {
        acceleration += info.inverseMass * force->force;
        angular = info.inverseInertia * force->torque;
    }
    next.velocity =
        (1.0f / (1.0f + dt * info.linearDamping)) * (motion.velocity + dt * acceleration);
    next.angularVelocity =
        (motion.angularVelocity + dt * angular) * (1.0f / (1.0f + dt * info.angularDamping));
    next.position = motion.position + (0.5f * dt) * (motion.velocity + next.velocity);
    const float turn = 0.5f * dt * (motion.angularVelocity + next.angularVelocity);
    if (turn != 0.0f) next.rotation = normalized(compose(rotationOf(turn), motion.rotation));
    return next;
}

}  // namespace

void SoftStep::finish(const Plan& plan, const SolverWorld& world, Executor* executor,
                      std::vector<std::uint32_t>& broken) {
    const auto places = static_cast<std::uint32_t>(plan.bodyOfPlace.size());
    auto brokenPlaces = perBlock<std::vector<std::uint32_t>>(places, bodyGrain);
    overRange(executor, places, bodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t place = std::max(begin, 1u); place < end; ++place) {
            const std::uint32_t body = plan.bodyOfPlace[place];
            if (!world.bodies[body].dynamic()) continue;  // copies of kinematic bodies
            const SolverBody& s = m_bodies[place];
            BodyMotion& motion = world.motions[body];
            BodyMotion next = motion;
            next.position = motion.position + Vec2{s.dx, s.dy};
            next.rotation = normalized(compose(Rotation{s.dc, s.ds}, motion.rotation));
            next.velocity = {s.vx, s.vy};
            next.angularVelocity = s.w;
            if (!settle(motion, next)) brokenPlaces[begin / bodyGrain].push_back(body);
        }
    });
    const auto free = static_cast<std::uint32_t>(plan.freeBodies.size());
    auto brokenFree = perBlock<std::vector<std::uint32_t>>(free, bodyGrain);
    overRange(executor, free, bodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t body = plan.freeBodies[i];
            const BodyForce* force = world.forces.empty() ? nullptr : &world.forces[body];
            BodyMotion& motion = world.motions[body];
            if (!settle(motion, freeFlight(motion, world.bodies[body], force, world.gravity,
                                           world.stepSeconds))) {
                brokenFree[begin / bodyGrain].push_back(body);
            }
        }
    });
    for (const auto& part : brokenPlaces) broken.insert(broken.end(), part.begin(), part.end());
    for (const auto& part : brokenFree) broken.insert(broken.end(), part.begin(), part.end());
    for (const std::uint32_t body : world.kinematic) {
        BodyMotion& motion = world.motions[body];
        if (motion.velocity == Vec2{} && motion.angularVelocity == 0.0f) continue;
        BodyMotion next = motion;
        next.position = motion.position + world.stepSeconds * motion.velocity;
        next.rotation = normalized(
            compose(rotationOf(world.stepSeconds * motion.angularVelocity), motion.rotation));
        if (!settle(motion, next)) broken.push_back(body);
    }
    std::sort(broken.begin(), broken.end());
}

}  // namespace huestep
