// The passes of the soft step over contact rows (physics page, "Starting point"; the soft row is
// derived in contact_block.h). One template, compiled once for each width.

#include "core/solver/contact_kernels.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "core/contact/narrow_phase.h"
#include "core/solver/contact_lanes.h"
#include "core/world/event.h"

namespace huestep {

namespace {

/// Whether the bodies of W contacts have moved so little against each other that their manifolds
/// are kept: `mayRecycle` and the overlap of bounds, operation by operation.
template <int W>
HUESTEP_INLINE void checkLanes(const BodyMotion* motions, const Bounds* bounds, ContactBlock& block,
                               int lane) {
    PoseLanes<W> a, b;
    gatherFour<W>(motions, block.motionA + lane, 0, a.x, a.y, a.c, a.s);
    gatherFour<W>(motions, block.motionB + lane, 0, b.x, b.y, b.c, b.s);
    LaneF<W> lowAx, lowAy, highAx, highAy, lowBx, lowBy, highBx, highBy;
    gatherFour<W>(bounds, block.boundsA + lane, 0, lowAx, lowAy, highAx, highAy);
    gatherFour<W>(bounds, block.boundsB + lane, 0, lowBx, lowBy, highBx, highBy);
    const auto near =
        both(both(lowAx <= highBx, lowBx <= highAx), both(lowAy <= highBy, lowBy <= highAy));

    const auto row = [&](const LaneRow& field) __attribute__((always_inline)) {
        return loadLanes<W>(field + lane);
    };
    const LaneF<W> cosine = splat<W>(recycleCosine);
    const auto upright = both(a.c * row(block.cosineA) + a.s * row(block.sineA) > cosine,
                              b.c * row(block.cosineB) + b.s * row(block.sineB) > cosine);
    const LaneF<W> dx = b.x - a.x, dy = b.y - a.y;
    const LaneF<W> movedX = (a.c * dx + a.s * dy) - row(block.relativeX);
    const LaneF<W> movedY = (a.c * dy - a.s * dx) - row(block.relativeY);
    const LaneF<W> c = a.c * b.c + a.s * b.s, s = a.c * b.s - a.s * b.c;
    const LaneF<W> madeC = row(block.relativeC), madeS = row(block.relativeS);
    const LaneF<W> turnedC = madeC * c + madeS * s;
    const LaneF<W> turnedS = madeC * s - madeS * c;
    const auto flat = row(block.roundness) * (splat<W>(1.0f) - turnedC) <= splat<W>(recycleLift);
    const LaneF<W> zero = splat<W>(0.0f);
    const LaneF<W> swing = row(block.reach) * selectLanes(turnedS < zero, zero - turnedS, turnedS);
    const LaneF<W> room = row(block.slack) - swing;
    const auto still = both(room > zero, movedX * movedX + movedY * movedY < room * room);
    storeMask<W>(block.kept + lane, both(both(near, upright), both(flat, still)));
}

/// How far a body has turned since its manifold was made: q₀⁻¹ q.
template <int W>
HUESTEP_INLINE void turnedSince(const LaneF<W>& c0, const LaneF<W>& s0, const PoseLanes<W>& now,
                                LaneF<W>& c, LaneF<W>& s) {
    c = c0 * now.c + s0 * now.s;
    s = c0 * now.s - s0 * now.c;
}

/// Separations follow the bodies from where the manifold was made, anchors and normal stay: how far
/// the anchors have come apart since, when they met. The passes add n·(rB − rA) and how the anchors
/// move from here on.
template <int W>
HUESTEP_INLINE void refreshLanes(const SolverBody* bodies, const SolverPose* poses,
                                 ContactBlock& block, int lane) {
    const Pair<W> pair(bodies, block, lane);
    const PoseLanes<W> a = gatherPoses<W>(poses, block.bodyA + lane);
    const PoseLanes<W> b = gatherPoses<W>(poses, block.bodyB + lane);
    LaneF<W> cA, sA, cB, sB;
    turnedSince<W>(loadLanes<W>(block.cosineA + lane), loadLanes<W>(block.sineA + lane), a, cA, sA);
    turnedSince<W>(loadLanes<W>(block.cosineB + lane), loadLanes<W>(block.sineB + lane), b, cB, sB);
    auto fast = splat<W>(0.0f) > splat<W>(0.0f);
    for (ContactPointRows& p : block.points) {
        const Anchors<W> r = anchorsOf<W>(p, lane);
        const LaneF<W> x = (b.x - a.x) + ((cB * r.bx - sB * r.by) - (cA * r.ax - sA * r.ay));
        const LaneF<W> y = (b.y - a.y) + ((sB * r.bx + cB * r.by) - (sA * r.ax + cA * r.ay));
        const LaneF<W> met = pair.nx * (r.bx - r.ax) + pair.ny * (r.by - r.ay);
        const LaneF<W> made = loadLanes<W>(p.madeSeparation + lane);
        storeLanes<W>(p.separation + lane, (made + (pair.nx * x + pair.ny * y)) - met);
        LaneF<W> vx, vy;
        relativeVelocity<W>(pair, r, vx, vy);
        const LaneF<W> approach = vx * pair.nx + vy * pair.ny;
        storeLanes<W>(p.approach + lane, approach);
        storeLanes<W>(p.maxNormalImpulse + lane, splat<W>(0.0f));
        fast = either(fast, approach < splat<W>(-hitSpeed));
    }
    storeMask<W>(block.hit + lane, fast);
}

template <int W>
HUESTEP_INLINE void applyWarmImpulses(SolverBody* bodies, ContactBlock& block,
                                      const BodyPlace* placeA, const BodyPlace* placeB, int lane,
                                      const ContactPass& pass) {
    PairLanes<W> pair(bodies, block, placeA, placeB, lane);
    const LaneF<W> nx = loadLanes<W>(block.normalX + lane);
    const LaneF<W> ny = loadLanes<W>(block.normalY + lane);
    for (const ContactPointRows& p : block.points) {
        const Anchors<W> r = anchorsOf<W>(p, lane);
        const LaneF<W> normal = loadLanes<W>(p.normalImpulse + lane);
        const LaneF<W> tangent = loadLanes<W>(p.tangentImpulse + lane);
        // The tangent is the normal turned right: (ny, −nx).
        applyImpulse<W>(pair, r, normal * nx + tangent * ny, normal * ny - tangent * nx);
    }
    if (pass.features.rolling) {
        const LaneF<W> rolling = loadLanes<W>(block.rollingImpulse + lane);
        pair.a.w = pair.a.w - pair.inverseInertiaA * rolling;
        pair.b.w = pair.b.w + pair.inverseInertiaB * rolling;
    }
    pair.store(bodies, placeA, placeB, lane);
}

template <int W>
HUESTEP_INLINE void warmStartLanes(SolverBody* bodies, ContactBlock& block, int lane,
                                   const ContactPass& pass) {
    applyWarmImpulses<W>(bodies, block, block.bodyA, block.bodyB, lane, pass);
}

template <int W>
HUESTEP_INLINE void warmStartAgainLanes(SolverBody* bodies, ContactBlock& block, int lane,
                                        const ContactPass& pass) {
    if (block.anyWarm == 0) return;
    applyWarmImpulses<W>(bodies, block, block.warmA, block.warmB, lane, pass);
}

/// The normal rows of both points. A point still apart may close its gap within the substep and
/// no faster (bias s/h); one that overlaps is pushed out softly, or not at all in relax.
/// `separationOf(p, r)`: how far a point is open.
template <int W, bool Bias, class SeparationOf>
HUESTEP_INLINE void solveNormals(Pair<W>& pair, ContactBlock& block, int lane,
                                 const ContactPass& pass, SeparationOf&& separationOf) {
    const LaneF<W> zero = splat<W>(0.0f);
    const LaneF<W> one = splat<W>(1.0f);
    for (ContactPointRows& p : block.points) {
        const Anchors<W> r = anchorsOf<W>(p, lane);
        const LaneF<W> s = separationOf(p, r);
        const auto apart = s > zero;
        LaneF<W> x, y;
        relativeVelocity<W>(pair, r, x, y);
        const LaneF<W> vn = x * pair.nx + y * pair.ny;
        const LaneF<W> mass = loadLanes<W>(p.normalMass + lane);
        const LaneF<W> old = loadLanes<W>(p.normalImpulse + lane);
        LaneF<W> impulse;
        if constexpr (Bias) {
            const LaneF<W> push =
                maxLanes(s * splat<W>(pass.soft.biasRate), splat<W>(-pass.pushSpeed));
            const LaneF<W> bias = selectLanes(apart, s * splat<W>(pass.inverseH), push);
            const LaneF<W> massScale = selectLanes(apart, one, splat<W>(pass.soft.massScale));
            const LaneF<W> keep = selectLanes(apart, zero, splat<W>(pass.soft.impulseScale));
            impulse = zero - (mass * (massScale * (vn + bias)) + keep * old);
        } else {
            const LaneF<W> bias = selectLanes(apart, s * splat<W>(pass.inverseH), zero);
            impulse = zero - mass * (vn + bias);
        }
        const LaneF<W> sum = maxLanes(old + impulse, zero);
        impulse = sum - old;
        storeLanes<W>(p.normalImpulse + lane, sum);
        // Half the writes of a pass, and of no use where nothing comes fast.
        if (block.mayHit != 0) {
            storeLanes<W>(p.maxNormalImpulse + lane,
                          maxLanes(loadLanes<W>(p.maxNormalImpulse + lane), sum));
        }
        applyImpulse<W>(pair, r, impulse * pair.nx, impulse * pair.ny);
    }
}

template <int W>
HUESTEP_INLINE void solveLanes(SolverBody* bodies, ContactBlock& block, int lane,
                               const ContactPass& pass) {
    Pair<W> pair(bodies, block, lane);
    if (pass.relaxedBefore) {
        const auto found = [&](const ContactPointRows& p, const Anchors<W>&)
            __attribute__((always_inline)) {
            return loadLanes<W>(p.relaxedAt + lane);
        };
        solveNormals<W, true>(pair, block, lane, pass, found);
    } else {
        const DeltaLanes<W> a = gatherDeltas<W>(bodies, block.bodyA + lane);
        const DeltaLanes<W> b = gatherDeltas<W>(bodies, block.bodyB + lane);
        const auto now = [&](const ContactPointRows& p, const Anchors<W>& r)
            __attribute__((always_inline)) {
            return separationNow<W>(pair, r, a, b, loadLanes<W>(p.separation + lane));
        };
        solveNormals<W, true>(pair, block, lane, pass, now);
    }
    pair.store(bodies, block, lane);
}

/// The normal rows without bias; keeps the separations, which are the next substep's at its start.
template <int W>
HUESTEP_INLINE void relaxNormals(const SolverBody* bodies, Pair<W>& pair, ContactBlock& block,
                                 int lane, const ContactPass& pass) {
    const DeltaLanes<W> a = gatherDeltas<W>(bodies, block.bodyA + lane);
    const DeltaLanes<W> b = gatherDeltas<W>(bodies, block.bodyB + lane);
    const auto now = [&](ContactPointRows & p, const Anchors<W>& r) __attribute__((always_inline)) {
        const LaneF<W> s = separationNow<W>(pair, r, a, b, loadLanes<W>(p.separation + lane));
        storeLanes<W>(p.relaxedAt + lane, s);
        return s;
    };
    solveNormals<W, false>(pair, block, lane, pass, now);
}

template <int W>
HUESTEP_INLINE void relaxLanes(SolverBody* bodies, ContactBlock& block, int lane,
                               const ContactPass& pass) {
    Pair<W> pair(bodies, block, lane);
    relaxNormals<W>(bodies, pair, block, lane, pass);
    if (pass.features.friction) solveFriction<W>(pair, block, lane, pass);
    if (pass.features.rolling) solveRolling<W>(pair, block, lane);
    pair.store(bodies, block, lane);
}

/// Normals and friction of a contact that has just begun know nothing of each other: each of these
/// passes brings them nearer. All other lanes keep what they have, to the bit.
template <int W>
HUESTEP_INLINE void relaxColdLanes(SolverBody* bodies, ContactBlock& block, int lane,
                                   const ContactPass& pass) {
    if (block.anyCold == 0) return;
    const auto cold = loadMask<W>(block.cold + lane);
    const Pair<W> before(bodies, block, lane);
    Pair<W> pair = before;
    float* const rows[] = {block.points[0].normalImpulse,
                           block.points[1].normalImpulse,
                           block.points[0].tangentImpulse,
                           block.points[1].tangentImpulse,
                           block.points[0].maxNormalImpulse,
                           block.points[1].maxNormalImpulse,
                           block.rollingImpulse};
    LaneF<W> old[std::size(rows)];
    for (std::size_t i = 0; i < std::size(rows); ++i) old[i] = loadLanes<W>(rows[i] + lane);
    relaxNormals<W>(bodies, pair, block, lane, pass);
    if (pass.features.friction) solveFriction<W>(pair, block, lane, pass);
    if (pass.features.rolling) solveRolling<W>(pair, block, lane);
    for (std::size_t i = 0; i < std::size(rows); ++i) {
        storeLanes<W>(rows[i] + lane, selectLanes(cold, loadLanes<W>(rows[i] + lane), old[i]));
    }
    const auto keep = [&](VelocityLanes<W> & now, const VelocityLanes<W>& was)
        __attribute__((always_inline)) {
        now.vx = selectLanes(cold, now.vx, was.vx);
        now.vy = selectLanes(cold, now.vy, was.vy);
        now.w = selectLanes(cold, now.w, was.w);
    };
    keep(pair.a, before.a);
    keep(pair.b, before.b);
    pair.store(bodies, block, lane);
}

/// Newton's law once at the end of the step, where the approach was above 1 m/s and the point
/// pushed at all: bodies that meet speculatively bounce with the speed they came with.
template <int W>
HUESTEP_INLINE void restituteLanes(SolverBody* bodies, ContactBlock& block, int lane,
                                   const ContactPass&) {
    constexpr float threshold = 1.0f;  // m/s
    static_assert(threshold >= hitSpeed, "blocks that bounce may hit");
    if (block.mayHit == 0) return;
    Pair<W> pair(bodies, block, lane);
    const LaneF<W> zero = splat<W>(0.0f);
    const LaneF<W> e = loadLanes<W>(block.restitution + lane);
    for (ContactPointRows& p : block.points) {
        const Anchors<W> r = anchorsOf<W>(p, lane);
        const LaneF<W> approach = loadLanes<W>(p.approach + lane);
        const LaneF<W> pushed = loadLanes<W>(p.maxNormalImpulse + lane);
        LaneF<W> x, y;
        relativeVelocity<W>(pair, r, x, y);
        const LaneF<W> vn = x * pair.nx + y * pair.ny;
        LaneF<W> mass = loadLanes<W>(p.normalMass + lane);
        mass = selectLanes(approach < splat<W>(-threshold), mass, zero);
        mass = selectLanes(pushed > zero, mass, zero);
        mass = selectLanes(e > zero, mass, zero);
        const LaneF<W> old = loadLanes<W>(p.normalImpulse + lane);
        const LaneF<W> sum = maxLanes(old - mass * (vn + e * approach), zero);
        // Where the law does not apply the impulse stays as it is, to the bit, and does nothing.
        const LaneF<W> next = selectLanes(mass > zero, sum, old);
        storeLanes<W>(p.normalImpulse + lane, next);
        const LaneF<W> impulse = changeOf<W>(old, next);
        applyImpulse<W>(pair, r, impulse * pair.nx, impulse * pair.ny);
    }
    pair.store(bodies, block, lane);
}

template <int W>
HUESTEP_INLINE void activeLanes(const SolverBody* bodies, const ContactBlock& block, int lane,
                                const ContactPass& pass, std::int32_t* active) {
    const Pair<W> pair(bodies, block, lane);
    const DeltaLanes<W> a = gatherDeltas<W>(bodies, block.bodyA + lane);
    const DeltaLanes<W> b = gatherDeltas<W>(bodies, block.bodyB + lane);
    const LaneF<W> zero = splat<W>(0.0f);
    const LaneF<W> rolling = loadLanes<W>(block.rollingImpulse + lane);
    auto any = either(rolling > zero, rolling < zero);
    for (const ContactPointRows& p : block.points) {
        const Anchors<W> r = anchorsOf<W>(p, lane);
        const LaneF<W> s = separationNow<W>(pair, r, a, b, loadLanes<W>(p.separation + lane));
        LaneF<W> x, y;
        relativeVelocity<W>(pair, r, x, y);
        const LaneF<W> closing = (x * pair.nx + y * pair.ny) + s * splat<W>(pass.inverseH);
        const LaneF<W> tangent = loadLanes<W>(p.tangentImpulse + lane);
        const auto pushes = either(loadLanes<W>(p.normalImpulse + lane) > zero,
                                   either(tangent > zero, tangent < zero));
        // What has pushed in this step may still bounce (0 in blocks that nothing hits).
        const auto meets = either(either(closing < zero, s < zero),
                                  loadLanes<W>(p.maxNormalImpulse + lane) > zero);
        any = either(any, both(loadLanes<W>(p.normalMass + lane) > zero, either(pushes, meets)));
    }
    storeMask<W>(active + lane, any);
}

/// `rowMasses` in lanes, with the inertias of the block. A point that is not there keeps its 0.
template <int W>
HUESTEP_INLINE void massLanes(const SolverBody* bodies, ContactBlock& block, int lane) {
    const auto inverse = [](const LaneF<W>& k) __attribute__((always_inline)) {
        const LaneF<W> zero = splat<W>(0.0f);
        return selectLanes(k > zero, splat<W>(1.0f) / k, zero);
    };
    const Pair<W> pair(bodies, block, lane);
    const LaneF<W> iA = pair.inverseInertiaA, iB = pair.inverseInertiaB;
    const LaneF<W> m = pair.a.inverseMass + pair.b.inverseMass;
    storeLanes<W>(block.rollingMass + lane, inverse(iA + iB));
    for (ContactPointRows& p : block.points) {
        const Anchors<W> r = anchorsOf<W>(p, lane);
        const LaneF<W> rnA = r.ax * pair.ny - r.ay * pair.nx;
        const LaneF<W> rnB = r.bx * pair.ny - r.by * pair.nx;
        const LaneF<W> rtA = r.ax * pair.nx + r.ay * pair.ny;
        const LaneF<W> rtB = r.bx * pair.nx + r.by * pair.ny;
        const LaneF<W> zero = splat<W>(0.0f);
        const auto there = loadLanes<W>(p.normalMass + lane) > zero;
        const LaneF<W> normal = inverse(m + iA * rnA * rnA + iB * rnB * rnB);
        const LaneF<W> tangent = inverse(m + iA * rtA * rtA + iB * rtB * rtB);
        storeLanes<W>(p.normalMass + lane, selectLanes(there, normal, zero));
        storeLanes<W>(p.tangentMass + lane, selectLanes(there, tangent, zero));
    }
}

template <int W>
HUESTEP_INLINE void shareLanes(const SolverBody* bodies, ContactBlock& block, int lane,
                               const std::int32_t* hubIsA, float inertia) {
    const auto isA = loadMask<W>(hubIsA + lane);
    const LaneF<W> ofHub = splat<W>(inertia);
    const LaneF<W> iA = loadLanes<W>(block.inverseInertiaA + lane);
    const LaneF<W> iB = loadLanes<W>(block.inverseInertiaB + lane);
    storeLanes<W>(block.inverseInertiaA + lane, selectLanes(isA, ofHub, iA));
    storeLanes<W>(block.inverseInertiaB + lane, selectLanes(isA, iB, ofHub));
    massLanes<W>(bodies, block, lane);
}

/// The number where it is finite, 0 where it is not, and +0 for either zero: `finiteOrZero`.
template <int W>
HUESTEP_INLINE LaneF<W> settled(LaneRow& field, int lane) {
    const LaneF<W> v = loadLanes<W>(field + lane);
    const LaneF<W> zero = splat<W>(0.0f);
    const LaneF<W> whole = selectLanes(v - v == zero, v, zero) + zero;
    storeLanes<W>(field + lane, whole);
    return whole;
}

template <int W>
HUESTEP_INLINE void settleLanes(ContactBlock& block, int lane) {
    settled<W>(block.rollingImpulse, lane);
    for (ContactPointRows& p : block.points) {
        settled<W>(p.normalImpulse, lane);
        settled<W>(p.tangentImpulse, lane);
    }
    if (block.mayHit == 0) return;
    const LaneF<W> zero = splat<W>(0.0f);
    auto hit = zero > zero;
    for (const ContactPointRows& p : block.points) {
        hit = either(hit, both(loadLanes<W>(p.approach + lane) < splat<W>(-hitSpeed),
                               loadLanes<W>(p.maxNormalImpulse + lane) > zero));
    }
    storeMask<W>(block.hit + lane, hit);
}

template <int W>
HUESTEP_INLINE void strainLanes(ContactBlock& block, int lane) {
    const LaneF<W> zero = splat<W>(0.0f);
    LaneF<W> most = zero;
    for (const ContactPointRows& p : block.points) {
        const LaneF<W> mass = loadLanes<W>(p.normalMass + lane);
        const auto there = mass > zero;
        const LaneF<W> change =
            loadLanes<W>(p.normalImpulse + lane) / selectLanes(there, mass, splat<W>(1.0f));
        most = maxLanes(most, selectLanes(there, change, zero));
    }
    storeLanes<W>(block.strain + lane, most * loadLanes<W>(block.allowance + lane));
}

HUESTEP_INLINE bool anySet(const std::int32_t (&mask)[blockLanes]) {
    std::int32_t all = 0;
    for (const std::int32_t m : mask) all |= m;
    return all != 0;
}

#define HUESTEP_CHECK(W, attributes)                                          \
    attributes void check##W(const BodyMotion* motions, const Bounds* bounds, \
                             ContactBlock* blocks, std::uint32_t count) {     \
        for (std::uint32_t i = 0; i < count; ++i) {                           \
            for (int lane = 0; lane < blockLanes; lane += W) {                \
                checkLanes<W>(motions, bounds, blocks[i], lane);              \
            }                                                                 \
        }                                                                     \
    }                                                                         \
    attributes bool settle##W(ContactBlock* blocks, std::uint32_t count) {    \
        bool hits = false;                                                    \
        for (std::uint32_t i = 0; i < count; ++i) {                           \
            for (int lane = 0; lane < blockLanes; lane += W) {                \
                settleLanes<W>(blocks[i], lane);                              \
            }                                                                 \
            hits = hits || (blocks[i].mayHit != 0 && anySet(blocks[i].hit));  \
        }                                                                     \
        return hits;                                                          \
    }                                                                         \
    attributes void strain##W(ContactBlock* blocks, std::uint32_t count) {    \
        for (std::uint32_t i = 0; i < count; ++i) {                           \
            for (int lane = 0; lane < blockLanes; lane += W) {                \
                strainLanes<W>(blocks[i], lane);                              \
            }                                                                 \
        }                                                                     \
    }
#define HUESTEP_REFRESH(W, attributes)                                            \
    attributes void refresh##W(const SolverBody* bodies, const SolverPose* poses, \
                               ContactBlock* blocks, std::uint32_t count) {       \
        for (std::uint32_t i = 0; i < count; ++i) {                               \
            for (int lane = 0; lane < blockLanes; lane += W) {                    \
                refreshLanes<W>(bodies, poses, blocks[i], lane);                  \
            }                                                                     \
            blocks[i].mayHit = anySet(blocks[i].hit) ? -1 : 0;                    \
        }                                                                         \
    }
#define HUESTEP_HUB(W, attributes)                                                               \
    attributes void markActive##W(const SolverBody* bodies, const ContactBlock& block,           \
                                  const ContactPass& pass, std::int32_t* active) {               \
        for (int lane = 0; lane < blockLanes; lane += W) {                                       \
            activeLanes<W>(bodies, block, lane, pass, active);                                   \
        }                                                                                        \
    }                                                                                            \
    attributes std::uint32_t countActive##W(const SolverBody* bodies, const ContactBlock& block, \
                                            const ContactPass& pass) {                           \
        std::int32_t active[blockLanes];                                                         \
        for (int lane = 0; lane < blockLanes; lane += W) {                                       \
            activeLanes<W>(bodies, block, lane, pass, active);                                   \
        }                                                                                        \
        std::uint32_t count = 0;                                                                 \
        for (const std::int32_t lane : active) count += lane != 0 ? 1u : 0u;                     \
        return count;                                                                            \
    }                                                                                            \
    attributes void shareHub##W(const SolverBody* bodies, ContactBlock& block,                   \
                                const std::int32_t* hubIsA, float inertia) {                     \
        for (int lane = 0; lane < blockLanes; lane += W) {                                       \
            shareLanes<W>(bodies, block, lane, hubIsA, inertia);                                 \
        }                                                                                        \
    }                                                                                            \
    attributes void findMasses##W(const SolverBody* bodies, ContactBlock& block) {               \
        for (int lane = 0; lane < blockLanes; lane += W) {                                       \
            massLanes<W>(bodies, block, lane);                                                   \
        }                                                                                        \
    }
#define HUESTEP_KERNELS(W, attributes)                                     \
    HUESTEP_HUB(W, attributes)                                             \
    HUESTEP_CHECK(W, attributes)                                           \
    HUESTEP_REFRESH(W, attributes)                                         \
    HUESTEP_PASS(warmStart, ContactBlock, ContactPass, W, attributes)      \
    HUESTEP_PASS(warmStartAgain, ContactBlock, ContactPass, W, attributes) \
    HUESTEP_PASS(solve, ContactBlock, ContactPass, W, attributes)          \
    HUESTEP_PASS(relax, ContactBlock, ContactPass, W, attributes)          \
    HUESTEP_PASS(relaxCold, ContactBlock, ContactPass, W, attributes)      \
    HUESTEP_PASS(restitute, ContactBlock, ContactPass, W, attributes)
#define HUESTEP_ENTRY(W, attributes)                                              \
    ContactKernels{check##W,      refresh##W,    warmStart##W, warmStartAgain##W, \
                   solve##W,      relax##W,      relaxCold##W, restitute##W,      \
                   project##W,    correct##W,    settle##W,    countActive##W,    \
                   markActive##W, findMasses##W, shareHub##W,  strain##W},

HUESTEP_EACH_WIDTH(HUESTEP_KERNELS)

#define HUESTEP_ONE(name)                                                                      \
    [](SolverBody* bodies, ContactBlock& block, std::uint32_t lane, const ContactPass& pass) { \
        name##Lanes<1>(bodies, block, static_cast<int>(lane), pass);                           \
    }
constexpr ContactLanePasses oneByOne{HUESTEP_ONE(warmStart), HUESTEP_ONE(warmStartAgain),
                                     HUESTEP_ONE(solve),     HUESTEP_ONE(relax),
                                     HUESTEP_ONE(relaxCold), HUESTEP_ONE(restitute)};

constexpr ContactKernels byWidth[] = {HUESTEP_EACH_WIDTH(HUESTEP_ENTRY)};

}  // namespace

const ContactLanePasses& contactLanePasses() {
    return oneByOne;
}

const ContactKernels& contactKernels(Simd simd) {
    return byWidth[widthIndex(simd)];
}

}  // namespace huestep
