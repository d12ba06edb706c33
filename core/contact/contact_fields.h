/// What the solver and the recycled check stream of a contact, field by field.
///
/// `T` is a float in a contact's own record and a row of lanes in a solver block: both name the
/// same fields in the same order, so a block is the transpose of its contacts' records.
#pragma once

namespace huestep {

/// One of the two points of a manifold. All zero where there is no point: no row of it does
/// anything then.
template <class T>
struct ContactPointFields {
    T anchorAx, anchorAy;  ///< m, from A's centre, world axes, fixed while the manifold is kept
    T anchorBx, anchorBy;  ///< from B's centre; the two coincided when the manifold was made
    T madeSeparation;      ///< m, when the manifold was made
    T normalMass;          ///< kg, of the row
    T tangentMass;
    T normalImpulse;  ///< N·s, accumulated in the current substep's cycle
    T tangentImpulse;
};

template <class T>
struct ContactFields {
    T inverseInertiaA, inverseInertiaB;  ///< 1/(kg·m²)
    T normalX, normalY;  ///< unit, world axes, from A to B, fixed while the manifold is kept
    T cosineA, sineA;    ///< of the bodies' rotations when the manifold was made
    T cosineB, sineB;
    T friction;
    T restitution;
    T tangentSpeed;       ///< m/s
    T rollingResistance;  ///< m: coefficient times the larger radius
    T rollingMass;        ///< kg·m²
    T rollingImpulse;     ///< N·m·s
    // What decides whether the manifold is kept.
    T relativeX, relativeY;  ///< m, body B's centre frame seen from body A's when it was made
    T relativeC, relativeS;
    T reach;      ///< m: farthest point of either body that can turn, from its centre
    T roundness;  ///< m: the larger radius
    /// m: how far the bodies may move while it is kept; negative: a manifold that never is.
    T slack;
};

}  // namespace huestep
