// Checkpoints: what a world carries from step to step, copied as far as it has changed.

#include <algorithm>
#include <cassert>

#include "core/world/world_data.h"

namespace huestep {

void Carried::become(const Carried& other, bool related) {
    const auto same = [related](Stamp mine, Stamp its) { return related && mine == its; };
    Accelerators& acc = accelerators;
    const Accelerators& its = other.accelerators;

    // Who has contacts elsewhere gathers them again when they are asked for.
    contactsInState = its.definitionsStale || !its.candidatesValid;
    assert(!contactsInState || other.contactsInState);
    const bool sameDefinitions = same(definitionsStamp, other.definitionsStamp);
    forEachArrayOf(
        [&](std::string_view, auto& mine, const auto& from) {
            using Record = std::remove_cvref_t<decltype(mine[0])>;
            if (isDefinition<Record> && sameDefinitions) return;
            if (std::is_same_v<Record, ContactState> && !contactsInState) return;
            mine = from;
        },
        state, other.state);
    definitionsStamp = other.definitionsStamp;
    events = other.events;
    report = other.report;
    roots = other.roots;
    rules = other.rules;
    activity = other.activity;

    acc.definitionsStale = its.definitionsStale;
    if (!same(acc.shapesStamp, its.shapesStamp)) acc.shapes = its.shapes;
    acc.tight = its.tight;
    acc.travel = its.travel;
    if (!same(acc.broadPhaseStamp, its.broadPhaseStamp)) acc.broadPhase = its.broadPhase;
    if (!same(acc.candidatesStamp, its.candidatesStamp)) acc.candidates = its.candidates;
    acc.candidateScratch.clear();
    acc.candidatesValid = its.candidatesValid;
    const std::size_t known = std::min(acc.contacts.size(), its.contacts.size());
    acc.contacts.resize(its.contacts.size());
    for (std::size_t i = 0; i < its.contacts.size(); ++i) {
        if (i < known && same(acc.contactStamps[i], its.contactStamps[i])) continue;
        acc.contacts[i] = its.contacts[i];
    }
    acc.freeContacts = its.freeContacts;
    acc.inLanes = its.inLanes;
    if (!same(acc.planStamp, its.planStamp)) {
        acc.plan = its.plan;
    } else {
        // What a batch knows of the effort of its islands goes on while the plan stays.
        acc.plan.batches = its.plan.batches;
    }
    acc.linksStale = its.linksStale;
    acc.planSharesAll = its.planSharesAll;
    acc.rowsHold = its.rowsHold;
    const std::size_t knownBlocks = std::min(acc.rowStamps.size(), its.rowStamps.size());
    acc.rows.copyRows(its.rows, [&](std::uint32_t block) {
        return block < knownBlocks && same(acc.rowStamps[block], its.rowStamps[block]);
    });
    acc.shapesStamp = its.shapesStamp;
    acc.broadPhaseStamp = its.broadPhaseStamp;
    acc.candidatesStamp = its.candidatesStamp;
    acc.planStamp = its.planStamp;
    acc.contactStamps = its.contactStamps;
    acc.rowStamps = its.rowStamps;
}

struct Checkpoint::Data {
    Carried image;
    Stamp stamp = 0;                     // none in the image is above it
    std::shared_ptr<const int> lineage;  // of the world whose image it is
};

Checkpoint::Checkpoint() = default;
Checkpoint::Checkpoint(Checkpoint&&) noexcept = default;
Checkpoint& Checkpoint::operator=(Checkpoint&&) noexcept = default;
Checkpoint::~Checkpoint() = default;

std::uint64_t Checkpoint::tick() const {
    assert(!empty());
    return m_data->image.state.info().tick;
}

void World::checkpoint(Checkpoint& into) const {
    if (into.empty()) into.m_data = std::make_unique<Checkpoint::Data>();
    into.m_data->image.become(*m_data, into.m_data->lineage == m_data->lineage);
    into.m_data->stamp = m_data->stamp;
    into.m_data->lineage = m_data->lineage;
}

void World::restore(const Checkpoint& from) {
    assert(!from.empty());
    const bool related = m_data->lineage == from.m_data->lineage;
    m_data->become(from.m_data->image, related);
    if (m_data->contactsInState || !related) m_data->gathered = {};
    m_data->forces.clear();
    m_data->anyAsleep = false;
    m_data->islandEfforts.clear();  // of a step that this world has not taken
    if (related) return;
    m_data->stamp = std::max(m_data->stamp, from.m_data->stamp);
    m_data->lineage = std::make_shared<const int>(0);
}

}  // namespace huestep
