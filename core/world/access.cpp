// Looking into a world, and the small changes every stage shares.

#include <algorithm>
#include <utility>

#include "core/state/delta.h"
#include "core/state/snapshot.h"
#include "core/state/validate.h"
#include "core/world/world_data.h"

namespace huestep {

std::optional<std::uint32_t> World::Data::findBody(BodyId id) const {
    const auto at = placeById(state.bodies, id);
    if (at && !removed.empty() && *at < removed.size() && removed[*at]) return std::nullopt;
    return at;
}

std::optional<std::uint32_t> World::Data::findJoint(JointId id) const {
    const auto at = placeById(state.joints, id);
    if (at && *at < removedJoints.size() && removedJoints[*at]) return std::nullopt;
    return at;
}

const PlayerRecord* World::Data::findPlayer(PlayerId id) const {
    const auto at = placeById(state.players, id);
    return at ? &state.players[*at] : nullptr;
}
PlayerRecord* World::Data::findPlayer(PlayerId id) {
    return const_cast<PlayerRecord*>(std::as_const(*this).findPlayer(id));
}

std::span<const ShapeInfo> World::Data::shapesOf(BodyId id) const {
    const std::vector<ShapeInfo>& shapes = state.shapes;
    const auto from = std::lower_bound(shapes.begin(), shapes.end(), id,
                                       [](const ShapeInfo& s, BodyId k) { return s.body < k; });
    const auto to = std::upper_bound(from, shapes.end(), id,
                                     [](BodyId k, const ShapeInfo& s) { return k < s.body; });
    return {from, to};
}

void World::Data::wake(std::uint32_t body) {
    if (state.bodies[body].dynamic()) state.motions[body].rest = 0;
}

/// Which contact each record shows, in key order, and which lane holds its impulses.
void World::Data::layOutRecords() const {
    const Accelerators& acc = accelerators;
    std::vector<std::uint32_t> recordOf(acc.contacts.size(), none);
    gathered.contactOf.clear();
    for (const Candidate& candidate : acc.candidates) {
        if (candidate.contact == none) continue;
        recordOf[candidate.contact] = static_cast<std::uint32_t>(gathered.contactOf.size());
        gathered.contactOf.push_back(candidate.contact);
    }
    gathered.stamps.assign(gathered.contactOf.size(), 0);
    state.contacts.resize(gathered.contactOf.size());
    gathered.recordOfLane.assign(acc.rowsHold ? acc.plan.contactOfLane.size() : 0, none);
    for (std::size_t lane = 0; lane < gathered.recordOfLane.size(); ++lane) {
        const std::uint32_t contact = acc.plan.contactOfLane[lane];
        if (contact != none) gathered.recordOfLane[lane] = recordOf[contact];
    }
    gathered.candidates = acc.candidatesStamp;
    gathered.plan = acc.planStamp;
}

/// Gathers the touching contacts, in key order, to where snapshots and hashes look for them.
void World::Data::contactsToState() const {
    if (contactsInState) return;
    const Accelerators& acc = accelerators;
    if (gathered.candidates != acc.candidatesStamp || gathered.plan != acc.planStamp) {
        layOutRecords();
    }
    for (std::size_t record = 0; record < gathered.contactOf.size(); ++record) {
        const std::uint32_t place = gathered.contactOf[record];
        if (gathered.stamps[record] == acc.contactStamps[place]) continue;
        gathered.stamps[record] = acc.contactStamps[place];
        const Contact& contact = acc.contacts[place];
        state.contacts[record] = stateOf(contact, state.shapes[contact.placeA].id,
                                         state.shapes[contact.placeB].id, impulsesOf(contact));
    }
    // Records lie in key order and lanes by colour: those of a later block are fetched in time.
    constexpr std::uint32_t ahead = 2;
    const std::span<const std::uint32_t> recordOfLane = gathered.recordOfLane;
    const auto blocks = static_cast<std::uint32_t>(recordOfLane.size() / blockLanes);
    for (std::uint32_t block = 0; block < blocks; ++block) {
        const std::uint32_t later = std::min(block + ahead, blocks - 1);
        for (const std::uint32_t record : recordOfLane.subspan(later * blockLanes, blockLanes)) {
            if (record != none) __builtin_prefetch(&state.contacts[record], 1);
        }
        acc.rows.storeImpulses(block, recordOfLane.subspan(block * blockLanes, blockLanes),
                               state.contacts);
    }
    contactsInState = true;
}

World::World(std::unique_ptr<Data> data) : m_data(std::move(data)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

// A copy carries the state alone: accelerators are made again.
World::World(const World& other) : m_data(std::make_unique<Data>()) {
    other.m_data->contactsToState();
    m_data->state = other.m_data->state;
    m_data->events = other.m_data->events;
    m_data->report = other.m_data->report;
    m_data->rules = other.m_data->rules;
    m_data->knownRules = other.m_data->knownRules;
}

World& World::operator=(const World& other) {
    if (this != &other) *this = World(other);
    return *this;
}

Result<World> World::create(const Scene& scene, RulesSet known) {
    if (const Status fine = check(scene); !fine) return fine.error();
    auto data = std::make_unique<Data>();
    data->build(scene);
    data->knownRules = known;
    if (const Status begun = data->beginRules(scene); !begun) return begun.error();
    // What a scene may say and what a state may hold differ by rounding at the rims.
    if (const Status sound = validate(data->state); !sound) return sound.error();
    return World(std::move(data));
}

Result<World> World::restore(std::span<const std::byte> snapshot, RulesSet known) {
    Result<WorldState> state = readSnapshot(snapshot);
    if (!state) return state.error();
    auto data = std::make_unique<Data>();
    data->state = std::move(*state);
    data->knownRules = known;
    if (const Status bound = data->bindRules(); !bound) {
        return Error{"snapshot: " + bound.error().message};
    }
    return World(std::move(data));
}

std::vector<std::byte> World::save() const {
    m_data->contactsToState();
    return writeSnapshot(m_data->state);
}

std::vector<std::byte> World::saveDelta(const World& base) const {
    const std::uint64_t baseRoot = base.fullRoot();  // and gathers the contacts
    const std::uint64_t root = fullRoot();
    return writeDelta(base.m_data->state, baseRoot, m_data->state, root);
}

Result<World> World::restore(const World& base, std::span<const std::byte> delta) {
    const std::uint64_t baseRoot = base.fullRoot();
    Result<WorldState> state = readDelta(base.m_data->state, baseRoot, delta);
    if (!state) return state.error();
    auto data = std::make_unique<Data>();
    data->state = std::move(*state);
    data->knownRules = base.m_data->knownRules;
    if (const Status bound = data->bindRules(); !bound) {
        return Error{"delta: " + bound.error().message};
    }
    return World(std::move(data));
}

const Events& World::step(std::span<const Command> commands, const StepResources& with) {
    m_data->step(commands, with);
    return m_data->events;
}

std::uint64_t World::tick() const {
    return m_data->state.info().tick;
}
std::uint64_t World::motionRoot() const {
    return huestep::motionRoot(m_data->state);
}
std::vector<std::uint64_t> World::motionLeaves() const {
    return huestep::motionLeaves(m_data->state);
}

std::uint64_t World::fullRoot() const {
    m_data->contactsToState();
    return huestep::fullRoot(m_data->state, m_data->roots);
}

const WorldInfo& World::info() const {
    return m_data->state.info();
}
std::span<const BodyInfo> World::bodies() const {
    return m_data->state.bodies;
}
std::span<const BodyMotion> World::motions() const {
    return m_data->state.motions;
}
std::span<const ShapeInfo> World::shapes() const {
    return m_data->state.shapes;
}
std::span<const JointInfo> World::joints() const {
    return m_data->state.joints;
}
std::span<const JointImpulses> World::jointImpulses() const {
    return m_data->state.jointImpulses;
}
std::span<const PlayerRecord> World::players() const {
    return m_data->state.players;
}
const Events& World::events() const {
    return m_data->events;
}
const StepReport& World::report() const {
    return m_data->report;
}

std::vector<ContactState> World::contacts() const {
    m_data->contactsToState();
    return m_data->state.contacts;
}

std::optional<std::uint32_t> World::find(BodyId id) const {
    return m_data->findBody(id);
}

std::span<const ShapeInfo> World::shapesOf(BodyId id) const {
    return m_data->shapesOf(id);
}

void World::dropAccelerators() {
    m_data->contactsToState();
    m_data->accelerators = {};
    m_data->roots = {};
}

}  // namespace huestep
