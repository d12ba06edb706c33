// Rules in a world: begun, found again, asked at their places in a step, and what they see.

#include "core/rules/rules.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "core/math/finite.h"
#include "core/world/queries.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

/// Calls `f(place of the float, its bytes)` for every float of a state.
template <class Byte, class F>
void forEachFloat(std::span<const Field> fields, std::span<Byte> state, F&& f) {
    for (const Field& field : fields) {
        if (field.type != FieldType::F32) continue;
        for (std::uint32_t k = 0; k < field.count; ++k) {
            f(field, state.subspan(field.offset + 4 * k, 4));
        }
    }
}

float floatAt(std::span<const std::byte> bytes) {
    float value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

/// What no state that a world has made could hold; the rest is the rules' to judge.
std::string faultOf(const Rules& rules, std::span<const std::byte> state) {
    if (state.size() != rules.stateBytes()) {
        return std::to_string(state.size()) + " bytes instead of their " +
               std::to_string(rules.stateBytes());
    }
    std::string bad;
    forEachFloat(rules.fields(), state, [&](const Field& field, std::span<const std::byte> at) {
        const float value = finiteOrZero(floatAt(at));
        if (bad.empty() && std::memcmp(&value, at.data(), sizeof value) != 0) {
            bad = std::string(field.name) + ": not finite, or a zero with a sign";
        }
    });
    return bad.empty() ? rules.faultOfBytes(state) : bad;
}

}  // namespace

Status World::Data::beginRules(const Scene& scene) {
    if (!scene.rules) return Done{};
    const RulesDef& def = *scene.rules;
    const Result<const Rules*> found = findRules(knownRules, def.name, def.version);
    if (!found) return Error{"rules: " + found.error().message};
    RulesInfo info{};
    std::copy(def.name.begin(), def.name.end(), info.name.begin());
    info.version = def.version;
    info.seed = def.seed;
    info.dice = def.seed;
    state.rules.push_back(info);
    state.rulesWords.assign((*found)->stateBytes() / sizeof(RulesWord), RulesWord{});
    rules = *found;
    RulesParameters parameters(def.parameters);
    Status started = rules->beginBytes(rulesState(), parameters, Seen(*this));
    if (started) started = parameters.verdict();
    if (!started) return Error{"rules " + def.name + ": " + started.error().message};
    cleanRulesState();
    const std::string fault = faultOf(*rules, rulesState());
    if (!fault.empty()) return Error{"rules " + def.name + " at their start: " + fault};
    return Done{};
}

Status World::Data::bindRules() {
    if (state.rules.empty()) return Done{};
    const RulesInfo& info = state.rules.front();
    const auto end = std::find(info.name.begin(), info.name.end(), std::uint8_t{0});
    const std::string name(info.name.begin(), end);
    const Result<const Rules*> found = findRules(knownRules, name, info.version);
    if (!found) return found.error();
    rules = *found;
    const std::string fault = faultOf(*rules, rulesState());
    if (!fault.empty()) return Error{"rules " + name + ": " + fault};
    return Done{};
}

std::span<std::byte> World::Data::rulesState() {
    return std::as_writable_bytes(std::span(state.rulesWords));
}

void World::Data::afterRules() {
    rules->afterBytes(rulesState(), Seen(*this));
    cleanRulesState();
}

void World::Data::cleanRulesState() {
    forEachFloat(rules->fields(), rulesState(), [](const Field&, std::span<std::byte> at) {
        const float value = finiteOrZero(floatAt(at));
        std::memcpy(at.data(), &value, sizeof value);
    });
}

const Rules* World::rules() const {
    return m_data->rules;
}
std::span<const std::byte> World::rulesState() const {
    return std::as_bytes(std::span(m_data->state.rulesWords));
}
std::string World::score() const {
    return m_data->rules == nullptr ? "" : m_data->rules->scoreOfBytes(rulesState(), Seen(*m_data));
}

// What rules see ---------------------------------------------------------------------------------

std::uint64_t Seen::tick() const {
    return m_world.state.info().tick;
}
float Seen::stepSeconds() const {
    return m_world.state.info().stepSeconds;
}
std::uint32_t Seen::ticksOf(float seconds) const {
    const float ticks = seconds / stepSeconds();
    constexpr float most = 4.0e9f;
    if (!(ticks >= 1.0f)) return 1;
    return static_cast<std::uint32_t>((ticks < most ? ticks : most) + 0.5f);
}
std::span<const PlayerRecord> Seen::players() const {
    return m_world.state.players;
}
const PlayerRecord* Seen::player(PlayerId id) const {
    return m_world.findPlayer(id);
}
std::span<const BodyInfo> Seen::bodies() const {
    return m_world.state.bodies;
}
std::span<const BodyMotion> Seen::motions() const {
    return m_world.state.motions;
}
std::optional<std::uint32_t> Seen::find(BodyId id) const {
    return m_world.findBody(id);
}
const BodyMotion* Seen::motionOf(BodyId id) const {
    const auto place = find(id);
    return place ? &m_world.state.motions[*place] : nullptr;
}
float Seen::massOf(BodyId id) const {
    const auto place = find(id);
    return place ? m_world.state.bodies[*place].mass : 0.0f;
}
std::span<const ShapeInfo> Seen::shapesOf(BodyId id) const {
    return m_world.shapesOf(id);
}
BodyId Seen::bodyOf(ShapeId id) const {
    const auto place = placeById(m_world.state.shapes, id);
    return place ? m_world.state.shapes[*place].body : 0;
}
const Events& Seen::events() const {
    return m_world.events;
}
std::vector<RayHit> Seen::castRay(Vec2 from, Vec2 to) const {
    return huestep::castRay(m_world.state, from, to);
}
std::vector<ShapeId> Seen::overlap(const ShapeDef& shape, const Pose& pose) const {
    return overlapping(m_world.state, shape, pose);
}

// Their dice -------------------------------------------------------------------------------------

std::uint64_t Game::roll() {
    std::uint64_t z = (m_data.state.rules.front().dice += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}
std::uint32_t Game::below(std::uint32_t count) {
    return static_cast<std::uint32_t>(((roll() >> 32) * count) >> 32);
}
float Game::between(float low, float high) {
    return low + (high - low) * (static_cast<float>(roll() >> 40) * 0x1.0p-24f);
}

}  // namespace huestep
