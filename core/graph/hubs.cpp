#include "core/graph/hubs.h"

#include <algorithm>

namespace huestep {

namespace {

struct Degree {
    std::uint32_t moving = 0;
    std::uint32_t fixed = 0;
};

std::size_t asIndex(BodyPlace place) {
    return static_cast<std::size_t>(place);
}

/// One hub's contacts of one kind, sorted into runs by how often the other has been met before.
/// `met`: by place; all zero before and after.
void appendRuns(std::span<const ConstraintBodies> contacts, BodyPlace hub, bool fixed,
                std::span<const std::uint32_t> mine, std::vector<std::uint32_t>& met,
                std::vector<HubRun>& runs) {
    const std::size_t first = runs.size();
    const auto otherOf = [&](std::uint32_t i) {
        return contacts[i].a == hub ? contacts[i].b : contacts[i].a;
    };
    for (const std::uint32_t i : mine) {
        const BodyPlace other = otherOf(i);
        const std::size_t before = other >= 0 ? met[asIndex(other)]++ : 0;
        if (first + before == runs.size()) runs.push_back({hub, fixed, {}});
        runs[first + before].constraints.push_back(i);
    }
    for (const std::uint32_t i : mine) {
        if (otherOf(i) >= 0) met[asIndex(otherOf(i))] = 0;
    }
}

}  // namespace

std::vector<HubRun> findHubs(std::span<const ConstraintBodies> contacts, std::uint32_t bodyCount,
                             std::uint32_t hubDegree) {
    std::vector<Degree> degrees(bodyCount);
    bool any = false;
    for (const ConstraintBodies& c : contacts) {
        const bool moving = c.a >= 0 && c.b >= 0;
        for (const BodyPlace place : {c.a, c.b}) {
            if (place < 0) continue;
            Degree& degree = degrees[asIndex(place)];
            any = ++(moving ? degree.moving : degree.fixed) > hubDegree || any;
        }
    }
    std::vector<HubRun> runs;
    if (!any) return runs;

    // By hub, in the order of places.
    struct Contacts {
        BodyPlace hub = fixedWorld;
        std::vector<std::uint32_t> moving, fixed;
    };
    std::vector<std::uint32_t> slot(bodyCount, 0);
    std::vector<Contacts> hubs;
    for (std::uint32_t place = 0; place < bodyCount; ++place) {
        if (degrees[place].moving <= hubDegree && degrees[place].fixed <= hubDegree) continue;
        slot[place] = static_cast<std::uint32_t>(hubs.size());
        hubs.push_back({static_cast<BodyPlace>(place), {}, {}});
    }
    for (std::uint32_t i = 0; i < contacts.size(); ++i) {
        const ConstraintBodies& c = contacts[i];
        if (c.a >= 0 && c.b >= 0) {
            const bool hubA = degrees[asIndex(c.a)].moving > hubDegree;
            const bool hubB = degrees[asIndex(c.b)].moving > hubDegree;
            if (hubA == hubB) continue;
            hubs[slot[asIndex(hubA ? c.a : c.b)]].moving.push_back(i);
        } else {
            const BodyPlace moving = c.a >= 0 ? c.a : c.b;
            if (degrees[asIndex(moving)].fixed <= hubDegree) continue;
            hubs[slot[asIndex(moving)]].fixed.push_back(i);
        }
    }
    std::vector<std::uint32_t> met(bodyCount, 0);
    for (const Contacts& hub : hubs) appendRuns(contacts, hub.hub, false, hub.moving, met, runs);
    for (const Contacts& hub : hubs) appendRuns(contacts, hub.hub, true, hub.fixed, met, runs);
    return runs;
}

}  // namespace huestep
