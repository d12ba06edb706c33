// The contacts of a step: which there are, and what the narrow phase says of each.

#include <algorithm>
#include <cassert>

#include "core/parallel/over_range.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

constexpr std::uint32_t contactGrain = 256;
// Kept manifolds may slide this part of the smaller shape's size: past that a small box would stand
// on the air beside its ledge.
constexpr float recyclePart = 0.2f;
constexpr float recycleMost = 0.05f;  // m

/// What of a contact follows from its two shapes.
Contact contactOf(const ShapePair& pair, const Shapes& known, std::span<const ShapeInfo> shapes) {
    const ShapeInfo& a = shapes[pair.a];
    const ShapeInfo& b = shapes[pair.b];
    Contact c{};
    c.state.shapeA = a.id;
    c.state.shapeB = b.id;
    c.placeA = pair.a;
    c.placeB = pair.b;
    c.bodyA = known.proxies[pair.a].body;
    c.bodyB = known.proxies[pair.b].body;
    c.reach = maxOf(known.reach[c.bodyA], known.reach[c.bodyB]);
    c.roundness = maxOf(a.radius, b.radius);
    c.slack = minOf(recycleMost, recyclePart * minOf(known.sizes[pair.a], known.sizes[pair.b]));
    c.friction = std::sqrt(a.friction * b.friction);
    c.restitution = maxOf(a.restitution, b.restitution);
    c.rollingResistance = maxOf(a.rollingResistance, b.rollingResistance) * c.roundness;
    c.tangentSpeed = a.tangentSpeed + b.tangentSpeed;
    return c;
}

}  // namespace

/// Brings the contacts in line with the pairs: old ones keep their place in key order with all they
/// hold, new ones begin apart, and those whose pair is gone end.
void World::Data::layOutContacts() {
    Accelerators& acc = accelerators;
    const Shapes& shapes = acc.shapes;
    acc.rowsHold = false;
    std::vector<Contact>& old = acc.contactScratch;
    acc.contacts.swap(old);
    if (!acc.contactsValid) {
        // After a restore or a change of definitions the contacts are in the state alone.
        assert(old.empty());
        for (const ContactState& c : state.contacts) {
            // Both shapes are there: whoever removes one removes its contacts.
            const ShapePair pair{*placeById(state.shapes, c.shapeA),
                                 *placeById(state.shapes, c.shapeB)};
            Contact contact = contactOf(pair, shapes, state.shapes);
            contact.state = c;
            remakeManifold(contact, narrowPhaseInput());
            old.push_back(contact);
        }
        acc.contactsValid = true;
    }
    acc.contacts.clear();
    acc.contacts.reserve(acc.broadPhase.pairs().size());
    auto from = old.begin();
    const auto dropBefore = [&](const ShapePair* pair) {
        for (; from != old.end() && (!pair || ShapePair{from->placeA, from->placeB} < *pair);
             ++from) {
            if (from->pointCount == 0) continue;
            // A contact at rest stays as it is, whatever the bounds say: nobody looks at it.
            if (!isActive(activity[from->bodyA] | activity[from->bodyB])) {
                acc.contacts.push_back(*from);
            } else {
                events.ends.push_back({from->state.shapeA, from->state.shapeB});
            }
        }
    };
    for (const ShapePair& pair : acc.broadPhase.pairs()) {
        dropBefore(&pair);
        if (from != old.end() && ShapePair{from->placeA, from->placeB} == pair) {
            acc.contacts.push_back(*from++);
        } else {
            acc.contacts.push_back(contactOf(pair, shapes, state.shapes));
        }
    }
    dropBefore(nullptr);
}

void World::Data::collideAll(Executor* executor) {
    const NarrowPhaseInput in = narrowPhaseInput();
    const std::size_t count = accelerators.contacts.size();
    accelerators.recycled.assign(count, 0);
    // What one block of contacts found: how many, which began or ended, and whether any sleeper is
    // touched by what is awake.
    struct Findings {
        std::uint32_t pairs = 0, recycled = 0;
        std::vector<std::uint32_t> changed;
        bool disturbs = false;
    };
    std::vector<std::uint8_t> looked(anyAsleep ? count : 0, 0);
    bool woke = false;
    do {
        auto findings = perBlock<Findings>(count, contactGrain);
        overRange(executor, count, contactGrain, [&](std::uint32_t begin, std::uint32_t end) {
            Findings& mine = findings[begin / contactGrain];
            for (std::uint32_t i = begin; i < end; ++i) {
                Contact& contact = accelerators.contacts[i];
                const auto both =
                    static_cast<std::uint8_t>(activity[contact.bodyA] | activity[contact.bodyB]);
                // What sleeps from its start is looked at once, so that its islands are known.
                if (!isActive(both) && (both & newToSleep) == 0) continue;
                if (anyAsleep) {
                    if (looked[i]) continue;
                    looked[i] = 1;
                }
                const bool touched = contact.pointCount > 0;
                const ContactUpdate update = updateContact(contact, in);
                const bool touching = contact.pointCount > 0;
                mine.pairs += update != ContactUpdate::Apart;
                mine.recycled += update == ContactUpdate::Recycled;
                accelerators.recycled[i] = update == ContactUpdate::Recycled;
                if (touched != touching) mine.changed.push_back(i);
                mine.disturbs |= touching && isActive(both) && isAsleep(both);
            }
        });
        bool disturbs = false;
        for (const Findings& f : findings) {
            report.pairs += f.pairs;
            report.recycled += f.recycled;
            disturbs |= f.disturbs;
            for (const std::uint32_t i : f.changed) {
                const Contact& contact = accelerators.contacts[i];
                (contact.pointCount > 0 ? events.begins : events.ends)
                    .push_back({contact.state.shapeA, contact.state.shapeB});
            }
        }
        woke = anyAsleep && wakeTouched(disturbs);
    } while (woke);
    std::sort(events.begins.begin(), events.begins.end(), keyBefore<ContactChange>);
    std::sort(events.ends.begin(), events.ends.end(), keyBefore<ContactChange>);
}

}  // namespace huestep
