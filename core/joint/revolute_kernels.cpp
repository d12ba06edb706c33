// The passes over revolute joints: the parts of parts.h, W joints side by side, operation by
// operation in their order, so that the bits are those of the one by one form.

#include "core/joint/revolute_block.h"

#include "core/math/angle_lanes.h"
#include "core/math/finite.h"
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
HUESTEP_INLINE void warmStartLanes(SolverBody* bodies, RevoluteBlock& block, int lane,
                                   const JointPass&) {
    const DeltaLanes<W> moveA = gatherDeltas<W>(bodies, block.bodyA + lane);
    const DeltaLanes<W> moveB = gatherDeltas<W>(bodies, block.bodyB + lane);
    const Anchors<W> r = turned<W>(anchorsOf<W>(block, lane), moveA, moveB);
    PairLanes<W> pair(bodies, block, lane);
    applyImpulse<W>(pair, r, loadLanes<W>(block.impulseX + lane),
                    loadLanes<W>(block.impulseY + lane));
    const auto impulse = [&](const float* row) __attribute__((always_inline)) {
        return loadLanes<W>(row + lane);
    };
    const LaneF<W> axial = ((impulse(block.springImpulse) + impulse(block.motorImpulse)) +
                            impulse(block.lowerImpulse)) -
                           impulse(block.upperImpulse);
    pair.a.w = pair.a.w - pair.inverseInertiaA * axial;
    pair.b.w = pair.b.w + pair.inverseInertiaB * axial;
    pair.store(bodies, block, lane);
}

/// The angle between two bodies as a coordinate: `AxisPart`.
template <int W>
struct AxisLanes {
    PairLanes<W>& pair;
    LaneF<W> mass;

    HUESTEP_INLINE explicit AxisLanes(PairLanes<W>& of) : pair(of) {
        const LaneF<W> zero = splat<W>(0.0f), one = splat<W>(1.0f);
        const LaneF<W> k = pair.inverseInertiaA + pair.inverseInertiaB;
        const auto turns = k > zero;
        mass = selectLanes(turns, one / selectLanes(turns, k, one), zero);
    }
    HUESTEP_INLINE LaneF<W> rate() const { return pair.b.w - pair.a.w; }

    /// An impulse for those lanes that have the part; of others nothing changes, to the bit.
    template <class Mask>
    HUESTEP_INLINE void apply(const Mask& has, const LaneF<W>& l) {
        pair.a.w = selectLanes(has, pair.a.w - pair.inverseInertiaA * l, pair.a.w);
        pair.b.w = selectLanes(has, pair.b.w + pair.inverseInertiaB * l, pair.b.w);
    }
};

template <int W>
HUESTEP_INLINE void solveSpring(AxisLanes<W>& axis, RevoluteBlock& block, int lane,
                                const LaneF<W>& angle) {
    const auto has = loadMask<W>(block.hasSpring + lane);
    const LaneF<W> old = loadLanes<W>(block.springImpulse + lane);
    const LaneF<W> rhs = axis.rate() + loadLanes<W>(block.springBiasRate + lane) * angle;
    const LaneF<W> delta =
        negated<W>(axis.mass * loadLanes<W>(block.springMassScale + lane) * rhs) -
        loadLanes<W>(block.springImpulseScale + lane) * old;
    storeLanes<W>(block.springImpulse + lane, selectLanes(has, old + delta, old));
    axis.apply(has, delta);
}

template <int W>
HUESTEP_INLINE void solveMotor(AxisLanes<W>& axis, RevoluteBlock& block, int lane, float h) {
    const auto has = loadMask<W>(block.hasMotor + lane);
    const LaneF<W> old = loadLanes<W>(block.motorImpulse + lane);
    const LaneF<W> most = splat<W>(h) * loadLanes<W>(block.motorMaxEffort + lane);
    const LaneF<W> least = negated<W>(most);
    const LaneF<W> free = old - axis.mass * (axis.rate() - loadLanes<W>(block.motorSpeed + lane));
    const LaneF<W> next = selectLanes(free < least, least, selectLanes(free > most, most, free));
    storeLanes<W>(block.motorImpulse + lane, selectLanes(has, next, old));
    axis.apply(has, next - old);
}

/// `sign`: +1 for the lower bound, −1 for the upper one.
template <int W>
HUESTEP_INLINE void solveLimit(AxisLanes<W>& axis, const std::int32_t* hasLimit, float* impulses,
                               int lane, float sign, const LaneF<W>& gap, const JointPass& pass) {
    const LaneF<W> zero = splat<W>(0.0f), one = splat<W>(1.0f), signs = splat<W>(sign);
    const auto has = loadMask<W>(hasLimit + lane);
    const auto open = gap > zero;
    const LaneF<W> bias =
        selectLanes(open, gap * splat<W>(pass.inverseH), splat<W>(pass.soft.biasRate) * gap);
    const LaneF<W> massScale = selectLanes(open, one, splat<W>(pass.soft.massScale));
    const LaneF<W> keep = selectLanes(open, zero, splat<W>(pass.soft.impulseScale));
    const LaneF<W> old = loadLanes<W>(impulses + lane);
    const LaneF<W> delta =
        negated<W>(axis.mass * massScale * (signs * axis.rate() + bias)) - keep * old;
    const LaneF<W> next = maxLanes(old + delta, zero);
    storeLanes<W>(impulses + lane, selectLanes(has, next, old));
    axis.apply(has, signs * (next - old));
}

template <int W>
HUESTEP_INLINE LaneF<W> angleOfLanes(const RevoluteBlock& block, int lane, const DeltaLanes<W>& a,
                                     const DeltaLanes<W>& b) {
    const LaneF<W> c = a.dc * b.dc + a.ds * b.ds, s = a.dc * b.ds - a.ds * b.dc;
    const LaneF<W> c0 = loadLanes<W>(block.angleC + lane), s0 = loadLanes<W>(block.angleS + lane);
    return angleLanes<W>(c * c0 - s * s0, s * c0 + c * s0);
}

/// Spring, motor and limit, in this order.
template <int W>
HUESTEP_INLINE void solveAxis(PairLanes<W>& pair, RevoluteBlock& block, int lane,
                              const DeltaLanes<W>& a, const DeltaLanes<W>& b,
                              const JointPass& pass) {
    const LaneF<W> angle = angleOfLanes<W>(block, lane, a, b);
    AxisLanes<W> axis(pair);
    solveSpring<W>(axis, block, lane, angle);
    solveMotor<W>(axis, block, lane, pass.h);
    solveLimit<W>(axis, block.hasLimit, block.lowerImpulse, lane, 1.0f,
                  angle - loadLanes<W>(block.lower + lane), pass);
    solveLimit<W>(axis, block.hasLimit, block.upperImpulse, lane, -1.0f,
                  loadLanes<W>(block.upper + lane) - angle, pass);
}

/// Two points coincide: `PointPart` with where its anchors are by now.
template <int W>
struct PointLanes {
    Anchors<W> r;
    LaneF<W> errorX, errorY;  // m
    LaneF<W> k11, k12, k22;   // 1/kg
    LaneF<W> inverse;         // of the determinant; 0 where nothing moves

    HUESTEP_INLINE PointLanes(const PairLanes<W>& pair, const RevoluteBlock& block, int lane,
                              const DeltaLanes<W>& moveA, const DeltaLanes<W>& moveB)
        : r(turned<W>(anchorsOf<W>(block, lane), moveA, moveB)) {
        errorX = ((moveB.dx - moveA.dx) + loadLanes<W>(block.centersX + lane)) + (r.bx - r.ax);
        errorY = ((moveB.dy - moveA.dy) + loadLanes<W>(block.centersY + lane)) + (r.by - r.ay);
        const LaneF<W>& iA = pair.inverseInertiaA;
        const LaneF<W>& iB = pair.inverseInertiaB;
        const LaneF<W> m = pair.a.inverseMass + pair.b.inverseMass;
        k11 = (m + iA * r.ay * r.ay) + iB * r.by * r.by;
        k12 = -(iA * r.ax * r.ay) - iB * r.bx * r.by;
        k22 = (m + iA * r.ax * r.ax) + iB * r.bx * r.bx;
        const LaneF<W> determinant = k11 * k22 - k12 * k12;
        const LaneF<W> zero = splat<W>(0.0f);
        const LaneF<W> one = splat<W>(1.0f);
        const auto regular = determinant > zero;
        // Padding has no mass: one divides by 1 there and takes 0.
        inverse = selectLanes(regular, one / selectLanes(regular, determinant, one), zero);
    }
    /// The impulse whose opposite makes the point move by (x, y).
    HUESTEP_INLINE void impulseOf(const LaneF<W>& x, const LaneF<W>& y, LaneF<W>& px,
                                  LaneF<W>& py) const {
        px = inverse * (k22 * x - k12 * y);
        py = inverse * (k11 * y - k12 * x);
    }
};

template <int W>
HUESTEP_INLINE void solveLanes(SolverBody* bodies, RevoluteBlock& block, int lane,
                               const JointPass& pass) {
    const DeltaLanes<W> moveA = gatherDeltas<W>(bodies, block.bodyA + lane);
    const DeltaLanes<W> moveB = gatherDeltas<W>(bodies, block.bodyB + lane);
    PairLanes<W> pair(bodies, block, lane);
    const PointLanes<W> point(pair, block, lane, moveA, moveB);
    if (block.anyPart != 0) solveAxis<W>(pair, block, lane, moveA, moveB, pass);
    LaneF<W> x, y, rigidX, rigidY;
    relativeVelocity<W>(pair, point.r, x, y);
    const LaneF<W> biasRate = splat<W>(pass.soft.biasRate);
    point.impulseOf(x + biasRate * point.errorX, y + biasRate * point.errorY, rigidX, rigidY);
    const LaneF<W> massScale = splat<W>(pass.soft.massScale);
    const LaneF<W> impulseScale = splat<W>(pass.soft.impulseScale);
    const LaneF<W> oldX = loadLanes<W>(block.impulseX + lane);
    const LaneF<W> oldY = loadLanes<W>(block.impulseY + lane);
    const LaneF<W> newX = (oldX - massScale * rigidX) - impulseScale * oldX;
    const LaneF<W> newY = (oldY - massScale * rigidY) - impulseScale * oldY;
    storeLanes<W>(block.impulseX + lane, newX);
    storeLanes<W>(block.impulseY + lane, newY);
    applyImpulse<W>(pair, point.r, newX - oldX, newY - oldY);
    pair.store(bodies, block, lane);
}

/// Moves the bodies to where limits and point hold: the same rows, with displacements for
/// velocities.
template <int W>
HUESTEP_INLINE void correctLanes(SolverBody* bodies, RevoluteBlock& block, int lane,
                                 const JointPass&) {
    DeltaLanes<W> moveA = gatherDeltas<W>(bodies, block.bodyA + lane);
    DeltaLanes<W> moveB = gatherDeltas<W>(bodies, block.bodyB + lane);
    PairLanes<W> pair(bodies, block, lane);
    pair.a.vx = pair.a.vy = pair.a.w = splat<W>(0.0f);
    pair.b.vx = pair.b.vy = pair.b.w = splat<W>(0.0f);
    const PointLanes<W> point(pair, block, lane, moveA, moveB);
    if (block.anyPart != 0) {
        const LaneF<W> angle = angleOfLanes<W>(block, lane, moveA, moveB);
        AxisLanes<W> axis(pair);
        RevoluteBlock::Row lower{}, upper{};  // impulses of this pass alone
        solveLimit<W>(axis, block.hasLimit, lower, lane, 1.0f,
                      angle - loadLanes<W>(block.lower + lane), correctionPass);
        solveLimit<W>(axis, block.hasLimit, upper, lane, -1.0f,
                      loadLanes<W>(block.upper + lane) - angle, correctionPass);
    }
    LaneF<W> x, y, px, py;
    relativeVelocity<W>(pair, point.r, x, y);
    point.impulseOf(x + point.errorX, y + point.errorY, px, py);
    const LaneF<W> zero = splat<W>(0.0f);
    applyImpulse<W>(pair, point.r, zero - px, zero - py);
    displace<W>(moveA, pair.a.vx, pair.a.vy, pair.a.w);
    displace<W>(moveB, pair.b.vx, pair.b.vy, pair.b.w);
    SolverBody trash;
    scatterDeltas<W>(bodies, trash, block.bodyA + lane, moveA);
    scatterDeltas<W>(bodies, trash, block.bodyB + lane, moveB);
}

/// `strainOf`, squared.
template <int W>
HUESTEP_INLINE void strainLanes(const SolverBody* bodies, RevoluteBlock& block, int lane) {
    const PairLanes<W> pair(bodies, block, lane);
    const Anchors<W> r = anchorsOf<W>(block, lane);
    const LaneF<W> px = loadLanes<W>(block.impulseX + lane);
    const LaneF<W> py = loadLanes<W>(block.impulseY + lane);
    const LaneF<W> turnA = pair.inverseInertiaA * (r.ax * py - r.ay * px);
    const LaneF<W> turnB = pair.inverseInertiaB * (r.bx * py - r.by * px);
    const LaneF<W> m = pair.a.inverseMass + pair.b.inverseMass;
    const LaneF<W> x = m * px - (turnA * r.ay + turnB * r.by);
    const LaneF<W> y = m * py + (turnA * r.ax + turnB * r.bx);
    const LaneF<W> allowance = loadLanes<W>(block.allowance + lane);
    storeLanes<W>(block.strain + lane, (x * x + y * y) * (allowance * allowance));
}

#define HUESTEP_STRAIN(W, attributes)                                          \
    attributes void strain##W(const SolverBody* bodies, RevoluteBlock* blocks, \
                              std::uint32_t count) {                           \
        for (std::uint32_t i = 0; i < count; ++i) {                            \
            for (int lane = 0; lane < blockLanes; lane += W) {                 \
                strainLanes<W>(bodies, blocks[i], lane);                       \
            }                                                                  \
        }                                                                      \
    }
#define HUESTEP_KERNELS(W, attributes)                               \
    HUESTEP_STRAIN(W, attributes)                                    \
    HUESTEP_PASS(warmStart, RevoluteBlock, JointPass, W, attributes) \
    HUESTEP_PASS(solve, RevoluteBlock, JointPass, W, attributes)     \
    HUESTEP_PASS(correct, RevoluteBlock, JointPass, W, attributes)
#define HUESTEP_ENTRY(W, attributes) RevoluteKernels{warmStart##W, solve##W, correct##W, strain##W},

HUESTEP_EACH_WIDTH(HUESTEP_KERNELS)

constexpr RevoluteKernels byWidth[] = {HUESTEP_EACH_WIDTH(HUESTEP_ENTRY)};

}  // namespace

void setRevoluteLane(RevoluteBlock& block, std::uint32_t lane, const JointRow& row) {
    block.bodyA[lane] = row.bodyA;
    block.bodyB[lane] = row.bodyB;
    block.inverseInertiaA[lane] = row.iA;
    block.inverseInertiaB[lane] = row.iB;
    block.anchorAx[lane] = row.anchorA.x;
    block.anchorAy[lane] = row.anchorA.y;
    block.anchorBx[lane] = row.anchorB.x;
    block.anchorBy[lane] = row.anchorB.y;
    block.centersX[lane] = row.centers.x;
    block.centersY[lane] = row.centers.y;
    block.impulseX[lane] = row.impulses.point.x;
    block.impulseY[lane] = row.impulses.point.y;
    block.springImpulse[lane] = row.impulses.spring;
    block.motorImpulse[lane] = row.impulses.motor;
    block.lowerImpulse[lane] = row.impulses.lower;
    block.upperImpulse[lane] = row.impulses.upper;
    const auto has = [&](std::uint32_t part) { return (row.flags & part) != 0 ? -1 : 0; };
    block.hasSpring[lane] = has(JointInfo::spring);
    block.hasMotor[lane] = has(JointInfo::motor);
    block.hasLimit[lane] = has(JointInfo::limit);
    block.angleC[lane] = row.angle.c;
    block.angleS[lane] = row.angle.s;
    block.springBiasRate[lane] = row.spring.biasRate;
    block.springMassScale[lane] = row.spring.massScale;
    block.springImpulseScale[lane] = row.spring.impulseScale;
    block.motorSpeed[lane] = row.motorSpeed;
    block.motorMaxEffort[lane] = row.motorMaxEffort;
    block.lower[lane] = row.lower;
    block.upper[lane] = row.upper;
    block.allowance[lane] = row.allowance;
}

void findParts(RevoluteBlock& block) {
    block.anyPart = 0;
    for (std::size_t lane = 0; lane < blockLanes; ++lane) {
        block.anyPart |= block.hasSpring[lane] | block.hasMotor[lane] | block.hasLimit[lane];
    }
}

JointImpulses storedImpulses(const RevoluteBlock& block, std::uint32_t lane) {
    return {{finiteOrZero(block.impulseX[lane]), finiteOrZero(block.impulseY[lane])},
            finiteOrZero(block.springImpulse[lane]),
            finiteOrZero(block.motorImpulse[lane]),
            finiteOrZero(block.lowerImpulse[lane]),
            finiteOrZero(block.upperImpulse[lane])};
}

void clearRevoluteLane(RevoluteBlock& block, std::uint32_t lane) {
    setRevoluteLane(block, lane, JointRow{});
}

const RevoluteKernels& revoluteKernels(Simd simd) {
    return byWidth[widthIndex(simd)];
}

}  // namespace huestep
