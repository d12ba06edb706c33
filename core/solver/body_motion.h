/// What forces and velocities do to a body, whatever the method.
#pragma once

#include "core/math/trig.h"
#include "core/solver/method.h"

namespace huestep {

/// A body's velocity after `h` seconds of its forces and damping.
inline void accelerate(SolverBody& b, const BodySource& s, float h) {
    b.vx = (b.vx + h * s.acceleration.x) * s.linearFactor;
    b.vy = (b.vy + h * s.acceleration.y) * s.linearFactor;
    b.w = (b.w + h * s.angularAcceleration) * s.angularFactor;
}

/// Moves a body by its velocity, less `lag`, for `h` seconds.
inline void advance(SolverBody& b, Vec2 lag, float h) {
    b.dx += h * (b.vx - lag.x);
    b.dy += h * (b.vy - lag.y);
    const Rotation q = compose(cayley(0.5f * h * b.w), Rotation{b.dc, b.ds});
    b.dc = q.c;
    b.ds = q.s;
}

/// `f(place)` for this worker's share of a batch's bodies; when it returns all are done.
template <class F>
void overBodies(const BatchTask& task, const Team& team, F&& f) {
    const Batch& batch = task.batch;
    const Share places(batch.endPlace - batch.firstPlace, team);
    for (std::uint32_t i = places.begin; i < places.end; ++i) f(batch.firstPlace + i);
    team.barrier();
}

}  // namespace huestep
