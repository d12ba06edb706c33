// Waking and falling asleep, by island.

#include <algorithm>

#include "core/world/world_data.h"

namespace huestep {

namespace {

// An island sleeps when no point of its bodies has been faster than this for half a second.
constexpr float sleepSpeed = 0.05f;  // m/s
constexpr float sleepSeconds = 0.5f;

}  // namespace

/// Wakes every sleeping island that something active touches (a contact has been found that does,
/// if `contactDisturbs`) or is jointed to. Returns whether any body woke: its contacts have to be
/// looked at then.
bool World::Data::wakeTouched(bool contactDisturbs) {
    const Shapes& shapes = accelerators.shapes;
    const auto disturbs = [&](std::uint32_t a, std::uint32_t b) {
        return (isActive(activity[a]) && isAsleep(activity[b])) ||
               (isActive(activity[b]) && isAsleep(activity[a]));
    };
    bool any = contactDisturbs;
    for (const ConstraintPlaces& j : shapes.jointBodies) any = any || disturbs(j.a, j.b);
    if (!any) return false;

    // Rare, so from scratch: islands of all dynamic bodies, asleep or not.
    std::vector<std::uint8_t> dynamic(state.bodies.size());
    for (std::size_t i = 0; i < dynamic.size(); ++i) dynamic[i] = state.bodies[i].dynamic();
    std::vector<Link> links;
    for (const ConstraintPlaces& j : shapes.jointBodies) links.push_back({j.a, j.b, 0});
    for (const Contact& c : accelerators.contacts) {
        if (c.pointCount > 0) links.push_back({c.bodyA, c.bodyB, 0});  // in any order
    }
    UnionFind sets;
    findIslands(links, dynamic, sets);
    std::vector<std::uint8_t> wakes(state.bodies.size(), 0);
    for (const Link& link : links) {
        if (!disturbs(link.a, link.b)) continue;
        for (const std::uint32_t body : {link.a, link.b}) {
            if (dynamic[body]) wakes[sets.find(body)] = 1;
        }
    }
    bool woke = false;
    for (std::uint32_t body = 0; body < dynamic.size(); ++body) {
        if (!isAsleep(activity[body]) || !wakes[sets.find(body)]) continue;
        wake(body);
        activity[body] = movesNow;
        accelerators.linksStale = true;
        woke = true;
    }
    return woke;
}

/// Counts quiet ticks and puts islands to sleep whose every body has been quiet long enough.
void World::Data::settleIslands() {
    const auto ticks = static_cast<std::uint16_t>(sleepSeconds / state.info().stepSeconds + 0.5f);
    const auto asleep = static_cast<std::uint16_t>(ticks | BodyMotion::asleepBit);
    if (anyAsleep) {
        for (std::size_t body = 0; body < activity.size(); ++body) {
            if ((activity[body] & newToSleep) != 0 && state.motions[body].asleep()) {
                state.motions[body].rest = asleep;
            }
        }
    }
    if ((state.info().flags & WorldInfo::sleep) == 0) return;
    const Plan& plan = accelerators.plan;
    // What a moving kinematic body touches is not at rest, however slow it is.
    std::vector<std::uint8_t> driven(state.bodies.size(), 0);
    for (const Link& link : plan.links) {
        if (activity[link.a] == drivesNow) driven[link.b] = 1;
        if (activity[link.b] == drivesNow) driven[link.a] = 1;
    }
    std::vector<std::uint16_t> fewest(state.bodies.size(), 0xffff);  // by island
    for (const std::uint32_t body : plan.awake) {
        BodyMotion& motion = state.motions[body];
        // No point of the body is faster than |v| + |ω| r.
        const float spin = motion.angularVelocity * accelerators.shapes.reach[body];
        const float left = sleepSpeed - absoluteOf(spin);
        const bool quiet = left > 0.0f && lengthSquared(motion.velocity) < left * left;
        const bool may = (state.bodies[body].flags & BodyInfo::maySleep) != 0 && !driven[body];
        const auto longer = static_cast<std::uint16_t>(motion.rest + 1);
        motion.rest = quiet && may ? std::min(longer, ticks) : std::uint16_t{0};
        std::uint16_t& island = fewest[plan.islandOf[body]];
        island = std::min(island, motion.rest);
    }
    for (const std::uint32_t body : plan.awake) {
        if (fewest[plan.islandOf[body]] < ticks) continue;
        BodyMotion& motion = state.motions[body];
        motion.rest = asleep;
        motion.velocity = {};
        motion.angularVelocity = 0.0f;
    }
}

}  // namespace huestep
