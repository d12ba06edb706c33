// The passes over pins: `PointPart` of parts.h, W joints side by side, operation by operation in
// its order, so that the bits are those of the one by one form.

#include "core/joint/pin_block.h"
#include "core/solver/body_lanes.h"

namespace huestep {

namespace {

/// The two bodies of W joints and where their anchors are by now.
template <int W>
struct Pins {
    VelocityLanes<W> a, b;
    LaneF<W> mA, iA, mB, iB;
    LaneF<W> rAx, rAy, rBx, rBy;

    HUESTEP_INLINE Pins(const SolverBody* bodies, const PinBlock& block, int lane,
                        const DeltaLanes<W>& turnA, const DeltaLanes<W>& turnB)
        : a(gatherVelocities<W>(bodies, block.bodyA + lane)),
          b(gatherVelocities<W>(bodies, block.bodyB + lane)),
          mA(loadLanes<W>(block.mA + lane)),
          iA(loadLanes<W>(block.iA + lane)),
          mB(loadLanes<W>(block.mB + lane)),
          iB(loadLanes<W>(block.iB + lane)) {
        const LaneF<W> ax = loadLanes<W>(block.anchorAx + lane);
        const LaneF<W> ay = loadLanes<W>(block.anchorAy + lane);
        const LaneF<W> bx = loadLanes<W>(block.anchorBx + lane);
        const LaneF<W> by = loadLanes<W>(block.anchorBy + lane);
        rAx = turnA.dc * ax - turnA.ds * ay;
        rAy = turnA.ds * ax + turnA.dc * ay;
        rBx = turnB.dc * bx - turnB.ds * by;
        rBy = turnB.ds * bx + turnB.dc * by;
    }

    /// The impulse (px, py) on B at its anchor, and its opposite on A.
    HUESTEP_INLINE void apply(const LaneF<W>& px, const LaneF<W>& py) {
        a.vx = a.vx - mA * px;
        a.vy = a.vy - mA * py;
        a.w = a.w - iA * (rAx * py - rAy * px);
        b.vx = b.vx + mB * px;
        b.vy = b.vy + mB * py;
        b.w = b.w + iB * (rBx * py - rBy * px);
    }

    HUESTEP_INLINE void store(SolverBody* bodies, const PinBlock& block, int lane) const {
        SolverBody trash;
        scatterVelocities<W>(bodies, trash, block.bodyA + lane, a);
        scatterVelocities<W>(bodies, trash, block.bodyB + lane, b);
    }
};

template <int W>
HUESTEP_INLINE void warmStartLanes(SolverBody* bodies, PinBlock& block, int lane,
                                   const JointPass&) {
    const DeltaLanes<W> turnA = gatherDeltas<W>(bodies, block.bodyA + lane);
    const DeltaLanes<W> turnB = gatherDeltas<W>(bodies, block.bodyB + lane);
    Pins<W> pins(bodies, block, lane, turnA, turnB);
    pins.apply(loadLanes<W>(block.impulseX + lane), loadLanes<W>(block.impulseY + lane));
    pins.b.w = pins.b.w + splat<W>(0.0f);  // as by the other parts' impulses, which are none
    pins.store(bodies, block, lane);
}

template <int W>
HUESTEP_INLINE void solveLanes(SolverBody* bodies, PinBlock& block, int lane,
                               const JointPass& pass) {
    const DeltaLanes<W> moveA = gatherDeltas<W>(bodies, block.bodyA + lane);
    const DeltaLanes<W> moveB = gatherDeltas<W>(bodies, block.bodyB + lane);
    Pins<W> p(bodies, block, lane, moveA, moveB);
    const LaneF<W> errorX =
        ((moveB.dx - moveA.dx) + loadLanes<W>(block.centersX + lane)) + (p.rBx - p.rAx);
    const LaneF<W> errorY =
        ((moveB.dy - moveA.dy) + loadLanes<W>(block.centersY + lane)) + (p.rBy - p.rAy);
    const LaneF<W> m = p.mA + p.mB;
    const LaneF<W> k11 = (m + p.iA * p.rAy * p.rAy) + p.iB * p.rBy * p.rBy;
    const LaneF<W> k12 = -(p.iA * p.rAx * p.rAy) - p.iB * p.rBx * p.rBy;
    const LaneF<W> k22 = (m + p.iA * p.rAx * p.rAx) + p.iB * p.rBx * p.rBx;
    const LaneF<W> determinant = k11 * k22 - k12 * k12;
    const LaneF<W> zero = splat<W>(0.0f);
    const LaneF<W> one = splat<W>(1.0f);
    const auto regular = determinant > zero;
    // Padding has no mass: one divides by 1 there and takes 0.
    const LaneF<W> inverse =
        selectLanes(regular, one / selectLanes(regular, determinant, one), zero);
    const LaneF<W> biasRate = splat<W>(pass.soft.biasRate);
    const LaneF<W> x = ((p.b.vx - p.b.w * p.rBy) - (p.a.vx - p.a.w * p.rAy)) + biasRate * errorX;
    const LaneF<W> y = ((p.b.vy + p.b.w * p.rBx) - (p.a.vy + p.a.w * p.rAx)) + biasRate * errorY;
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
    p.apply(newX - oldX, newY - oldY);
    p.store(bodies, block, lane);
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
    block.mA[lane] = row.mA;
    block.iA[lane] = row.iA;
    block.mB[lane] = row.mB;
    block.iB[lane] = row.iB;
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
