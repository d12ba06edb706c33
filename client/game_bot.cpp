// Bots that play the games of core/games: what they see is the world and the state of its rules.

#include <algorithm>
#include <optional>
#include <utility>

#include "client/bot.h"
#include "client/centre.h"
#include "client/dice.h"
#include "core/games/ball.h"
#include "core/games/building.h"

namespace huestep::client {

namespace {

class GameBot : public Bot {
 public:
    explicit GameBot(std::uint64_t seed) : m_dice(seed), m_wander(makeWanderBot(seed)) {}

    std::vector<Action> act(const Situation& now) override {
        const Rules* const rules = now.world.rules();
        if (rules == nullptr) return m_wander->act(now);
        if (rules->name() == "ball") return playBall(now);
        if (rules->name() == "building") return build(now);
        return m_wander->act(now);
    }

 private:
    /// Runs to where it has the ball before it and the other goal behind that, and kicks.
    std::vector<Action> playBall(const Situation& now) {
        std::vector<Action> out;
        const auto state = rulesStateOf<games::BallState>(now.world.rulesState());
        const auto seat = std::find(state.player.begin(), state.player.end(), now.player);
        const std::optional<Vec2> own = centreOf(now.world, now.body);
        const std::optional<Vec2> ball = centreOf(now.world, state.ball);
        const std::optional<std::uint32_t> pitch = now.world.find(state.pitch);
        const bool inPlay = state.phase == static_cast<std::uint32_t>(games::BallPhase::Play);
        if (seat == state.player.end() || !own || !ball || !pitch || !inPlay) return out;
        const auto place = static_cast<std::size_t>(seat - state.player.begin());
        const float side = state.team[place] == 0 ? 1.0f : -1.0f;
        const Vec2 goal =
            transform(now.world.motions()[*pitch].pose(), Vec2{side * state.halfLength, 0.0f});
        const Vec2 aim = normalized(goal - *ball);
        const Vec2 to = *ball - 0.9f * aim - *own;
        // Not every tick: a person would not either, and those who run alike would stick together.
        if (!m_dice.once(4)) {
            const float mass = now.world.bodies()[*now.world.find(now.body)].mass;
            const Vec2 push = (0.4f * mass) * normalized(to);
            out.push_back(ApplyImpulse{now.body, push, *own});
        }
        const bool near = length(*ball - *own) < 1.3f;
        const bool behind = dot(*ball - *own, aim) > 0.0f;
        if (near && behind && state.rest[place] == 0) {
            const Vec2 aside{m_dice.between(-0.2f, 0.2f), m_dice.between(-0.2f, 0.2f)};
            out.push_back(Custom{games::kick, 0, 0, aim + aside});
        }
        return out;
    }

    /// Moves about like any player, and puts a piece there now and then.
    std::vector<Action> build(const Situation& now) {
        std::vector<Action> out = m_wander->act(now);
        std::erase_if(out, [](const Action& a) { return std::holds_alternative<Spawn>(a); });
        const std::optional<Vec2> own = centreOf(now.world, now.body);
        if (!own || !m_dice.once(40)) return out;
        Custom piece;
        piece.kind = static_cast<std::uint32_t>(games::putBox + m_dice.roll() % 3);
        piece.vector = *own + Vec2{m_dice.between(-3.0f, 3.0f), m_dice.between(1.0f, 3.0f)};
        out.push_back(piece);
        return out;
    }

    Dice m_dice;
    std::unique_ptr<Bot> m_wander;
};

}  // namespace

std::unique_ptr<Bot> makeGameBot(std::uint64_t seed) {
    return std::make_unique<GameBot>(seed);
}

}  // namespace huestep::client
