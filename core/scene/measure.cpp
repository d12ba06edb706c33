#include "core/scene/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/collision/manifold.h"
#include "core/scene/in_double.h"

namespace huestep {

namespace {

using Vec2d = Vec2T<double>;
using Posed = PoseT<double>;

constexpr std::uint32_t nowhere = 0xffffffffu;
constexpr double unbounded = std::numeric_limits<double>::infinity();

bool isFinite(const Posed& pose) {
    return std::isfinite(pose.p.x) && std::isfinite(pose.p.y) && std::isfinite(pose.q.c) &&
           std::isfinite(pose.q.s);
}

/// The pose in double, its rotation brought back to unit length: the measure judges positions, not
/// the rounding of a unit vector.
Posed poseOf(const BodyMotion& motion) {
    const RotationT<double> q{static_cast<double>(motion.rotation.c),
                              static_cast<double>(motion.rotation.s)};
    return {inDouble(motion.position), normalized(q)};
}

std::uint32_t placeOf(std::span<const BodyInfo> bodies, BodyId id) {
    const auto found =
        std::lower_bound(bodies.begin(), bodies.end(), id,
                         [](const BodyInfo& body, BodyId wanted) { return body.id < wanted; });
    if (found == bodies.end() || found->id != id) return nowhere;
    return static_cast<std::uint32_t>(found - bodies.begin());
}

/// How far a coordinate is outside of the joint's limit.
double outsideOf(const JointInfo& joint, double coordinate) {
    return std::max({0.0, static_cast<double>(joint.lower) - coordinate,
                     coordinate - static_cast<double>(joint.upper)});
}

/// How far body B's centre is from where body A has it, by the angle alone.
double swingOf(const JointInfo& joint, const Posed& poseA, const Posed& poseB) {
    const RotationT<double> reference{static_cast<double>(joint.reference.c),
                                      static_cast<double>(joint.reference.s)};
    const RotationT<double> held = compose(poseA.q, normalized(reference));
    const Vec2d arm = inDouble(joint.anchorB);
    return length(rotate(poseB.q, arm) - rotate(held, arm));
}

/// Across the axis or outside of the limit, and the swing, whichever is most.
double slideErrorOf(const JointInfo& joint, const Posed& poseA, const Posed& poseB, Vec2d gap) {
    const Vec2d axis = normalized(rotate(poseA.q, inDouble(joint.axis())));
    const double outside = joint.has(JointInfo::limit) ? outsideOf(joint, dot(axis, gap)) : 0.0;
    return std::max({std::abs(cross(axis, gap)), outside, swingOf(joint, poseA, poseB)});
}

/// How far the joint is from where it should be; 0 for a mouse joint, whose target may be far.
double errorOf(const JointInfo& joint, const Posed& poseA, const Posed& poseB) {
    const Vec2d gap =
        transform(poseB, inDouble(joint.anchorB)) - transform(poseA, inDouble(joint.anchorA));
    const double distance = length(gap);
    switch (joint.kind()) {
        case JointKind::Revolute:
            return distance;
        case JointKind::Mouse:
            return 0.0;
        case JointKind::Weld:
            if (joint.has(JointInfo::spring)) return distance;
            return std::max(distance, swingOf(joint, poseA, poseB));
        case JointKind::Prismatic:
            return slideErrorOf(joint, poseA, poseB, gap);
        case JointKind::Distance:
            break;
    }
    if (joint.has(JointInfo::limit)) return outsideOf(joint, distance);
    if (joint.has(JointInfo::spring)) return 0.0;
    return std::abs(distance - static_cast<double>(joint.length));
}

/// A shape where it is, with what decides whether it may touch another.
struct Placed {
    BoundsT<double> bounds;
    HullT<double> hull;
    std::uint32_t body = 0;   ///< place
    std::uint32_t shape = 0;  ///< place
};

/// Pairs of places of bodies, lower first, whose shapes may not touch because a joint links them.
std::vector<std::pair<std::uint32_t, std::uint32_t>> linkedBodies(
    std::span<const BodyInfo> bodies, std::span<const JointInfo> joints) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> linked;
    for (const JointInfo& joint : joints) {
        if (joint.has(JointInfo::collideConnected)) continue;
        linked.emplace_back(
            std::minmax(placeOf(bodies, joint.bodyA), placeOf(bodies, joint.bodyB)));
    }
    std::sort(linked.begin(), linked.end());
    return linked;
}

/// Nothing where a shape's body is not finite.
std::optional<std::vector<Placed>> placedShapes(std::span<const BodyInfo> bodies,
                                                std::span<const ShapeInfo> shapes,
                                                std::span<const BodyMotion> motions) {
    std::vector<Placed> placed;
    placed.reserve(shapes.size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        Placed entry;
        entry.shape = static_cast<std::uint32_t>(i);
        entry.body = placeOf(bodies, shapes[i].body);
        if (entry.body == nowhere) continue;
        const Posed pose = poseOf(motions[entry.body]);
        if (!isFinite(pose)) return std::nullopt;  // it has no place in any order
        entry.hull = hullOf<double>(shapes[i]);
        entry.bounds = boundsOf(entry.hull, pose);
        placed.push_back(entry);
    }
    return placed;
}

/// Depth of the overlap of two shapes; 0 where they are apart.
double depthOf(const Placed& a, const Placed& b, std::span<const BodyMotion> motions) {
    const Posed seen = relative(poseOf(motions[a.body]), poseOf(motions[b.body]));
    const ManifoldT<double> manifold = collide(a.hull, b.hull, seen, 0.0);
    double depth = 0.0;
    for (int i = 0; i < manifold.count; ++i) {
        depth = std::max(depth, -manifold.points[i].separation);
    }
    return depth;
}

/// Calls `visit` for every pair of shapes whose bounds overlap: sort along x, then sweep.
template <class Visit>
void sweep(std::vector<Placed>& placed, const Visit& visit) {
    std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
        return a.bounds.low.x != b.bounds.low.x ? a.bounds.low.x < b.bounds.low.x
                                                : a.shape < b.shape;
    });
    std::vector<BoundsT<double>> bounds;
    bounds.reserve(placed.size());
    for (const Placed& entry : placed) bounds.push_back(entry.bounds);
    for (std::size_t i = 0; i < placed.size(); ++i) {
        for (std::size_t j = i + 1; j < placed.size(); ++j) {
            if (bounds[j].low.x > bounds[i].high.x) break;
            if (bounds[j].low.y > bounds[i].high.y || bounds[i].low.y > bounds[j].high.y) continue;
            visit(placed[i], placed[j]);
        }
    }
}

void measurePenetration(std::span<const BodyInfo> bodies, std::span<const ShapeInfo> shapes,
                        std::span<const JointInfo> joints, std::span<const BodyMotion> motions,
                        Measures& into) {
    const auto linked = linkedBodies(bodies, joints);
    std::optional<std::vector<Placed>> placed = placedShapes(bodies, shapes, motions);
    if (!placed) {
        into.maxPenetration = into.meanPenetration = unbounded;
        return;
    }
    double sum = 0.0;
    std::size_t pairs = 0;
    sweep(*placed, [&](const Placed& a, const Placed& b) {
        if (a.body == b.body) return;
        if (!bodies[a.body].dynamic() && !bodies[b.body].dynamic()) return;
        if (!mayTouch(shapes[a.shape].filter(), shapes[b.shape].filter())) return;
        const std::pair<std::uint32_t, std::uint32_t> link = std::minmax(a.body, b.body);
        if (std::binary_search(linked.begin(), linked.end(), link)) return;
        // Lower body first, as the world does: the measure then sees the same manifold.
        const double depth = a.body < b.body ? depthOf(a, b, motions) : depthOf(b, a, motions);
        if (depth <= 0.0) return;
        into.maxPenetration = std::max(into.maxPenetration, depth);
        sum += depth;
        ++pairs;
    });
    if (pairs > 0) into.meanPenetration = sum / static_cast<double>(pairs);
}

}  // namespace

double kineticEnergy(const BodyInfo& body, const BodyMotion& motion) {
    const auto spin = static_cast<double>(motion.angularVelocity);
    return 0.5 * static_cast<double>(body.mass) * lengthSquared(inDouble(motion.velocity)) +
           0.5 * static_cast<double>(body.inertia) * spin * spin;
}

double energyScale(const WorldInfo& world, std::span<const BodyInfo> bodies,
                   std::span<const BodyMotion> motions) {
    double mass = 0.0;
    double kinetic = 0.0;
    Vec2d low{1e300, 1e300};
    Vec2d high{-1e300, -1e300};
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        low = minOf(low, inDouble(motions[i].position));
        high = maxOf(high, inDouble(motions[i].position));
        if (!bodies[i].dynamic()) continue;
        mass += static_cast<double>(bodies[i].mass);
        kinetic += kineticEnergy(bodies[i], motions[i]);
    }
    const double extent = std::max(bodies.empty() ? 0.0 : length(high - low), 1.0);
    const double scale = mass * length(inDouble(world.gravity)) * extent + kinetic;
    return scale > 0.0 ? scale : 1.0;
}

double energyOf(const WorldInfo& world, std::span<const BodyInfo> bodies,
                std::span<const BodyMotion> motions) {
    const Vec2d gravity = inDouble(world.gravity);
    double energy = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (!bodies[i].dynamic()) continue;
        const double weight =
            static_cast<double>(bodies[i].mass) * static_cast<double>(bodies[i].gravityScale);
        energy += kineticEnergy(bodies[i], motions[i]);
        energy -= weight * dot(gravity, inDouble(motions[i].position));
    }
    return energy;
}

double maxJointErrorOf(std::span<const BodyInfo> bodies, std::span<const JointInfo> joints,
                       std::span<const BodyMotion> motions) {
    double most = 0.0;
    for (const JointInfo& joint : joints) {
        const std::uint32_t a = placeOf(bodies, joint.bodyA);
        const std::uint32_t b = placeOf(bodies, joint.bodyB);
        if (a == nowhere || b == nowhere) continue;
        const Posed poseA = poseOf(motions[a]);
        const Posed poseB = poseOf(motions[b]);
        // A maximum would pass over what is not a number.
        const bool known = isFinite(poseA) && isFinite(poseB);
        most = std::max(most, known ? errorOf(joint, poseA, poseB) : unbounded);
    }
    return most;
}

Measures measure(const WorldInfo& world, std::span<const BodyInfo> bodies,
                 std::span<const ShapeInfo> shapes, std::span<const JointInfo> joints,
                 std::span<const BodyMotion> motions) {
    Measures result;
    result.energy = energyOf(world, bodies, motions);
    result.maxJointError = maxJointErrorOf(bodies, joints, motions);
    measurePenetration(bodies, shapes, joints, motions, result);
    return result;
}

}  // namespace huestep
