// Taking bodies and joints out of a world.

#include <algorithm>

#include "core/world/world_data.h"

namespace huestep {

void World::Data::removeMarked() {
    if (removed.empty() && removedJoints.empty()) return;
    changeDefinitions();
    removed.resize(state.bodies.size(), 0);
    removedJoints.resize(state.joints.size(), 0);
    const auto gone = [&](BodyId id) {
        const auto place = placeById(state.bodies, id);
        return place && removed[*place];
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
        return state.shapes[*placeById(state.shapes, id)].body;
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
    closeGaps();
}

/// Moves what stays together, in order.
void World::Data::closeGaps() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < removed.size(); ++i) {
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
    for (std::size_t i = 0; i < removedJoints.size(); ++i) {
        if (removedJoints[i]) continue;
        state.joints[kept] = state.joints[i];
        state.jointImpulses[kept] = state.jointImpulses[i];
        ++kept;
    }
    state.joints.resize(kept);
    state.jointImpulses.resize(kept);
    removed.clear();
    removedJoints.clear();
}

}  // namespace huestep
