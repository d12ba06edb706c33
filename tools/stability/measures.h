/// The measures that the suite's criteria are made of, each a function of one tick.
#pragma once

#include "tools/stability/criterion.h"

namespace huestep::tools::stability {

// Of dynamic bodies.
double farthestMoved(const Moment& moment);   ///< m, from the start
double farthestAside(const Moment& moment);   ///< m, from the start along x
double furthestTurned(const Moment& moment);  ///< rad, from the start, [0, π]
double fastest(const Moment& moment);         ///< m/s
double rmsSpeed(const Moment& moment);        ///< m/s, over the bodies
double lowest(const Moment& moment);          ///< m: how far the lowest centre is below y = 0
double energyGain(const Moment& moment);      ///< (E − E₀) / E_scale

double penetration(const Moment& moment);  ///< m, the deepest, from a fresh narrow phase in double
double jointError(const Moment& moment);   ///< m, the largest

/// Bodies that are `metres` or more from where they started, or turned by `radians` or more.
Measure fallen(double metres, double radians);
/// Bodies that are turned by less than `radians`.
Measure standing(double radians);
/// m, from where they came to rest if they only fell by `drop(body)`.
Measure movedFromRest(std::function<double(const Tracked& body)> drop);

// Of one body on an arm about the origin, its length as at the start.
double armError(const Moment& moment);     ///< |r − r₀| / r₀
double kineticLoss(const Moment& moment);  ///< (T₀ − T) / T₀

/// m: how far the foremost point of any dynamic body is beyond x.
Measure beyond(double x);
/// m: how far a centre is outside of the square of half side `half` about the origin; < 0: inside.
Measure outside(double half);
/// The same about body `drum`, in its frame; it is none of those that are inside.
Measure outsideDrum(BodyId drum, double half);
/// Kinetic energy of all dynamic bodies but `drum`, over their weight times `height` m.
Measure kineticShare(BodyId drum, double height);
/// m: what is left wrong at the contacts of a round hub, body 1, with the discs about it: overlap
/// and approach over 1/240 s, their root mean square.
double hubResidual(const Moment& moment);

}  // namespace huestep::tools::stability
