#include "core/games/building.h"

#include <algorithm>
#include <optional>

#include "core/games/seats.h"

#include "core/math/trig.h"

namespace huestep::games {

namespace {

constexpr std::int32_t leastSize = 20;  // cm
constexpr std::int32_t mostSize = 160;  // cm

/// One builder's part of the state.
struct Builder {
    BuildingState& s;
    std::size_t seat;

    std::uint32_t& count() { return s.pieces[seat]; }
    BodyId& body(std::size_t i) { return s.body[seat * maxPieces + i]; }
    std::uint32_t& age(std::size_t i) { return s.age[seat * maxPieces + i]; }

    void forget(std::size_t piece) {
        --count();
        for (std::size_t i = piece; i < count(); ++i) {
            body(i) = body(i + 1);
            age(i) = age(i + 1);
        }
        body(count()) = 0;
        age(count()) = 0;
    }
    void leave() {
        while (count() > 0) forget(count() - 1);
        s.player[seat] = s.rest[seat] = 0;
    }
};

/// A polygon around a circle of radius `half`, with 3 to 8 corners.
ShapeDef polygonOf(std::uint32_t corners, float half) {
    std::array<Vec2, maxPolygonVertices> points{};
    const float turn = 6.2831853f / static_cast<float>(corners);
    for (std::uint32_t i = 0; i < corners; ++i) {
        const Rotation q = rotationOf(turn * static_cast<float>(i));
        points[i] = {half * q.c, half * q.s};
    }
    return ShapeDef::polygon(std::span(points).first(corners));
}

/// Rolls the dice whether or not they are needed, so that each piece takes as many numbers.
BodyDef pieceOf(const Custom& wish, Game& game) {
    const float rolled = game.between(0.3f, 0.8f);
    const std::uint32_t corners = 3 + game.below(6);
    const Rotation turn = rotationOf(game.between(-3.0f, 3.0f));
    const float half = wish.number == 0 ? 0.5f * rolled : 0.005f * static_cast<float>(wish.number);
    BodyDef piece;
    piece.type = BodyType::Dynamic;
    piece.position = wish.vector;
    piece.rotation = turn;
    if (wish.kind == putBox) piece.shapes = {ShapeDef::box(half, half)};
    if (wish.kind == putDisc) piece.shapes = {ShapeDef::circle({}, half)};
    if (wish.kind == putPolygon) piece.shapes = {polygonOf(corners, half)};
    return piece;
}

Rejection put(BuildingState& s, Game& game, PlayerId player, const Custom& wish) {
    const std::optional<std::size_t> seat = seatOf(s.player, player);
    if (!seat || s.rest[*seat] != 0) return Rejection::AgainstRules;
    const bool sized = wish.number >= leastSize && wish.number <= mostSize;
    if (wish.number != 0 && !sized) return Rejection::BadDefinition;
    const PlayerRecord* const record = game.player(player);
    if (record == nullptr) return Rejection::AgainstRules;  // it left in this tick
    if (const BodyMotion* const own = game.motionOf(record->body)) {
        if (!(length(wish.vector - own->position) <= buildReach)) return Rejection::TooFar;
    }
    Builder builder{s, *seat};
    const RulesOutcome spawned = game.act(Spawn{{pieceOf(wish, game)}, {}}, player);
    if (!spawned.done()) return spawned.reason;
    if (builder.count() >= s.budget) {
        game.act(RemoveBody{builder.body(0)});
        builder.forget(0);
    }
    builder.body(builder.count()++) = spawned.firstBody;
    s.rest[*seat] = s.pauseTicks;
    ++s.placed;
    return Rejection::None;
}

}  // namespace

Status Building::begin(BuildingState& s, RulesParameters& parameters, const Seen& seen) const {
    s.budget = parameters.takeWhole("budget", 12, 1, maxPieces);
    s.pauseTicks = seen.ticksOf(parameters.take("pause", 0.25f, 0.0f, 60.0f));
    const float life = parameters.take("life", 0.0f, 0.0f, 3600.0f);
    s.lifeTicks = life > 0.0f ? seen.ticksOf(life) : 0;
    return Done{};
}

Rejection Building::onCommand(BuildingState& s, Game& game, const Command& command) const {
    if (std::holds_alternative<Spawn>(command.action)) return Rejection::AgainstRules;
    const auto* const wish = std::get_if<Custom>(&command.action);
    if (wish == nullptr) return Rejection::None;
    if (wish->kind < putBox || wish->kind > putPolygon) return Rejection::UnknownAction;
    return put(s, game, command.author, *wish);
}

void Building::beforeStep(BuildingState& s, Game& game) const {
    for (std::size_t seat = 0; seat < builders; ++seat) {
        Builder builder{s, seat};
        if (s.player[seat] != 0 && game.player(s.player[seat]) == nullptr) builder.leave();
        s.rest[seat] -= s.rest[seat] > 0;
        for (std::size_t i = 0; i < builder.count();) {
            const bool there = game.find(builder.body(i)).has_value();
            const bool old = s.lifeTicks != 0 && ++builder.age(i) >= s.lifeTicks;
            if (there && old) game.act(RemoveBody{builder.body(i)});
            if (there && !old) {
                ++i;
            } else {
                builder.forget(i);
            }
        }
    }
    for (const PlayerRecord& record : game.players()) {
        if (record.id == 0 || seatOf(s.player, record.id)) continue;
        const auto free = std::find(s.player.begin(), s.player.end(), 0u);
        if (free == s.player.end()) return;  // full: it may push what others build
        *free = record.id;
    }
}

std::string Building::faultOf(const BuildingState& s) const {
    if (s.budget < 1 || s.budget > maxPieces) return "budget: out of range";
    for (const std::uint32_t count : s.pieces) {
        if (count > s.budget) return "pieces: more than the budget";
    }
    return {};
}

std::string Building::score(const BuildingState& s, const Seen&) const {
    std::uint32_t there = 0;
    for (const std::uint32_t count : s.pieces) there += count;
    return std::to_string(there) + " pieces of " + std::to_string(s.placed) + " placed";
}

}  // namespace huestep::games
