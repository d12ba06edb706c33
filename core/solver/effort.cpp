#include "core/solver/effort.h"

#include <algorithm>

#include "core/math/vec.h"

namespace huestep {

namespace {

// At n = 4 and 60 Hz 0.125 are the 30 Hz that the field has settled on (physics page, "Starting
// point"). Where nothing hits anything contacts may be stiffer, by measurement: a stack of 100
// boxes stands at 0.16 and falls from 0.2 on; piles that are small enough for n = 2 bear 0.25. What
// is hit must not be: at 0.2 a box of 300 times their mass that falls on ten rows of boxes throws
// them about. Large islands, which more substeps would be too many for, get 0.22, damped less: a
// pyramid of 5,050 boxes sinks by 0.46 m when it is set up, where 0.16 makes it 0.68 m and the
// standard 1.08 m; at 0.24 it sways.
constexpr float contactShare = 0.125f;
constexpr float gentleContactShare = 0.16f;
constexpr float fewGentleContactShare = 0.25f;
constexpr float largeContactShare = 0.22f;
constexpr float contactDamping = 10.0f;
constexpr float largeContactDamping = 7.0f;
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
constexpr float treeRatio = 20.0f;
constexpr std::uint32_t manyJoints = 24;
// A pendulum is 30 times, a double pendulum 10 times as exact.
constexpr std::uint32_t fewJoints = 2;

constexpr int rampOfOctave = 16;
constexpr int contactRamp = 4;            // of an octave: they push at 3 m/s at most
constexpr float rampStep = 0.957603281f;  // 2^(−1/16)

}  // namespace

RowFrequency rowFrequency(std::uint32_t substeps, bool gentle, bool large) {
    if (!gentle) return {contactShare, jointShare, contactDamping};
    if (substeps < 4) return {fewGentleContactShare, jointShare, contactDamping};
    if (!large) return {gentleContactShare, jointShare, contactDamping};
    return {largeContactShare, jointShare, largeContactDamping};
}

float softFloor(float frequency, float h) {
    const float omega = 6.28318530718f * frequency;
    return h / (omega * omega);
}

float visualTolerance(float reach) {
    return maxOf(leastTolerance, toleranceOfSize * (sizeOfReach * reach));
}

float allowedError(float need, float reachA, float reachB) {
    if (need > 0.0f) return need;
    if (!(reachA > 0.0f)) return visualTolerance(reachB);
    return visualTolerance(reachB > 0.0f ? minOf(reachA, reachB) : reachA);
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
    const bool large = range.most <= standardEffort;
    const float stiffer = rowFrequency(n, range.gentle, large).contact /
                          rowFrequency(n / 2, range.gentle, large).contact;
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
    const bool calmTrees = trees && !range.keepsTrees && isCalmTree(strain.trees);
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
    return bodies.joints >= manyJoints || bodies.ratio >= treeRatio ||
           (bodies.joints > 0 && bodies.joints <= fewJoints);
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

}  // namespace huestep
