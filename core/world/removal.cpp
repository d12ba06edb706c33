// Taking bodies and joints out of a world.

#include <algorithm>

#include "core/world/world_data.h"

namespace huestep {

void World::Data::removeMarked() {
    if (removed.empty() && removedJoints.empty()) return;
    changeDefinitions();
    removed.resize(state.bodies.size(), 0);
    removedJoints.resize(state.joints.size(), 0);
    markJointsOfRemoved();
    endContactsOfRemoved();
    for (PlayerRecord& player : state.players) {
        if (player.body == 0) continue;
        const auto place = placeById(state.bodies, player.body);
        if (place && removed[*place]) player.body = 0;
    }
    closeGaps();
}

/// A joint goes with either of its bodies; whom it held wakes.
void World::Data::markJointsOfRemoved() {
    const std::vector<ConstraintPlaces>& known = accelerators.shapes.jointBodies;
    for (std::size_t i = 0; i < state.joints.size(); ++i) {
        const JointInfo& j = state.joints[i];
        ConstraintPlaces at;
        if (i < known.size()) {
            at = known[i];
        } else {
            at.b = *placeById(state.bodies, j.bodyB);
            at.a = j.bodyA == 0 ? at.b : *placeById(state.bodies, j.bodyA);
        }
        if (removed[at.a] || removed[at.b]) removedJoints[i] = 1;
        if (!removedJoints[i]) continue;
        wake(at.a);
        wake(at.b);
        if (PlayerRecord* player = findPlayer(j.owner); player && player->grab == j.id) {
            player->grab = 0;
        }
    }
}

/// A contact ends with either of its bodies; whom it held wakes.
void World::Data::endContactsOfRemoved() {
    const auto ends = [this](std::uint32_t a, std::uint32_t b, ContactChange change) {
        if (!removed[a] && !removed[b]) return false;
        wake(a);
        wake(b);
        events.ends.push_back(change);
        return true;
    };
    Accelerators& acc = accelerators;
    if (acc.definitionsStale) {
        const auto bodyOf = [this](ShapeId id) {
            return *placeById(state.bodies, state.shapes[*placeById(state.shapes, id)].body);
        };
        std::erase_if(state.contacts, [&](const ContactState& c) {
            return ends(bodyOf(c.shapeA), bodyOf(c.shapeB), {c.shapeA, c.shapeB});
        });
        return;
    }
    for (Candidate& candidate : acc.candidates) {
        if (candidate.contact == none) continue;
        const auto [a, b] = candidate.pair;
        const ContactChange change{state.shapes[a].id, state.shapes[b].id};
        if (!ends(acc.shapes.proxies[a].body, acc.shapes.proxies[b].body, change)) continue;
        dropContact(candidate.contact);
        candidate.contact = none;
    }
}

namespace {

/// Moves the records that `gone` does not mark together, in order, and lists their places.
template <class Record, class Gone>
void closeUp(std::vector<Record>& records, std::vector<std::uint32_t>& kept, Gone&& gone) {
    kept.clear();
    for (std::uint32_t i = 0; i < records.size(); ++i) {
        if (!gone(i)) kept.push_back(i);
    }
    keep(records, kept);
}

}  // namespace

void World::Data::closeGaps() {
    kept.all = false;
    std::uint32_t body = 0;
    closeUp(state.shapes, kept.shapes, [&](std::uint32_t shape) {
        while (state.bodies[body].id != state.shapes[shape].body) ++body;
        return removed[body] != 0;
    });
    closeUp(state.bodies, kept.bodies, [&](std::uint32_t i) { return removed[i] != 0; });
    closeUp(state.joints, kept.joints, [&](std::uint32_t i) { return removedJoints[i] != 0; });
    keep(state.motions, kept.bodies);
    keep(forces, kept.bodies);
    keep(state.jointImpulses, kept.joints);
    removed.clear();
    removedJoints.clear();
}

}  // namespace huestep
