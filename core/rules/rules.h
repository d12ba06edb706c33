/// The rules of a game: a session's own logic, as deterministic code that every replica runs.
///
/// Rules are a value without state: what they remember is plain bytes of the world, hashed,
/// snapshotted and restored with it. A step is
///
///     commands, each first seen by `onCommand`  →  `beforeStep`  →  physics  →  `afterStep`
///
/// Before the step rules look and act (`Game`); after it they look and count (`Seen`): what they
/// want done then, they remember and do in the next tick.
///
/// The laws of the core are theirs: no clock, no file, no global, no `rand`, no libm trigonometry
/// (core/math/trig.h has it), no order of a hash table or of addresses; floats by + − × / and
/// `sqrt`, built with the project's flags. Docs: docs/write_a_game.md. Thread rule: any number of
/// worlds may share rules, each stepping in its own thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/result.h"
#include "core/rules/game.h"
#include "core/state/records.h"
#include "core/state/state.h"

namespace huestep {

/// What rules are started with: the scene's numbers, or the rules' own where it names none.
class RulesParameters {
 public:
    explicit RulesParameters(std::span<const RulesParameter> given) : m_given(given) {}

    /// The value; `standard` if the scene does not say. One outside of [low, high] is remembered
    /// as wrong, and so is one of the scene's that nobody asks for.
    float take(std::string_view name, float standard, float low, float high);
    /// The same for whole numbers.
    std::uint32_t takeWhole(std::string_view name, std::uint32_t standard, std::uint32_t low,
                            std::uint32_t high);
    /// Whether all was well; else the first thing wrong, by name.
    [[nodiscard]] Status verdict() const;

 private:
    std::span<const RulesParameter> m_given;
    std::vector<std::string_view> m_known;
    std::string m_problem;
};

/// The form in which a world has rules; games are written as `RulesOver`.
class Rules {
 public:
    Rules() = default;
    Rules(const Rules&) = delete;
    Rules& operator=(const Rules&) = delete;
    virtual ~Rules() = default;

    [[nodiscard]] virtual std::string_view name() const = 0;  ///< 1 to 32 of [a-z0-9_-]
    /// Rises with every change by which a game could go on otherwise than before.
    [[nodiscard]] virtual std::uint32_t version() const = 0;
    [[nodiscard]] virtual std::span<const Field> fields() const = 0;  ///< tile the state
    [[nodiscard]] virtual std::size_t stateBytes() const = 0;  ///< of 4, at most `maxRulesBytes`

    // The state is `stateBytes()` bytes.
    virtual Status beginBytes(std::span<std::byte> state, RulesParameters& parameters,
                              const Seen& seen) const = 0;
    virtual Rejection commandBytes(std::span<std::byte> state, Game& game,
                                   const Command& command) const = 0;
    virtual void beforeBytes(std::span<std::byte> state, Game& game) const = 0;
    virtual void afterBytes(std::span<std::byte> state, const Seen& seen) const = 0;
    [[nodiscard]] virtual std::string faultOfBytes(std::span<const std::byte> state) const = 0;
    [[nodiscard]] virtual std::string scoreOfBytes(std::span<const std::byte> state,
                                                   const Seen& seen) const = 0;
};

/// A member of a state, or an array of `count`.
struct Member {
    const char* name;
    FieldType type;
    std::uint32_t count = 1;
};

/// The fields of a state whose members are these, in order and without padding.
template <std::size_t n>
constexpr std::array<Field, n> inOrder(const Member (&members)[n]) {
    std::array<Field, n> fields{};
    std::uint32_t offset = 0;
    for (std::size_t i = 0; i < n; ++i) {
        fields[i] = {members[i].name, members[i].type, offset, members[i].count};
        offset += members[i].count * sizeOf(members[i].type);
    }
    return fields;
}

/// The bytes of a state as what they are.
template <class State>
State rulesStateOf(std::span<const std::byte> bytes) {
    State state{};
    std::memcpy(&state, bytes.data(), std::min(sizeof state, bytes.size()));
    return state;
}

/// Rules over a state of one plain type, whose fields `fieldsOf<State>` lists as those of any
/// record (core/state/records.h): no padding, no pointer, whole words of 4 bytes. Floats of it that
/// are not finite become 0 after each step, since what a NaN looks like differs by machine.
template <class State>
class RulesOver : public Rules {
 public:
    /// Fills a state of zeros for a new world. A failure is a sentence on the parameters or the
    /// scene; whether a parameter is unknown or out of range is looked after.
    virtual Status begin(State& state, RulesParameters& parameters, const Seen& seen) const = 0;

    /// Every player's command before the world judges it, its numbers finite; and every `Custom`
    /// command, the host's too, which only rules understand. What is not `Rejection::None` refuses
    /// it. The standard answer lets through what the world itself allows.
    virtual Rejection onCommand(State&, Game&, const Command& command) const {
        const bool custom = std::holds_alternative<Custom>(command.action);
        return custom ? Rejection::UnknownAction : Rejection::None;
    }
    /// After all commands of the tick, before its physics.
    virtual void beforeStep(State&, Game&) const {}
    /// After its physics; `seen.events()` has the contacts that began and ended.
    virtual void afterStep(State&, const Seen&) const {}

    /// What no game of these rules could have come to, or nothing: a snapshot comes from outside.
    /// Whatever a count or a place in an array is, must be judged here.
    [[nodiscard]] virtual std::string faultOf(const State&) const { return {}; }
    /// How the game stands, in a line for people.
    [[nodiscard]] virtual std::string score(const State&, const Seen&) const { return {}; }

 private:
    static_assert(fieldsTile<State>(), "fieldsOf<State> must name every byte of the state");
    static_assert(sizeof(State) % sizeof(RulesWord) == 0 && sizeof(State) <= maxRulesBytes);

    std::span<const Field> fields() const final { return fieldsOf<State>; }
    std::size_t stateBytes() const final { return sizeof(State); }

    /// Lets `f` work on the state as what it is. On the heap, since it may be as large as a stack.
    template <class F>
    static auto edited(std::span<std::byte> bytes, F&& f) {
        const auto state = std::make_unique<State>();
        std::memcpy(state.get(), bytes.data(), sizeof(State));
        if constexpr (std::is_void_v<decltype(f(*state))>) {
            f(*state);
            std::memcpy(bytes.data(), state.get(), sizeof(State));
        } else {
            auto result = f(*state);
            std::memcpy(bytes.data(), state.get(), sizeof(State));
            return result;
        }
    }
    Status beginBytes(std::span<std::byte> bytes, RulesParameters& parameters,
                      const Seen& seen) const final {
        return edited(bytes, [&](State& state) { return begin(state, parameters, seen); });
    }
    Rejection commandBytes(std::span<std::byte> bytes, Game& game,
                           const Command& command) const final {
        return edited(bytes, [&](State& state) { return onCommand(state, game, command); });
    }
    void beforeBytes(std::span<std::byte> bytes, Game& game) const final {
        edited(bytes, [&](State& state) { beforeStep(state, game); });
    }
    void afterBytes(std::span<std::byte> bytes, const Seen& seen) const final {
        edited(bytes, [&](State& state) { afterStep(state, seen); });
    }
    std::string faultOfBytes(std::span<const std::byte> bytes) const final {
        return faultOf(rulesStateOf<State>(bytes));
    }
    std::string scoreOfBytes(std::span<const std::byte> bytes, const Seen& seen) const final {
        return score(rulesStateOf<State>(bytes), seen);
    }
};

/// The rules of that name and version among those known, or a sentence that says what there is.
Result<const Rules*> findRules(RulesSet known, std::string_view name, std::uint32_t version);

}  // namespace huestep
