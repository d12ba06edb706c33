// Bodies and joints come into a world; what is derived from them is made again.

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

#include "core/world/from_definition.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

/// From the mean of the vertices to the farthest point.
float sizeOf(const Hull& hull) {
    Vec2 middle;
    const auto count = static_cast<std::size_t>(hull.count);
    for (std::size_t v = 0; v < count; ++v) middle += hull.vertices[v];
    middle = (1.0f / static_cast<float>(count)) * middle;
    return reachOf(hull, middle);
}

/// Half of the least width of the core, and the radius. A core of one vertex or two has no width.
float thicknessOf(const Hull& hull) {
    const auto count = static_cast<std::size_t>(hull.count);
    float least = 0.0f;
    for (std::size_t i = 0; i < count && count > 2; ++i) {
        float width = 0.0f;
        for (std::size_t v = 0; v < count; ++v) {
            width = maxOf(width, dot(hull.normals[i], hull.vertices[i] - hull.vertices[v]));
        }
        least = i == 0 ? width : minOf(least, width);
    }
    return 0.5f * least + hull.radius;
}

/// A body of several shapes is as thin as its thinnest. Mere lines are not looked at.
Stride strideOf(std::span<const Hull> hulls, std::span<const float> thickness) {
    Stride stride{std::numeric_limits<float>::max(), 0.0f};
    for (std::size_t i = 0; i < hulls.size(); ++i) {
        if (thickness[i] > 0.0f) stride.most = minOf(stride.most, 0.5f * thickness[i]);
        stride.reach = maxOf(stride.reach, coreReachOf(hulls[i]));
    }
    return stride;
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
    changeDefinitions();
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
    return first;
}

void World::Data::build(const Scene& scene) {
    WorldInfo info{};
    info.nextBody = scene.counters.nextBody;
    info.nextShape = scene.counters.nextShape;
    info.nextJoint = scene.counters.nextJoint;
    info.flags = (scene.sleep ? WorldInfo::sleep : 0u) | (scene.players ? WorldInfo::players : 0u);
    info.gravity = canonicalZero(scene.gravity);
    info.stepSeconds = scene.stepSeconds;
    info.substeps = scene.substeps;
    info.penetrationNeed = canonicalZero(scene.need.penetration);
    info.jointNeed = canonicalZero(scene.need.joint);
    info.method = static_cast<std::uint32_t>(scene.method);
    info.maxBodies = scene.limits.bodies;
    info.maxShapes = scene.limits.shapes;
    info.maxJoints = scene.limits.joints;
    info.maxCommandsPerTick = scene.limits.commandsPerTick;
    info.maxPlayers = scene.limits.players;
    if (scene.players) {
        info.maxSpawned = scene.players->maxSpawned;
        info.maxImpulse = canonicalZero(scene.players->maxImpulse);
        info.maxForce = canonicalZero(scene.players->maxForce);
        for (const Vec2 point : scene.players->spawnPoints) {
            state.spawnPoints.push_back({canonicalZero(point)});
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

/// Makes what is derived of definitions for those bodies, shapes and joints that are behind the
/// last one known, and for all what depends on the others.
void World::Data::completeShapes() {
    Shapes& s = accelerators.shapes;
    const std::size_t bodies = state.bodies.size();
    const std::size_t knownBodies = s.reach.size(), knownShapes = s.hulls.size();
    s.first.resize(bodies + 1);
    s.reach.resize(bodies, 0.0f);
    s.forbidden.clear();
    s.kinematic.clear();
    std::vector<std::uint8_t> jointed(bodies, 0);
    for (std::uint32_t i = 0; i < state.joints.size(); ++i) {
        const JointInfo& j = state.joints[i];
        if (i == s.jointBodies.size()) {
            const std::uint32_t b = *findBody(j.bodyB);
            s.jointBodies.push_back({j.bodyA == 0 ? b : *findBody(j.bodyA), b});
        }
        const auto [a, b] = s.jointBodies[i];
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
        if (body < knownBodies) {
            for (; shape < knownShapes && s.proxies[shape].body == body; ++shape) {
                s.proxies[shape].jointed = jointed[body] != 0;
            }
            continue;
        }
        for (; shape < state.shapes.size() && state.shapes[shape].body == info.id; ++shape) {
            const ShapeInfo& record = state.shapes[shape];
            const Hull hull = hullOf<float>(record);
            s.hulls.push_back(hull);
            s.sizes.push_back(sizeOf(hull));
            s.thickness.push_back(thicknessOf(hull));
            if (info.type() != BodyType::Static) {
                s.reach[body] = maxOf(s.reach[body], huestep::reachOf(hull));
            }
            s.proxies.push_back({body, record.filter(), info.dynamic(), jointed[body] != 0, false});
        }
        const std::size_t shapes = shape - s.first[body];
        s.strides.push_back(strideOf({s.hulls.data() + s.first[body], shapes},
                                     {s.thickness.data() + s.first[body], shapes}));
    }
    s.first[bodies] = shape;
    sortIntoKinds(s.proxies);
    findTrees();
}

/// Whose joints want to be solved at once: by what hangs together by joints alone.
void World::Data::findTrees() {
    Shapes& s = accelerators.shapes;
    const auto bodies = static_cast<std::uint32_t>(state.bodies.size());
    s.wantsTree.assign(s.jointBodies.empty() ? 0 : bodies, 0);
    s.jointed.assign(s.wantsTree.size(), 0);
    if (s.jointBodies.empty()) return;
    std::vector<std::uint8_t> dynamic(bodies);
    for (std::uint32_t i = 0; i < bodies; ++i) dynamic[i] = state.bodies[i].dynamic();
    std::vector<Link> links;
    const auto isHeld = [&](std::size_t joint) {  // by a player: that is no joint of its own
        return state.joints[joint].kind() == JointKind::Mouse;
    };
    for (std::size_t i = 0; i < s.jointBodies.size(); ++i) {
        if (!isHeld(i)) links.push_back({s.jointBodies[i].a, s.jointBodies[i].b, 0});
    }
    UnionFind sets;
    findIslands(links, dynamic, sets);
    std::vector<JointedBodies> of(bodies);
    for (std::size_t i = 0; i < s.jointBodies.size(); ++i) {
        if (isHeld(i)) continue;
        const ConstraintPlaces& j = s.jointBodies[i];
        s.jointed[j.a] = s.jointed[j.b] = 1;
        JointedBodies& joined = of[sets.find(dynamic[j.b] ? j.b : j.a)];
        ++joined.joints;
        const float a = state.bodies[j.a].inverseMass, b = state.bodies[j.b].inverseMass;
        joined.ratio = maxOf(joined.ratio, massRatio(a, b));
    }
    for (std::uint32_t i = 0; i < bodies; ++i) {
        s.wantsTree[i] = dynamic[i] && wantsTree(of[sets.find(i)]) ? 1 : 0;
    }
}

}  // namespace huestep
