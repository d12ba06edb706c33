/// A ball game for two teams, from above: players push themselves about and kick what they are at.
///
/// The pitch is a body of the scene, whose frame is the game's: the goals' lines stand at x = ±
/// half the length, and a goal is as wide as the parameters say. The ball is the rules' own.
/// Whoever enters is put into the smaller team. A goal counts when the ball's centre is past a
/// line, in the goal's width; then all are put back to their halves and a pause goes by. After the
/// time, or at so many goals, the game is over; the next one begins by itself.
///
/// Players may do two things, each once a tick at most, while the ball is in play: an impulse at
/// their own body, of as much as the scene allows; and `Custom{kick}` while they are within reach
/// of the ball and have not kicked for a while.
#pragma once

#include "core/rules/rules.h"

namespace huestep::games {

/// `Custom::kind` of a kick; its vector is the direction, and how hard: 1 or longer is as hard as
/// it gets.
inline constexpr std::uint32_t kick = 1;

inline constexpr std::size_t ballSeats = 32;

enum class BallPhase : std::uint32_t {
    Pause,  ///< all stand until it is over, then the ball is in play
    Play,
    Over
};

struct BallState {
    // What the game was started with.
    BodyId pitch;
    float halfLength;  ///< m
    float halfGoal;    ///< m
    std::uint32_t goalsToWin;
    std::uint32_t playTicks;   ///< a game
    std::uint32_t pauseTicks;  ///< before each kick-off
    // How it stands.
    std::uint32_t phase;      ///< `BallPhase`
    std::uint32_t phaseLeft;  ///< ticks of a pause, or until the next game
    std::uint32_t ticksLeft;  ///< of play
    BodyId ball;              ///< 0 before the first kick-off
    std::uint32_t kickOff;    ///< 1: all are to be put on their spots
    PlayerId lastTouch;       ///< who touched the ball last, or 0
    std::uint32_t games;      ///< begun
    std::array<std::uint32_t, 2> goals;
    // Who plays; a seat without a player has zeros.
    std::array<PlayerId, ballSeats> player;  ///< 0: free
    std::array<std::uint32_t, ballSeats> team;
    std::array<std::uint32_t, ballSeats> pushed;  ///< 1: in this tick
    std::array<std::uint32_t, ballSeats> rest;    ///< ticks until the next kick
    std::array<std::uint32_t, ballSeats> scored;
};

}  // namespace huestep::games

template <>
inline constexpr auto huestep::fieldsOf<huestep::games::BallState> = huestep::inOrder({
    {"pitch", FieldType::U32},
    {"halfLength", FieldType::F32},
    {"halfGoal", FieldType::F32},
    {"goalsToWin", FieldType::U32},
    {"playTicks", FieldType::U32},
    {"pauseTicks", FieldType::U32},
    {"phase", FieldType::U32},
    {"phaseLeft", FieldType::U32},
    {"ticksLeft", FieldType::U32},
    {"ball", FieldType::U32},
    {"kickOff", FieldType::U32},
    {"lastTouch", FieldType::U32},
    {"games", FieldType::U32},
    {"goals", FieldType::U32, 2},
    {"player", FieldType::U32, games::ballSeats},
    {"team", FieldType::U32, games::ballSeats},
    {"pushed", FieldType::U32, games::ballSeats},
    {"rest", FieldType::U32, games::ballSeats},
    {"scored", FieldType::U32, games::ballSeats},
});

namespace huestep::games {

class Ball final : public RulesOver<BallState> {
 public:
    [[nodiscard]] std::string_view name() const override { return "ball"; }
    [[nodiscard]] std::uint32_t version() const override { return 1; }

    Status begin(BallState& s, RulesParameters& parameters, const Seen& seen) const override;
    Rejection onCommand(BallState& s, Game& game, const Command& command) const override;
    void beforeStep(BallState& s, Game& game) const override;
    void afterStep(BallState& s, const Seen& seen) const override;
    [[nodiscard]] std::string faultOf(const BallState& s) const override;
    [[nodiscard]] std::string score(const BallState& s, const Seen& seen) const override;
};

}  // namespace huestep::games
