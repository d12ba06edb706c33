// Judging a spawn before anything is added: definitions, rights, budget, and how crowded it is.

#include "core/world/from_definition.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

// What a player may add at once. Bodies cost what they touch: a heap of shapes on one spot is a
// contact for every two of them, so crowds are refused where they would begin.
constexpr std::size_t maxPlayerBodies = 8;  // a command
constexpr std::size_t maxPlayerShapes = 8;  // a body
constexpr float maxPlayerReach = 10.0f;     // m, from a body's centre
constexpr std::uint32_t maxCrowd = 64;      // shapes whose bounds a spawned shape may overlap

}  // namespace

float World::Data::reachOf(std::uint32_t body) const {
    float reach = 0.0f;
    for (const ShapeInfo& shape : shapesOf(state.bodies[body].id)) {
        reach = maxOf(reach, huestep::reachOf(hullOf<float>(shape)));
    }
    return reach;
}

/// Bodies the player spawned and that are still there; the one the scene gave it apart.
std::size_t World::Data::spawnedBy(PlayerId player) {
    const BodyId own = findPlayer(player)->body;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < state.bodies.size(); ++i) {
        const bool gone = i < removed.size() && removed[i];
        if (state.bodies[i].owner == player && state.bodies[i].id != own && !gone) ++count;
    }
    return count;
}

/// Whether a shape at a pose would overlap the bounds of more shapes than a player may crowd.
bool World::Data::crowded(const ShapeInfo& shape, const Pose& pose) const {
    const Bounds here = boundsOf(hullOf<float>(shape), pose);
    std::uint32_t overlapping = 0;
    std::uint32_t body = 0;
    for (const ShapeInfo& other : state.shapes) {
        while (state.bodies[body].id != other.body) ++body;
        if (!overlaps(here, boundsOf(hullOf<float>(other), state.motions[body].pose()))) continue;
        if (++overlapping > maxCrowd) return true;
    }
    return false;
}

Rejection World::Data::judge(const Spawn& spawn, PlayerId author) {
    const bool host = author == 0;
    if (spawn.bodies.empty()) return Rejection::BadDefinition;
    if (!host && (spawn.bodies.size() > maxPlayerBodies || !spawn.joints.empty())) {
        return Rejection::NotAllowed;
    }
    for (const JointDef& joint : spawn.joints) {
        if (joint.id != 0 || !check(joint, spawn.bodies.size(), "joint")) {
            return Rejection::BadDefinition;
        }
    }
    for (const BodyDef& body : spawn.bodies) {
        if (body.id != 0 || body.firstShape != 0) return Rejection::BadDefinition;
        if (!check(body, "body")) return Rejection::BadDefinition;
        const BodyRecords records = recordsOf(body);
        if (!validate(records)) return Rejection::BadDefinition;
        if (host) continue;
        if (body.type != BodyType::Dynamic || body.shapes.size() > maxPlayerShapes) {
            return Rejection::NotAllowed;
        }
        for (const ShapeInfo& shape : records.shapes) {
            if (huestep::reachOf(hullOf<float>(shape)) > maxPlayerReach)
                return Rejection::NotAllowed;
            if (crowded(shape, records.motion.pose())) return Rejection::TooCrowded;
        }
    }
    if (!host && spawnedBy(author) + spawn.bodies.size() > state.info().maxSpawned) {
        return Rejection::OverBudget;
    }
    return Rejection::None;
}

}  // namespace huestep
