// Queries: rays and shapes against the world, in key order.

#include "core/world/queries.h"

#include <algorithm>

#include "core/collision/cast.h"
#include "core/world/from_definition.h"
#include "core/world/world_data.h"

namespace huestep {

std::vector<RayHit> World::castRay(Vec2 from, Vec2 to) const {
    return huestep::castRay(m_data->state, from, to);
}

std::vector<ShapeId> World::overlap(const ShapeDef& shape, const Pose& pose) const {
    return overlapping(m_data->state, shape, pose);
}

std::vector<RayHit> castRay(const WorldState& state, Vec2 from, Vec2 to) {
    std::vector<RayHit> hits;
    std::uint32_t body = 0;
    for (const ShapeInfo& shape : state.shapes) {
        while (state.bodies[body].id != shape.body) ++body;
        const Pose pose = state.motions[body].pose();
        const Hull hull = hullOf<float>(shape);
        const Bounds ray{minOf(from, to), maxOf(from, to)};
        if (!overlaps(boundsOf(hull, pose), ray)) continue;
        const auto hit = castRayAtHull(hull, untransform(pose, from), untransform(pose, to));
        if (!hit) continue;
        hits.push_back({shape.id, shape.body, hit->fraction, from + hit->fraction * (to - from),
                        rotate(pose.q, hit->normal)});
    }
    std::sort(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) {
        return a.fraction != b.fraction ? a.fraction < b.fraction : a.shape < b.shape;
    });
    return hits;
}

std::vector<ShapeId> overlapping(const WorldState& state, const ShapeDef& shape, const Pose& pose) {
    std::vector<ShapeId> found;
    BodyDef probe;
    probe.shapes.push_back(shape);
    if (!check(probe, "shape")) return found;
    const Hull hull = hullOf<float>(shapeInfo(shape, {}));
    const Bounds bounds = boundsOf(hull, pose);
    std::uint32_t body = 0;
    for (const ShapeInfo& other : state.shapes) {
        while (state.bodies[body].id != other.body) ++body;
        const Pose otherPose = state.motions[body].pose();
        const Hull otherHull = hullOf<float>(other);
        if (!overlaps(boundsOf(otherHull, otherPose), bounds)) continue;
        if (collide(otherHull, hull, relative(otherPose, pose), 0.0f).count > 0) {
            found.push_back(other.id);
        }
    }
    return found;
}

std::vector<ContactView> World::contactViews() const {
    std::vector<ContactView> views;
    m_data->contactsToState();
    const Data& d = *m_data;
    const Accelerators& acc = d.accelerators;
    std::vector<int> colours(acc.contacts.size(), -1);
    const Plan& plan = acc.plan;
    for (std::size_t i = plan.jointLinks; i < plan.links.size() && acc.rowsHold; ++i) {
        const std::uint8_t colour = plan.colourOfLink[i];
        colours[plan.links[i].source] = isSerial(colour) ? 255 : colour;
    }
    auto impulses = d.state.contacts.begin();  // in the order of those candidates that touch
    for (const Candidate& candidate : acc.candidates) {
        if (candidate.contact == none) continue;
        const Contact& c = acc.contacts[candidate.contact];
        const Pose a = d.state.motions[c.bodyA].pose();
        const Pose b = d.state.motions[c.bodyB].pose();
        ContactView view;
        view.shapeA = d.state.shapes[c.placeA].id;
        view.shapeB = d.state.shapes[c.placeB].id;
        view.normal = c.normal();
        view.pointCount = c.pointCount;
        view.colour = colours[candidate.contact];
        for (std::size_t k = 0; k < c.pointCount; ++k) {
            const Vec2 onA = a.p + rotate(relative(c.rotationA(), a.q), c.anchorA(k));
            const Vec2 onB = b.p + rotate(relative(c.rotationB(), b.q), c.anchorB(k));
            view.point[k] = 0.5f * (onA + onB);
            view.separation[k] = c.points[k].madeSeparation + dot(view.normal, onB - onA);
            view.normalImpulse[k] = impulses->normalImpulse[k];
        }
        ++impulses;
        views.push_back(view);
    }
    return views;
}

}  // namespace huestep
