// What contacts that begin ask of the step in which they do, when no impulse tells of them yet.

#include <algorithm>

#include "core/solver/effort.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

/// The speed of two bodies' centres against each other along the normal, m/s; positive: nearer.
float approachOf(const World::Data& world, const Contact& contact) {
    const BodyMotion& a = world.state.motions[contact.bodyA];
    const BodyMotion& b = world.state.motions[contact.bodyB];
    return dot(contact.normal(), a.velocity - b.velocity);
}

/// The level that a contact asks for that begins in this step.
std::uint8_t effortOfBeginning(const World::Data& world, const Contact& contact) {
    const std::vector<std::uint8_t>& jointed = world.accelerators.shapes.jointed;
    const std::uint32_t heavier =
        contact.inverseMassA < contact.inverseMassB ? contact.bodyA : contact.bodyB;
    // Its joints may hold it: the drum that light things tumble in is no load upon them.
    if (!jointed.empty() && jointed[heavier] != 0) return standardEffort;
    const WorldInfo& info = world.state.info();
    const float approach = approachOf(world, contact);
    const float weight =
        absoluteOf(world.state.bodies[heavier].gravityScale) * length(info.gravity);
    const std::vector<float>& reach = world.accelerators.shapes.reach;
    const float most =
        allowedError(info.penetrationNeed, reach[contact.bodyA], reach[contact.bodyB]);
    const float strain = strainOfBeginning(contact.inverseMassA, contact.inverseMassB, approach,
                                           weight, info.stepSeconds, 1.0f / most, standardEffort);
    return std::min(neededEffort(standardEffort, strain), highestEffort);
}

/// Whether a contact begins deeper than what its bodies' motion explains.
bool beginsDeep(const World::Data& world, const Contact& contact) {
    float overlap = 0.0f;
    for (std::size_t i = 0; i < contact.pointCount; ++i) {
        overlap = maxOf(overlap, -contact.points[i].madeSeparation);
    }
    const BodyMotion& a = world.state.motions[contact.bodyA];
    const BodyMotion& b = world.state.motions[contact.bodyB];
    const std::vector<float>& reach = world.accelerators.shapes.reach;
    const float speed = length(a.velocity - b.velocity) +
                        absoluteOf(a.angularVelocity) * reach[contact.bodyA] +
                        absoluteOf(b.angularVelocity) * reach[contact.bodyB];
    const float explained = speed * world.state.info().stepSeconds;
    return overlap > explained + deepBeginning *
                                     allowedError(0.0f, reach[contact.bodyA], reach[contact.bodyB]);
}

}  // namespace

std::vector<std::uint8_t> World::Data::effortsNow() const {
    const bool planned = state.info().planned();
    std::vector<std::uint8_t> efforts;
    efforts.reserve(state.motions.size());
    for (const BodyMotion& motion : state.motions) efforts.push_back(motion.effort);
    for (const std::uint32_t place : begun) {
        const Contact& contact = accelerators.contacts[place];
        const std::uint8_t needed = planned ? effortOfBeginning(*this, contact) : standardEffort;
        const bool deep = beginsDeep(*this, contact);
        const bool hits = approachOf(*this, contact) > hitSpeed;
        for (const std::uint32_t body : {contact.bodyA, contact.bodyB}) {
            const EffortPlan raised{std::max(levelOf(efforts[body]), needed), 0,
                                    gentleAt(efforts[body]) && !hits, treesAt(efforts[body]),
                                    deep || recoversAt(efforts[body])};
            efforts[body] = raised.packed();
        }
    }
    if (!planned) return efforts;
    const std::vector<std::uint8_t>& trees = accelerators.shapes.wantsTree;
    for (std::size_t body = 0; body < trees.size(); ++body) {
        if (trees[body] != 0) efforts[body] |= EffortPlan::treesBit;
    }
    return efforts;
}

}  // namespace huestep
