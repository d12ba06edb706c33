/// Gather and scatter of solver bodies into lanes, and what a constraint does to two of them.
#pragma once

#include "core/math/lanes.h"
#include "core/solver/contact_block.h"

namespace huestep {

template <int W>
struct VelocityLanes {
    LaneF<W> vx, vy, w;
    LaneF<W> inverseMass;  ///< never changes: it fills the fourth place of a gather
};

template <int W>
struct DeltaLanes {
    LaneF<W> dx, dy, dc, ds;
};

template <int W>
struct PoseLanes {
    LaneF<W> x, y, c, s;
};

using F4 = LaneF<4>;
using F8 = LaneF<8>;
using F16 = LaneF<16>;

/// Rows to columns: four floats of each of four places.
HUESTEP_INLINE void transpose4(const float* r0, const float* r1, const float* r2, const float* r3,
                               F4& c0, F4& c1, F4& c2, F4& c3) {
    const F4 a = loadLanes<4>(r0), b = loadLanes<4>(r1), c = loadLanes<4>(r2), d = loadLanes<4>(r3);
    const F4 ab0 = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const F4 ab1 = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const F4 cd0 = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const F4 cd1 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    c0 = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
    c1 = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
    c2 = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
    c3 = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
}

HUESTEP_INLINE F8 join(const F4& low, const F4& high) {
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
HUESTEP_INLINE F16 join(const F8& low, const F8& high) {
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

HUESTEP_INLINE const float* floatsOf(const SolverBody& body) {
    return &body.vx;
}
HUESTEP_INLINE const float* floatsOf(const SolverPose& pose) {
    return &pose.x;
}

HUESTEP_INLINE const float* floatsOf(const BodyMotion& motion) {
    return &motion.position.x;
}
HUESTEP_INLINE const float* floatsOf(const Bounds& bounds) {
    return &bounds.low.x;
}

/// Four floats at `offset` of each lane's record, as columns.
template <class Record>
HUESTEP_INLINE void gather(const Record* records, const BodyPlace* place, int offset, F4& c0,
                           F4& c1, F4& c2, F4& c3) {
    const auto row = [&](int lane) __attribute__((always_inline)) {
        return floatsOf(records[readPlace(place[lane])]) + offset;
    };
    transpose4(row(0), row(1), row(2), row(3), c0, c1, c2, c3);
}

/// Eight lanes: each 128-bit half is four bodies; halves are joined before transposing, so the
/// transpose costs no more instructions than that of four.
template <class Record>
HUESTEP_INLINE void gather(const Record* records, const BodyPlace* place, int offset, F8& c0,
                           F8& c1, F8& c2, F8& c3) {
    const auto pair = [&](int lane) __attribute__((always_inline)) {
        return join(loadLanes<4>(floatsOf(records[readPlace(place[lane])]) + offset),
                    loadLanes<4>(floatsOf(records[readPlace(place[lane + 4])]) + offset));
    };
    const F8 a = pair(0), b = pair(1), c = pair(2), d = pair(3);
    const F8 ab0 = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const F8 ab1 = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const F8 cd0 = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const F8 cd1 = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    c0 = __builtin_shufflevector(ab0, cd0, 0, 1, 8, 9, 4, 5, 12, 13);
    c1 = __builtin_shufflevector(ab0, cd0, 2, 3, 10, 11, 6, 7, 14, 15);
    c2 = __builtin_shufflevector(ab1, cd1, 0, 1, 8, 9, 4, 5, 12, 13);
    c3 = __builtin_shufflevector(ab1, cd1, 2, 3, 10, 11, 6, 7, 14, 15);
}

template <class Record>
HUESTEP_INLINE void gather(const Record* records, const BodyPlace* place, int offset, F16& c0,
                           F16& c1, F16& c2, F16& c3) {
    F8 l0, l1, l2, l3, h0, h1, h2, h3;
    gather(records, place, offset, l0, l1, l2, l3);
    gather(records, place + 8, offset, h0, h1, h2, h3);
    c0 = join(l0, h0);
    c1 = join(l1, h1);
    c2 = join(l2, h2);
    c3 = join(l3, h3);
}

/// The same for any number of lanes.
template <int W, class Record>
HUESTEP_INLINE void gatherFour(const Record* records, const BodyPlace* place, int offset,
                               LaneF<W>& c0, LaneF<W>& c1, LaneF<W>& c2, LaneF<W>& c3) {
    if constexpr (W == 1) {
        const float* row = floatsOf(records[readPlace(place[0])]) + offset;
        c0 = row[0];
        c1 = row[1];
        c2 = row[2];
        c3 = row[3];
    } else {
        gather(records, place, offset, c0, c1, c2, c3);
    }
}

template <int W>
HUESTEP_INLINE VelocityLanes<W> gatherVelocities(const SolverBody* bodies, const BodyPlace* place) {
    VelocityLanes<W> v;
    gatherFour<W>(bodies, place, 0, v.vx, v.vy, v.w, v.inverseMass);
    return v;
}

template <int W>
HUESTEP_INLINE DeltaLanes<W> gatherDeltas(const SolverBody* bodies, const BodyPlace* place) {
    DeltaLanes<W> d;
    gatherFour<W>(bodies, place, 4, d.dx, d.dy, d.dc, d.ds);
    return d;
}

template <int W>
HUESTEP_INLINE PoseLanes<W> gatherPoses(const SolverPose* poses, const BodyPlace* place) {
    PoseLanes<W> p;
    gatherFour<W>(poses, place, 0, p.x, p.y, p.c, p.s);
    return p;
}

/// Where four floats of a lane go: to its body at `offset`, or to `trash` for a body that is never
/// written.
template <int Offset>
HUESTEP_INLINE float* fourOf(SolverBody* bodies, SolverBody& trash, BodyPlace place) {
    return (place < 0 ? &trash.vx : &bodies[place].vx) + Offset;
}

template <int Offset>
HUESTEP_INLINE void scatter(SolverBody* bodies, SolverBody& trash, const BodyPlace* place,
                            const F4& vx, const F4& vy, const F4& w, const F4& mass) {
    const F4 xy0 = __builtin_shufflevector(vx, vy, 0, 4, 1, 5);
    const F4 xy1 = __builtin_shufflevector(vx, vy, 2, 6, 3, 7);
    const F4 wz0 = __builtin_shufflevector(w, mass, 0, 4, 1, 5);
    const F4 wz1 = __builtin_shufflevector(w, mass, 2, 6, 3, 7);
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[0]),
                  __builtin_shufflevector(xy0, wz0, 0, 1, 4, 5));
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[1]),
                  __builtin_shufflevector(xy0, wz0, 2, 3, 6, 7));
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[2]),
                  __builtin_shufflevector(xy1, wz1, 0, 1, 4, 5));
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[3]),
                  __builtin_shufflevector(xy1, wz1, 2, 3, 6, 7));
}

HUESTEP_INLINE F4 lowHalf(const F8& v) {
    return __builtin_shufflevector(v, v, 0, 1, 2, 3);
}
HUESTEP_INLINE F4 highHalf(const F8& v) {
    return __builtin_shufflevector(v, v, 4, 5, 6, 7);
}

template <int Offset>
HUESTEP_INLINE void scatter(SolverBody* bodies, SolverBody& trash, const BodyPlace* place,
                            const F8& vx, const F8& vy, const F8& w, const F8& mass) {
    const F8 xy0 = __builtin_shufflevector(vx, vy, 0, 8, 1, 9, 4, 12, 5, 13);
    const F8 xy1 = __builtin_shufflevector(vx, vy, 2, 10, 3, 11, 6, 14, 7, 15);
    const F8 wz0 = __builtin_shufflevector(w, mass, 0, 8, 1, 9, 4, 12, 5, 13);
    const F8 wz1 = __builtin_shufflevector(w, mass, 2, 10, 3, 11, 6, 14, 7, 15);
    const F8 r0 = __builtin_shufflevector(xy0, wz0, 0, 1, 8, 9, 4, 5, 12, 13);
    const F8 r1 = __builtin_shufflevector(xy0, wz0, 2, 3, 10, 11, 6, 7, 14, 15);
    const F8 r2 = __builtin_shufflevector(xy1, wz1, 0, 1, 8, 9, 4, 5, 12, 13);
    const F8 r3 = __builtin_shufflevector(xy1, wz1, 2, 3, 10, 11, 6, 7, 14, 15);
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[0]), lowHalf(r0));
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[1]), lowHalf(r1));
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[2]), lowHalf(r2));
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[3]), lowHalf(r3));
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[4]), highHalf(r0));
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[5]), highHalf(r1));
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[6]), highHalf(r2));
    storeLanes<4>(fourOf<Offset>(bodies, trash, place[7]), highHalf(r3));
}

template <int Offset>
HUESTEP_INLINE void scatter(SolverBody* bodies, SolverBody& trash, const BodyPlace* place,
                            const F16& vx, const F16& vy, const F16& w, const F16& mass) {
    const auto low = [](const F16& v) __attribute__((always_inline)) {
        return __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);
    };
    const auto high = [](const F16& v) __attribute__((always_inline)) {
        return __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
    };
    scatter<Offset>(bodies, trash, place, low(vx), low(vy), low(w), low(mass));
    scatter<Offset>(bodies, trash, place + 8, high(vx), high(vy), high(w), high(mass));
}

template <int W, int Offset>
HUESTEP_INLINE void scatterFour(SolverBody* bodies, SolverBody& trash, const BodyPlace* place,
                                const LaneF<W>& c0, const LaneF<W>& c1, const LaneF<W>& c2,
                                const LaneF<W>& c3) {
    if constexpr (W == 1) {
        float* to = fourOf<Offset>(bodies, trash, place[0]);
        to[0] = c0;
        to[1] = c1;
        to[2] = c2;
        to[3] = c3;
    } else {
        scatter<Offset>(bodies, trash, place, c0, c1, c2, c3);
    }
}

template <int W>
HUESTEP_INLINE void scatterVelocities(SolverBody* bodies, SolverBody& trash, const BodyPlace* place,
                                      const VelocityLanes<W>& v) {
    scatterFour<W, 0>(bodies, trash, place, v.vx, v.vy, v.w, v.inverseMass);
}

template <int W>
HUESTEP_INLINE void scatterDeltas(SolverBody* bodies, SolverBody& trash, const BodyPlace* place,
                                  const DeltaLanes<W>& d) {
    scatterFour<W, 4>(bodies, trash, place, d.dx, d.dy, d.dc, d.ds);
}

/// Moves and turns W bodies, by Cayley's map.
template <int W>
HUESTEP_INLINE void displace(DeltaLanes<W>& d, const LaneF<W>& x, const LaneF<W>& y,
                             const LaneF<W>& angle) {
    const LaneF<W> one = splat<W>(1.0f);
    const LaneF<W> k = splat<W>(0.5f) * angle;
    const LaneF<W> inverse = one / (one + k * k);
    const LaneF<W> c = (one - k * k) * inverse, s = (k + k) * inverse;
    d.dx = d.dx + x;
    d.dy = d.dy + y;
    const LaneF<W> dc = c * d.dc - s * d.ds;
    d.ds = s * d.dc + c * d.ds;
    d.dc = dc;
}

/// The two bodies of W constraints, in registers between gather and scatter.
template <int W>
struct PairLanes {
    VelocityLanes<W> a, b;
    LaneF<W> inverseInertiaA, inverseInertiaB;

    template <class Block>
    HUESTEP_INLINE PairLanes(const SolverBody* bodies, const Block& block, int lane)
        : PairLanes(bodies, block, block.bodyA, block.bodyB, lane) {}

    /// With other places than the block's own.
    template <class Block>
    HUESTEP_INLINE PairLanes(const SolverBody* bodies, const Block& block, const BodyPlace* placeA,
                             const BodyPlace* placeB, int lane)
        : a(gatherVelocities<W>(bodies, placeA + lane)),
          b(gatherVelocities<W>(bodies, placeB + lane)),
          inverseInertiaA(loadLanes<W>(block.inverseInertiaA + lane)),
          inverseInertiaB(loadLanes<W>(block.inverseInertiaB + lane)) {}

    template <class Block>
    HUESTEP_INLINE void store(SolverBody* bodies, const Block& block, int lane) const {
        store(bodies, block.bodyA, block.bodyB, lane);
    }
    HUESTEP_INLINE void store(SolverBody* bodies, const BodyPlace* placeA, const BodyPlace* placeB,
                              int lane) const {
        SolverBody trash;
        scatterVelocities<W>(bodies, trash, placeA + lane, a);
        scatterVelocities<W>(bodies, trash, placeB + lane, b);
    }
};

/// Where a point's two anchors are, from the centres of A and B.
template <int W>
struct Anchors {
    LaneF<W> ax, ay, bx, by;
};

template <int W, class Rows>
HUESTEP_INLINE Anchors<W> anchorsOf(const Rows& rows, int lane) {
    return {loadLanes<W>(rows.anchorAx + lane), loadLanes<W>(rows.anchorAy + lane),
            loadLanes<W>(rows.anchorBx + lane), loadLanes<W>(rows.anchorBy + lane)};
}

/// Relative velocity of the anchors, B less A.
template <int W>
HUESTEP_INLINE void relativeVelocity(const PairLanes<W>& pair, const Anchors<W>& r, LaneF<W>& x,
                                     LaneF<W>& y) {
    x = (pair.b.vx - pair.b.w * r.by) - (pair.a.vx - pair.a.w * r.ay);
    y = (pair.b.vy + pair.b.w * r.bx) - (pair.a.vy + pair.a.w * r.ax);
}

/// The impulse (px, py) on B at its anchor, and its opposite on A.
template <int W>
HUESTEP_INLINE void applyImpulse(PairLanes<W>& pair, const Anchors<W>& r, const LaneF<W>& px,
                                 const LaneF<W>& py) {
    pair.a.vx = pair.a.vx - pair.a.inverseMass * px;
    pair.a.vy = pair.a.vy - pair.a.inverseMass * py;
    pair.a.w = pair.a.w - pair.inverseInertiaA * (r.ax * py - r.ay * px);
    pair.b.vx = pair.b.vx + pair.b.inverseMass * px;
    pair.b.vy = pair.b.vy + pair.b.inverseMass * py;
    pair.b.w = pair.b.w + pair.inverseInertiaB * (r.bx * py - r.by * px);
}

}  // namespace huestep
