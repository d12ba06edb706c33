#include "tools/reorder.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

#include "core/world/world.h"

namespace huestep::tools {
namespace {

constexpr std::uint32_t maxNoise = 60;  // bodies: enough for islands, contacts, joints and sleep

/// Writes out ids that are 0. A world hands free ids to them in the order of the list and shows
/// its records by id, so the ids it has beyond the written ones, ascending, are theirs in order.
template <class Def, class Info>
void writeIds(std::vector<Def>& defs, std::span<const Info> infos) {
    std::vector<std::uint32_t> written;
    for (const Def& def : defs)
        if (def.id != 0) written.push_back(def.id);
    std::sort(written.begin(), written.end());
    std::vector<std::uint32_t> given;
    for (const Info& info : infos)
        if (!std::binary_search(written.begin(), written.end(), info.id)) given.push_back(info.id);
    auto next = given.begin();
    for (Def& def : defs)
        if (def.id == 0) def.id = *next++;
}

std::vector<std::uint32_t> permutation(std::size_t count, std::mt19937_64& random) {
    std::vector<std::uint32_t> places(count);
    std::iota(places.begin(), places.end(), 0u);
    std::shuffle(places.begin(), places.end(), random);
    return places;
}

/// Where noise is put: farther to the right than anything of the scene may get to in a run.
float noiseX(const Scene& scene) {
    float right = 0.0f;
    for (const BodyDef& body : scene.bodies) right = std::max(right, body.position.x);
    return std::min(right + 5000.0f, 0.9f * maxCoordinate);
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

/// Adds noise at the front, the middle and the end of the lists, with the ids that the two
/// functions give to noise body k and noise joint k.
template <class BodyIdOf, class JointIdOf>
Noisy addNoise(const Scene& scene, BodyIdOf bodyId, JointIdOf jointId) {
    const std::uint32_t count = std::min(maxNoise, scene.limits.commandsPerTick);
    Noisy noisy;
    Scene& out = noisy.scene = scene;
    out.limits.bodies += count;
    out.limits.shapes += count;
    out.limits.joints += count;
    const auto own = static_cast<std::uint32_t>(scene.bodies.size());
    const float x0 = noiseX(scene);
    for (std::uint32_t k = 0; k < count; ++k) {
        BodyDef body = noiseBody(k, x0);
        body.id = bodyId(k);
        noisy.removal.push_back({0, k + 1, RemoveBody{body.id}});
        out.bodies.push_back(std::move(body));
        if (k % 4 != 3) continue;
        JointDef rod;
        rod.id = jointId(k / 4);
        rod.kind = JointKind::Distance;
        rod.bodyA = own + k - 1;
        rod.bodyB = own + k;
        rod.length = 1.4f;
        out.joints.push_back(rod);
    }
    out = shuffled(out, 0x6e6f697365);
    return noisy;
}

template <class Def>
std::uint32_t highestId(const std::vector<Def>& defs, std::uint32_t counter) {
    std::uint32_t highest = counter == 0 ? 0 : counter - 1;
    for (const Def& def : defs) highest = std::max(highest, def.id);
    return highest;
}

}  // namespace

Result<Scene> withExplicitIds(const Scene& scene) {
    const Result<World> world = World::create(scene);
    if (!world) return world.error();
    Scene out = scene;
    writeIds(out.bodies, world->bodies());
    writeIds(out.joints, world->joints());
    return out;
}

Scene shuffled(const Scene& scene, std::uint64_t seed) {
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

Result<Noisy> withNoiseAbove(const Scene& scene) {
    const std::uint32_t body = highestId(scene.bodies, scene.counters.nextBody);
    const std::uint32_t joint = highestId(scene.joints, scene.counters.nextJoint);
    const std::uint32_t top = std::numeric_limits<std::uint32_t>::max() - 2 * maxNoise;
    if (body > top || joint > top) return Error{"--reorder: no ids are left above the scene's"};
    return addNoise(
        scene, [=](std::uint32_t k) { return body + 1 + k; },
        [=](std::uint32_t k) { return joint + 1 + k; });
}

Result<Noisy> withNoiseBetween(const Scene& scene) {
    const std::uint32_t top = std::numeric_limits<std::uint32_t>::max() / 2 - maxNoise;
    if (highestId(scene.bodies, scene.counters.nextBody) > top ||
        highestId(scene.joints, scene.counters.nextJoint) > top)
        return Error{"--reorder: the scene's ids are too high to be doubled"};
    Scene spread = scene;
    for (BodyDef& body : spread.bodies) body.id *= 2;
    for (JointDef& joint : spread.joints) joint.id *= 2;
    const auto odd = [](std::uint32_t k) { return 2 * k + 1; };
    return addNoise(spread, odd, odd);
}

Result<Scene> withCountersOf(const Scene& scene, const Noisy& noisy) {
    const Result<World> world = World::create(noisy.scene);
    if (!world) return world.error();
    Scene out = scene;
    out.limits = noisy.scene.limits;
    out.counters = {world->info().nextBody, world->info().nextShape, world->info().nextJoint};
    return out;
}

}  // namespace huestep::tools
