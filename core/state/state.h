/// The state of a world between two steps: everything its future depends on, and nothing else.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/state/records.h"

namespace huestep {

/// Arrays of records, each sorted by id. `motions[i]` belongs to `bodies[i]`, `jointImpulses[i]` to
/// `joints[i]`. Contacts are sorted by (shapeA, shapeB).
struct WorldState {
    std::vector<WorldInfo> world = std::vector<WorldInfo>(1);  ///< exactly one
    std::vector<PlayerRecord> players;                         ///< the host first
    std::vector<BodyMotion> motions;
    std::vector<BodyInfo> bodies;
    std::vector<ShapeInfo> shapes;
    std::vector<JointImpulses> jointImpulses;
    std::vector<JointInfo> joints;
    std::vector<ContactState> contacts;
    std::vector<SpawnPoint> spawnPoints;
    std::vector<BodyInfo> playerBody;      ///< what players get: none or one, id 0
    std::vector<BodyMotion> playerMotion;  ///< likewise
    std::vector<ShapeInfo> playerShapes;   ///< its shapes, id and body 0
    std::vector<RulesInfo> rules;          ///< none or one
    std::vector<RulesWord> rulesWords;     ///< their state; none without rules

    [[nodiscard]] WorldInfo& info() { return world.front(); }
    [[nodiscard]] const WorldInfo& info() const { return world.front(); }
};

/// Place of the record with this id in an array sorted by id, if it is there.
template <class Record>
std::optional<std::uint32_t> placeById(const std::vector<Record>& array, std::uint32_t id) {
    const auto at = std::lower_bound(array.begin(), array.end(), id,
                                     [](const Record& r, std::uint32_t k) { return r.id < k; });
    if (at == array.end() || at->id != id) return std::nullopt;
    return static_cast<std::uint32_t>(at - array.begin());
}

/// Leaves the elements at the places listed, which rise; places behind the last element mean
/// nothing.
template <class T>
void keep(std::vector<T>& array, std::span<const std::uint32_t> places) {
    std::size_t count = 0;
    for (; count < places.size() && places[count] < array.size(); ++count) {
        if (places[count] != count) array[count] = array[places[count]];
    }
    array.resize(count);
}

/// Calls `visit(name, arrays…)` for every array, with that of each state, in the order of
/// snapshots and of differences. The one list: whoever hashes, saves, loads, compares or copies
/// goes through here.
template <class Visit, class... States>
void forEachArrayOf(Visit&& visit, States&... s) {
    visit(std::string_view("world"), s.world...);
    visit(std::string_view("player"), s.players...);
    visit(std::string_view("motion"), s.motions...);
    visit(std::string_view("body"), s.bodies...);
    visit(std::string_view("shape"), s.shapes...);
    visit(std::string_view("jointImpulse"), s.jointImpulses...);
    visit(std::string_view("joint"), s.joints...);
    visit(std::string_view("contact"), s.contacts...);
    visit(std::string_view("spawnPoint"), s.spawnPoints...);
    visit(std::string_view("playerBody"), s.playerBody...);
    visit(std::string_view("playerMotion"), s.playerMotion...);
    visit(std::string_view("playerShape"), s.playerShapes...);
    visit(std::string_view("rules"), s.rules...);
    visit(std::string_view("rulesWord"), s.rulesWords...);
}

/// The same of one state.
template <class State, class Visit>
void forEachArray(State& s, Visit&& visit) {
    forEachArrayOf(visit, s);
}

/// Arrays that hashes, snapshots and deltas leave out where there are no rules, so that these are
/// what they were before there were any.
template <class Record>
inline constexpr bool isOfRules =
    std::is_same_v<Record, RulesInfo> || std::is_same_v<Record, RulesWord>;

/// Most bytes that rules may have as state.
inline constexpr std::size_t maxRulesBytes = std::size_t{64} << 10;

/// Records that change by command alone.
template <class Record>
inline constexpr bool isDefinition =
    std::is_same_v<Record, BodyInfo> || std::is_same_v<Record, ShapeInfo> ||
    std::is_same_v<Record, JointInfo> || std::is_same_v<Record, SpawnPoint>;

}  // namespace huestep
