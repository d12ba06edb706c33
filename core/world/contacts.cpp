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
constexpr std::uint32_t layOutGrain = 4096;  // pairs
// In `inLanes`: the contact ended in its row. Its candidate learns that from here when it is looked
// at, which is before anybody gets the contact's place.
constexpr std::uint8_t endedInLane = 2;
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
    c.inverseMassA = state.bodies[c.bodyA].inverseMass;
    c.inverseMassB = state.bodies[c.bodyB].inverseMass;
    ContactFields<float>& row = c.row;
    row.slack = minOf(recycleMost, recyclePart * minOf(known.sizes[pair.a], known.sizes[pair.b]));
    row.inverseInertiaA = state.bodies[c.bodyA].inverseInertia;
    row.inverseInertiaB = state.bodies[c.bodyB].inverseInertia;
    row.reach = maxOf(known.reach[c.bodyA], known.reach[c.bodyB]);
    row.roundness = maxOf(a.radius, b.radius);
    row.friction = std::sqrt(a.friction * b.friction);
    row.restitution = maxOf(a.restitution, b.restitution);
    row.rollingResistance = maxOf(a.rollingResistance, b.rollingResistance) * row.roundness;
    row.tangentSpeed = a.tangentSpeed + b.tangentSpeed;
    row.rollingMass = inverseOrZero(row.inverseInertiaA + row.inverseInertiaB);
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
void World::Data::layOutCandidates(Executor* executor) {
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
    const std::span<const ShapePair> pairs = acc.broadPhase.pairs();
    acc.candidates.resize(pairs.size());
    auto lost = perBlock<std::vector<Candidate>>(pairs.size() + 1, layOutGrain);
    // Each block takes over the old ones up to the next block's first pair, the last one the rest.
    overBlocks(executor, pairs.size() + 1, layOutGrain,
               [&](std::uint32_t begin, std::uint32_t end) {
                   const auto oldFrom = [&](std::uint32_t pair) {
                       if (pair == 0) return old.begin();
                       if (pair >= pairs.size()) return old.end();
                       return std::lower_bound(
                           old.begin(), old.end(), pairs[pair],
                           [](const Candidate& c, const ShapePair& key) { return c.pair < key; });
                   };
                   auto from = oldFrom(begin);
                   const auto last = end > pairs.size() ? old.end() : oldFrom(end);
                   std::vector<Candidate>& mine = lost[begin / layOutGrain];
                   for (std::uint32_t i = begin; i < end && i < pairs.size(); ++i) {
                       for (; from != last && from->pair < pairs[i]; ++from) {
                           if (from->contact != none) mine.push_back(*from);
                       }
                       const bool known = from != last && from->pair == pairs[i];
                       acc.candidates[i] = {pairs[i], known ? (from++)->contact : none};
                   }
                   for (; from != last; ++from) {
                       if (from->contact != none) mine.push_back(*from);
                   }
               });
    std::vector<Candidate> resting;
    for (const std::vector<Candidate>& part : lost) {
        for (const Candidate& candidate : part) {
            const Contact& contact = acc.contacts[candidate.contact];
            // A contact at rest stays as it is, whatever the bounds say: nobody looks at it.
            if (!isActive(activity[contact.bodyA] | activity[contact.bodyB])) {
                resting.push_back(candidate);
            } else {
                events.ends.push_back(changeOf(contact));
                dropContact(candidate.contact);
            }
        }
    }
    if (resting.empty()) return;
    const std::size_t paired = acc.candidates.size();
    acc.candidates.insert(acc.candidates.end(), resting.begin(), resting.end());
    std::inplace_merge(acc.candidates.begin(),
                       acc.candidates.begin() + static_cast<std::ptrdiff_t>(paired),
                       acc.candidates.end(),
                       [](const Candidate& x, const Candidate& y) { return x.pair < y.pair; });
}

/// Takes impulses out of the solver's rows: after the check of manifolds those of the kept ones, as
/// others have had theirs fetched when they got a new one; before it all.
void World::Data::fetchImpulses(Lanes which, Executor* executor) {
    Accelerators& acc = accelerators;
    overRange(executor, acc.rows.blockCount(), blockGrain,
              [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::uint32_t lane = begin * blockLanes; lane < end * blockLanes; ++lane) {
                      const std::uint32_t contact = acc.plan.contactOfLane[lane];
                      if (contact == none) continue;
                      if (which == Lanes::Kept && !acc.rows.isKept(lane)) continue;
                      acc.contactStamps[contact] = stamp;
                      setImpulses(acc.contacts[contact], acc.rows.impulses(lane));
                  }
              });
}

namespace {

/// The collide stage at work: each worker notes what its block of work found, and what the world
/// shares is changed in the order of blocks once all are done.
class Collide {
 public:
    Collide(World::Data& world, Simd simd, Executor* executor)
        : m_world(world),
          m_acc(world.accelerators),
          m_in(world.narrowPhaseInput()),
          m_simd(simd),
          m_executor(executor),
          m_looked(world.anyAsleep ? m_acc.candidates.size() : 0, 0) {
        m_acc.freshLanes.clear();
    }

    void lookAtRows();
    /// Those that no row holds and that nobody has looked at yet.
    void lookAtCandidates();
    /// Whether anybody awake touches a sleeper, of what was found since this was last asked.
    bool takeDisturbed() { return std::exchange(m_disturbs, false); }

 private:
    struct Findings {
        std::uint32_t recycled = 0;
        std::vector<std::uint32_t> fresh;                      // lanes
        std::vector<std::uint32_t> ended;                      // contacts
        std::vector<std::pair<std::uint32_t, Contact>> begun;  // with the candidate's place
        bool disturbs = false;
    };

    [[nodiscard]] std::uint8_t activityOf(std::uint32_t bodyA, std::uint32_t bodyB) const {
        return static_cast<std::uint8_t>(m_world.activity[bodyA] | m_world.activity[bodyB]);
    }
    [[nodiscard]] bool isRenewed(std::uint32_t lane, Findings& mine) const;
    void renew(std::uint32_t lane, Findings& mine) const;
    void lookAt(std::uint32_t candidate, Findings& mine);
    void note(std::uint32_t place, ContactUpdate update, Findings& mine) const;
    void collect(const std::vector<Findings>& findings);

    World::Data& m_world;
    Accelerators& m_acc;
    NarrowPhaseInput m_in;
    Simd m_simd;
    Executor* m_executor;
    std::vector<std::uint8_t> m_looked;  // by candidate; empty where nobody sleeps
    bool m_disturbs = false;
};

/// Notes what became of a contact.
void Collide::note(std::uint32_t place, ContactUpdate update, Findings& mine) const {
    const Contact& contact = m_acc.contacts[place];
    m_acc.contactStamps[place] = m_world.stamp;
    mine.recycled += update == ContactUpdate::Recycled;
    if (contact.pointCount == 0) {
        mine.ended.push_back(place);
    } else {
        const std::uint8_t both = activityOf(contact.bodyA, contact.bodyB);
        mine.disturbs |= isActive(both) && isAsleep(both);
    }
}

void Collide::collect(const std::vector<Findings>& findings) {
    Events& events = m_world.events;
    for (const Findings& f : findings) {
        m_world.report.recycled += f.recycled;
        m_disturbs |= f.disturbs;
        m_acc.freshLanes.insert(m_acc.freshLanes.end(), f.fresh.begin(), f.fresh.end());
        for (const std::uint32_t contact : f.ended) {
            events.ends.push_back(m_world.changeOf(m_acc.contacts[contact]));
            m_world.dropContact(contact);
            m_acc.inLanes[contact] = endedInLane;
        }
        for (const auto& [candidate, contact] : f.begun) {
            const std::uint32_t place = m_world.addContact(contact);
            m_acc.candidates[candidate].contact = place;
            m_world.begun.push_back(place);
            events.begins.push_back(m_world.changeOf(contact));
        }
    }
}

/// Whether the contact of a lane needs a new manifold.
bool Collide::isRenewed(std::uint32_t lane, Findings& mine) const {
    const std::uint32_t place = m_acc.plan.contactOfLane[lane];
    if (place == none) return false;
    if (m_world.anyAsleep) {
        const ConstraintPlaces bodies = m_acc.rows.bodiesOf(lane);
        const std::uint8_t both = activityOf(bodies.a, bodies.b);
        if (!isActive(both)) {
            // It fell asleep; who wakes it looks at the contact alone.
            setImpulses(m_acc.contacts[place], m_acc.rows.impulses(lane));
            m_acc.contactStamps[place] = m_world.stamp;
            m_acc.rows.dropLane(lane);
            m_acc.inLanes[place] = 0;
            return false;
        }
        mine.disturbs |= m_acc.rows.isKept(lane) && isAsleep(both);
    }
    mine.recycled += m_acc.rows.isKept(lane);
    return !m_acc.rows.isKept(lane);
}

void Collide::renew(std::uint32_t lane, Findings& mine) const {
    const std::uint32_t place = m_acc.plan.contactOfLane[lane];
    Contact& contact = m_acc.contacts[place];
    if (contact.pointCount == 0) return;  // it ended with its pair
    setImpulses(contact, m_acc.rows.impulses(lane));
    mine.fresh.push_back(lane);
    note(place, renewContact(contact, m_in), mine);
}

void Collide::lookAtRows() {
    const std::uint32_t blocks = m_acc.rows.blockCount();
    auto findings = perBlock<Findings>(blocks, blockGrain);
    overBlocks(m_executor, blocks, blockGrain, [&](std::uint32_t begin, std::uint32_t end) {
        Findings& mine = findings[begin / blockGrain];
        m_acc.rows.check(m_world.state.motions, m_acc.tight, m_simd, {begin, end});
        // Contacts lie anywhere: first whom to look at, so that they are on their way.
        std::array<std::uint32_t, blockGrain * blockLanes> renewed{};
        std::size_t count = 0;
        for (std::uint32_t block = begin; block < end; ++block) {
            if (!m_world.anyAsleep && m_acc.rows.allKept(block)) {
                mine.recycled += blockLanes;
                continue;
            }
            for (std::uint32_t lane = block * blockLanes; lane < (block + 1) * blockLanes; ++lane) {
                if (!isRenewed(lane, mine)) continue;
                renewed[count++] = lane;
                prefetch(m_acc.contacts[m_acc.plan.contactOfLane[lane]]);
            }
        }
        for (std::size_t k = 0; k < count; ++k) renew(renewed[k], mine);
    });
    collect(findings);
}

void Collide::lookAt(std::uint32_t candidate, Findings& mine) {
    const auto [pair, place] = m_acc.candidates[candidate];
    const std::uint32_t bodyA = m_acc.shapes.proxies[pair.a].body;
    const std::uint32_t bodyB = m_acc.shapes.proxies[pair.b].body;
    const std::uint8_t both = activityOf(bodyA, bodyB);
    // What sleeps from its start is looked at once, so that its islands are known.
    if (!isActive(both) && (both & newToSleep) == 0) return;
    if (!m_looked.empty()) {
        if (m_looked[candidate] != 0) return;
        m_looked[candidate] = 1;
    }
    if (place != none) {
        note(place, updateContact(m_acc.contacts[place], m_in), mine);
        if (m_acc.contacts[place].pointCount == 0) m_acc.candidates[candidate].contact = none;
        return;
    }
    const Manifold manifold = manifoldOf(bodyA, bodyB, pair.a, pair.b, m_in);
    if (manifold.count == 0) return;
    mine.disturbs |= isActive(both) && isAsleep(both);
    mine.begun.emplace_back(candidate, contactOf(pair, m_acc.shapes, m_world.state));
    beginContact(mine.begun.back().second, manifold, m_in);
}

void Collide::lookAtCandidates() {
    const std::size_t count = m_acc.candidates.size();
    auto findings = perBlock<Findings>(count, candidateGrain);
    overBlocks(m_executor, count, candidateGrain, [&](std::uint32_t begin, std::uint32_t end) {
        // Whom to look at: without a branch that half of them would mispredict.
        std::array<std::uint32_t, candidateGrain> near{};
        std::size_t nearCount = 0;
        const std::uint8_t nobody = 0;
        const std::uint8_t* inLanes = m_acc.inLanes.empty() ? &nobody : m_acc.inLanes.data();
        for (std::uint32_t i = begin; i < end; ++i) {
            Candidate& candidate = m_acc.candidates[i];
            const bool overlap =
                overlaps(m_acc.tight[candidate.pair.a], m_acc.tight[candidate.pair.b]);
            bool apart = candidate.contact == none;
            const std::uint8_t lane = inLanes[apart ? 0 : candidate.contact];
            if (!apart && lane == endedInLane) {
                candidate.contact = none;
                apart = true;
            }
            near[nearCount] = i;
            nearCount += (apart ? overlap : lane == 0) ? 1u : 0u;
        }
        for (std::size_t k = 0; k < nearCount; ++k) {
            lookAt(near[k], findings[begin / candidateGrain]);
        }
    });
    collect(findings);
}

}  // namespace

void World::Data::collideAll(Simd simd, Executor* executor) {
    Collide stage(*this, simd, executor);
    if (accelerators.rowsHold) stage.lookAtRows();
    do {
        stage.lookAtCandidates();
    } while (anyAsleep && wakeTouched(stage.takeDisturbed()));
    report.pairs = static_cast<std::uint32_t>(accelerators.candidates.size());
    std::sort(events.begins.begin(), events.begins.end(), keyBefore<ContactChange>);
    std::sort(events.ends.begin(), events.ends.end(), keyBefore<ContactChange>);
}

}  // namespace huestep
