#include "core/contact/narrow_phase.h"

#include "core/math/finite.h"

namespace huestep {

namespace {

float cosineBetween(Rotation a, Rotation b) {
    return a.c * b.c + a.s * b.s;
}

Pose relativePose(std::uint32_t bodyA, std::uint32_t bodyB, const NarrowPhaseInput& in) {
    return canonicalZero(relative(in.motions[bodyA].pose(), in.motions[bodyB].pose()));
}

bool boundsOverlap(const Contact& contact, const NarrowPhaseInput& in) {
    return overlaps(in.bounds[contact.placeA], in.bounds[contact.placeB]);
}

bool mayRecycle(const Contact& contact, const NarrowPhaseInput& in) {
    const BodyMotion& a = in.motions[contact.bodyA];
    const BodyMotion& b = in.motions[contact.bodyB];
    if (!(cosineBetween(a.rotation, contact.rotationA()) > recycleCosine)) return false;
    if (!(cosineBetween(b.rotation, contact.rotationB()) > recycleCosine)) return false;
    const Pose now = relative(a.pose(), b.pose());
    const Pose made = contact.relative();
    const Rotation turned = relative(made.q, now.q);
    if (!(contact.row.roundness * (1.0f - turned.c) <= recycleLift)) return false;
    const float swing = contact.row.reach * absoluteOf(turned.s);
    const float room = contact.row.slack - swing;
    return room > 0.0f && lengthSquared(now.p - made.p) < room * room;
}

/// Everything that follows from a manifold made at `made`, but for the impulses; turned into the
/// world by the rotation that the state keeps.
void setManifold(Contact& contact, const Pose& made, const Manifold& manifold) {
    ContactFields<float>& row = contact.row;
    const Rotation qA = fromTurn(contact.turn);
    const Rotation qB = compose(qA, made.q);
    const Vec2 n = rotate(qA, manifold.normal);
    contact.pointCount = static_cast<std::uint8_t>(manifold.count);
    row.relativeX = made.p.x;
    row.relativeY = made.p.y;
    row.relativeC = made.q.c;
    row.relativeS = made.q.s;
    row.cosineA = qA.c;
    row.sineA = qA.s;
    row.cosineB = qB.c;
    row.sineB = qB.s;
    row.normalX = n.x;
    row.normalY = n.y;
    // A single point is a vertex: it slides over the other shape as that turns.
    const float slack = absoluteOf(row.slack);
    row.slack = manifold.count < 2 ? -slack : slack;
    const float m = contact.inverseMassA + contact.inverseMassB;
    for (std::size_t i = 0; i < 2; ++i) {
        ContactPointFields<float>& p = contact.points[i];
        p = {};
        if (i >= static_cast<std::size_t>(manifold.count)) continue;
        const Vec2 rA = rotate(qA, manifold.points[i].point);
        const Vec2 rB = rotate(qA, manifold.points[i].point - made.p);
        p.anchorAx = rA.x;
        p.anchorAy = rA.y;
        p.anchorBx = rB.x;
        p.anchorBy = rB.y;
        p.madeSeparation = manifold.points[i].separation;
        contact.feature[i] = manifold.points[i].feature;
        const RowMasses masses = rowMasses(rA, rB, n, m, row.inverseInertiaA, row.inverseInertiaB);
        p.normalMass = masses.normal;
        p.tangentMass = masses.tangent;
    }
}

}  // namespace

void remakeManifold(Contact& contact, const Pose& relative, const NarrowPhaseInput& in) {
    const ContactImpulses impulses = impulsesOf(contact);
    setManifold(
        contact, relative,
        collide(in.hulls[contact.placeA], in.hulls[contact.placeB], relative, speculativeDistance));
    setImpulses(contact, impulses);
    // A snapshot from outside may claim impulses of a point that is not there.
    if (contact.pointCount < 2) {
        contact.points[1].normalImpulse = contact.points[1].tangentImpulse = 0.0f;
    }
}

ContactUpdate updateContact(Contact& contact, const NarrowPhaseInput& in) {
    if (contact.pointCount > 0 && boundsOverlap(contact, in) && mayRecycle(contact, in))
        return ContactUpdate::Recycled;
    return renewContact(contact, in);
}

ContactUpdate renewContact(Contact& contact, const NarrowPhaseInput& in) {
    if (!boundsOverlap(contact, in)) {
        contact.pointCount = 0;
        return ContactUpdate::Apart;
    }
    const std::size_t oldCount = contact.pointCount;
    const ContactImpulses old = impulsesOf(contact);
    const std::uint16_t oldFeature[2] = {contact.feature[0], contact.feature[1]};
    const Pose now = relativePose(contact.bodyA, contact.bodyB, in);
    contact.turn = turnOf(in.motions[contact.bodyA].rotation);
    const Manifold manifold =
        collide(in.hulls[contact.placeA], in.hulls[contact.placeB], now, speculativeDistance);
    setManifold(contact, now, manifold);
    ContactImpulses matched;
    if (manifold.count > 0 && oldCount > 0) matched.rolling = old.rolling;
    for (std::size_t i = 0; i < contact.pointCount; ++i) {
        for (std::size_t k = 0; k < oldCount; ++k) {
            if (contact.feature[i] != oldFeature[k]) continue;
            matched.normal[i] = old.normal[k];
            matched.tangent[i] = old.tangent[k];
            break;
        }
    }
    setImpulses(contact, matched);
    return manifold.count > 0 ? ContactUpdate::Fresh : ContactUpdate::Apart;
}

Manifold manifoldOf(std::uint32_t bodyA, std::uint32_t bodyB, std::uint32_t shapeA,
                    std::uint32_t shapeB, const NarrowPhaseInput& in) {
    return collide(in.hulls[shapeA], in.hulls[shapeB], relativePose(bodyA, bodyB, in),
                   speculativeDistance);
}

void beginContact(Contact& contact, const Manifold& manifold, const NarrowPhaseInput& in) {
    contact.turn = turnOf(in.motions[contact.bodyA].rotation);
    contact.began = 1;
    setManifold(contact, relativePose(contact.bodyA, contact.bodyB, in), manifold);
}

}  // namespace huestep
