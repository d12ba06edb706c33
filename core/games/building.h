/// A sandbox: players put boxes, discs and polygons into the world, so many at a time and not too
/// fast. Who has as many as the budget allows loses the oldest for the next.
///
/// Beside that players may push, grab and remove as the world allows; its own `Spawn` goes through
/// these rules alone.
#pragma once

#include "core/rules/rules.h"

namespace huestep::games {

/// `Custom::kind` of what is put there: at `vector` (m), `number` cm large across, [20, 160]; 0:
/// the dice say.
inline constexpr std::uint32_t putBox = 1;
inline constexpr std::uint32_t putDisc = 2;
inline constexpr std::uint32_t putPolygon = 3;

inline constexpr std::size_t builders = 64;
inline constexpr std::size_t maxPieces = 32;  ///< a builder's at a time
inline constexpr float buildReach = 15.0f;    ///< m, from the builder's body, if it has one

struct BuildingState {
    std::uint32_t budget;                           ///< pieces a builder may have
    std::uint32_t pauseTicks;                       ///< from one piece of a builder to its next
    std::uint32_t lifeTicks;                        ///< a piece's; 0: for ever
    std::uint32_t placed;                           ///< pieces in all
    std::array<PlayerId, builders> player;          ///< 0: free
    std::array<std::uint32_t, builders> rest;       ///< ticks until the next piece
    std::array<std::uint32_t, builders> pieces;     ///< how many of its places below are taken
    std::array<BodyId, builders * maxPieces> body;  ///< a builder's in a row, oldest first
    std::array<std::uint32_t, builders * maxPieces> age;  ///< ticks
};

}  // namespace huestep::games

template <>
inline constexpr auto huestep::fieldsOf<huestep::games::BuildingState> = huestep::inOrder({
    {"budget", FieldType::U32},
    {"pauseTicks", FieldType::U32},
    {"lifeTicks", FieldType::U32},
    {"placed", FieldType::U32},
    {"player", FieldType::U32, games::builders},
    {"rest", FieldType::U32, games::builders},
    {"pieces", FieldType::U32, games::builders},
    {"body", FieldType::U32, games::builders* games::maxPieces},
    {"age", FieldType::U32, games::builders* games::maxPieces},
});

namespace huestep::games {

class Building final : public RulesOver<BuildingState> {
 public:
    [[nodiscard]] std::string_view name() const override { return "building"; }
    [[nodiscard]] std::uint32_t version() const override { return 1; }

    Status begin(BuildingState& s, RulesParameters& parameters, const Seen& seen) const override;
    Rejection onCommand(BuildingState& s, Game& game, const Command& command) const override;
    void beforeStep(BuildingState& s, Game& game) const override;
    [[nodiscard]] std::string faultOf(const BuildingState& s) const override;
    [[nodiscard]] std::string score(const BuildingState& s, const Seen& seen) const override;
};

}  // namespace huestep::games
