#include "core/solver/soft_step.h"

#include "core/solver/body_motion.h"
#include "core/solver/effort.h"
#include "core/solver/joint_trees.h"
#include "core/solver/recovery.h"

namespace huestep {

namespace {

// Damping of joints by measurement: with 2 a pendulum loses 0.33 % of its energy in 10 s, with 1 it
// loses 0.19 %.
constexpr float jointDamping = 1.0f;
constexpr float pushSpeed = 3.0f;  // m/s

// Substeps shorter than this, s, sweep twice where something may hit something. Their rows are
// stiffer, and in one sweep a blow runs along some of them only: of ten rows of boxes that are hit
// by one of 100 times their mass at 8 substeps, the farthest goes 0.59 m aside with one sweep and
// 0.08 m with two. At 16 and one it is 0.57 m: it is no matter of more substeps.
constexpr float shortSubstep = 1.0f / 300.0f;

// Of contacts that begin, in their first substep: a box on a slope of 20° starts with half a
// substep of friction too little without, and slides 1 % too far; with three it is 0.1 %.
constexpr int coldPasses = 3;

/// One batch's substeps, as one worker goes through them.
class SoftStep {
 public:
    SoftStep(const BatchTask& task, const Team& team, Sweeper& sweeper);
    void run();

 private:
    void lagBehind(std::uint32_t place, Vec2 pushed, bool first);
    /// Joint trees are one worker's; without any nothing happens.
    template <class F>
    void onTrees(F&& f);
    void start(std::uint32_t place, bool first);
    void pushApart();
    void takeBack();

    const BatchTask& m_task;
    Rows& m_rows;
    Team m_team;
    Sweeper& m_sweeper;
    float m_h;  // s, of a substep
    SweepPass m_biased, m_relaxed;
    struct {
        int solve = 1, relax = 1;
    } m_passes;           ///< sweeps a substep
    Recovery m_recovery;  ///< the first worker's
};

SoftStep::SoftStep(const BatchTask& task, const Team& team, Sweeper& sweeper)
    : m_task(task),
      m_rows(task.rows),
      m_team(team),
      m_sweeper(sweeper),
      m_h(task.stepSeconds / static_cast<float>(task.substeps)) {
    if (m_h < shortSubstep && !task.gentle) m_passes = {2, 2};
    if (task.batch.recovers) m_passes = {recoveryPasses, 2};
    const float rate = 1.0f / m_h, full = task.ramp * rate;
    const RowFrequency frequency = rowFrequency(task.substeps, task.gentle, task.batch.large);
    ContactPass& moving = m_biased.moving;
    moving.soft = softness(frequency.contact * full, frequency.contactDamping, m_h);
    moving.inverseH = rate;
    moving.pushSpeed = pushSpeed;
    moving.features = task.features;
    m_biased.fixed = moving;
    m_biased.fixed.soft = softness(2.0f * frequency.contact * full, frequency.contactDamping, m_h);
    m_biased.joint.h = m_h;
    m_biased.joint.inverseH = rate;
    m_relaxed = m_biased;
    m_biased.joint.soft = softness(frequency.joint * full, jointDamping, m_h);
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

template <class F>
void SoftStep::onTrees(F&& f) {
    if (m_task.trees == nullptr) return;
    if (m_team.worker == 0) f(*m_task.trees);
    m_team.barrier();
}

/// The last impulses start the substep. Contact rows keep their arms over the step, so what they
/// would do to a body is what they did to it in the last substep, and a body without joints carries
/// that over by itself (performance page, 5). Joints turn their arms.
void SoftStep::start(std::uint32_t place, bool first) {
    SolverBody& b = m_rows.bodies[place];
    const BodySource& s = m_rows.sources[place];
    Rows::Velocity& before = m_rows.pushed[place];
    const Rows::Velocity pushed{b.vx - before.x, b.vy - before.y, b.w - before.w};
    if (s.carries) lagBehind(place, {pushed.x, pushed.y}, first);
    accelerate(b, s, m_h);
    before = {b.vx, b.vy, b.w};
    if (first || !s.carries) return;
    b.vx += pushed.x;
    b.vy += pushed.y;
    b.w += pushed.w;
}

/// What brings overlapping bodies apart in this substep, until it has gone through the heap.
void SoftStep::pushApart() {
    if (m_team.worker == 0) m_recovery.keep(m_rows, m_task.batch);
    m_team.barrier();
}

/// The push has moved places; it leaves no speed.
void SoftStep::takeBack() {
    if (m_team.worker == 0) m_recovery.restore(m_rows, m_task.batch);
    m_team.barrier();
}

void SoftStep::run() {
    const Batch& batch = m_task.batch;
    const bool hasJoints =
        batch.firstJoint < batch.endJoint || batch.firstRevoluteBlock < batch.endRevoluteBlock;
    const bool sweeps = m_task.trees == nullptr || m_task.trees->leavesWork();
    for (std::uint32_t substep = 0; substep < m_task.substeps; ++substep) {
        const bool first = substep == 0;
        // Bodies move after the solving sweeps and not before.
        m_biased.moving.relaxedBefore = m_biased.fixed.relaxedBefore = !first;
        overBodies(m_task, m_team, [&](std::uint32_t place) { start(place, first); });
        if (!sweeps) {
            // Trees start cold.
        } else if (first) {
            m_sweeper.sweep(warmStartSweep, m_biased);
        } else if (hasJoints) {
            m_sweeper.sweep(warmStartAgainSweep, m_biased);
        }
        onTrees([&](JointTrees& trees) { trees.begin(m_rows, m_h); });
        if (sweeps) {
            if (batch.recovers) pushApart();
            for (int k = 0; k < m_passes.solve; ++k) m_sweeper.sweep(solveSweep, m_biased);
            onTrees([&](JointTrees& trees) { trees.solvePlaces(m_rows); });
        }
        overBodies(m_task, m_team, [&](std::uint32_t place) {
            advance(m_rows.bodies[place], m_rows.sources[place].lag, m_h);
        });
        onTrees([&](JointTrees& trees) { trees.turn(m_rows); });
        if (!sweeps) continue;
        if (batch.recovers) takeBack();
        for (int k = 0; k < m_passes.relax; ++k) m_sweeper.sweep(relaxSweep, m_relaxed);
        for (int k = 0; first && m_task.features.cold && k < coldPasses; ++k) {
            m_sweeper.sweep(relaxColdSweep, m_relaxed);
        }
        const bool last = substep + 1 == m_task.substeps;
        if (last && m_task.features.restitution) m_sweeper.sweep(restituteSweep, m_relaxed);
        onTrees([&](JointTrees& trees) { trees.solveVelocities(m_rows); });
    }
}

}  // namespace

void softStep(const BatchTask& task, const Team& team, Sweeper& sweeper) {
    SoftStep(task, team, sweeper).run();
}

void solveSoftStep(const BatchTask& task, const Team& team) {
    ColourSweeper sweeper(task, team);
    softStep(task, team, sweeper);
}

}  // namespace huestep
