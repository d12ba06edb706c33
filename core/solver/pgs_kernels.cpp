// The passes of projected Gauss-Seidel over contact rows (pgs.h). One template, compiled once for
// each width.

#include "core/solver/contact_kernels.h"
#include "core/solver/contact_lanes.h"

namespace huestep {

namespace {

/// Rigid normal rows of both points: overlap beyond the slop is pushed out at the bias rate, no
/// faster than the push speed; a gap may close within the step.
template <int W>
HUESTEP_INLINE void pushNormals(Pair<W>& pair, ContactBlock& block, int lane,
                                const ContactPass& pass) {
    const LaneF<W> zero = splat<W>(0.0f);
    for (ContactPointRows& p : block.points) {
        const Anchors<W> r = anchorsOf<W>(p, lane);
        // Bodies have not moved yet: separations are those of the step's start.
        const LaneF<W> s =
            (pair.nx * (r.bx - r.ax) + pair.ny * (r.by - r.ay)) + loadLanes<W>(p.separation + lane);
        LaneF<W> x, y;
        relativeVelocity<W>(pair, r, x, y);
        const LaneF<W> vn = x * pair.nx + y * pair.ny;
        const LaneF<W> overlap = minLanes(s + splat<W>(pass.slop), zero);
        const LaneF<W> push =
            maxLanes(overlap * splat<W>(pass.soft.biasRate), splat<W>(-pass.pushSpeed));
        const LaneF<W> bias = selectLanes(s > zero, s * splat<W>(pass.inverseH), push);
        const LaneF<W> old = loadLanes<W>(p.normalImpulse + lane);
        const LaneF<W> sum = maxLanes(old - loadLanes<W>(p.normalMass + lane) * (vn + bias), zero);
        const LaneF<W> impulse = sum - old;
        storeLanes<W>(p.normalImpulse + lane, sum);
        if (block.mayHit != 0) {
            storeLanes<W>(p.maxNormalImpulse + lane,
                          maxLanes(loadLanes<W>(p.maxNormalImpulse + lane), sum));
        }
        applyImpulse<W>(pair, r, impulse * pair.nx, impulse * pair.ny);
    }
}

template <int W>
HUESTEP_INLINE void projectLanes(SolverBody* bodies, ContactBlock& block, int lane,
                                 const ContactPass& pass) {
    Pair<W> pair(bodies, block, lane);
    pushNormals<W>(pair, block, lane, pass);
    if (pass.features.friction) solveFriction<W>(pair, block, lane, pass);
    if (pass.features.rolling) solveRolling<W>(pair, block, lane);
    pair.store(bodies, block, lane);
}

/// Nonlinear Gauss-Seidel: C = max(rate · min(s + slop, 0), −most), P = −C/K with the arms by now.
/// `soft.biasRate` is a share here, not a rate, and `pushSpeed` a distance.
template <int W>
HUESTEP_INLINE void correctLanes(SolverBody* bodies, ContactBlock& block, int lane,
                                 const ContactPass& pass) {
    const Pair<W> pair(bodies, block, lane);
    DeltaLanes<W> a = gatherDeltas<W>(bodies, block.bodyA + lane);
    DeltaLanes<W> b = gatherDeltas<W>(bodies, block.bodyB + lane);
    const LaneF<W> zero = splat<W>(0.0f), one = splat<W>(1.0f);
    const LaneF<W>& iA = pair.inverseInertiaA;
    const LaneF<W>& iB = pair.inverseInertiaB;
    for (const ContactPointRows& p : block.points) {
        const Anchors<W> r = anchorsOf<W>(p, lane);
        const LaneF<W> s = separationNow<W>(pair, r, a, b, loadLanes<W>(p.separation + lane));
        const LaneF<W> error =
            maxLanes(splat<W>(pass.soft.biasRate) * minLanes(s + splat<W>(pass.slop), zero),
                     splat<W>(-pass.pushSpeed));
        const LaneF<W> ax = a.dc * r.ax - a.ds * r.ay, ay = a.ds * r.ax + a.dc * r.ay;
        const LaneF<W> bx = b.dc * r.bx - b.ds * r.by, by = b.ds * r.bx + b.dc * r.by;
        const LaneF<W> armA = ax * pair.ny - ay * pair.nx, armB = bx * pair.ny - by * pair.nx;
        const LaneF<W> k =
            (pair.a.inverseMass + pair.b.inverseMass) + iA * armA * armA + iB * armB * armB;
        // No point is there, or nothing moves: no row.
        const auto there = both(loadLanes<W>(p.normalMass + lane) > zero, k > zero);
        const LaneF<W> push = selectLanes(there, (zero - error) / selectLanes(there, k, one), zero);
        const LaneF<W> moveA = zero - pair.a.inverseMass * push;
        const LaneF<W> moveB = pair.b.inverseMass * push;
        displace<W>(a, moveA * pair.nx, moveA * pair.ny, zero - iA * armA * push);
        displace<W>(b, moveB * pair.nx, moveB * pair.ny, iB * armB * push);
    }
    SolverBody trash;
    scatterDeltas<W>(bodies, trash, block.bodyA + lane, a);
    scatterDeltas<W>(bodies, trash, block.bodyB + lane, b);
}

}  // namespace

#define HUESTEP_KERNELS(W, attributes)                              \
    HUESTEP_PASS(project, ContactBlock, ContactPass, W, attributes) \
    HUESTEP_PASS(correct, ContactBlock, ContactPass, W, attributes)

HUESTEP_EACH_WIDTH(HUESTEP_KERNELS)

}  // namespace huestep
