/// Vectors, rotations as unit vectors, and rigid transforms of the plane.
///
/// Every type is a template on the real number so that the narrow phase can be run once more in
/// double as a measure of accuracy; the world itself is `float` throughout. All functions are
/// exact compositions of + - * / and sqrt in the order written: no fused operation, no libm.
#pragma once

#include <cmath>

namespace huestep {

/// A point or a direction, metres unless said.
template <class Real>
struct Vec2T {
    Real x{0};
    Real y{0};

    friend constexpr Vec2T operator+(Vec2T a, Vec2T b) { return {a.x + b.x, a.y + b.y}; }
    friend constexpr Vec2T operator-(Vec2T a, Vec2T b) { return {a.x - b.x, a.y - b.y}; }
    friend constexpr Vec2T operator*(Real s, Vec2T a) { return {s * a.x, s * a.y}; }
    friend constexpr Vec2T operator-(Vec2T a) { return {-a.x, -a.y}; }
    constexpr Vec2T& operator+=(Vec2T b) { return *this = *this + b; }
    constexpr Vec2T& operator-=(Vec2T b) { return *this = *this - b; }
    friend constexpr bool operator==(Vec2T, Vec2T) = default;
};

template <class Real>
constexpr Real dot(Vec2T<Real> a, Vec2T<Real> b) {
    return a.x * b.x + a.y * b.y;
}

/// The z component of the cross product of two vectors of the plane.
template <class Real>
constexpr Real cross(Vec2T<Real> a, Vec2T<Real> b) {
    return a.x * b.y - a.y * b.x;
}

/// ω × r: the velocity of a point at r of a body that turns with ω (rad/s).
template <class Real>
constexpr Vec2T<Real> crossScalar(Real w, Vec2T<Real> r) {
    return {-(w * r.y), w * r.x};
}

/// The vector turned a quarter to the left.
template <class Real>
constexpr Vec2T<Real> perpLeft(Vec2T<Real> a) {
    return {-a.y, a.x};
}

/// The vector turned a quarter to the right: the outward normal of a counter-clockwise edge.
template <class Real>
constexpr Vec2T<Real> perpRight(Vec2T<Real> a) {
    return {a.y, -a.x};
}

template <class Real>
constexpr Real lengthSquared(Vec2T<Real> a) {
    return dot(a, a);
}

template <class Real>
Real length(Vec2T<Real> a) {
    return std::sqrt(dot(a, a));
}

/// `a` with length 1, or zero where it is too short to have a direction.
template <class Real>
Vec2T<Real> normalized(Vec2T<Real> a) {
    const Real l = length(a);
    if (!(l > Real(1e-18))) return {};
    return {a.x / l, a.y / l};
}

template <class Real>
constexpr Real minOf(Real a, Real b) {
    return a < b ? a : b;
}
template <class Real>
constexpr Real maxOf(Real a, Real b) {
    return a > b ? a : b;
}
template <class Real>
constexpr Real absoluteOf(Real v) {
    return v < Real(0) ? -v : v;
}
/// 1/v of what is above 0; else 0, as the mass of what nothing can move.
template <class Real>
constexpr Real inverseOrZero(Real v) {
    return v > Real(0) ? Real(1) / v : Real(0);
}
template <class Real>
constexpr Real clampTo(Real v, Real low, Real high) {
    return v < low ? low : (v > high ? high : v);
}
template <class Real>
constexpr Vec2T<Real> minOf(Vec2T<Real> a, Vec2T<Real> b) {
    return {minOf(a.x, b.x), minOf(a.y, b.y)};
}
template <class Real>
constexpr Vec2T<Real> maxOf(Vec2T<Real> a, Vec2T<Real> b) {
    return {maxOf(a.x, b.x), maxOf(a.y, b.y)};
}

/// A rotation by an angle θ, held as the unit vector (cos θ, sin θ): no trigonometry in a step.
template <class Real>
struct RotationT {
    Real c{1};
    Real s{0};
    friend constexpr bool operator==(RotationT, RotationT) = default;
};

template <class Real>
constexpr Vec2T<Real> rotate(RotationT<Real> q, Vec2T<Real> v) {
    return {q.c * v.x - q.s * v.y, q.s * v.x + q.c * v.y};
}

/// Rotation by −θ.
template <class Real>
constexpr Vec2T<Real> unrotate(RotationT<Real> q, Vec2T<Real> v) {
    return {q.c * v.x + q.s * v.y, q.c * v.y - q.s * v.x};
}

/// First `b`, then `a`.
template <class Real>
constexpr RotationT<Real> compose(RotationT<Real> a, RotationT<Real> b) {
    return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s};
}

/// The rotation that leads from `a` to `b`: a⁻¹ b.
template <class Real>
constexpr RotationT<Real> relative(RotationT<Real> a, RotationT<Real> b) {
    return {a.c * b.c + a.s * b.s, a.c * b.s - a.s * b.c};
}

/// The nearest rotation: (c, s) scaled to length 1. Requires a length that is not zero.
template <class Real>
RotationT<Real> normalized(RotationT<Real> q) {
    const Real l = std::sqrt(q.c * q.c + q.s * q.s);
    return {q.c / l, q.s / l};
}

/// A rotation in one number, to about 2e-7 rad: the tangent of half its angle, t = s / (1 + c), for
/// c ≥ 0; for c < 0 that of the opposite rotation, moved by 2 away from zero. In [−3, 3].
constexpr float turnOf(RotationT<float> q) {
    if (q.c >= 0.0f) return q.s / (1.0f + q.c) + 0.0f;
    const float t = -q.s / (1.0f - q.c);
    return t < 0.0f ? t - 2.0f : t + 2.0f;
}
constexpr RotationT<float> fromTurn(float turn) {
    const bool opposite = turn > 1.5f || turn < -1.5f;
    const float t = !opposite ? turn : (turn < 0.0f ? turn + 2.0f : turn - 2.0f);
    const float inverse = 1.0f / (1.0f + t * t);
    const float c = (1.0f - t * t) * inverse;
    const float s = (t + t) * inverse;
    return opposite ? RotationT<float>{-c, -s} : RotationT<float>{c, s};
}

/// A rotation followed by a translation: where a body is.
template <class Real>
struct PoseT {
    Vec2T<Real> p;
    RotationT<Real> q;
    friend constexpr bool operator==(PoseT, PoseT) = default;
};

template <class Real>
constexpr Vec2T<Real> transform(const PoseT<Real>& pose, Vec2T<Real> v) {
    return pose.p + rotate(pose.q, v);
}

template <class Real>
constexpr Vec2T<Real> untransform(const PoseT<Real>& pose, Vec2T<Real> v) {
    return unrotate(pose.q, v - pose.p);
}

/// The pose of `b` as seen from `a`: a⁻¹ b.
template <class Real>
constexpr PoseT<Real> relative(const PoseT<Real>& a, const PoseT<Real>& b) {
    return {untransform(a, b.p), relative(a.q, b.q)};
}

/// An axis-aligned box, closed.
template <class Real>
struct BoundsT {
    Vec2T<Real> low;
    Vec2T<Real> high;
    friend constexpr bool operator==(BoundsT, BoundsT) = default;
};

template <class Real>
constexpr bool overlaps(const BoundsT<Real>& a, const BoundsT<Real>& b) {
    // Without branches: where boxes are many, none of the four is foreseen.
    return ((a.low.x <= b.high.x) & (b.low.x <= a.high.x) & (a.low.y <= b.high.y) &
            (b.low.y <= a.high.y)) != 0;
}
template <class Real>
constexpr bool contains(const BoundsT<Real>& outer, const BoundsT<Real>& inner) {
    return outer.low.x <= inner.low.x && outer.low.y <= inner.low.y &&
           inner.high.x <= outer.high.x && inner.high.y <= outer.high.y;
}
template <class Real>
constexpr BoundsT<Real> unite(const BoundsT<Real>& a, const BoundsT<Real>& b) {
    return {minOf(a.low, b.low), maxOf(a.high, b.high)};
}
template <class Real>
constexpr BoundsT<Real> grown(const BoundsT<Real>& a, Real margin) {
    return {{a.low.x - margin, a.low.y - margin}, {a.high.x + margin, a.high.y + margin}};
}

using Vec2 = Vec2T<float>;
using Rotation = RotationT<float>;
using Pose = PoseT<float>;
using Bounds = BoundsT<float>;

/// +0 for either zero: IEEE's round-to-nearest makes −0 + 0 = +0 and leaves all else alone.
/// State holds canonical zeros only, so that equal states have equal bytes.
constexpr float canonicalZero(float v) {
    return v + 0.0f;
}
constexpr Vec2 canonicalZero(Vec2 v) {
    return {v.x + 0.0f, v.y + 0.0f};
}
constexpr Rotation canonicalZero(Rotation q) {
    return {q.c + 0.0f, q.s + 0.0f};
}
constexpr Pose canonicalZero(const Pose& pose) {
    return {canonicalZero(pose.p), canonicalZero(pose.q)};
}

}  // namespace huestep
