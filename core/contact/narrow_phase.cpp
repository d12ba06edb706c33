#include "core/contact/narrow_phase.h"

#include "core/math/finite.h"

namespace huestep {

namespace {

// Recycling (physics page, 4): a manifold is kept while its bodies have moved less than 5 cm and
// turned less than 11.5° against each other since it was made. Its separations follow the bodies;
// its points, and with them the friction anchors, stay: that is what holds tall stacks up.
constexpr float recycleDistanceSquared = 0.05f * 0.05f;
constexpr float recycleCosine = 0.98f;
// A rounded surface that rolls by θ lifts a kept anchor by r(1 − cos θ): keep that below 0.5 mm.
constexpr float recycleLift = 0.0005f;

bool mayRecycle(const Contact& contact, const Pose& now, float roundness) {
    // A single point is a vertex: it slides over the other shape as that turns.
    if (contact.pointCount < 2) return false;
    const Pose& made = contact.state.relative;
    if (lengthSquared(now.p - made.p) > recycleDistanceSquared) return false;
    const float cosine = now.q.c * made.q.c + now.q.s * made.q.s;
    return cosine > recycleCosine && roundness * (1.0f - cosine) <= recycleLift;
}

void setManifold(Contact& contact, const Manifold& manifold) {
    contact.pointCount = static_cast<std::uint8_t>(manifold.count);
    contact.normal = manifold.normal;
    for (int i = 0; i < manifold.count; ++i) {
        contact.anchorA[i] = manifold.points[i].point;
        contact.anchorB[i] = untransform(contact.state.relative, manifold.points[i].point);
        contact.separation[i] = manifold.points[i].separation;
        contact.feature[i] = manifold.points[i].feature;
    }
    contact.made = true;
}

Pose canonical(const Pose& pose) {
    return {{canonicalZero(pose.p.x), canonicalZero(pose.p.y)},
            {canonicalZero(pose.q.c), canonicalZero(pose.q.s)}};
}

}  // namespace

void remakeManifold(Contact& contact, const NarrowPhaseInput& in) {
    const int count = contact.pointCount;
    setManifold(contact, collide(in.hulls[contact.placeA], in.hulls[contact.placeB],
                                 contact.state.relative, speculativeDistance));
    // A snapshot from outside may claim a contact where there is none: it has no points then.
    if (contact.pointCount != count && contact.pointCount < 2) {
        contact.state.normalImpulse[1] = contact.state.tangentImpulse[1] = 0.0f;
    }
}

ContactUpdate updateContact(Contact& contact, const NarrowPhaseInput& in) {
    if (!overlaps(in.bounds[contact.placeA], in.bounds[contact.placeB])) {
        contact.pointCount = 0;
        return ContactUpdate::Apart;
    }
    const Pose now =
        canonical(relative(in.motions[contact.bodyA].pose(), in.motions[contact.bodyB].pose()));
    const Hull& hullA = in.hulls[contact.placeA];
    const Hull& hullB = in.hulls[contact.placeB];
    if (contact.pointCount > 0 && !contact.made) remakeManifold(contact, in);
    if (mayRecycle(contact, now, maxOf(hullA.radius, hullB.radius))) return ContactUpdate::Recycled;

    const int oldCount = contact.pointCount;
    const ContactState old = contact.state;
    const std::uint16_t oldFeature[2] = {contact.feature[0], contact.feature[1]};
    const Manifold manifold = collide(hullA, hullB, now, speculativeDistance);
    contact.state.relative = now;
    setManifold(contact, manifold);
    contact.state.normalImpulse = {};
    contact.state.tangentImpulse = {};
    if (manifold.count == 0 || oldCount == 0) contact.state.rollingImpulse = 0.0f;
    for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(oldCount); ++k) {
            if (contact.feature[i] != oldFeature[k]) continue;
            contact.state.normalImpulse[i] = old.normalImpulse[k];
            contact.state.tangentImpulse[i] = old.tangentImpulse[k];
            break;
        }
    }
    return manifold.count > 0 ? ContactUpdate::Fresh : ContactUpdate::Apart;
}

}  // namespace huestep
