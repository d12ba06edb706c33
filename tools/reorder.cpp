#include "tools/reorder.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <random>

#include "core/world/world.h"

namespace huestep::tools {
namespace {

constexpr std::uint32_t maxNoise = 60;  // bodies: enough for islands, contacts, joints and sleep
constexpr float noiseWidth = 200.0f;    // m: fifteen groups of four bodies, 10 m apart

/// Places of the scene's bodies by ascending id.
std::vector<std::size_t> placesById(const std::vector<BodyId>& ids) {
    std::vector<std::size_t> places(ids.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    std::sort(places.begin(), places.end(),
              [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
    return places;
}

/// Writes the ids of bodies, joints and shapes into the scene, as a world of it would have them.
void writeIds(Scene& scene) {
    const std::vector<BodyId> bodies = bodyIdsOf(scene);
    const std::vector<JointId> joints = jointIdsOf(scene);
    for (std::size_t i = 0; i < bodies.size(); ++i) scene.bodies[i].id = bodies[i];
    for (std::size_t i = 0; i < joints.size(); ++i) scene.joints[i].id = joints[i];
    const bool given = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                   [](const BodyDef& body) { return body.firstShape != 0; });
    ShapeId next = given ? 1 : std::max(scene.counters.nextShape, 1u);
    for (const std::size_t i : placesById(bodies)) {
        BodyDef& body = scene.bodies[i];
        next = std::max(next, body.firstShape);
        body.firstShape = next;
        next += static_cast<ShapeId>(body.shapes.size());
    }
}

std::vector<std::uint32_t> permutation(std::size_t count, std::mt19937_64& random) {
    std::vector<std::uint32_t> places(count);
    std::iota(places.begin(), places.end(), 0u);
    std::shuffle(places.begin(), places.end(), random);
    return places;
}

/// From a body's origin to its farthest point, whatever its rotation.
float reachOf(const BodyDef& body) {
    float reach = 0.0f;
    for (const ShapeDef& shape : body.shapes)
        for (std::size_t v = 0; v < shape.vertexCount; ++v)
            reach = std::max(reach, length(shape.vertices[v]) + shape.radius);
    return reach;
}

/// Where noise begins: farther away than anything of the scene may get in a run, to the right or
/// the left, whichever is nearer to the origin. Nowhere, if the scene fills the world's width.
std::optional<float> noiseX(const Scene& scene) {
    constexpr float away = 5000.0f;
    float left = 0.0f;
    float right = 0.0f;
    for (const BodyDef& body : scene.bodies) {
        left = std::min(left, body.position.x - reachOf(body));
        right = std::max(right, body.position.x + reachOf(body));
    }
    const float toTheRight = right + away;
    const float toTheLeft = left - away - noiseWidth;
    const float x = toTheRight <= -toTheLeft ? toTheRight : toTheLeft;
    const bool inside = x >= -maxCoordinate && x + noiseWidth <= maxCoordinate;
    return inside ? std::optional(x) : std::nullopt;
}

/// Body k of the noise, in groups of four: a ground, a box that overlaps it, a disc that falls on
/// the box, and a capsule that hangs from the disc.
BodyDef noiseBody(std::uint32_t k, float x0) {
    const float x = x0 + 10.0f * static_cast<float>(k / 4);
    BodyDef body;
    body.type = k % 4 == 0 ? BodyType::Static : BodyType::Dynamic;
    switch (k % 4) {
        case 0:
            body.position = {x, -1.0f};
            body.shapes = {ShapeDef::box(4.0f, 1.0f)};
            break;
        case 1:
            body.position = {x, 0.495f};
            body.shapes = {ShapeDef::box(0.5f, 0.5f)};
            break;
        case 2:
            body.position = {x + 0.1f, 1.8f};
            body.shapes = {ShapeDef::circle({}, 0.4f)};
            break;
        default:
            body.position = {x + 1.5f, 1.8f};
            body.shapes = {ShapeDef::capsule({-0.3f, 0.0f}, {0.3f, 0.0f}, 0.2f)};
            break;
    }
    return body;
}

/// A rod between bodies k − 1 and k of the noise, the first of which is at place `first`.
JointDef noiseRod(std::uint32_t k, std::uint32_t first) {
    JointDef rod;
    rod.kind = JointKind::Distance;
    rod.bodyA = first + k - 1;
    rod.bodyB = first + k;
    rod.length = 1.4f;
    return rod;
}

/// Up to half of `count` odd ids, each just below one of the doubled ids `taken`; the rest above.
std::vector<std::uint32_t> idsBetween(std::vector<std::uint32_t> taken, std::uint32_t count) {
    std::sort(taken.begin(), taken.end());
    const std::size_t between = std::min<std::size_t>(taken.size(), count / 2);
    std::vector<std::uint32_t> ids;
    for (std::size_t k = 0; k < between; ++k) ids.push_back(taken[k * taken.size() / between] - 1);
    std::uint32_t next = taken.empty() ? 1 : taken.back() + 1;
    while (ids.size() < count) ids.push_back(next++);
    return ids;
}

/// The scene with doubled ids: the odd id below a body's own is free, and so is the id below its
/// first shape, for every body has one shape id more than it has shapes.
Scene doubled(Scene scene) {
    writeIds(scene);
    ShapeId next = 2;
    for (const std::size_t i : placesById(bodyIdsOf(scene))) {
        scene.bodies[i].firstShape = next;
        next += static_cast<ShapeId>(scene.bodies[i].shapes.size()) + 1;
    }
    for (BodyDef& body : scene.bodies) body.id *= 2;
    for (JointDef& joint : scene.joints) joint.id *= 2;
    scene.counters = {1, 1, 1};
    return scene;
}

std::uint32_t highestId(const Scene& scene) {
    std::uint32_t highest = 0;
    for (const BodyId id : bodyIdsOf(scene)) highest = std::max(highest, id);
    for (const JointId id : jointIdsOf(scene)) highest = std::max(highest, id);
    return highest;
}

/// How many bodies of noise, each with a shape, and one joint for every four of them, a world has
/// room for beside the scene, and one tick has for their removal.
std::uint32_t noiseCount(const Scene& scene) {
    std::size_t shapes = 0;
    for (const BodyDef& body : scene.bodies) shapes += body.shapes.size();
    const std::size_t room =
        std::min({caps::maxBodies - scene.bodies.size(), caps::maxShapes - shapes,
                  4 * (caps::maxJoints - scene.joints.size())});
    const std::uint32_t most = std::min(maxNoise, scene.limits.commandsPerTick);
    return static_cast<std::uint32_t>(std::min<std::size_t>(most, room));
}

/// Limits that leave room for the noise.
WorldLimits widened(WorldLimits limits, std::uint32_t noise) {
    limits.bodies = std::min(limits.bodies + noise, caps::maxBodies);
    limits.shapes = std::min(limits.shapes + noise, caps::maxShapes);
    limits.joints = std::min(limits.joints + noise, caps::maxJoints);
    return limits;
}

Counters countersOf(const World& world) {
    return {world.info().nextBody, world.info().nextShape, world.info().nextJoint};
}

}  // namespace

Scene shuffled(const Scene& given, std::uint64_t seed) {
    Scene scene = given;
    writeIds(scene);
    std::mt19937_64 random(seed);
    const std::vector<std::uint32_t> bodies = permutation(scene.bodies.size(), random);
    const std::vector<std::uint32_t> joints = permutation(scene.joints.size(), random);
    Scene out = scene;
    for (std::uint32_t from = 0; from < bodies.size(); ++from)
        out.bodies[bodies[from]] = scene.bodies[from];
    for (std::uint32_t from = 0; from < joints.size(); ++from) {
        JointDef joint = scene.joints[from];
        joint.bodyA = bodies[joint.bodyA];
        joint.bodyB = bodies[joint.bodyB];
        out.joints[joints[from]] = joint;
    }
    return out;
}

Command NoiseIds::renamed(Command command) const {
    const auto body = [this](BodyId& id) {
        id = id < from.nextBody ? 2 * id : id - from.nextBody + to.nextBody;
    };
    const auto joint = [this](JointId& id) {
        id = id < from.nextJoint ? 2 * id : id - from.nextJoint + to.nextJoint;
    };
    std::visit(
        [&](auto& action) {
            if constexpr (requires { action.body; }) body(action.body);
            if constexpr (requires { action.joint; }) joint(action.joint);
        },
        command.action);
    return command;
}

Result<NoisePair> withNoise(const Scene& scene) {
    if (scene.rules)
        return Error{
            "--reorder: the scene has rules, which may know bodies by their ids, and with noise "
            "these are others"};
    if (highestId(scene) > (caps::maxId - 2 * maxNoise) / 2)
        return Error{"--reorder: the scene's ids are too high to leave room for noise between"};
    const std::uint32_t count = noiseCount(scene);
    if (count == 0)
        return Error{
            "--reorder: the scene is as large as a world may be, without room "
            "for noise"};
    const std::optional<float> x0 = noiseX(scene);
    if (!x0)
        return Error{
            "--reorder: the scene's bodies leave no room for noise to their left or right"};
    NoisePair pair;
    pair.quiet = doubled(scene);
    pair.quiet.limits = widened(scene.limits, count);

    Scene& noisy = pair.noisy = pair.quiet;
    const std::vector<BodyId> bodyIds = idsBetween(bodyIdsOf(noisy), count);
    const std::vector<JointId> jointIds = idsBetween(jointIdsOf(noisy), count / 4);
    std::vector<std::pair<BodyId, ShapeId>> owners;  // of the scene: id and first shape
    for (const BodyDef& body : noisy.bodies) owners.emplace_back(body.id, body.firstShape);
    const auto first = static_cast<std::uint32_t>(noisy.bodies.size());
    for (std::uint32_t k = 0; k < count; ++k) {
        BodyDef body = noiseBody(k, *x0);
        body.id = bodyIds[k];
        for (const auto& [id, shape] : owners)
            if (id == body.id + 1) body.firstShape = shape - 1;
        noisy.bodies.push_back(std::move(body));
        if (k % 4 == 3) {
            noisy.joints.push_back(noiseRod(k, first));
            noisy.joints.back().id = jointIds[k / 4];
        }
        pair.removal.push_back({0, k + 1, RemoveBody{bodyIds[k]}});
    }
    noisy = shuffled(noisy, 3);

    const Result<World> world = World::create(noisy);
    if (!world) return world.error();
    const Result<World> alone = World::create(scene);
    if (!alone) return alone.error();
    pair.quiet.counters = countersOf(*world);
    pair.ids = {countersOf(*alone), pair.quiet.counters};
    return pair;
}

}  // namespace huestep::tools
