// The last stage: where bodies went.

#include <algorithm>

#include "core/math/finite.h"
#include "core/math/trig.h"
#include "core/parallel/over_range.h"
#include "core/solver/solve.h"

namespace huestep {

namespace {

constexpr std::uint32_t bodyGrain = 256;

/// Moves a body to where it went, unless that is nowhere: then it stays, at rest.
bool settle(BodyMotion& motion, const BodyMotion& next) {
    const bool whole = isFinite(next.position) && isFinite(next.velocity) &&
                       isFinite(next.angularVelocity) && isFinite(next.rotation.c) &&
                       isFinite(next.rotation.s);
    const auto beyond = [](float x, float most) { return x > most || x < -most; };
    if (!whole || beyond(next.position.x, maxCoordinate) ||
        beyond(next.position.y, maxCoordinate) || beyond(next.velocity.x, maxSpeed) ||
        beyond(next.velocity.y, maxSpeed) || beyond(next.angularVelocity, maxSpeed)) {
        motion.velocity = {};
        motion.angularVelocity = 0.0f;
        return false;
    }
    motion.position = {canonicalZero(next.position.x), canonicalZero(next.position.y)};
    motion.rotation = {canonicalZero(next.rotation.c), canonicalZero(next.rotation.s)};
    motion.velocity = {canonicalZero(next.velocity.x), canonicalZero(next.velocity.y)};
    motion.angularVelocity = canonicalZero(next.angularVelocity);
    return true;
}

/// A body without constraints moves with the mean of its old and new velocity: exact for constant
/// acceleration, the parabola (physics page, 7). It turns by ω Δt, exactly.
BodyMotion freeFlight(const BodyMotion& motion, const BodyInfo& info, const BodyForce* force,
                      Vec2 gravity, float dt) {
    BodyMotion next = motion;
    Vec2 acceleration = info.gravityScale * gravity;
    float angular = 0.0f;
    if (force != nullptr) {
        acceleration += info.inverseMass * force->force;
        angular = info.inverseInertia * force->torque;
    }
    next.velocity =
        (1.0f / (1.0f + dt * info.linearDamping)) * (motion.velocity + dt * acceleration);
    next.angularVelocity =
        (motion.angularVelocity + dt * angular) * (1.0f / (1.0f + dt * info.angularDamping));
    next.position = motion.position + (0.5f * dt) * (motion.velocity + next.velocity);
    const float turn = 0.5f * dt * (motion.angularVelocity + next.angularVelocity);
    if (turn != 0.0f) next.rotation = normalized(compose(rotationOf(turn), motion.rotation));
    return next;
}

/// Whether a point of the body may have gone farther than its stride: a bound that needs no root.
/// A body that goes round and round is seen by its spin, rad over the step.
bool leaps(const Pose& from, const Pose& to, float spin, const Stride& stride) {
    const float chord = absoluteOf(to.q.c - from.q.c) + absoluteOf(to.q.s - from.q.s);
    const float way = absoluteOf(to.p.x - from.p.x) + absoluteOf(to.p.y - from.p.y);
    return way + stride.reach * maxOf(chord, absoluteOf(spin)) > stride.most;
}

/// What the bodies of one block of work did.
class Findings {
 public:
    /// Moves the body and keeps what is to be said of it.
    void move(const SolverWorld& world, std::uint32_t body, const BodyMotion& next) {
        BodyMotion& motion = world.motions[body];
        const Pose from = motion.pose();
        if (!settle(motion, next)) {
            m_moved.broken.push_back(body);
        } else if (leaps(from, motion.pose(), world.stepSeconds * motion.angularVelocity,
                         world.strides[body])) {
            m_moved.leaps.push_back({body, from});
        }
    }
    void moveInto(Moved& all) const {
        all.broken.insert(all.broken.end(), m_moved.broken.begin(), m_moved.broken.end());
        all.leaps.insert(all.leaps.end(), m_moved.leaps.begin(), m_moved.leaps.end());
    }

 private:
    Moved m_moved;
};

}  // namespace

Moved finish(const Rows& rows, const Plan& plan, const SolverWorld& world, Executor* executor) {
    const std::size_t places = plan.bodyOfPlace.size();
    auto ofPlaces = perBlock<Findings>(places, bodyGrain);
    overRange(executor, places, bodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t place = std::max(begin, 1u); place < end; ++place) {
            const std::uint32_t body = plan.bodyOfPlace[place];
            // Neither kinematic bodies nor the lanes' copies of hubs.
            if (!world.bodies[body].dynamic() || plan.isCopy[place] != 0) continue;
            const SolverBody& s = rows.bodies[place];
            const BodyMotion& motion = world.motions[body];
            BodyMotion next = motion;
            next.position = motion.position + Vec2{s.dx, s.dy};
            next.rotation = normalized(compose(Rotation{s.dc, s.ds}, motion.rotation));
            next.velocity = {s.vx, s.vy};
            next.angularVelocity = s.w;
            ofPlaces[begin / bodyGrain].move(world, body, next);
        }
    });
    const std::size_t free = plan.freeBodies.size();
    auto ofFree = perBlock<Findings>(free, bodyGrain);
    overRange(executor, free, bodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t body = plan.freeBodies[i];
            const BodyForce* force = world.forces.empty() ? nullptr : &world.forces[body];
            ofFree[begin / bodyGrain].move(world, body,
                                           freeFlight(world.motions[body], world.bodies[body],
                                                      force, world.gravity, world.stepSeconds));
        }
    });
    Moved moved;
    for (const Findings& f : ofPlaces) f.moveInto(moved);
    for (const Findings& f : ofFree) f.moveInto(moved);
    for (const std::uint32_t body : world.kinematic) {
        BodyMotion& motion = world.motions[body];
        if (motion.velocity == Vec2{} && motion.angularVelocity == 0.0f) continue;
        BodyMotion next = motion;
        next.position = motion.position + world.stepSeconds * motion.velocity;
        next.rotation = normalized(
            compose(rotationOf(world.stepSeconds * motion.angularVelocity), motion.rotation));
        moved.driven.push_back({body, motion.pose()});
        if (!settle(motion, next)) moved.broken.push_back(body);
    }
    std::sort(moved.broken.begin(), moved.broken.end());
    return moved;
}

}  // namespace huestep
