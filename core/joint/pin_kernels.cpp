// The passes over pins: `PointPart` of parts.h, W joints side by side, operation by operation in
// its order, so that the bits are those of the one by one form.

#include "core/joint/pin_block.h"
#include "core/solver/body_lanes.h"

namespace huestep {

namespace {

/// Anchors turn with their bodies every substep.
template <int W>
HUESTEP_INLINE Anchors<W> turned(const Anchors<W>& r, const DeltaLanes<W>& a,
                                 const DeltaLanes<W>& b) {
    return {a.dc * r.ax - a.ds * r.ay, a.ds * r.ax + a.dc * r.ay, b.dc * r.bx - b.ds * r.by,
            b.ds * r.bx + b.dc * r.by};
}

template <int W>
HUESTEP_INLINE void warmStartLanes(SolverBody* bodies, PinBlock& block, int lane,
                                   const JointPass&) {
    const DeltaLanes<W> moveA = gatherDeltas<W>(bodies, block.bodyA + lane);
    const DeltaLanes<W> moveB = gatherDeltas<W>(bodies, block.bodyB + lane);
    const Anchors<W> r = turned<W>(anchorsOf<W>(block, lane), moveA, moveB);
    PairLanes<W> pair(bodies, block, lane);
    applyImpulse<W>(pair, r, loadLanes<W>(block.impulseX + lane),
                    loadLanes<W>(block.impulseY + lane));
    pair.b.w = pair.b.w + splat<W>(0.0f);  // as by the other parts' impulses, which are none
    pair.store(bodies, block, lane);
}

template <int W>
HUESTEP_INLINE void solveLanes(SolverBody* bodies, PinBlock& block, int lane,
                               const JointPass& pass) {
    const DeltaLanes<W> moveA = gatherDeltas<W>(bodies, block.bodyA + lane);
    const DeltaLanes<W> moveB = gatherDeltas<W>(bodies, block.bodyB + lane);
    const Anchors<W> r = turned<W>(anchorsOf<W>(block, lane), moveA, moveB);
    PairLanes<W> pair(bodies, block, lane);
    const LaneF<W> errorX =
        ((moveB.dx - moveA.dx) + loadLanes<W>(block.centersX + lane)) + (r.bx - r.ax);
    const LaneF<W> errorY =
        ((moveB.dy - moveA.dy) + loadLanes<W>(block.centersY + lane)) + (r.by - r.ay);
    const LaneF<W>& iA = pair.inverseInertiaA;
    const LaneF<W>& iB = pair.inverseInertiaB;
    const LaneF<W> m = pair.inverseMassA + pair.inverseMassB;
    const LaneF<W> k11 = (m + iA * r.ay * r.ay) + iB * r.by * r.by;
    const LaneF<W> k12 = -(iA * r.ax * r.ay) - iB * r.bx * r.by;
    const LaneF<W> k22 = (m + iA * r.ax * r.ax) + iB * r.bx * r.bx;
    const LaneF<W> determinant = k11 * k22 - k12 * k12;
    const LaneF<W> zero = splat<W>(0.0f);
    const LaneF<W> one = splat<W>(1.0f);
    const auto regular = determinant > zero;
    // Padding has no mass: one divides by 1 there and takes 0.
    const LaneF<W> inverse =
        selectLanes(regular, one / selectLanes(regular, determinant, one), zero);
    LaneF<W> x, y;
    relativeVelocity<W>(pair, r, x, y);
    const LaneF<W> biasRate = splat<W>(pass.soft.biasRate);
    x = x + biasRate * errorX;
    y = y + biasRate * errorY;
    const LaneF<W> rigidX = inverse * (k22 * x - k12 * y);
    const LaneF<W> rigidY = inverse * (k11 * y - k12 * x);
    const LaneF<W> massScale = splat<W>(pass.soft.massScale);
    const LaneF<W> impulseScale = splat<W>(pass.soft.impulseScale);
    const LaneF<W> oldX = loadLanes<W>(block.impulseX + lane);
    const LaneF<W> oldY = loadLanes<W>(block.impulseY + lane);
    const LaneF<W> newX = (oldX - massScale * rigidX) - impulseScale * oldX;
    const LaneF<W> newY = (oldY - massScale * rigidY) - impulseScale * oldY;
    storeLanes<W>(block.impulseX + lane, newX);
    storeLanes<W>(block.impulseY + lane, newY);
    applyImpulse<W>(pair, r, newX - oldX, newY - oldY);
    pair.store(bodies, block, lane);
}

#define HUESTEP_KERNELS(W, attributes)                          \
    HUESTEP_PASS(warmStart, PinBlock, JointPass, W, attributes) \
    HUESTEP_PASS(solve, PinBlock, JointPass, W, attributes)
#define HUESTEP_ENTRY(W, attributes) PinKernels{warmStart##W, solve##W},

HUESTEP_EACH_WIDTH(HUESTEP_KERNELS)

constexpr PinKernels byWidth[] = {HUESTEP_EACH_WIDTH(HUESTEP_ENTRY)};

}  // namespace

bool isPin(const JointInfo& info, const JointImpulses& impulses) {
    constexpr std::uint32_t others = JointInfo::spring | JointInfo::limit | JointInfo::motor;
    return info.kind() == JointKind::Revolute && (info.flags & others) == 0 &&
           impulses.spring == 0.0f && impulses.motor == 0.0f && impulses.lower == 0.0f &&
           impulses.upper == 0.0f;
}

void setPinLane(PinBlock& block, std::uint32_t lane, const JointRow& row) {
    block.bodyA[lane] = row.bodyA;
    block.bodyB[lane] = row.bodyB;
    block.inverseMassA[lane] = row.mA;
    block.inverseInertiaA[lane] = row.iA;
    block.inverseMassB[lane] = row.mB;
    block.inverseInertiaB[lane] = row.iB;
    block.anchorAx[lane] = row.anchorA.x;
    block.anchorAy[lane] = row.anchorA.y;
    block.anchorBx[lane] = row.anchorB.x;
    block.anchorBy[lane] = row.anchorB.y;
    block.centersX[lane] = row.centers.x;
    block.centersY[lane] = row.centers.y;
    block.impulseX[lane] = row.impulses.point.x;
    block.impulseY[lane] = row.impulses.point.y;
}

void clearPinLane(PinBlock& block, std::uint32_t lane) {
    setPinLane(block, lane, JointRow{});
}

const PinKernels& pinKernels(Simd simd) {
    return byWidth[widthIndex(simd)];
}

}  // namespace huestep
