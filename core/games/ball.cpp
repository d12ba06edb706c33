#include "core/games/ball.h"

#include <algorithm>
#include <optional>

#include "core/games/seats.h"

namespace huestep::games {

namespace {

constexpr float ballRadius = 0.35f;   // m
constexpr float kickReach = 0.4f;     // m, between the player's rim and the ball's
constexpr float kickSpeed = 14.0f;    // m/s that the hardest kick gives the ball
constexpr float restSeconds = 0.4f;   // between two kicks of a player
constexpr float overSeconds = 10.0f;  // from the end of a game to the next
constexpr float maxSeconds = 3600.0f;

Pose pitchOf(const BallState& s, const Seen& seen) {
    const BodyMotion* const pitch = seen.motionOf(s.pitch);
    return pitch == nullptr ? Pose{} : pitch->pose();
}

bool inPlay(const BallState& s) {
    return s.phase == static_cast<std::uint32_t>(BallPhase::Play);
}

void enter(BallState& s, BallPhase phase, std::uint32_t ticks) {
    s.phase = static_cast<std::uint32_t>(phase);
    s.phaseLeft = ticks;
}

/// The farthest that a round body reaches, m; 0 for none.
float radiusOf(const Seen& seen, BodyId body) {
    float radius = 0.0f;
    for (const ShapeInfo& shape : seen.shapesOf(body)) radius = std::max(radius, shape.radius);
    return radius;
}

/// Its place in the own half, spread over the width by seat, in the frame of the pitch.
Vec2 placeOf(const BallState& s, std::size_t seat, Game& game) {
    const float side = s.team[seat] == 0 ? -1.0f : 1.0f;
    std::uint32_t before = 0;  // of the team
    for (std::size_t i = 0; i < seat; ++i) before += s.player[i] != 0 && s.team[i] == s.team[seat];
    const float row = static_cast<float>(before % 4);
    const float file = static_cast<float>(before / 4 % 4);
    const Vec2 aside{game.between(-0.2f, 0.2f), game.between(-0.2f, 0.2f)};
    return Vec2{side * s.halfLength * (0.3f + 0.15f * file),
                2.0f * s.halfGoal * (row - 1.5f) / 1.5f} +
           aside;
}

void putOnSpot(BallState& s, std::size_t seat, Game& game) {
    game.respawn(s.player[seat], transform(pitchOf(s, game), placeOf(s, seat, game)));
}

void lookWhoIsThere(BallState& s, Game& game) {
    for (std::size_t i = 0; i < ballSeats; ++i) {
        if (s.player[i] == 0 || game.player(s.player[i]) != nullptr) continue;
        s.player[i] = s.team[i] = s.pushed[i] = s.rest[i] = s.scored[i] = 0;
    }
    for (const PlayerRecord& record : game.players()) {
        if (record.id == 0 || seatOf(s.player, record.id)) continue;
        const auto free = std::find(s.player.begin(), s.player.end(), 0u);
        if (free == s.player.end()) return;  // full: it may look on
        std::array<std::uint32_t, 2> strength{};
        for (std::size_t i = 0; i < ballSeats; ++i) strength[s.team[i]] += s.player[i] != 0;
        const auto seat = static_cast<std::size_t>(free - s.player.begin());
        s.player[seat] = record.id;
        s.team[seat] = strength[1] < strength[0] ? 1 : 0;
        putOnSpot(s, seat, game);
    }
}

/// Everyone to their places, the ball to its own.
void kickOff(BallState& s, Game& game) {
    if (game.find(s.ball)) game.act(RemoveBody{s.ball});
    BodyDef ball;
    ball.type = BodyType::Dynamic;
    ball.maySleep = false;
    ball.linearDamping = 0.6f;
    ball.angularDamping = 0.6f;
    // Aside by a hair that nobody knows beforehand: two bots that run alike do not meet for ever.
    const Vec2 spot{game.between(-0.05f, 0.05f), game.between(-0.5f, 0.5f)};
    ball.position = transform(pitchOf(s, game), spot);
    ball.shapes = {ShapeDef::circle({}, ballRadius)};
    ball.shapes[0].density = 1.0f;
    ball.shapes[0].material.restitution = 0.7f;
    ball.shapes[0].material.friction = 0.2f;
    s.ball = game.act(Spawn{{ball}, {}}).firstBody;
    s.lastTouch = 0;
    s.kickOff = 0;
    for (std::size_t i = 0; i < ballSeats; ++i) {
        if (s.player[i] != 0) putOnSpot(s, i, game);
    }
}

void beginGame(BallState& s) {
    ++s.games;
    s.goals = {};
    s.scored = {};
    s.ticksLeft = s.playTicks;
    s.kickOff = 1;
    enter(s, BallPhase::Pause, s.pauseTicks);
}

Rejection kickBall(BallState& s, Game& game, std::size_t seat, Vec2 direction) {
    const PlayerRecord* const player = game.player(s.player[seat]);
    const BodyMotion* const own = game.motionOf(player->body);
    const BodyMotion* const ball = game.motionOf(s.ball);
    if (own == nullptr || ball == nullptr) return Rejection::UnknownBody;
    if (s.rest[seat] != 0) return Rejection::AgainstRules;
    const float reach = radiusOf(game, player->body) + ballRadius + kickReach;
    if (!(length(ball->position - own->position) <= reach)) return Rejection::TooFar;
    const float hard = length(direction);
    if (!(hard > 0.0f)) return Rejection::NotFinite;
    const float speed = kickSpeed * (hard < 1.0f ? hard : 1.0f);
    const Vec2 impulse = (game.massOf(s.ball) * speed / hard) * direction;
    const RulesOutcome done = game.act(ApplyImpulse{s.ball, impulse, ball->position});
    if (done.done()) {
        s.rest[seat] = game.ticksOf(restSeconds);
        s.lastTouch = s.player[seat];
    }
    return done.reason;
}

}  // namespace

Status Ball::begin(BallState& s, RulesParameters& parameters, const Seen& seen) const {
    s.pitch = parameters.takeWhole("pitch", 1, 1, 1'000'000);
    s.halfLength = 0.5f * parameters.take("length", 30.0f, 4.0f, 1000.0f);
    s.halfGoal = 0.5f * parameters.take("goal", 5.0f, 1.0f, 100.0f);
    s.goalsToWin = parameters.takeWhole("goals", 5, 1, 1000);
    s.playTicks = seen.ticksOf(parameters.take("seconds", 180.0f, 1.0f, maxSeconds));
    s.pauseTicks = seen.ticksOf(parameters.take("pause", 1.5f, 0.0f, 60.0f));
    const auto pitch = seen.find(s.pitch);
    if (!pitch || seen.bodies()[*pitch].dynamic()) {
        return Error{"parameter pitch: no body of the scene that stands still has the id " +
                     std::to_string(s.pitch)};
    }
    beginGame(s);
    return Done{};
}

Rejection Ball::onCommand(BallState& s, Game& game, const Command& command) const {
    const std::optional<std::size_t> seat = seatOf(s.player, command.author);
    const auto* const custom = std::get_if<Custom>(&command.action);
    if (custom != nullptr && custom->kind != kick) return Rejection::UnknownAction;
    const auto* const push = std::get_if<ApplyImpulse>(&command.action);
    if (!seat || !inPlay(s) || (custom == nullptr && push == nullptr)) {
        return Rejection::AgainstRules;
    }
    if (custom != nullptr) return kickBall(s, game, *seat, custom->vector);
    const PlayerRecord* const player = game.player(command.author);
    if (push->body != player->body || s.pushed[*seat] != 0) return Rejection::AgainstRules;
    s.pushed[*seat] = 1;
    return Rejection::None;
}

void Ball::beforeStep(BallState& s, Game& game) const {
    lookWhoIsThere(s, game);
    s.pushed = {};
    for (std::uint32_t& rest : s.rest) rest -= rest > 0;
    if (s.kickOff != 0 || !game.find(s.ball)) kickOff(s, game);
    if (inPlay(s) || --s.phaseLeft > 0) return;
    if (s.phase == static_cast<std::uint32_t>(BallPhase::Over)) return beginGame(s);
    enter(s, BallPhase::Play, 0);
}

void Ball::afterStep(BallState& s, const Seen& seen) const {
    for (const ContactChange& touch : seen.events().begins) {
        const BodyId a = seen.bodyOf(touch.shapeA);
        const BodyId b = seen.bodyOf(touch.shapeB);
        if (a != s.ball && b != s.ball) continue;
        const BodyId other = a == s.ball ? b : a;
        for (const PlayerRecord& player : seen.players()) {
            if (player.body == other && seatOf(s.player, player.id)) s.lastTouch = player.id;
        }
    }
    if (!inPlay(s)) return;
    --s.ticksLeft;
    if (const BodyMotion* const ball = seen.motionOf(s.ball)) {
        const Vec2 at = untransform(pitchOf(s, seen), ball->position);
        const bool between = at.y > -s.halfGoal && at.y < s.halfGoal;
        if (between && (at.x > s.halfLength || at.x < -s.halfLength)) {
            const std::uint32_t team = at.x > 0.0f ? 0 : 1;  // the one that plays towards there
            ++s.goals[team];
            const auto seat = seatOf(s.player, s.lastTouch);
            if (seat && s.team[*seat] == team) ++s.scored[*seat];
            s.kickOff = 1;
            enter(s, BallPhase::Pause, s.pauseTicks);
        }
    }
    if (s.ticksLeft == 0 || *std::max_element(s.goals.begin(), s.goals.end()) >= s.goalsToWin) {
        enter(s, BallPhase::Over, seen.ticksOf(overSeconds));
    }
}

std::string Ball::faultOf(const BallState& s) const {
    if (s.phase > static_cast<std::uint32_t>(BallPhase::Over)) return "phase: there is none such";
    if (!inPlay(s) && s.phaseLeft == 0) return "phaseLeft: 0 in a phase that ends";
    if (inPlay(s) && s.ticksLeft == 0) return "ticksLeft: 0 in play";
    for (const std::uint32_t team : s.team) {
        if (team > 1) return "team: there are two";
    }
    return {};
}

std::string Ball::score(const BallState& s, const Seen& seen) const {
    const auto seconds =
        static_cast<std::uint32_t>(static_cast<float>(s.ticksLeft) * seen.stepSeconds());
    std::string line =
        "red " + std::to_string(s.goals[0]) + " : " + std::to_string(s.goals[1]) + " blue, ";
    if (s.phase == static_cast<std::uint32_t>(BallPhase::Over)) return line + "over";
    return line + std::to_string(seconds) + " s left";
}

}  // namespace huestep::games
