#include "core/solver/soft_step.h"

#include <algorithm>
#include <array>

#include "core/math/lanes.h"
#include "core/math/trig.h"
#include "core/solver/contact_kernels.h"
#include "core/solver/effort.h"

namespace huestep {

namespace {

// Damping of joints by measurement: with 2 a pendulum loses 0.33 % of its energy in 10 s, with 1 it
// loses 0.19 %.
constexpr float contactDamping = 10.0f;
constexpr float jointDamping = 1.0f;
constexpr float pushSpeed = 3.0f;  // m/s

// Of contacts that begin, in their first substep: a box on a slope of 20° starts with half a
// substep of friction too little without, and slides 1 % too far; with three it is 0.1 %.
constexpr int coldPasses = 3;
constexpr std::uint32_t jointsAsLanes = 8;  // a joint one by one takes as long as so many in lanes

/// What one pass over all colours does with each kind of constraint; null: nothing.
struct Sweep {
    void (*joint)(SolverBody* bodies, JointRow& row, const JointPass& pass);
    RevoluteKernel RevoluteKernels::*revolute;
    ContactKernel ContactKernels::*contact;
};
constexpr Sweep warmStartSweep{
    [](SolverBody* bodies, JointRow& row, const JointPass&) { warmStartJoint(bodies, row); },
    &RevoluteKernels::warmStart, &ContactKernels::warmStart};
constexpr Sweep warmStartAgainSweep{warmStartSweep.joint, &RevoluteKernels::warmStart,
                                    &ContactKernels::warmStartAgain};
constexpr Sweep solveSweep{solveJoint, &RevoluteKernels::solve, &ContactKernels::solve};
constexpr Sweep relaxSweep{solveJoint, &RevoluteKernels::solve, &ContactKernels::relax};
constexpr Sweep relaxColdSweep{nullptr, nullptr, &ContactKernels::relaxCold};
constexpr Sweep restituteSweep{nullptr, nullptr, &ContactKernels::restitute};

/// One batch's substeps, as one worker goes through them.
class SoftStep {
 public:
    SoftStep(const BatchTask& task, const Team& team);
    void run();

 private:
    void sweep(const Sweep& sweep, const JointPass& joint);
    void sweepColour(const ColourRun& run, const Sweep& sweep, const JointPass& joint,
                     const Team& team);
    void sweepHub(const ColourRun& run, ContactKernel kernel, const ContactPass& pass);
    template <class F>
    void overBodies(F&& f);
    void lagBehind(std::uint32_t place, Vec2 pushed, bool first);
    void accelerate(std::uint32_t place, bool first);
    void move(std::uint32_t place);

    const BatchTask& m_task;
    Rows& m_rows;
    Team m_team;
    float m_h;             // s, of a substep
    ContactPass m_moving;  // between two bodies that move
    ContactPass m_fixed;   // against a body that does not
    JointPass m_biased, m_relaxed;
};

SoftStep::SoftStep(const BatchTask& task, const Team& team)
    : m_task(task),
      m_rows(task.rows),
      m_team(team),
      m_h(task.stepSeconds / static_cast<float>(task.substeps)) {
    const float rate = 1.0f / m_h, full = task.ramp * rate;
    const RowFrequency frequency = rowFrequency(task.substeps, task.rests);
    m_moving.soft = softness(frequency.contact * full, contactDamping, m_h);
    m_moving.inverseH = rate;
    m_moving.pushSpeed = pushSpeed;
    m_moving.features = task.features;
    m_fixed = m_moving;
    m_fixed.soft = softness(2.0f * frequency.contact * full, contactDamping, m_h);
    m_relaxed.h = m_h;
    m_relaxed.inverseH = rate;
    m_biased = m_relaxed;
    m_biased.soft = softness(frequency.joint * full, jointDamping, m_h);
}

/// A hub's contacts, bucket by bucket: each lane works on a copy of the hub, and the mean of the
/// copies is what becomes of the hub. Lanes that act share its mass; those that do not would make
/// it the heavier. The sum has a fixed shape of eight lanes, whatever the kernel's width.
void SoftStep::sweepHub(const ColourRun& run, ContactKernel kernel, const ContactPass& pass) {
    const ContactKernels& kernels = m_task.contacts;
    std::vector<SolverBody>& bodies = m_rows.bodies;
    constexpr std::uint32_t sumLanes = 8;
    SolverBody& hub = bodies[run.hub];
    SolverBody* copies = bodies.data() + run.firstCopy;
    for (std::uint32_t first = 0; first < run.contactCount; first += blockLanes) {
        const std::uint32_t lanes =
            std::min(run.contactCount - first, static_cast<std::uint32_t>(blockLanes));
        ContactBlock& block = m_rows.blocks[run.firstBlock + first / blockLanes];
        std::fill_n(copies, lanes, hub);
        const std::uint32_t acting = kernels.countActive(bodies.data(), block, pass);
        if (acting == 0) continue;
        const auto shares = static_cast<float>(acting);
        for (std::uint32_t i = 0; i < lanes; ++i) copies[i].inverseMass = shares * hub.inverseMass;
        if (block.shares != acting) {
            block.shares = acting;
            std::array<std::int32_t, blockLanes> hubIsA{};
            const auto firstCopy = static_cast<BodyPlace>(run.firstCopy);
            for (std::uint32_t i = 0; i < lanes; ++i) {
                hubIsA[i] = block.bodyA[i] == firstCopy + static_cast<BodyPlace>(i) ? -1 : 0;
            }
            kernels.shareHub(bodies.data(), block, hubIsA.data(),
                             shares * m_rows.sources[run.hub].inverseInertia);
        }
        const LaneF<4> before = loadLanes<4>(&hub.vx);
        kernel(bodies.data(), &block, lanes, pass);
        std::array<LaneF<4>, sumLanes> sum{};
        for (std::uint32_t i = 0; i < lanes; ++i) {
            sum[i % sumLanes] += loadLanes<4>(&copies[i].vx) - before;
        }
        const LaneF<4> change =
            ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
        const LaneF<4> after = before + change / splat<4>(shares);
        hub.vx = after[0];
        hub.vy = after[1];
        hub.w = after[2];
    }
}

/// This worker's share of one colour; of a colour that is not shared, all of it on one.
void SoftStep::sweepColour(const ColourRun& run, const Sweep& sweep, const JointPass& joint,
                           const Team& team) {
    const ContactPass& contactPass = run.colour >= firstFixedColour ? m_fixed : m_moving;
    if (isHub(run.colour)) {
        sweepHub(run, m_task.contacts.*sweep.contact, contactPass);
        return;
    }
    // Constraints of the overflow share bodies: one by one, in key order.
    const bool serial = isSerial(run.colour);
    SolverBody* bodies = m_rows.bodies.data();
    const Share joints(sweep.joint != nullptr ? run.jointCount : 0, team);
    for (std::uint32_t i = joints.begin; i < joints.end; ++i) {
        sweep.joint(bodies, m_rows.joints[run.firstJoint + i], joint);
    }
    // Whole blocks are shared out; padding of the last one is left out.
    const auto overBlocks = [&](std::uint32_t count, auto&& f) {
        const Share blocks(blocksOf(count), team);
        if (blocks.begin == blocks.end) return;
        const std::uint32_t last = std::min(blocks.end * blockLanes, count);
        f(blocks.begin, last - blocks.begin * blockLanes);
    };
    overBlocks(sweep.revolute != nullptr ? run.revoluteCount : 0,
               [&](std::uint32_t first, std::uint32_t n) {
                   (m_task.revolutes.*sweep.revolute)(
                       bodies, m_rows.revolutes.data() + run.firstRevoluteBlock + first, n, joint);
               });
    const ContactKernels& contacts = serial ? contactKernels(Simd::Scalar) : m_task.contacts;
    overBlocks(run.contactCount, [&](std::uint32_t first, std::uint32_t n) {
        (contacts.*sweep.contact)(bodies, m_rows.blocks.data() + run.firstBlock + first, n,
                                  contactPass);
    });
}

void SoftStep::sweep(const Sweep& sweep, const JointPass& joint) {
    const Plan& plan = m_task.plan;
    const Batch& batch = m_task.batch;
    for (std::uint32_t c = batch.firstColour; c < batch.endColour; ++c) {
        // Colours too small to share go through one worker, one after another, without a barrier
        // between: a hub has dozens of them.
        const bool shared = m_team.workers > 1 && isShared(plan, plan.runs[c]);
        if (shared) {
            sweepColour(plan.runs[c], sweep, joint, m_team);
        } else if (m_team.worker == 0) {
            sweepColour(plan.runs[c], sweep, joint, {});
        }
        if (c + 1 == batch.endColour || shared || isShared(plan, plan.runs[c + 1])) {
            m_team.barrier();
        }
    }
}

template <class F>
void SoftStep::overBodies(F&& f) {
    const Batch& batch = m_task.batch;
    const Share places(batch.endPlace - batch.firstPlace, m_team);
    for (std::uint32_t i = places.begin; i < places.end; ++i) f(batch.firstPlace + i);
    m_team.barrier();
}

/// A body with contacts and no joints: what acted on it in the last substep goes on, so this one's
/// mean velocity is behind its last by half of that. At rest nothing is left of gravity, and the
/// body stays; a disc that rolls down a slope is 0.2 % nearer to its closed form. An impact does
/// not go on: what is more than the forces from outside is none of it.
void SoftStep::lagBehind(std::uint32_t place, Vec2 pushed, bool first) {
    BodySource& s = m_rows.sources[place];
    const Vec2 forced = m_h * s.acceleration;
    const Vec2 change = forced + pushed;
    const bool steady = !first && lengthSquared(change) <= lengthSquared(forced);
    s.lag = steady ? 0.5f * change : Vec2{};
}

/// The last impulses start the substep. Contact rows keep their arms over the step, so what they
/// would do to a body is what they did to it in the last substep, and a body without joints carries
/// that over by itself (performance page, 5). Joints turn their arms.
void SoftStep::accelerate(std::uint32_t place, bool first) {
    SolverBody& b = m_rows.bodies[place];
    const BodySource& s = m_rows.sources[place];
    Rows::Velocity& before = m_rows.pushed[place];
    const Rows::Velocity pushed{b.vx - before.x, b.vy - before.y, b.w - before.w};
    if (s.carries) lagBehind(place, {pushed.x, pushed.y}, first);
    b.vx = (b.vx + m_h * s.acceleration.x) * s.linearFactor;
    b.vy = (b.vy + m_h * s.acceleration.y) * s.linearFactor;
    b.w = (b.w + m_h * s.angularAcceleration) * s.angularFactor;
    before = {b.vx, b.vy, b.w};
    if (first || !s.carries) return;
    b.vx += pushed.x;
    b.vy += pushed.y;
    b.w += pushed.w;
}

void SoftStep::move(std::uint32_t place) {
    SolverBody& b = m_rows.bodies[place];
    const BodySource& s = m_rows.sources[place];
    b.dx += m_h * (b.vx - s.lag.x);
    b.dy += m_h * (b.vy - s.lag.y);
    const Rotation q = compose(cayley(0.5f * m_h * b.w), Rotation{b.dc, b.ds});
    b.dc = q.c;
    b.ds = q.s;
}

void SoftStep::run() {
    const Batch& batch = m_task.batch;
    const bool hasJoints =
        batch.firstJoint < batch.endJoint || batch.firstRevoluteBlock < batch.endRevoluteBlock;
    for (std::uint32_t substep = 0; substep < m_task.substeps; ++substep) {
        const bool first = substep == 0;
        overBodies([&](std::uint32_t place) { accelerate(place, first); });
        if (first) {
            sweep(warmStartSweep, m_biased);
        } else if (hasJoints) {
            sweep(warmStartAgainSweep, m_biased);
        }
        sweep(solveSweep, m_biased);
        overBodies([&](std::uint32_t place) { move(place); });
        sweep(relaxSweep, m_relaxed);
        for (int k = 0; first && m_task.features.cold && k < coldPasses; ++k) {
            sweep(relaxColdSweep, m_relaxed);
        }
    }
    if (m_task.features.restitution) sweep(restituteSweep, m_relaxed);
}

}  // namespace

bool isShared(const Plan& plan, const ColourRun& run) {
    return !isSerial(run.colour) && !isHub(run.colour) &&
           run.contactCount + run.revoluteCount + jointsAsLanes * run.jointCount >= plan.sharedFrom;
}

void solveSoftStep(const BatchTask& task, const Team& team) {
    SoftStep(task, team).run();
}

}  // namespace huestep
