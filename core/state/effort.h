/// How much work an island gets, as the state of its bodies keeps it, and what its size allows.
///
/// What follows from strain is the solver's matter (core/solver/effort.h).
#pragma once

#include <cstdint>

namespace huestep {

/// A level of effort is log₂ of the substeps; from 1 to 32.
inline constexpr std::uint8_t highestEffort = 5;
inline constexpr std::uint8_t standardEffort = 2;  ///< with which bodies start
inline constexpr std::uint8_t restingEffort = 1;
inline constexpr std::uint8_t hangingEffort = 0;
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
/// What an island does next.
struct EffortPlan {
    std::uint8_t level = standardEffort;
    std::int8_t calm = 0;   ///< steps; −1, −2: strained; below: a ramp, see `rampOf`
    bool gentle = false;    ///< contacts may be stiffer: nothing hits anything
    bool trees = false;     ///< joint trees are solved at once (joint_trees.h)
    bool recovers = false;  ///< bodies that began deep inside each other come apart (recovery.h)

    // As a body's state keeps them, `calm` apart.
    static constexpr std::uint8_t gentleBit = 0x80, treesBit = 0x40, recoversBit = 0x20;
    [[nodiscard]] constexpr std::uint8_t packed() const {
        return static_cast<std::uint8_t>(level | (gentle ? gentleBit : 0) | (trees ? treesBit : 0) |
                                         (recovers ? recoversBit : 0));
    }
};
constexpr std::uint8_t levelOf(std::uint8_t effort) {
    return effort & (EffortPlan::recoversBit - 1);
}
constexpr bool treesAt(std::uint8_t effort) {
    return (effort & EffortPlan::treesBit) != 0;
}
constexpr bool recoversAt(std::uint8_t effort) {
    return (effort & EffortPlan::recoversBit) != 0;
}
constexpr bool gentleAt(std::uint8_t effort) {
    return (effort & EffortPlan::gentleBit) != 0;
}

/// The level up to which an island of so many constraints may go: substeps times constraints are
/// bounded (4,096 constraints at n = 4, 512 at n = 32), so that no island takes a tick hostage; the
/// standard is always allowed.
constexpr std::uint8_t affordableEffort(std::uint32_t constraints) {
    constexpr std::uint32_t budget = 16'384;  // constraint substeps a tick
    std::uint8_t level = highestEffort;
    while (level > standardEffort && (constraints << level) > budget) --level;
    return level;
}
/// Whether an island of so many constraints gets no more than the standard.
constexpr bool isLarge(std::uint32_t constraints) {
    return affordableEffort(constraints) <= standardEffort;
}

/// Up to how many constraints an island's joint trees may be solved at once: one thread does it.
inline constexpr std::uint32_t mostWithTrees = 1024;

/// Up to how many constraints an island may recover: it takes ten times as long.
inline constexpr std::uint32_t mostRecovering = 2048;

}  // namespace huestep
