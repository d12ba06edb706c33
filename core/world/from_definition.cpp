#include "core/world/from_definition.h"

#include "core/solver/effort.h"
#include "core/state/validate.h"

namespace huestep {

ShapeInfo shapeInfo(const ShapeDef& def, Vec2 localCenter) {
    ShapeInfo s{};
    s.kind =
        static_cast<std::uint32_t>(def.kind) | (static_cast<std::uint32_t>(def.vertexCount) << 8);
    s.radius = canonicalZero(def.radius);
    for (std::size_t i = 0; i < def.vertexCount; ++i) {
        s.vertices[i] = canonicalZero(def.vertices[i] - localCenter);
    }
    s.density = canonicalZero(def.density);
    s.friction = canonicalZero(def.material.friction);
    s.restitution = canonicalZero(def.material.restitution);
    s.rollingResistance = canonicalZero(def.material.rollingResistance);
    s.tangentSpeed = canonicalZero(def.material.tangentSpeed);
    s.category = def.filter.category;
    s.mask = def.filter.mask;
    s.group = def.filter.group;
    return s;
}

MassProperties massOf(const BodyDef& def) {
    std::vector<MassProperties> parts;
    for (const ShapeDef& shape : def.shapes) {
        parts.push_back(
            massOf(hullOf<double>(shapeInfo(shape, {})), static_cast<double>(shape.density)));
    }
    return combine(parts);
}

BodyRecords recordsOf(const BodyDef& def) {
    BodyRecords r;
    r.info.flags = static_cast<std::uint32_t>(def.type) |
                   (def.fixedRotation ? BodyInfo::fixedRotation : 0u) |
                   (def.maySleep ? BodyInfo::maySleep : 0u);
    r.info.linearDamping = canonicalZero(def.linearDamping);
    r.info.angularDamping = canonicalZero(def.angularDamping);
    r.info.gravityScale = canonicalZero(def.gravityScale);
    if (def.type == BodyType::Dynamic) {
        const MassProperties mass = massOf(def);
        r.info.localCenter = canonicalZero(
            Vec2{static_cast<float>(mass.center.x), static_cast<float>(mass.center.y)});
        r.info.mass = static_cast<float>(mass.mass);
        r.info.inverseMass = static_cast<float>(1.0 / mass.mass);
        if (!def.fixedRotation && mass.inertia > 0.0) {
            r.info.inertia = static_cast<float>(mass.inertia);
            r.info.inverseInertia = static_cast<float>(1.0 / mass.inertia);
        }
    }
    const Rotation q = normalized(def.rotation);
    r.motion.position = canonicalZero(def.position + rotate(q, r.info.localCenter));
    r.motion.rotation = canonicalZero(q);
    if (def.type != BodyType::Static) {
        r.motion.velocity = canonicalZero(def.velocity);
        r.motion.angularVelocity = canonicalZero(def.angularVelocity);
    }
    if (def.type == BodyType::Dynamic) r.motion.effort = standardEffort;
    if (def.type == BodyType::Dynamic && def.asleep) r.motion.rest = BodyMotion::asleepBit;
    for (const ShapeDef& shape : def.shapes) {
        r.shapes.push_back(shapeInfo(shape, r.info.localCenter));
    }
    return r;
}

JointInfo jointInfo(const JointDef& def, const BodyInfo* a, const BodyInfo& b) {
    JointInfo j{};
    j.flags = static_cast<std::uint32_t>(def.kind) |
              (def.collideConnected ? JointInfo::collideConnected : 0u) |
              (def.spring.enabled ? JointInfo::spring : 0u) |
              (def.limit.enabled ? JointInfo::limit : 0u) |
              (def.motor.enabled ? JointInfo::motor | JointInfo::hasMotor : 0u);
    j.bodyA = a != nullptr ? a->id : 0;
    j.bodyB = b.id;
    if (a != nullptr) j.anchorA = canonicalZero(def.anchorA - a->localCenter);
    j.anchorB = canonicalZero(def.anchorB - b.localCenter);
    j.reference = canonicalZero(normalized(def.reference));
    j.length = canonicalZero(def.length);
    const Rotation axis = normalized(def.axis);
    j.target = canonicalZero(def.kind == JointKind::Prismatic ? Vec2{axis.c, axis.s} : def.target);
    j.maxForce = canonicalZero(def.maxForce);
    j.springHertz = canonicalZero(def.spring.hertz);
    j.springDamping = canonicalZero(def.spring.dampingRatio);
    j.lower = canonicalZero(def.limit.lower);
    j.upper = canonicalZero(def.limit.upper);
    j.motorSpeed = canonicalZero(def.motor.speed);
    j.motorMaxEffort = canonicalZero(def.motor.maxEffort);
    return j;
}

Status validate(const BodyRecords& records) {
    std::string fault = faultOf(records.info);
    if (fault.empty()) fault = faultOf(records.motion);
    for (const ShapeInfo& shape : records.shapes) {
        if (fault.empty()) fault = faultOf(shape);
    }
    if (!fault.empty()) return Error{std::move(fault)};
    return Done{};
}

}  // namespace huestep
