/// Players of the games in core/games, as functions of the world alone.
#pragma once

#include <algorithm>
#include <vector>

#include "core/games/ball.h"
#include "core/games/building.h"

namespace huestep::test {

/// Says something for each player, with a sequence that rises.
class Voices {
 public:
    explicit Voices(const World& world) : m_world(world), m_sequence(100 * (world.tick() + 1)) {}
    void say(PlayerId author, Action action) {
        commands.push_back({author, ++m_sequence, std::move(action)});
    }
    [[nodiscard]] Vec2 placeOf(BodyId body) const {
        const auto place = m_world.find(body);
        return place ? m_world.motions()[*place].position : Vec2{};
    }
    std::vector<Command> commands;

 private:
    const World& m_world;
    std::uint64_t m_sequence;
};

/// Five who run to the ball and kick it to the other side; one leaves, another comes. Some of what
/// they do is against the rules.
inline std::vector<Command> ballScript(const World& world) {
    const std::uint64_t tick = world.tick();
    Voices voices(world);
    const auto state = rulesStateOf<games::BallState>(world.rulesState());
    if (tick == 2) {
        for (PlayerId player = 1; player <= 5; ++player) voices.say(0, AddPlayer{player});
    }
    if (tick == 200) voices.say(0, RemovePlayer{2});
    if (tick == 230) voices.say(0, AddPlayer{8});
    for (const PlayerRecord& player : world.players()) {
        if (player.id == 0) continue;
        const auto seat = static_cast<std::size_t>(
            std::find(state.player.begin(), state.player.end(), player.id) - state.player.begin());
        if (seat == games::ballSeats) continue;
        const float side = state.team[seat] == 0 ? 1.0f : -1.0f;
        const Vec2 own = voices.placeOf(player.body);
        const Vec2 way = voices.placeOf(state.ball) - own;
        const float far = length(way);
        const Vec2 to = way - Vec2{0.9f * side, 0.0f};  // behind it
        // One team is the faster, or nobody ever shoots a goal.
        if (length(to) > 0.0f && (tick + player.id) % 3 >= state.team[seat] + 1) {
            const Vec2 push = (1.5f / length(to)) * to;
            voices.say(player.id, ApplyImpulse{player.body, push, own});
            if (tick % 20 == 7) voices.say(player.id, ApplyImpulse{player.body, push, own});
        }
        if (far < 1.3f && way.x * side > 0.0f)
            voices.say(player.id, Custom{games::kick, 0, 0, {side, 0.1f * way.y}});
        if ((tick + player.id) % 50 == 0) voices.say(player.id, Custom{games::kick, 0, 0, way});
        if ((tick + player.id) % 90 == 0) voices.say(player.id, RemoveBody{state.ball});
    }
    return voices.commands;
}

/// Three who build and push; one leaves.
inline std::vector<Command> buildingScript(const World& world) {
    const std::uint64_t tick = world.tick();
    Voices voices(world);
    if (tick == 1) {
        for (PlayerId player = 1; player <= 3; ++player) voices.say(0, AddPlayer{player});
    }
    if (tick == 300) voices.say(0, RemovePlayer{2});
    for (const PlayerRecord& player : world.players()) {
        if (player.id == 0) continue;
        const std::uint64_t now = tick + 7 * player.id;
        const Vec2 own = voices.placeOf(player.body);
        const float side = now / 30 % 2 == 0 ? 1.0f : -1.0f;
        if (now % 8 == 0) {
            const auto kind = static_cast<std::uint32_t>(1 + now / 8 % 4);  // one there is not
            const std::int32_t size = now % 24 == 0 ? 0 : 40;
            voices.say(player.id, Custom{kind, 0, size, own + Vec2{2.0f * side, 1.5f}});
        }
        if (now % 25 == 0) voices.say(player.id, ApplyImpulse{player.body, {8 * side, 6}, own});
        if (now % 70 == 0) voices.say(player.id, Spawn{});
    }
    return voices.commands;
}

}  // namespace huestep::test
