/// Effort by need: how many substeps an island gets, from how much its rows give way.
///
/// A soft row of effective mass m under a force F is violated by e = F / (m ω²) at rest, whatever
/// else (physics page, 1), with ω = 2πf and f a fixed share of the substep rate. F is the last
/// impulse λ over the substep h, so e = (λ/m) h / (2πc)²: known, row by row, once a step is solved.
/// A row's strain is e over what the scene allows there; an island's is the largest of its rows. As
/// f goes with n, twice the substeps quarter it: that says how many the next step needs.
#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace huestep {

/// A level of effort is log₂ of the substeps; from 1 to 32.
inline constexpr std::uint8_t highestEffort = 5;
inline constexpr std::uint8_t standardEffort = 2;  ///< with which bodies start
inline constexpr std::uint8_t restingEffort = 1;
constexpr std::uint32_t substepsOf(std::uint8_t effort) {
    return 1u << effort;
}

/// Steps for which a lower level must do before it is taken.
inline constexpr std::int8_t calmSteps = 30;
/// Steps for which rows must be strained before a higher level is taken: an impact is over by then.
inline constexpr std::int8_t strainedSteps = 3;

/// How many sixteenths of an octave a raised island's rows are still below their full frequency.
/// They come nearer by one a step. Stretched joints that were stiffened at once would be given the
/// energy of the stiffer spring: a chain of ratio 100 swung 2.6 times as high. An island of
/// contacts alone has only a quarter of the way to go: waiting costs it more than the push.
constexpr std::uint8_t rampOf(std::int8_t calm) {
    constexpr int first = 1 - strainedSteps;
    return calm < first ? static_cast<std::uint8_t>(first - calm) : std::uint8_t{0};
}
inline constexpr std::uint8_t highestRamp = 64;
/// The share of its full frequency that a row has so far below it: (0, 1].
float rampShare(std::uint8_t ramp);

/// Frequencies of rows as shares of the substep rate.
struct RowFrequency {
    float contact;  ///< against static and kinematic bodies twice that
    float joint;
};
RowFrequency rowFrequency(std::uint32_t substeps, bool gentle = false);

/// Violation at rest for an impulse that changes a row's velocity by 1 m/s a substep of `h`
/// seconds: m. `frequency`: share of the substep rate.
float softFloor(float frequency, float h);

/// How far rows of a body of this size may be off where the scene leaves it at *visual*: m.
/// `reach`: its farthest point from the centre; 0: no bound but the least.
float visualTolerance(float reach);

/// What an island does next.
struct EffortPlan {
    std::uint8_t level = standardEffort;
    std::int8_t calm = 0;  ///< steps; −1, −2: strained; below: a ramp, see `rampOf`
    bool gentle = false;   ///< contacts may be stiffer: nothing hits anything
    bool trees = false;    ///< joint trees are solved at once (joint_trees.h)

    // As a body's state keeps them, `calm` apart.
    static constexpr std::uint8_t gentleBit = 0x80, treesBit = 0x40;
    [[nodiscard]] constexpr std::uint8_t packed() const {
        return static_cast<std::uint8_t>(level | (gentle ? gentleBit : 0) | (trees ? treesBit : 0));
    }
};
constexpr std::uint8_t levelOf(std::uint8_t effort) {
    return effort & (EffortPlan::treesBit - 1);
}
constexpr bool treesAt(std::uint8_t effort) {
    return (effort & EffortPlan::treesBit) != 0;
}
constexpr bool gentleAt(std::uint8_t effort) {
    return (effort & EffortPlan::gentleBit) != 0;
}

/// Between which levels an island may be.
struct EffortRange {
    std::uint8_t least = standardEffort;  ///< `restingEffort` of one at rest without joints
    std::uint8_t most = highestEffort;    ///< `affordableEffort`; what needs more stays there
    bool gentle = false;                  ///< whether nothing in it is faster than 1 m/s
    bool jointed = false;                 ///< whether it has joints
    bool mayHaveTrees = false;            ///< that may be solved at once
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
/// very unlike, or loads add up over a long row of them.
bool wantsTree(const JointedBodies& bodies);

/// Up to how many constraints an island's joint trees may be solved at once: one thread does it.
inline constexpr std::uint32_t mostWithTrees = 1024;

/// What the strain of a contact that begins will be, which no impulse tells yet: the heavier body's
/// weight and its momentum over a step, on a row of the lighter one. Of bodies of like mass, 0:
/// what they do to each other is over before it is known.
float strainOfBeginning(float inverseMassA, float inverseMassB, float approach, float gravity,
                        float stepSeconds, float allowance, std::uint8_t level);

/// Whether the level below would do, with a margin.
bool isCalm(std::uint8_t level, float strain, const EffortRange& range);

/// The level at which the strain would be at most 1, however high; for reports.
std::uint8_t neededEffort(std::uint8_t level, float strain);

/// The level up to which an island of so many constraints may go: substeps times constraints are
/// bounded, so that no island takes a tick hostage; the standard is always allowed.
std::uint8_t affordableEffort(std::uint32_t constraints);

}  // namespace huestep
