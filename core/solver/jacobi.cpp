#include "core/solver/jacobi.h"

#include <algorithm>

#include "core/math/lanes.h"
#include "core/solver/lane_copies.h"
#include "core/solver/soft_step.h"

namespace huestep {

namespace {

using Change = MethodMemory::Change;

/// A batch's sweeps, as one worker goes through them. Every worker has the same blocks and joints
/// in each.
class JacobiSweeper final : public Sweeper {
 public:
    JacobiSweeper(const BatchTask& task, const Team& team, bool splits);
    ~JacobiSweeper() override;
    JacobiSweeper(const JacobiSweeper&) = delete;
    JacobiSweeper& operator=(const JacobiSweeper&) = delete;

    void sweep(const Sweep& sweep, const SweepPass& pass) override;

 private:
    template <class F>
    void overContacts(F&& f);
    template <class F>
    void overRevolutes(F&& f);
    template <class F>
    void overJoints(F&& f);
    [[nodiscard]] SolverBody copyOf(BodyPlace place) const;
    void load(const ConstraintBodies* places, std::uint32_t lanes);
    void keepChanges(const ConstraintBodies* places, std::uint32_t lanes, std::uint32_t slot);
    void sweepJoint(JointRow& row, const Sweep& sweep, const JointPass& pass, std::uint32_t slot);
    template <class F>
    void sumOver(F&& f);

    void countActive();
    void splitMasses();

    const BatchTask& m_task;
    Rows& m_rows;
    const Plan& m_plan;
    const Incidence& m_incidence;
    Team m_team;
    bool m_splits;
    LaneCopies m_copies;
};

JacobiSweeper::JacobiSweeper(const BatchTask& task, const Team& team, bool splits)
    : m_task(task),
      m_rows(task.rows),
      m_plan(task.plan),
      m_incidence(task.plan.incidence),
      m_team(team),
      m_splits(splits) {
    overContacts([&](const ColourRun&, std::uint32_t block, std::uint32_t) {
        ContactBlock& rows = m_rows.blocks[block];
        placeOnCopies(rows);
        for (std::uint32_t i = 0; i < blockLanes; ++i) {
            rows.warmA[i] = copyPlace(rows.warmA[i], i);
            rows.warmB[i] = copyPlace(rows.warmB[i], blockLanes + i);
        }
    });
    overRevolutes(
        [&](std::uint32_t block, std::uint32_t) { placeOnCopies(m_rows.revolutes[block]); });
    if (splits) {
        countActive();
        splitMasses();
    }
}

/// Contact rows stay for the next step, with the places that their plan has.
JacobiSweeper::~JacobiSweeper() {
    const auto warm = [](BodyPlace copy, BodyPlace place) {
        return copy < 0 && place >= 0 ? ~place : place;
    };
    overContacts([&](const ColourRun&, std::uint32_t block, std::uint32_t) {
        ContactBlock& rows = m_rows.blocks[block];
        for (std::uint32_t i = 0; i < blockLanes; ++i) {
            const ConstraintBodies& places = m_plan.lanePlaces[block * blockLanes + i];
            rows.bodyA[i] = places.a;
            rows.bodyB[i] = places.b;
            rows.warmA[i] = warm(rows.warmA[i], places.a);
            rows.warmB[i] = warm(rows.warmB[i], places.b);
        }
    });
}

/// This worker's blocks, each with its run and how many of its lanes have a row.
template <class F>
void JacobiSweeper::overContacts(F&& f) {
    for (std::uint32_t r = m_task.batch.firstColour; r < m_task.batch.endColour; ++r) {
        const ColourRun& run = m_plan.runs[r];
        const Share blocks(blocksOf(run.contactCount), m_team);
        for (std::uint32_t i = blocks.begin; i < blocks.end; ++i) {
            const std::uint32_t rest = run.contactCount - i * blockLanes;
            f(run, run.firstBlock + i, std::min<std::uint32_t>(rest, blockLanes));
        }
    }
}

template <class F>
void JacobiSweeper::overRevolutes(F&& f) {
    for (std::uint32_t r = m_task.batch.firstColour; r < m_task.batch.endColour; ++r) {
        const ColourRun& run = m_plan.runs[r];
        const Share blocks(blocksOf(run.revoluteCount), m_team);
        for (std::uint32_t i = blocks.begin; i < blocks.end; ++i) {
            const std::uint32_t rest = run.revoluteCount - i * blockLanes;
            f(run.firstRevoluteBlock + i, std::min<std::uint32_t>(rest, blockLanes));
        }
    }
}

template <class F>
void JacobiSweeper::overJoints(F&& f) {
    const Batch& batch = m_task.batch;
    const Share joints(batch.endJoint - batch.firstJoint, m_team);
    for (std::uint32_t i = joints.begin; i < joints.end; ++i) f(batch.firstJoint + i);
}

/// The body as its rows see it: whole, or the share of it that one of them has.
SolverBody JacobiSweeper::copyOf(BodyPlace place) const {
    const auto at = static_cast<std::size_t>(readPlace(place));
    SolverBody copy = m_rows.bodies[at];
    if (m_splits && place >= 0) copy.inverseMass *= m_rows.memory.shares[at];
    return copy;
}

void JacobiSweeper::load(const ConstraintBodies* places, std::uint32_t lanes) {
    for (std::uint32_t i = 0; i < lanes; ++i) {
        m_copies[i] = copyOf(places[i].a);
        m_copies[blockLanes + i] = copyOf(places[i].b);
    }
}

void JacobiSweeper::keepChanges(const ConstraintBodies* places, std::uint32_t lanes,
                                std::uint32_t slot) {
    const auto keep = [&](BodyPlace place, const SolverBody& copy, Change& change) {
        const SolverBody& body = m_rows.bodies[static_cast<std::size_t>(readPlace(place))];
        storeLanes<4>(&change.vx, changeOf<4>(loadLanes<4>(&body.vx), loadLanes<4>(&copy.vx)));
    };
    Change* changes = m_rows.memory.changes.data() + slot;
    for (std::uint32_t i = 0; i < lanes; ++i) {
        keep(places[i].a, m_copies[i], changes[2 * i]);
        keep(places[i].b, m_copies[blockLanes + i], changes[2 * i + 1]);
    }
}

void JacobiSweeper::sweepJoint(JointRow& row, const Sweep& sweep, const JointPass& pass,
                               std::uint32_t slot) {
    Change* changes = m_rows.memory.changes.data() + slot;
    changes[0] = changes[1] = {};
    if (sweep.joint == nullptr) return;
    const ConstraintBodies places{row.bodyA, row.bodyB};
    const SolverBody a = m_copies[0] = copyOf(places.a);
    const SolverBody b = m_copies[1] = copyOf(places.b);
    row.bodyA = copyPlace(places.a, 0);
    row.bodyB = copyPlace(places.b, 1);
    sweep.joint(m_copies.data(), row, pass);
    row.bodyA = places.a;
    row.bodyB = places.b;
    storeLanes<4>(&changes[0].vx, changeOf<4>(loadLanes<4>(&a.vx), loadLanes<4>(&m_copies[0].vx)));
    storeLanes<4>(&changes[1].vx, changeOf<4>(loadLanes<4>(&b.vx), loadLanes<4>(&m_copies[1].vx)));
}

/// `f(place, sum)` for this worker's bodies, once all changes are made. The order of a sum is that
/// of slots, whoever made them.
template <class F>
void JacobiSweeper::sumOver(F&& f) {
    m_team.barrier();
    const std::vector<Change>& changes = m_rows.memory.changes;
    const Batch& batch = m_task.batch;
    const Share places(batch.endPlace - batch.firstPlace, m_team);
    for (std::uint32_t i = places.begin; i < places.end; ++i) {
        const std::uint32_t place = batch.firstPlace + i;
        LaneF<4> sum{};
        for (const std::uint32_t slot : m_incidence.touchesOf(place)) {
            sum += loadLanes<4>(&changes[slot].vx);
        }
        f(place, sum);
    }
    m_team.barrier();
}

void JacobiSweeper::sweep(const Sweep& sweep, const SweepPass& pass) {
    std::vector<Change>& changes = m_rows.memory.changes;
    overJoints([&](std::uint32_t joint) {
        sweepJoint(m_rows.joints[joint], sweep, pass.joint, 2 * joint);
    });
    overRevolutes([&](std::uint32_t block, std::uint32_t lanes) {
        const std::uint32_t lane = block * blockLanes;
        const std::uint32_t slot = m_incidence.slotOfRevolute(lane);
        if (sweep.revolute == nullptr) {
            std::fill_n(changes.begin() + slot, 2 * lanes, Change{});
            return;
        }
        const ConstraintBodies* places = m_plan.revolutePlaces.data() + lane;
        load(places, lanes);
        (m_task.revolutes.*sweep.revolute)(m_copies.data(), &m_rows.revolutes[block], lanes,
                                           pass.joint);
        keepChanges(places, lanes, slot);
    });
    const ContactKernel kernel = m_task.contacts.*sweep.contact;
    overContacts([&](const ColourRun& run, std::uint32_t block, std::uint32_t lanes) {
        const std::uint32_t lane = block * blockLanes;
        const ConstraintBodies* places = m_plan.lanePlaces.data() + lane;
        load(places, lanes);
        kernel(m_copies.data(), &m_rows.blocks[block], lanes, contactPassOf(pass, run.colour));
        keepChanges(places, lanes, m_incidence.slotOfContact(lane));
    });
    sumOver([&](std::uint32_t place, const LaneF<4>& sum) {
        // The mean of k bodies of which each has been changed by its row alone.
        const float part = m_splits ? 1.0f / m_rows.memory.shares[place] : 1.0f;
        SolverBody& body = m_rows.bodies[place];
        body.vx += part * sum[0];
        body.vy += part * sum[1];
        body.w += part * sum[2];
    });
}

/// Among how many rows each body is divided: those that act, or whose gap closes within the step
/// under the forces of the step. Joints always act.
void JacobiSweeper::countActive() {
    std::vector<Change>& changes = m_rows.memory.changes;
    std::vector<float>& shares = m_rows.memory.shares;
    const Batch& batch = m_task.batch;
    const Share places(batch.endPlace - batch.firstPlace, m_team);
    std::fill_n(shares.begin() + batch.firstPlace + places.begin, places.end - places.begin, 1.0f);
    m_team.barrier();
    const Change one{1.0f, 0.0f, 0.0f, 0.0f};
    overJoints([&](std::uint32_t joint) { std::fill_n(changes.begin() + 2 * joint, 2, one); });
    overRevolutes([&](std::uint32_t block, std::uint32_t lanes) {
        const std::uint32_t slot = m_incidence.slotOfRevolute(block * blockLanes);
        std::fill_n(changes.begin() + slot, 2 * lanes, one);
    });
    ContactPass pass;
    pass.inverseH = 1.0f / m_task.stepSeconds;
    overContacts([&](const ColourRun&, std::uint32_t block, std::uint32_t lanes) {
        const std::uint32_t lane = block * blockLanes;
        const ConstraintBodies* at = m_plan.lanePlaces.data() + lane;
        load(at, lanes);
        const auto accelerate = [&](SolverBody& copy, BodyPlace place) {
            const BodySource& s = m_rows.sources[static_cast<std::size_t>(readPlace(place))];
            copy.vx += m_task.stepSeconds * s.acceleration.x;
            copy.vy += m_task.stepSeconds * s.acceleration.y;
        };
        for (std::uint32_t i = 0; i < lanes; ++i) {
            accelerate(m_copies[i], at[i].a);
            accelerate(m_copies[blockLanes + i], at[i].b);
        }
        std::array<std::int32_t, blockLanes> active{};
        m_task.contacts.markActive(m_copies.data(), m_rows.blocks[block], pass, active.data());
        for (std::uint32_t i = 0; i < lanes; ++i) {
            const std::uint32_t slot = m_incidence.slotOfContact(lane + i);
            std::fill_n(changes.begin() + slot, 2, active[i] != 0 ? one : Change{});
        }
    });
    sumOver(
        [&](std::uint32_t place, const LaneF<4>& sum) { shares[place] = std::max(1.0f, sum[0]); });
}

/// Rows get the masses of the bodies that are theirs alone. Those of contacts are made anew in
/// every step, so nothing has to be undone.
void JacobiSweeper::splitMasses() {
    const auto inertia = [&](BodyPlace place) {
        const auto at = static_cast<std::size_t>(readPlace(place));
        const float whole = m_rows.sources[at].inverseInertia;
        return place >= 0 ? m_rows.memory.shares[at] * whole : whole;
    };
    overJoints([&](std::uint32_t joint) {
        JointRow& row = m_rows.joints[joint];
        row.mA = copyOf(row.bodyA).inverseMass;
        row.mB = copyOf(row.bodyB).inverseMass;
        row.iA = inertia(row.bodyA);
        row.iB = inertia(row.bodyB);
    });
    const auto split = [&](auto& rows, const ConstraintBodies* places, std::uint32_t lanes) {
        for (std::uint32_t i = 0; i < lanes; ++i) {
            rows.inverseInertiaA[i] = inertia(places[i].a);
            rows.inverseInertiaB[i] = inertia(places[i].b);
        }
    };
    overRevolutes([&](std::uint32_t block, std::uint32_t lanes) {
        split(m_rows.revolutes[block], m_plan.revolutePlaces.data() + block * blockLanes, lanes);
    });
    overContacts([&](const ColourRun&, std::uint32_t block, std::uint32_t lanes) {
        const ConstraintBodies* places = m_plan.lanePlaces.data() + block * blockLanes;
        split(m_rows.blocks[block], places, lanes);
        load(places, lanes);
        m_task.contacts.findMasses(m_copies.data(), m_rows.blocks[block]);
    });
}

}  // namespace

void solveJacobi(const BatchTask& task, const Team& team) {
    JacobiSweeper sweeper(task, team, false);
    softStep(task, team, sweeper);
}

void solveJacobiSplit(const BatchTask& task, const Team& team) {
    JacobiSweeper sweeper(task, team, true);
    softStep(task, team, sweeper);
}

void fitJacobi(MethodMemory& memory, const Plan& plan) {
    memory.changes.resize(plan.incidence.slots());
    memory.shares.resize(plan.bodyOfPlace.size());
}

}  // namespace huestep
