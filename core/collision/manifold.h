/// Contact manifolds: where and how deep two rounded hulls touch.
///
/// A manifold is a function of the two hulls and their relative pose alone; world poses never
/// reach the narrow phase. Everything is expressed in the frame of A. At most two points.
///
/// Method: separating axes over the edge normals of both cores, then clipping the incident edge
/// against the reference edge (Gottschalk, Lin and Manocha 1996 for the axes; Catto, "Contact
/// Manifolds", GDC 2007 for clipping); where the cores are apart and nearest at two vertices, one
/// point along the line between them. Chain segments push along no normal but those of their own
/// part of the chain's Gauss image, from the normal of the face before to that of the face after;
/// two of them do not touch.
#pragma once

#include <cstdint>

#include "core/collision/hull.h"

namespace huestep {

template <class Real>
struct ManifoldPointT {
    Vec2T<Real> point;          ///< m, in the frame of A, midway between the two surfaces
    Real separation{0};         ///< m, along the normal; negative: overlap
    std::uint16_t feature = 0;  ///< the vertex of A (high byte) and of B (low byte) it belongs to
};

template <class Real>
struct ManifoldT {
    Vec2T<Real> normal;  ///< unit, from A to B, in the frame of A
    int count = 0;       ///< 0, 1 or 2
    ManifoldPointT<Real> points[2];
};

using Manifold = ManifoldT<float>;

/// Points of the hulls with a separation of at most `margin` (m). `relative` is B seen from A.
template <class Real>
ManifoldT<Real> collide(const HullT<Real>& a, const HullT<Real>& b, const PoseT<Real>& relative,
                        Real margin);

extern template ManifoldT<float> collide(const HullT<float>&, const HullT<float>&,
                                         const PoseT<float>&, float);
extern template ManifoldT<double> collide(const HullT<double>&, const HullT<double>&,
                                          const PoseT<double>&, double);

}  // namespace huestep
