/// Mass properties of rounded hulls, exactly: core polygon, edge strips and corner sectors.
#pragma once

#include <span>

#include "core/collision/hull.h"

namespace huestep {

struct MassProperties {
    double mass = 0.0;     ///< kg
    Vec2T<double> center;  ///< m, in the frame the hull is given in
    double inertia = 0.0;  ///< kg·m², about `center`
};

/// Of one hull of uniform density (kg/m²). A segment (two vertices, radius 0) has none.
MassProperties massOf(const HullT<double>& given, double density);

/// Of several rigidly joined parts (Steiner's theorem).
MassProperties combine(std::span<const MassProperties> parts);

}  // namespace huestep
