/// Going over all constraints of a batch once: what is done with each kind, and in which order.
///
/// Methods differ in the order (colours one after another; all at once; any order under locks) and
/// in what a sweep does; the parts of both are shared.
#pragma once

#include "core/solver/method.h"

namespace huestep {

/// What one sweep does with each kind of constraint; null: nothing.
struct Sweep {
    void (*joint)(SolverBody* bodies, JointRow& row, const JointPass& pass);
    RevoluteKernel RevoluteKernels::*revolute;
    ContactKernel ContactKernels::*contact;
    ContactLanePass ContactLanePasses::*lane;  ///< as `contact`, one by one
};

/// Applies the impulses that rows hold to all bodies.
inline constexpr Sweep warmStartSweep{
    [](SolverBody* bodies, JointRow& row, const JointPass&) { warmStartJoint(bodies, row); },
    &RevoluteKernels::warmStart, &ContactKernels::warmStart, &ContactLanePasses::warmStart};
/// The same for bodies that do not carry their impulses over by themselves.
inline constexpr Sweep warmStartAgainSweep{warmStartSweep.joint, &RevoluteKernels::warmStart,
                                           &ContactKernels::warmStartAgain,
                                           &ContactLanePasses::warmStartAgain};
inline constexpr Sweep solveSweep{solveJoint, &RevoluteKernels::solve, &ContactKernels::solve,
                                  &ContactLanePasses::solve};
inline constexpr Sweep relaxSweep{solveJoint, &RevoluteKernels::solve, &ContactKernels::relax,
                                  &ContactLanePasses::relax};
/// `relaxSweep` once more, of contacts that began in this step.
inline constexpr Sweep relaxColdSweep{nullptr, nullptr, &ContactKernels::relaxCold,
                                      &ContactLanePasses::relaxCold};
inline constexpr Sweep restituteSweep{nullptr, nullptr, &ContactKernels::restitute,
                                      &ContactLanePasses::restitute};

/// Constants of a sweep.
struct SweepPass {
    ContactPass moving;  ///< of contacts between two bodies that move
    ContactPass fixed;   ///< against a body that does not
    JointPass joint;
};

/// The contacts' pass of a colour.
inline const ContactPass& contactPassOf(const SweepPass& pass, std::uint8_t colour) {
    return colour >= firstFixedColour ? pass.fixed : pass.moving;
}

/// An order in which a batch's constraints are taken, as one worker of a team goes through it. All
/// workers make the same calls; when one returns, what all of them did is done.
class Sweeper {
 public:
    virtual ~Sweeper() = default;
    virtual void sweep(const Sweep& sweep, const SweepPass& pass) = 0;
};

/// Colour by colour, moving bodies first: Gauss-Seidel. Constraints of the overflow follow their
/// key order on one worker; a batch whose plan has no colours is all overflow.
class ColourSweeper final : public Sweeper {
 public:
    ColourSweeper(const BatchTask& task, const Team& team) : m_task(task), m_team(team) {}
    void sweep(const Sweep& sweep, const SweepPass& pass) override;

 private:
    void sweepColour(const ColourRun& run, const Sweep& sweep, const SweepPass& pass,
                     const Team& team);
    void sweepHub(const ColourRun& run, ContactKernel kernel, ContactPass pass);

    const BatchTask& m_task;
    Team m_team;
};

/// Whether a colour of a giant island is worth a barrier: by its size alone, whoever runs it.
bool isShared(const Plan& plan, const ColourRun& run);

}  // namespace huestep
