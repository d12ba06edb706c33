// The contacts of a step: which there are, and what the narrow phase says of each.

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "core/parallel/over_range.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

constexpr std::uint32_t blockGrain = 16;  // of rows: 256 contacts
constexpr std::uint32_t candidateGrain = 512;
// Kept manifolds may slide this part of the smaller shape's size: past that a small box would stand
// on the air beside its ledge.
constexpr float recyclePart = 0.2f;
constexpr float recycleMost = 0.05f;  // m

/// What of a contact follows from its two shapes and their bodies.
Contact contactOf(const ShapePair& pair, const Shapes& known, const WorldState& state) {
    const ShapeInfo& a = state.shapes[pair.a];
    const ShapeInfo& b = state.shapes[pair.b];
    Contact c;
    c.placeA = pair.a;
    c.placeB = pair.b;
    c.bodyA = known.proxies[pair.a].body;
    c.bodyB = known.proxies[pair.b].body;
    c.row.slack = minOf(recycleMost, recyclePart * minOf(known.sizes[pair.a], known.sizes[pair.b]));
    ContactFields<float>& row = c.row;
    c.inverseMassA = state.bodies[c.bodyA].inverseMass;
    row.inverseInertiaA = state.bodies[c.bodyA].inverseInertia;
    c.inverseMassB = state.bodies[c.bodyB].inverseMass;
    row.inverseInertiaB = state.bodies[c.bodyB].inverseInertia;
    row.reach = maxOf(known.reach[c.bodyA], known.reach[c.bodyB]);
    row.roundness = maxOf(a.radius, b.radius);
    row.friction = std::sqrt(a.friction * b.friction);
    row.restitution = maxOf(a.restitution, b.restitution);
    row.rollingResistance = maxOf(a.rollingResistance, b.rollingResistance) * row.roundness;
    row.tangentSpeed = a.tangentSpeed + b.tangentSpeed;
    const float k = row.inverseInertiaA + row.inverseInertiaB;
    row.rollingMass = k > 0.0f ? 1.0f / k : 0.0f;
    return c;
}

}  // namespace

ContactChange World::Data::changeOf(const Contact& contact) const {
    return {state.shapes[contact.placeA].id, state.shapes[contact.placeB].id};
}

std::uint32_t World::Data::addContact(const Contact& contact) {
    Accelerators& acc = accelerators;
    acc.linksStale = true;
    acc.candidatesStamp = stamp;
    if (acc.freeContacts.empty()) {
        acc.contacts.push_back(contact);
        acc.contactStamps.push_back(stamp);
        acc.inLanes.push_back(0);
        return static_cast<std::uint32_t>(acc.contacts.size() - 1);
    }
    const std::uint32_t place = acc.freeContacts.back();
    acc.freeContacts.pop_back();
    acc.contacts[place] = contact;
    acc.contactStamps[place] = stamp;
    acc.inLanes[place] = 0;
    return place;
}

void World::Data::dropContact(std::uint32_t contact) {
    Accelerators& acc = accelerators;
    acc.linksStale = true;
    acc.candidatesStamp = stamp;
    acc.contactStamps[contact] = stamp;
    acc.contacts[contact].pointCount = 0;
    acc.freeContacts.push_back(contact);
}

/// Brings the candidates in line with the pairs: old ones keep their place in key order with their
/// contact, and those whose pair is gone end.
void World::Data::layOutCandidates() {
    Accelerators& acc = accelerators;
    std::vector<Candidate>& old = acc.candidateScratch;
    acc.candidates.swap(old);
    if (!acc.candidatesValid) {
        // After a restore or a change of definitions the contacts are in the state alone.
        assert(old.empty());
        for (const ContactState& c : state.contacts) {
            // Both shapes are there: whoever removes one removes its contacts.
            const ShapePair pair{*placeById(state.shapes, c.shapeA),
                                 *placeById(state.shapes, c.shapeB)};
            Contact contact = contactOf(pair, acc.shapes, state);
            contact.turn = c.turn;
            setImpulses(contact, {c.normalImpulse, c.tangentImpulse, c.rollingImpulse});
            remakeManifold(contact, c.relative, narrowPhaseInput());
            // A snapshot from outside may claim a contact that is none.
            old.push_back({pair, contact.pointCount > 0 ? addContact(contact) : none});
        }
        acc.candidatesValid = true;
    }
    acc.candidatesStamp = stamp;
    acc.candidates.clear();
    acc.candidates.reserve(acc.broadPhase.pairs().size());
    auto from = old.begin();
    const auto dropBefore = [&](const ShapePair* pair) {
        for (; from != old.end() && (!pair || from->pair < *pair); ++from) {
            if (from->contact == none) continue;
            const Contact& contact = acc.contacts[from->contact];
            // A contact at rest stays as it is, whatever the bounds say: nobody looks at it.
            if (!isActive(activity[contact.bodyA] | activity[contact.bodyB])) {
                acc.candidates.push_back(*from);
            } else {
                events.ends.push_back(changeOf(contact));
                dropContact(from->contact);
            }
        }
    };
    for (const ShapePair& pair : acc.broadPhase.pairs()) {
        dropBefore(&pair);
        if (from != old.end() && from->pair == pair) {
            acc.candidates.push_back(*from++);
        } else {
            acc.candidates.push_back({pair, none});
        }
    }
    dropBefore(nullptr);
}

/// Takes the impulses of contacts whose manifold is kept out of the solver's rows. Others have had
/// theirs fetched when they got a new manifold.
void World::Data::fetchImpulses(Executor* executor) {
    Accelerators& acc = accelerators;
    overRange(executor, acc.solver.blockCount(), blockGrain,
              [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::uint32_t lane = begin * blockLanes; lane < end * blockLanes; ++lane) {
                      const std::uint32_t contact = acc.plan.contactOfLane[lane];
                      if (contact == none || !acc.solver.isKept(lane)) continue;
                      acc.contactStamps[contact] = stamp;
                      setImpulses(acc.contacts[contact], acc.solver.impulses(lane));
                  }
              });
}

void World::Data::collideAll(Simd simd, Executor* executor) {
    Accelerators& acc = accelerators;
    const NarrowPhaseInput in = narrowPhaseInput();
    acc.freshLanes.clear();
    // What one block of work found: which contacts ended or began, and whether any sleeper is
    // touched by what is awake.
    struct Findings {
        std::uint32_t recycled = 0;
        std::vector<std::uint32_t> fresh;                      // lanes
        std::vector<std::uint32_t> ended;                      // contacts
        std::vector<std::pair<std::uint32_t, Contact>> begun;  // with the candidate's place
        bool disturbs = false;
    };
    const auto activityOfBoth = [&](const Contact& contact) {
        return static_cast<std::uint8_t>(activity[contact.bodyA] | activity[contact.bodyB]);
    };
    const auto activityOfLane = [&](std::uint32_t lane) {
        const ConstraintPlaces bodies = acc.solver.bodiesOf(lane);
        return static_cast<std::uint8_t>(activity[bodies.a] | activity[bodies.b]);
    };
    bool disturbs = false;
    const auto collect = [&](std::vector<Findings>& findings) {
        for (Findings& f : findings) {
            report.recycled += f.recycled;
            disturbs |= f.disturbs;
            acc.freshLanes.insert(acc.freshLanes.end(), f.fresh.begin(), f.fresh.end());
            for (const std::uint32_t contact : f.ended) {
                const Contact& c = acc.contacts[contact];
                const auto at = std::lower_bound(
                    acc.candidates.begin(), acc.candidates.end(), ShapePair{c.placeA, c.placeB},
                    [](const Candidate& x, const ShapePair& pair) { return x.pair < pair; });
                at->contact = none;
                events.ends.push_back(changeOf(c));
                dropContact(contact);
            }
            for (const auto& [candidate, contact] : f.begun) {
                acc.candidates[candidate].contact = addContact(contact);
                events.begins.push_back(changeOf(contact));
            }
        }
    };
    const auto lookAt = [&](std::uint32_t place, ContactUpdate update, Findings& mine) {
        const Contact& contact = acc.contacts[place];
        acc.contactStamps[place] = stamp;
        mine.recycled += update == ContactUpdate::Recycled;
        if (contact.pointCount == 0) {
            mine.ended.push_back(place);
        } else if (anyAsleep) {
            const std::uint8_t both = activityOfBoth(contact);
            mine.disturbs |= isActive(both) && isAsleep(both);
        }
    };

    if (acc.rowsHold) {
        const std::uint32_t blocks = acc.solver.blockCount();
        auto findings = perBlock<Findings>(blocks, blockGrain);
        overBlocks(executor, blocks, blockGrain, [&](std::uint32_t begin, std::uint32_t end) {
            Findings& mine = findings[begin / blockGrain];
            acc.solver.check(state.motions, acc.tight, simd, {begin, end});
            // Contacts lie anywhere: first whom to look at, so that they are on their way.
            std::array<std::uint32_t, blockGrain * blockLanes> renewed{};
            std::size_t renewedCount = 0;
            for (std::uint32_t block = begin; block < end; ++block) {
                if (!anyAsleep && acc.solver.allKept(block)) {
                    mine.recycled += blockLanes;
                    continue;
                }
                for (std::uint32_t lane = block * blockLanes; lane < (block + 1) * blockLanes;
                     ++lane) {
                    const std::uint32_t place = acc.plan.contactOfLane[lane];
                    if (place == none) continue;
                    const std::uint8_t both =
                        anyAsleep ? activityOfLane(lane) : std::uint8_t{movesNow};
                    if (!isActive(both)) {
                        // It fell asleep; who wakes it looks at the contact alone.
                        setImpulses(acc.contacts[place], acc.solver.impulses(lane));
                        acc.contactStamps[place] = stamp;
                        acc.solver.dropLane(lane);
                        acc.inLanes[place] = 0;
                    } else if (acc.solver.isKept(lane)) {
                        ++mine.recycled;
                        mine.disturbs |= isAsleep(both);
                    } else {
                        renewed[renewedCount++] = lane;
                        __builtin_prefetch(&acc.contacts[place]);
                        __builtin_prefetch(&acc.contacts[place].points[0]);
                        __builtin_prefetch(&acc.contacts[place].points[1].tangentImpulse);
                    }
                }
            }
            for (std::size_t k = 0; k < renewedCount; ++k) {
                const std::uint32_t lane = renewed[k];
                const std::uint32_t place = acc.plan.contactOfLane[lane];
                Contact& contact = acc.contacts[place];
                if (contact.pointCount == 0) continue;  // it ended with its pair
                setImpulses(contact, acc.solver.impulses(lane));
                mine.fresh.push_back(lane);
                lookAt(place, renewContact(contact, in), mine);
            }
        });
        collect(findings);
    }

    const std::size_t count = acc.candidates.size();
    const std::uint8_t nobody = 0;
    std::vector<std::uint8_t> looked(anyAsleep ? count : 0, 0);
    bool woke = false;
    do {
        const std::uint8_t* inLanes = acc.inLanes.empty() ? &nobody : acc.inLanes.data();
        auto findings = perBlock<Findings>(count, candidateGrain);
        overBlocks(executor, count, candidateGrain, [&](std::uint32_t begin, std::uint32_t end) {
            Findings& mine = findings[begin / candidateGrain];
            // Whom to look at: without a branch that half of them would mispredict.
            std::array<std::uint32_t, candidateGrain> near{};
            std::size_t nearCount = 0;
            for (std::uint32_t i = begin; i < end; ++i) {
                const Candidate& candidate = acc.candidates[i];
                const bool overlap =
                    overlaps(acc.tight[candidate.pair.a], acc.tight[candidate.pair.b]);
                const bool apart = candidate.contact == none;
                const bool held = inLanes[apart ? 0 : candidate.contact] != 0;
                near[nearCount] = i;
                nearCount += (apart ? overlap : !held) ? 1u : 0u;
            }
            for (std::size_t k = 0; k < nearCount; ++k) {
                const std::uint32_t i = near[k];
                const Candidate& candidate = acc.candidates[i];
                const std::uint32_t bodyA = acc.shapes.proxies[candidate.pair.a].body;
                const std::uint32_t bodyB = acc.shapes.proxies[candidate.pair.b].body;
                const auto both = static_cast<std::uint8_t>(activity[bodyA] | activity[bodyB]);
                // What sleeps from its start is looked at once, so that its islands are known.
                if (!isActive(both) && (both & newToSleep) == 0) continue;
                if (anyAsleep) {
                    if (looked[i]) continue;
                    looked[i] = 1;
                }
                if (candidate.contact != none) {
                    lookAt(candidate.contact, updateContact(acc.contacts[candidate.contact], in),
                           mine);
                    continue;
                }
                const Manifold manifold =
                    manifoldOf(bodyA, bodyB, candidate.pair.a, candidate.pair.b, in);
                if (manifold.count == 0) continue;
                mine.disturbs |= isActive(both) && isAsleep(both);
                Contact& contact =
                    mine.begun.emplace_back(i, contactOf(candidate.pair, acc.shapes, state)).second;
                beginContact(contact, manifold, in);
            }
        });
        collect(findings);
        woke = anyAsleep && wakeTouched(disturbs);
        disturbs = false;
    } while (woke);
    report.pairs = static_cast<std::uint32_t>(count);
    std::sort(events.begins.begin(), events.begins.end(), keyBefore<ContactChange>);
    std::sort(events.ends.begin(), events.ends.end(), keyBefore<ContactChange>);
}

}  // namespace huestep
