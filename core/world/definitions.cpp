// From definitions to records, and what is derived from them.

#include <algorithm>
#include <cassert>
#include <numeric>

#include "core/collision/mass.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

float zeroed(float v) {
    return canonicalZero(v);
}
Vec2 zeroed(Vec2 v) {
    return {canonicalZero(v.x), canonicalZero(v.y)};
}
Rotation zeroed(Rotation q) {
    return {canonicalZero(q.c), canonicalZero(q.s)};
}

ShapeInfo shapeInfo(const ShapeDef& def, Vec2 localCenter) {
    ShapeInfo s{};
    s.kind =
        static_cast<std::uint32_t>(def.kind) | (static_cast<std::uint32_t>(def.vertexCount) << 8);
    s.radius = zeroed(def.radius);
    for (std::size_t i = 0; i < def.vertexCount; ++i) {
        s.vertices[i] = zeroed(def.vertices[i] - localCenter);
    }
    s.density = zeroed(def.density);
    s.friction = zeroed(def.material.friction);
    s.restitution = zeroed(def.material.restitution);
    s.rollingResistance = zeroed(def.material.rollingResistance);
    s.tangentSpeed = zeroed(def.material.tangentSpeed);
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

/// The records of one body. Mass is summed in double and rounded once.
struct BodyRecords {
    BodyInfo info{};
    BodyMotion motion{};
    std::vector<ShapeInfo> shapes;
};

BodyRecords recordsOf(const BodyDef& def) {
    BodyRecords r;
    r.info.flags = static_cast<std::uint32_t>(def.type) |
                   (def.fixedRotation ? BodyInfo::fixedRotation : 0u) |
                   (def.maySleep ? BodyInfo::maySleep : 0u);
    r.info.linearDamping = zeroed(def.linearDamping);
    r.info.angularDamping = zeroed(def.angularDamping);
    r.info.gravityScale = zeroed(def.gravityScale);
    if (def.type == BodyType::Dynamic) {
        const MassProperties mass = massOf(def);
        r.info.localCenter =
            zeroed(Vec2{static_cast<float>(mass.center.x), static_cast<float>(mass.center.y)});
        r.info.mass = static_cast<float>(mass.mass);
        r.info.inverseMass = static_cast<float>(1.0 / mass.mass);
        if (!def.fixedRotation && mass.inertia > 0.0) {
            r.info.inertia = static_cast<float>(mass.inertia);
            r.info.inverseInertia = static_cast<float>(1.0 / mass.inertia);
        }
    }
    const Rotation q = normalized(def.rotation);
    r.motion.position = zeroed(def.position + rotate(q, r.info.localCenter));
    r.motion.rotation = zeroed(q);
    if (def.type != BodyType::Static) {
        r.motion.velocity = zeroed(def.velocity);
        r.motion.angularVelocity = zeroed(def.angularVelocity);
    }
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
    if (a != nullptr) j.anchorA = zeroed(def.anchorA - a->localCenter);
    j.anchorB = zeroed(def.anchorB - b.localCenter);
    j.reference = zeroed(normalized(def.reference));
    j.length = zeroed(def.length);
    j.target = zeroed(def.target);
    j.maxForce = zeroed(def.maxForce);
    j.springHertz = zeroed(def.spring.hertz);
    j.springDamping = zeroed(def.spring.dampingRatio);
    j.lower = zeroed(def.limit.lower);
    j.upper = zeroed(def.limit.upper);
    j.motorSpeed = zeroed(def.motor.speed);
    j.motorMaxEffort = zeroed(def.motor.maxEffort);
    return j;
}

/// Places in the order of ids given, those without one after all others in their own order.
template <class Def>
std::vector<std::size_t> orderById(std::span<const Def> defs) {
    std::vector<std::size_t> order(defs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return defs[a].id - 1u < defs[b].id - 1u;  // 0 wraps to the end
    });
    return order;
}

}  // namespace

BodyId World::Data::add(std::span<const BodyDef> bodies, std::span<const JointDef> joints,
                        PlayerId owner) {
    contactsToState();
    WorldInfo& info = state.info();
    std::vector<std::uint32_t> placeOf(bodies.size());
    BodyId first = 0;
    for (const std::size_t i : orderById(bodies)) {
        const BodyDef& def = bodies[i];
        BodyRecords r = recordsOf(def);
        r.info.id = std::max(def.id, info.nextBody);
        r.info.owner = owner;
        info.nextBody = r.info.id + 1;
        info.nextShape = std::max(info.nextShape, def.firstShape);
        placeOf[i] = static_cast<std::uint32_t>(state.bodies.size());
        if (first == 0) first = r.info.id;
        state.bodies.push_back(r.info);
        state.motions.push_back(r.motion);
        for (ShapeInfo& shape : r.shapes) {
            shape.id = info.nextShape++;
            shape.body = r.info.id;
            state.shapes.push_back(shape);
        }
    }
    for (const std::size_t i : orderById(joints)) {
        const JointDef& def = joints[i];
        const bool mouse = def.kind == JointKind::Mouse;
        JointInfo j = jointInfo(def, mouse ? nullptr : &state.bodies[placeOf[def.bodyA]],
                                state.bodies[placeOf[def.bodyB]]);
        j.id = std::max(def.id, info.nextJoint);
        j.owner = owner;
        info.nextJoint = j.id + 1;
        state.joints.push_back(j);
        state.jointImpulses.push_back({});
    }
    accelerators.definitionsStale = true;
    roots.definitionsKnown = false;
    return first;
}

void World::Data::build(const Scene& scene) {
    WorldInfo info{};
    info.nextBody = scene.counters.nextBody;
    info.nextShape = scene.counters.nextShape;
    info.nextJoint = scene.counters.nextJoint;
    info.flags = (scene.sleep ? WorldInfo::sleep : 0u) | (scene.players ? WorldInfo::players : 0u);
    info.gravity = zeroed(scene.gravity);
    info.stepSeconds = scene.stepSeconds;
    info.substeps = scene.substeps;
    info.maxBodies = scene.limits.bodies;
    info.maxShapes = scene.limits.shapes;
    info.maxJoints = scene.limits.joints;
    info.maxCommandsPerTick = scene.limits.commandsPerTick;
    info.maxPlayers = scene.limits.players;
    if (scene.players) {
        info.maxSpawned = scene.players->maxSpawned;
        info.maxImpulse = zeroed(scene.players->maxImpulse);
        info.maxForce = zeroed(scene.players->maxForce);
        for (const Vec2 point : scene.players->spawnPoints) {
            state.spawnPoints.push_back({zeroed(point)});
        }
        if (scene.players->body) {
            BodyRecords r = recordsOf(*scene.players->body);
            state.playerBody.push_back(r.info);
            state.playerMotion.push_back(r.motion);
            state.playerShapes = std::move(r.shapes);
        }
    }
    // Every id is known before the first body is added; the counters go on past all of them.
    const bool shapesGiven = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                         [](const BodyDef& b) { return b.firstShape != 0; });
    info.nextBody = info.nextJoint = 1;
    if (shapesGiven) info.nextShape = 1;
    state.info() = info;
    state.players.push_back({});
    std::vector<BodyDef> bodies = scene.bodies;
    std::vector<JointDef> joints = scene.joints;
    const std::vector<BodyId> bodyIds = bodyIdsOf(scene);
    const std::vector<JointId> jointIds = jointIdsOf(scene);
    for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].id = bodyIds[i];
    for (std::size_t i = 0; i < joints.size(); ++i) joints[i].id = jointIds[i];
    add(bodies, joints, 0);
    state.info().nextBody = std::max(state.info().nextBody, scene.counters.nextBody);
    state.info().nextShape = std::max(state.info().nextShape, scene.counters.nextShape);
    state.info().nextJoint = std::max(state.info().nextJoint, scene.counters.nextJoint);
}

void World::Data::removeMarked() {
    if (removed.empty() && removedJoints.empty()) return;
    contactsToState();
    const std::size_t bodyCount = state.bodies.size();
    removed.resize(bodyCount, 0);
    removedJoints.resize(state.joints.size(), 0);
    const auto gone = [&](BodyId id) {
        const auto at = std::lower_bound(state.bodies.begin(), state.bodies.end(), id,
                                         [](const BodyInfo& b, BodyId k) { return b.id < k; });
        return at != state.bodies.end() &&
               removed[static_cast<std::size_t>(at - state.bodies.begin())];
    };
    const auto wakeId = [&](BodyId id) {
        if (const auto body = findBody(id)) wake(*body);
    };

    for (std::size_t i = 0; i < state.joints.size(); ++i) {
        const JointInfo& j = state.joints[i];
        if ((j.bodyA != 0 && gone(j.bodyA)) || gone(j.bodyB)) removedJoints[i] = 1;
        if (!removedJoints[i]) continue;
        wakeId(j.bodyA);
        wakeId(j.bodyB);
        if (PlayerRecord* player = findPlayer(j.owner); player && player->grab == j.id) {
            player->grab = 0;
        }
    }
    const auto bodyOfShape = [&](ShapeId id) {
        return std::lower_bound(state.shapes.begin(), state.shapes.end(), id,
                                [](const ShapeInfo& s, ShapeId k) { return s.id < k; })
            ->body;
    };
    std::erase_if(state.contacts, [&](const ContactState& c) {
        const BodyId a = bodyOfShape(c.shapeA);
        const BodyId b = bodyOfShape(c.shapeB);
        if (!gone(a) && !gone(b)) return false;
        wakeId(a);
        wakeId(b);
        events.ends.push_back({c.shapeA, c.shapeB});
        return true;
    });
    for (PlayerRecord& player : state.players) {
        if (player.body != 0 && gone(player.body)) player.body = 0;
    }
    std::erase_if(state.shapes, [&](const ShapeInfo& s) { return gone(s.body); });

    std::size_t kept = 0;
    for (std::size_t i = 0; i < bodyCount; ++i) {
        if (removed[i]) continue;
        state.bodies[kept] = state.bodies[i];
        state.motions[kept] = state.motions[i];
        if (!forces.empty()) forces[kept] = forces[i];
        ++kept;
    }
    state.bodies.resize(kept);
    state.motions.resize(kept);
    if (!forces.empty()) forces.resize(kept);
    kept = 0;
    for (std::size_t i = 0; i < state.joints.size(); ++i) {
        if (removedJoints[i]) continue;
        state.joints[kept] = state.joints[i];
        state.jointImpulses[kept] = state.jointImpulses[i];
        ++kept;
    }
    state.joints.resize(kept);
    state.jointImpulses.resize(kept);
    removed.clear();
    removedJoints.clear();
    accelerators.definitionsStale = true;
    roots.definitionsKnown = false;
}

void World::Data::rebuildShapes() {
    assert(contactsInState);
    accelerators = {};
    accelerators.definitionsStale = false;
    Shapes& s = accelerators.shapes;
    const std::size_t bodies = state.bodies.size();
    s.first.assign(bodies + 1, 0);
    s.reach.assign(bodies, 0.0f);
    std::vector<std::uint8_t> jointed(bodies, 0);
    for (std::uint32_t i = 0; i < state.joints.size(); ++i) {
        const JointInfo& j = state.joints[i];
        const std::uint32_t b = *findBody(j.bodyB);
        const std::uint32_t a = j.bodyA == 0 ? b : *findBody(j.bodyA);
        s.jointBodies.push_back({a, b});
        if (a == b || j.has(JointInfo::collideConnected)) continue;
        jointed[a] = jointed[b] = 1;
        s.forbidden.push_back({std::min(a, b), std::max(a, b)});
    }
    std::sort(s.forbidden.begin(), s.forbidden.end());
    std::uint32_t shape = 0;
    for (std::uint32_t body = 0; body < bodies; ++body) {
        const BodyInfo& info = state.bodies[body];
        s.first[body] = shape;
        if (info.type() == BodyType::Kinematic) s.kinematic.push_back(body);
        for (; shape < state.shapes.size() && state.shapes[shape].body == info.id; ++shape) {
            const ShapeInfo& record = state.shapes[shape];
            const Hull hull = hullOf<float>(record);
            const bool turns = info.type() != BodyType::Static;
            for (std::size_t v = 0; turns && v < static_cast<std::size_t>(hull.count); ++v) {
                s.reach[body] = maxOf(s.reach[body], length(hull.vertices[v]) + hull.radius);
            }
            s.hulls.push_back(hull);
            s.proxies.push_back({body, record.filter(), info.dynamic(), jointed[body] != 0});
        }
    }
    s.first[bodies] = shape;
}

}  // namespace huestep
