/// Contact rows as the solver streams them: structure of arrays in blocks of 16 lanes.
///
/// One field of one block is one cache line, so kernels of 1, 4, 8 and 16 lanes read the same
/// memory, and a field that a pass does not touch costs that pass nothing.
#pragma once

#include <cstdint>
#include <cstring>

#include "core/contact/contact_fields.h"
#include "core/state/records.h"

namespace huestep {

/// What a solver pass reads and writes of a body: 32 bytes, one gather.
///
/// Positions are deltas from the step's start, so that precision does not fade far from the origin.
struct alignas(32) SolverBody {
    float vx = 0, vy = 0, w = 0;  ///< m/s, rad/s
    float inverseMass = 0;        ///< 1/kg; 0: never moved
    float dx = 0, dy = 0;         ///< m, moved since the start of the step
    float dc = 1, ds = 0;         ///< turned since the start of the step
};

/// Where a body was at the start of the step, by the same places: m, and its rotation.
struct alignas(16) SolverPose {
    float x = 0, y = 0;
    float c = 1, s = 0;
};

/// The place of a body in the solver's array: a static or kinematic one is `~place` (negative):
/// it is read and never written. Place 0 is the world itself, at its origin.
using BodyPlace = std::int32_t;
inline constexpr BodyPlace fixedWorld = ~BodyPlace{0};
constexpr BodyPlace readPlace(BodyPlace p) {
    return p < 0 ? ~p : p;
}

inline constexpr int blockLanes = 16;
/// How many blocks `lanes` constraints fill.
constexpr std::uint32_t blocksOf(std::uint32_t lanes) {
    return (lanes + blockLanes - 1) / blockLanes;
}

using LaneRow = float[blockLanes];

struct alignas(64) ContactPointRows : ContactPointFields<LaneRow> {
    LaneRow separation;        ///< m, at the start of the step, less n·(rB − rA)
    LaneRow maxNormalImpulse;  ///< over the step: whether the point ever pushed; where it `mayHit`
    LaneRow approach;          ///< m/s, relative normal velocity at the start of the step
    LaneRow relaxedAt;         ///< m, the separation that the last `relax` found
};

struct alignas(64) ContactBlock : ContactFields<LaneRow> {
    BodyPlace bodyA[blockLanes];
    BodyPlace bodyB[blockLanes];
    ContactPointRows points[2];
    // As `bodyA` and `bodyB` for the warm start of later substeps: bodies that carry their impulses
    // over by themselves are read and not written.
    BodyPlace warmA[blockLanes];
    BodyPlace warmB[blockLanes];
    std::int32_t anyWarm;  ///< whether a lane has a body that does not
    // Of the world, for what is not solved: places of bodies and shapes.
    std::int32_t motionA[blockLanes];
    std::int32_t motionB[blockLanes];
    std::int32_t boundsA[blockLanes];
    std::int32_t boundsB[blockLanes];
    std::int32_t kept[blockLanes];  ///< −1: the manifold is that of the last step; 0: it is not
    std::int32_t hit[blockLanes];   ///< −1: the shapes met hard in this step; 0: they did not
    std::int32_t mayHit;            ///< whether any lane approaches fast enough to hit or bounce
    /// Of a hub's block: by how many lanes the hub's mass was divided last; 0: rows are as made.
    std::uint32_t shares;
    std::int32_t cold[blockLanes];  ///< −1: the contact began in this step, and gets `relaxCold`
    std::int32_t anyCold;           ///< whether any lane is
    // Where substeps are planned.
    LaneRow allowance;  ///< 1/m, of what a lane may overlap; 0: padding
    LaneRow strain;     ///< s⁻¹: the speed by which its last impulses change it, times that
};

/// Impulses of one lane for substeps of another length.
inline void scaleLane(ContactBlock& rows, std::uint32_t lane, float by) {
    for (ContactPointRows& p : rows.points) {
        p.normalImpulse[lane] *= by;
        p.tangentImpulse[lane] *= by;
    }
    rows.rollingImpulse[lane] *= by;
}

/// Makes the impulses of one block those of another.
inline void copyImpulses(const ContactBlock& from, ContactBlock& to) {
    for (std::size_t i = 0; i < 2; ++i) {
        std::memcpy(to.points[i].normalImpulse, from.points[i].normalImpulse, sizeof(LaneRow));
        std::memcpy(to.points[i].tangentImpulse, from.points[i].tangentImpulse, sizeof(LaneRow));
    }
    std::memcpy(to.rollingImpulse, from.rollingImpulse, sizeof(LaneRow));
}

/// Soft constraint coefficients of a damped oscillator (frequency f, damping ratio ζ) at step h:
/// ω = 2πf, a₁ = 2ζ + hω, a₂ = hω a₁, a₃ = 1/(1 + a₂); bias rate ω/a₁, mass scale a₂a₃, impulse
/// scale a₃ (physics page, section on soft rows; Catto, "Soft Constraints", GDC 2011).
struct Softness {
    float biasRate = 0;  ///< 1/s
    float massScale = 1;
    float impulseScale = 0;
};
Softness softness(float hertz, float dampingRatio, float h);

/// What the rows of a colour use; unused parts are skipped whole.
struct ContactFeatures {
    bool friction = false;
    bool rolling = false;
    bool tangentSpeed = false;
    bool restitution = false;
    bool cold = false;  ///< a contact that began in this step
};

constexpr ContactFeatures operator|(ContactFeatures a, ContactFeatures b) {
    return {a.friction || b.friction, a.rolling || b.rolling, a.tangentSpeed || b.tangentSpeed,
            a.restitution || b.restitution, a.cold || b.cold};
}

/// Constants of a pass.
struct ContactPass {
    Softness soft;
    float inverseH = 0;   ///< 1/s
    float pushSpeed = 0;  ///< m/s, most that overlap is pushed apart with
    float slop = 0;       ///< m, of overlap that `project` and `correct` let be
    /// Of `solve`: whether nothing has moved since the last `relax` of all rows. Then separations
    /// are those that it found, and bodies' moves need not be fetched: the same bits for less.
    bool relaxedBefore = false;
    ContactFeatures features;
};

/// A pass over `count` contacts from the start of `blocks`. Contacts of one call share no body
/// that is written. Thread rule: calls on disjoint blocks of one colour may run side by side.
using ContactKernel = void (*)(SolverBody* bodies, ContactBlock* blocks, std::uint32_t count,
                               const ContactPass& pass);

/// Brings `count` whole blocks to the start of a step: separations and approach speeds from the
/// bodies' poses and velocities, of all 16 lanes. Everything else of a row holds as long as its
/// manifold does.
using ContactRefresh = void (*)(const SolverBody* bodies, const SolverPose* poses,
                                ContactBlock* blocks, std::uint32_t count);

/// Finds which of `count` whole blocks' manifolds are kept (physics page, 4), of all 16 lanes:
/// where the shapes' bounds overlap and the bodies have hardly moved against each other. The lanes'
/// form of `mayRecycle`.
using ContactCheck = void (*)(const BodyMotion* motions, const Bounds* bounds, ContactBlock* blocks,
                              std::uint32_t count);

/// Makes the impulses of `count` whole blocks fit for state (finite, canonical zeros) and marks the
/// hits. Returns whether there are any.
using ContactSettle = bool (*)(ContactBlock* blocks, std::uint32_t count);

/// Writes how much the lanes of `count` whole blocks are strained (core/solver/effort.h).
using ContactStrain = void (*)(ContactBlock* blocks, std::uint32_t count);

/// How many of a block's lanes have a row that acts or may: it pushes already, or its gap closes
/// within the substep. `bodies` holds what the lanes' places say.
using ContactCount = std::uint32_t (*)(const SolverBody* bodies, const ContactBlock& block,
                                       const ContactPass& pass);

/// The same by lane: −1 for those that act, 0 for others. `active` has room for 16.
using ContactActivity = void (*)(const SolverBody* bodies, const ContactBlock& block,
                                 const ContactPass& pass, std::int32_t* active);

/// Gives a block's rows the masses that follow from its inertias and from the bodies at the lanes'
/// places.
using ContactMasses = void (*)(const SolverBody* bodies, ContactBlock& block);

/// Gives the rows of a hub's block the masses that follow from the bodies at the lanes' places,
/// copies of the hub with their share of its mass among them. `hubIsA`: a mask by lane;
/// `inertia`: of such a copy, inverse, 1/(kg·m²).
using ContactShare = void (*)(const SolverBody* bodies, ContactBlock& block,
                              const std::int32_t* hubIsA, float inertia);

struct ContactKernels {
    ContactCheck check = nullptr;
    ContactRefresh refresh = nullptr;
    ContactKernel warmStart = nullptr;
    ContactKernel warmStartAgain = nullptr;  ///< of bodies that do not carry their impulses over
    ContactKernel solve = nullptr;           ///< normals with bias
    ContactKernel relax = nullptr;           ///< normals without bias, then friction and rolling
    ContactKernel relaxCold = nullptr;       ///< `relax` once more, of contacts that began
    ContactKernel restitute = nullptr;
    // Of projected Gauss-Seidel (pgs_kernels.cpp):
    ContactKernel project = nullptr;  ///< normals that push rigidly at the bias rate, then friction
    ContactKernel correct = nullptr;  ///< moves bodies that overlap apart, no velocity
    ContactSettle settle = nullptr;
    ContactCount countActive = nullptr;
    ContactActivity markActive = nullptr;
    ContactMasses findMasses = nullptr;
    ContactShare shareHub = nullptr;
    ContactStrain strain = nullptr;
};

/// The same passes for one contact of a block.
using ContactLanePass = void (*)(SolverBody* bodies, ContactBlock& block, std::uint32_t lane,
                                 const ContactPass& pass);
struct ContactLanePasses {
    ContactLanePass warmStart = nullptr;
    ContactLanePass warmStartAgain = nullptr;
    ContactLanePass solve = nullptr;
    ContactLanePass relax = nullptr;
    ContactLanePass relaxCold = nullptr;
    ContactLanePass restitute = nullptr;
};

}  // namespace huestep
