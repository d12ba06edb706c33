#include "core/solver/pgs.h"

#include "core/solver/body_motion.h"
#include "core/solver/sweep.h"

namespace huestep {

namespace {

constexpr float baumgarte = 0.2f;      // of an error, a step
constexpr float slop = 0.005f;         // m
constexpr float pushSpeed = 4.0f;      // m/s
constexpr float mostCorrected = 0.2f;  // m, in one sweep over positions

constexpr Sweep projectSweep{solveJoint, &RevoluteKernels::solve, &ContactKernels::project,
                             nullptr};
constexpr Sweep correctSweep{
    [](SolverBody* bodies, JointRow& row, const JointPass&) { correctJoint(bodies, row); },
    &RevoluteKernels::correct, &ContactKernels::correct, nullptr};

/// Rigid rows over the whole step that know no errors of position.
SweepPass rigidPass(const BatchTask& task) {
    SweepPass pass;
    pass.joint.h = task.stepSeconds;
    pass.joint.inverseH = 1.0f / task.stepSeconds;
    pass.moving.inverseH = pass.joint.inverseH;
    pass.moving.features = task.features;
    pass.moving.slop = slop;
    pass.fixed = pass.moving;
    return pass;
}

/// Forces, last impulses, `iterations` sweeps, and where that leads.
void iterate(const BatchTask& task, const Team& team, Sweeper& sweeper, const Sweep& sweep,
             const SweepPass& pass) {
    Rows& rows = task.rows;
    const float dt = task.stepSeconds;
    overBodies(task, team, [&](std::uint32_t place) {
        accelerate(rows.bodies[place], rows.sources[place], dt);
    });
    sweeper.sweep(warmStartSweep, pass);
    for (std::uint32_t i = 0; i < task.substeps; ++i) sweeper.sweep(sweep, pass);
    overBodies(task, team, [&](std::uint32_t place) { advance(rows.bodies[place], {}, dt); });
}

}  // namespace

void solvePgs(const BatchTask& task, const Team& team) {
    ColourSweeper sweeper(task, team);
    SweepPass pass = rigidPass(task);
    const Softness rigid{baumgarte * pass.joint.inverseH, 1.0f, 0.0f};
    pass.joint.soft = pass.moving.soft = pass.fixed.soft = rigid;
    pass.moving.pushSpeed = pass.fixed.pushSpeed = pushSpeed;
    iterate(task, team, sweeper, projectSweep, pass);
    if (task.features.restitution) sweeper.sweep(restituteSweep, pass);
}

void solvePgsNgs(const BatchTask& task, const Team& team) {
    ColourSweeper sweeper(task, team);
    SweepPass pass = rigidPass(task);
    iterate(task, team, sweeper, relaxSweep, pass);
    if (task.features.restitution) sweeper.sweep(restituteSweep, pass);
    pass.moving.soft.biasRate = pass.fixed.soft.biasRate = baumgarte;
    pass.moving.pushSpeed = pass.fixed.pushSpeed = mostCorrected;
    for (std::uint32_t i = 0; i < (task.substeps + 1) / 2; ++i) sweeper.sweep(correctSweep, pass);
}

}  // namespace huestep
