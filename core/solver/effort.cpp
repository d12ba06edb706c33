#include "core/solver/effort.h"

#include <algorithm>

#include "core/math/vec.h"

namespace huestep {

namespace {

// At n = 4 and 60 Hz 0.125 are the 30 Hz that the field has settled on (physics page, "Starting
// point"). Where all goes gently contacts may be stiffer, by measurement: at 0.16 the overlap of a
// pyramid of 5,050 boxes is 1.6 times smaller and a step takes no longer; at 0.175 and above some
// of its contacts flicker, and those of piles that are small enough for n = 2 do not at 0.25. What
// is hit must not be: at 0.2 a box of 300 times their mass that falls on ten rows of boxes throws
// them about.
constexpr float contactShare = 0.125f;
constexpr float restingContactShare = 0.16f;
constexpr float fewRestingContactShare = 0.25f;
constexpr float jointShare = 0.25f;

constexpr float leastTolerance = 0.005f;    // m
constexpr float toleranceOfSize = 0.01f;    // of a body's size
constexpr float sizeOfReach = 1.41421356f;  // a square's side, from its half diagonal
constexpr float margin = 1.5625f;  // that a lower level needs: from n = 4 to 2 it is 4 in all

// Of a contact between bodies of unlike mass: from which ratio on, and the inverse effective mass
// of a box's corner row, in inverse masses of the box.
constexpr float leastRatio = 8.0f;
constexpr float rowOfLight = 2.5f;

constexpr float treeMargin = 4.0f;  // below the need, before trees are left to sweeps again
// From which on joints are solved with their tree. Ragdolls of 10 joints are left to sweeps, which
// take a quarter of the time and hold them well enough.
constexpr float treeRatio = 10.0f;
constexpr std::uint32_t manyJoints = 24;

constexpr int rampOfOctave = 16;
constexpr int contactRamp = 4;            // of an octave: they push at 3 m/s at most
constexpr float rampStep = 0.957603281f;  // 2^(−1/16)

/// Constraint substeps a tick that an island may take: 4,096 constraints at n = 4, 512 at n = 32.
constexpr std::uint32_t budget = 16'384;

}  // namespace

RowFrequency rowFrequency(std::uint32_t substeps, bool gentle) {
    const float resting = substeps < 4 ? fewRestingContactShare : restingContactShare;
    return {gentle ? resting : contactShare, jointShare};
}

float softFloor(float frequency, float h) {
    const float omega = 6.28318530718f * frequency;
    return h / (omega * omega);
}

float visualTolerance(float reach) {
    return maxOf(leastTolerance, toleranceOfSize * (sizeOfReach * reach));
}

std::uint8_t neededEffort(std::uint8_t level, float strain) {
    std::uint8_t needed = level;
    while (strain > 1.0f && needed < 24) {
        strain *= 0.25f;
        ++needed;
    }
    return needed;
}

bool isCalm(std::uint8_t level, float strain, const EffortRange& range) {
    if (level <= range.least) return false;
    const std::uint32_t n = substepsOf(level);
    const float stiffer =
        rowFrequency(n, range.gentle).contact / rowFrequency(n / 2, range.gentle).contact;
    return margin * (4.0f * stiffer * stiffer) * strain <= 1.0f;
}

float rampShare(std::uint8_t ramp) {
    float share = 1.0f;
    for (int octaves = ramp / rampOfOctave; octaves > 0; --octaves) share *= 0.5f;
    for (int steps = ramp % rampOfOctave; steps > 0; --steps) share *= rampStep;
    return share;
}

EffortPlan planEffort(EffortPlan now, IslandStrain strain, const EffortRange& range) {
    const bool trees = now.trees && range.mayHaveTrees;
    const auto plan = [&](int level, int calm, bool atOnce) {
        return EffortPlan{static_cast<std::uint8_t>(level), static_cast<std::int8_t>(calm),
                          range.gentle, atOnce};
    };
    if (now.level > range.most) return plan(range.most, 0, trees);
    if (now.level < range.least) return plan(range.least, 0, trees);
    const int ramp = rampOf(now.calm);
    // What it will be at the end of the ramp.
    const float share = rampShare(rampOf(now.calm));
    const float full = strain.rows * (share * share);
    const auto ramping = [](int steps) { return steps > 0 ? 1 - strainedSteps - steps : 0; };
    const bool wantsTrees = range.mayHaveTrees && !trees && strain.trees > 1.0f;
    if (wantsTrees || (full > 1.0f && now.level < range.most)) {
        if (ramp == 0 && now.calm > 1 - strainedSteps) {
            return plan(now.level, std::min<int>(now.calm, 0) - 1, trees);
        }
        const std::uint8_t level = std::min(neededEffort(now.level, full), range.most);
        const int longer = (range.jointed ? rampOfOctave : contactRamp) * (level - now.level);
        return plan(level, ramping(std::min<int>(ramp + longer, highestRamp)), trees || wantsTrees);
    }
    if (ramp > 0) return plan(now.level, ramping(ramp - 1), trees);
    const bool calmTrees = trees && isCalmTree(strain.trees);
    if (!calmTrees && !isCalm(now.level, strain.rows, range)) return plan(now.level, 0, trees);
    if (now.calm + 1 < calmSteps) return plan(now.level, std::max<int>(now.calm, 0) + 1, trees);
    return calmTrees ? plan(now.level, 0, false) : plan(now.level - 1, 0, trees);
}

bool isCalmTree(float strain) {
    return treeMargin * strain <= 1.0f;
}

float massRatio(float inverseMassA, float inverseMassB) {
    const float light = maxOf(inverseMassA, inverseMassB);
    const float heavy = minOf(inverseMassA, inverseMassB);
    return heavy > 0.0f ? light / heavy : 1.0f;
}

bool wantsTree(const JointedBodies& bodies) {
    return bodies.joints >= manyJoints || bodies.ratio >= treeRatio;
}

float strainOfBeginning(float inverseMassA, float inverseMassB, float approach, float gravity,
                        float stepSeconds, float allowance, std::uint8_t level) {
    const float light = maxOf(inverseMassA, inverseMassB),
                heavy = minOf(inverseMassA, inverseMassB);
    if (!(heavy > 0.0f) || light < leastRatio * heavy) return 0.0f;
    const std::uint32_t n = substepsOf(level);
    const float h = stepSeconds / static_cast<float>(n);
    const float push = (gravity + maxOf(approach, 0.0f) / stepSeconds) * h;  // m/s a substep
    const float change = rowOfLight * (light / heavy) * push;
    return change * allowance * softFloor(rowFrequency(n, false).contact, h);
}

std::uint8_t affordableEffort(std::uint32_t constraints) {
    std::uint8_t level = highestEffort;
    while (level > standardEffort && (constraints << level) > budget) --level;
    return level;
}

}  // namespace huestep
