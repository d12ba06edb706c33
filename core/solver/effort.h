/// Effort by need: how many substeps an island gets, from how much its rows give way.
///
/// A soft row of effective mass m under a force F is violated by e = F / (m ω²) at rest, whatever
/// else (physics page, 1), with ω = 2πf and f a fixed share of the substep rate. F is the last
/// impulse λ over the substep h, so e = (λ/m) h / (2πc)²: known, row by row, once a step is solved.
/// A row's strain is e over what the scene allows there; an island's is the largest of its rows. As
/// f goes with n, twice the substeps quarter it: that says how many the next step needs.
#pragma once

#include <cstdint>

#include "core/state/effort.h"

namespace huestep {

/// The share of its full frequency that a row has so far below it: (0, 1].
float rampShare(std::uint8_t ramp);

/// Frequencies of rows as shares of the substep rate, and how contacts are damped.
struct RowFrequency {
    float contact;  ///< against static and kinematic bodies twice that
    float joint;
    float contactDamping;  ///< ratio ζ
};
/// `gentle`: nothing in the island hits anything; `large`: no more substeps are allowed it.
RowFrequency rowFrequency(std::uint32_t substeps, bool gentle = false, bool large = false);
/// Violation at rest for an impulse that changes a row's velocity by 1 m/s a substep of `h`
/// seconds: m. `frequency`: share of the substep rate.
float softFloor(float frequency, float h);

/// How far rows of a body of this size may be off where the scene leaves it at *visual*: m.
/// `reach`: its farthest point from the centre; 0: no bound but the least.
float visualTolerance(float reach);

/// How far a row of two bodies of these reaches may be off, m: `need` where the scene names one (it
/// is not 0), else *visual*, by the smaller of those that have a reach.
float allowedError(float need, float reachA, float reachB);

/// Between which levels an island may be.
struct EffortRange {
    std::uint8_t least = standardEffort;  ///< `restingEffort`, `hangingEffort` of one at rest
    std::uint8_t most = highestEffort;    ///< `affordableEffort`; what needs more stays there
    bool gentle = false;                  ///< whether nothing in it hits anything
    bool jointed = false;                 ///< whether it has joints
    bool mayHaveTrees = false;            ///< that may be solved at once
    bool keepsTrees = false;              ///< and always are: see `wantsTree`
};

/// How much an island's rows gave way, of what they may.
struct IslandStrain {
    float rows = 0;   ///< of those that more substeps help
    float trees = 0;  ///< of joints that may be solved at once, were they not
};

/// From what this step took, how long it has been calm, and the strain it ended with.
EffortPlan planEffort(EffortPlan now, IslandStrain strain, const EffortRange& range);

/// Whether joints that are solved at once could be left to sweeps again, with a margin.
bool isCalmTree(float strain);

/// What hangs together by joints alone.
struct JointedBodies {
    std::uint32_t joints = 0;
    float ratio = 1.0f;  ///< of the masses that a joint holds together, the most unlike
};
/// The heavier mass over the lighter, of inverse masses (1/kg); 1 where one does not move.
float massRatio(float inverseMassA, float inverseMassB);
/// Whether its joints are solved at once from the start, before their rows give way: masses are
/// very unlike, or loads add up over a long row of them, or they are so few that it costs nothing.
bool wantsTree(const JointedBodies& bodies);

/// Overlap with which a contact begins that was not brought about by its bodies' motion, in
/// tolerances: its island recovers until all are within one.
inline constexpr float deepBeginning = 4.0f;
/// What the strain of a contact that begins will be, which no impulse tells yet: the heavier body's
/// weight and its momentum over a step, on a row of the lighter one. Of bodies of like mass, 0:
/// what they do to each other is over before it is known.
float strainOfBeginning(float inverseMassA, float inverseMassB, float approach, float gravity,
                        float stepSeconds, float allowance, std::uint8_t level);

/// Whether the level below would do, with a margin.
bool isCalm(std::uint8_t level, float strain, const EffortRange& range);

/// The level at which the strain would be at most 1, however high; for reports.
std::uint8_t neededEffort(std::uint8_t level, float strain);

}  // namespace huestep
