/// What the passes of all methods do with W contacts.
#pragma once

#include "core/solver/body_lanes.h"

namespace huestep {

/// The two bodies of W contacts and the normal from A to B.
template <int W>
struct Pair : PairLanes<W> {
    LaneF<W> nx, ny;

    HUESTEP_INLINE Pair(const SolverBody* bodies, const ContactBlock& block, int lane)
        : PairLanes<W>(bodies, block, lane),
          nx(loadLanes<W>(block.normalX + lane)),
          ny(loadLanes<W>(block.normalY + lane)) {}
};

/// Current separation: at the start, plus how the anchors moved along the normal since.
template <int W>
HUESTEP_INLINE LaneF<W> separationNow(const Pair<W>& pair, const Anchors<W>& r,
                                      const DeltaLanes<W>& a, const DeltaLanes<W>& b,
                                      const LaneF<W>& start) {
    const LaneF<W> x = (b.dx - a.dx) + ((b.dc * r.bx - b.ds * r.by) - (a.dc * r.ax - a.ds * r.ay));
    const LaneF<W> y = (b.dy - a.dy) + ((b.ds * r.bx + b.dc * r.by) - (a.ds * r.ax + a.dc * r.ay));
    return (x * pair.nx + y * pair.ny) + start;
}

/// A bound of an impulse: `share` of the load, and of a row without a share 0 whatever the load.
/// An infinite one would make it no number, in a batch where others have a share; alone the row
/// would not be gone through.
template <int W>
HUESTEP_INLINE LaneF<W> boundOf(const LaneF<W>& share, const LaneF<W>& load) {
    const LaneF<W> zero = splat<W>(0.0f);
    return selectLanes(share > zero, share * load, zero);
}

/// Coulomb's cone, a row a point, with the normal impulse just found.
template <int W>
HUESTEP_INLINE void solveFriction(Pair<W>& pair, ContactBlock& block, int lane,
                                  const ContactPass& pass) {
    const LaneF<W> friction = loadLanes<W>(block.friction + lane);
    const LaneF<W> zero = splat<W>(0.0f);
    LaneF<W> surface = zero;
    if (pass.features.tangentSpeed) surface = loadLanes<W>(block.tangentSpeed + lane);
    for (ContactPointRows& p : block.points) {
        const Anchors<W> r = anchorsOf<W>(p, lane);
        LaneF<W> x, y;
        relativeVelocity<W>(pair, r, x, y);
        const LaneF<W> vt = (x * pair.ny - y * pair.nx) + surface;
        const LaneF<W> old = loadLanes<W>(p.tangentImpulse + lane);
        const LaneF<W> most = boundOf<W>(friction, loadLanes<W>(p.normalImpulse + lane));
        const LaneF<W> free = old - loadLanes<W>(p.tangentMass + lane) * vt;
        const LaneF<W> sum = maxLanes(zero - most, minLanes(free, most));
        const LaneF<W> impulse = sum - old;
        storeLanes<W>(p.tangentImpulse + lane, sum);
        applyImpulse<W>(pair, r, impulse * pair.ny, zero - impulse * pair.nx);
    }
}

template <int W>
HUESTEP_INLINE void solveRolling(Pair<W>& pair, ContactBlock& block, int lane) {
    const LaneF<W> zero = splat<W>(0.0f);
    const LaneF<W> load = loadLanes<W>(block.points[0].normalImpulse + lane) +
                          loadLanes<W>(block.points[1].normalImpulse + lane);
    const LaneF<W> most = boundOf<W>(loadLanes<W>(block.rollingResistance + lane), load);
    const LaneF<W> old = loadLanes<W>(block.rollingImpulse + lane);
    const LaneF<W> free = old - loadLanes<W>(block.rollingMass + lane) * (pair.b.w - pair.a.w);
    const LaneF<W> sum = maxLanes(zero - most, minLanes(free, most));
    storeLanes<W>(block.rollingImpulse + lane, sum);
    pair.a.w = pair.a.w - pair.inverseInertiaA * (sum - old);
    pair.b.w = pair.b.w + pair.inverseInertiaB * (sum - old);
}

}  // namespace huestep
