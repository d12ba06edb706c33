/// A small game for tests: it counts what it is asked, rolls dice, and does what `Custom` says.
#pragma once

#include <limits>

#include "core/rules/rules.h"
#include "tests/core/support.h"

namespace huestep::test {

struct TallyState {
    std::uint32_t commands;
    std::uint32_t before;
    std::uint32_t after;
    std::uint32_t begins;  ///< contacts that began
    std::uint32_t most;    ///< a parameter, and what `commands` may come to
    std::uint32_t rolled;
    float reached;  ///< m, the highest body
    BodyId last;    ///< spawned
};

}  // namespace huestep::test

template <>
inline constexpr auto huestep::fieldsOf<huestep::test::TallyState> = huestep::inOrder({
    {"commands", FieldType::U32},
    {"before", FieldType::U32},
    {"after", FieldType::U32},
    {"begins", FieldType::U32},
    {"most", FieldType::U32},
    {"rolled", FieldType::U32},
    {"reached", FieldType::F32},
    {"last", FieldType::U32},
});

namespace huestep::test {

inline constexpr std::uint32_t tallyRoll = 1;     // the dice, `number` times
inline constexpr std::uint32_t tallySpawn = 2;    // a disc at `vector`, the author's
inline constexpr std::uint32_t tallyRespawn = 3;  // the author, at `vector`
inline constexpr std::uint32_t tallySpoil = 4;    // `reached` becomes a NaN
inline constexpr std::uint32_t tallyRemove = 5;   // the body `id`, with the author's rights

class Tally final : public RulesOver<TallyState> {
 public:
    [[nodiscard]] std::string_view name() const override { return "tally"; }
    [[nodiscard]] std::uint32_t version() const override { return 2; }

    Status begin(TallyState& s, RulesParameters& parameters, const Seen& seen) const override {
        s.most = parameters.takeWhole("most", 1000, 1, 100'000);
        if (seen.bodies().empty()) return Error{"a tally wants a body"};
        return Done{};
    }
    Rejection onCommand(TallyState& s, Game& game, const Command& command) const override {
        if (s.commands >= s.most) return Rejection::AgainstRules;
        ++s.commands;
        const auto* const custom = std::get_if<Custom>(&command.action);
        if (custom == nullptr) return Rejection::None;
        switch (custom->kind) {
            case tallyRoll:
                for (std::int32_t i = 0; i < custom->number; ++i) s.rolled = game.below(1000);
                return Rejection::None;
            case tallySpawn: {
                const RulesOutcome spawned =
                    game.act(Spawn{{discAt(custom->vector, 0.3f)}, {}}, command.author);
                if (spawned.done()) s.last = spawned.firstBody;
                return spawned.reason;
            }
            case tallyRespawn:
                return game.respawn(command.author, custom->vector).reason;
            case tallySpoil:
                s.reached = std::numeric_limits<float>::quiet_NaN();
                return Rejection::None;
            case tallyRemove:
                return game.act(RemoveBody{custom->id}, command.author).reason;
            default:
                return Rejection::UnknownAction;
        }
    }
    void beforeStep(TallyState& s, Game& game) const override {
        ++s.before;
        if (s.before % 10 == 0) s.rolled = game.below(1000);
    }
    void afterStep(TallyState& s, const Seen& seen) const override {
        ++s.after;
        s.begins += static_cast<std::uint32_t>(seen.events().begins.size());
        for (const BodyMotion& motion : seen.motions()) {
            if (motion.position.y > s.reached) s.reached = motion.position.y;
        }
    }
    [[nodiscard]] std::string faultOf(const TallyState& s) const override {
        return s.commands > s.most ? "commands: more than the most" : "";
    }
    [[nodiscard]] std::string score(const TallyState& s, const Seen&) const override {
        return std::to_string(s.commands) + " commands";
    }
};

inline RulesSet tallyAlone() {
    static const Tally tally;
    static const std::array<const Rules*, 1> all{&tally};
    return all;
}

/// A ground, two boxes that fall on it; players have bodies.
inline Scene tallyScene() {
    Scene scene = sceneOf({ground(), boxAt({0.0f, 2.0f}), boxAt({3.0f, 4.0f})});
    PlayerDef players;
    players.body = discAt({}, 0.4f);
    players.spawnPoints = {{-10.0f, 5.0f}};
    players.maxSpawned = 3;
    scene.players = players;
    scene.rules = {.name = "tally", .version = 2, .seed = 77, .parameters = {}};
    return scene;
}

inline World tallyWorld(const Scene& scene = tallyScene()) {
    Result<World> world = World::create(scene, tallyAlone());
    if (!world.ok()) {
        ADD_FAILURE() << world.error().message;
        std::abort();
    }
    return std::move(world).value();
}

inline TallyState tallyOf(const World& world) {
    return rulesStateOf<TallyState>(world.rulesState());
}

/// Something to do in most ticks: as a function of the world alone.
inline std::vector<Command> tallyCommands(const World& world) {
    const std::uint64_t tick = world.tick();
    const std::uint64_t sequence = 10 * (tick + 1);
    if (tick == 0) return {{0, sequence, AddPlayer{1}}};
    const auto spot = static_cast<float>(tick % 7);
    switch (tick % 5) {
        case 0:
            return {{1, sequence, Custom{tallyRoll, 0, 3, {}}}};
        case 1:
            return {{1, sequence, Custom{tallySpawn, 0, 0, {spot, 6.0f}}}};
        case 2:
            return {{1, sequence, Custom{tallyRemove, tallyOf(world).last, 0, {}}}};
        case 3:
            return {{1, sequence, Custom{tallyRespawn, 0, 0, {-spot, 3.0f}}},
                    {1, sequence + 1, Custom{99, 0, 0, {}}}};
        default:
            return {};
    }
}

}  // namespace huestep::test
