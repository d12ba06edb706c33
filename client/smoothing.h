/// What a renderer adds to the poses of a predicted world so that corrections are not seen to jump.
///
/// When ticks are stepped again because a guess was wrong, bodies are elsewhere at the same tick
/// than they were shown. The difference is kept here, a body each, and decays to nothing; whoever
/// draws adds it to the pose. It is made from worlds and never reaches one: nothing of it is state.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/world/world.h"

namespace huestep::client {

struct SmoothingRules {
    float seconds = 0.1f;       ///< s, in which an error falls to 1/e of it, > 0
    float leastMetres = 1e-3f;  ///< a smaller error, with a turn of less than 1 mrad, is gone
    /// A larger error is shown at once, as is a turn by more than a quarter: hiding it would show
    /// the body where it surely is not.
    float mostMetres = 2.0f;
};

/// How far a body is shown from where the world has it.
struct ShownError {
    BodyId body = 0;
    Vec2 offset;    ///< m, to add to the position of the centre of mass
    Rotation turn;  ///< to compose with the rotation
};

class Smoothing {
 public:
    explicit Smoothing(const SmoothingRules& rules) : m_rules(rules) {}

    /// The world as it is shown, before it goes back. Until `corrected`, a second call is the same
    /// going back once more, and is let go.
    void shown(const World& world);
    /// Whether the world of this tick is to be told to `corrected`.
    [[nodiscard]] bool awaits(std::uint64_t tick) const { return m_waiting && tick == m_tick; }
    /// The world at the same tick, stepped again. Returns the largest error of the guess: m. Ids of
    /// bodies that were spawned in the meantime may now be of others; an owner shows that.
    float corrected(const World& world);
    /// The tick will not come again, or not of this session: nothing of before is of use.
    void forget();

    /// Lets time pass: s, ≥ 0.
    void decay(float seconds);

    /// By body; empty when nothing is left to hide.
    [[nodiscard]] std::span<const ShownError> errors() const { return m_errors; }
    /// Where to draw a body that the world has at this pose (of its centre of mass).
    [[nodiscard]] Pose posed(BodyId body, const Pose& pose) const;

 private:
    struct Place {
        BodyId body;
        PlayerId owner;
        Pose pose;
    };
    [[nodiscard]] bool worthHiding(const ShownError& error) const;

    SmoothingRules m_rules;
    std::vector<ShownError> m_errors;  ///< by body
    std::vector<Place> m_places;       ///< as shown at `m_tick`, by body
    std::uint64_t m_tick = 0;
    bool m_waiting = false;
};

}  // namespace huestep::client
