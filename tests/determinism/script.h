/// Four players who do everything that players may do, as a function of the world alone.
#pragma once

#include <vector>

#include "core/world/world.h"

namespace huestep::test {

/// The next tick's commands. Some are rejected on purpose: rejections are part of a run.
inline std::vector<Command> playersScript(const World& world) {
    const std::uint64_t tick = world.tick();
    std::vector<Command> commands;
    std::uint64_t sequence = 100 * (tick + 1);
    const auto say = [&](PlayerId author, Action action) {
        commands.push_back({author, ++sequence, std::move(action)});
    };
    if (tick == 3) {
        for (PlayerId player = 1; player <= 4; ++player) say(0, AddPlayer{player});
    }
    if (tick == 150) say(0, RemovePlayer{2});
    if (tick == 180) say(0, AddPlayer{7});
    for (const PlayerRecord& player : world.players()) {
        if (player.id == 0) continue;
        const std::uint64_t now = tick + 11 * player.id;
        const auto own = world.find(player.body);
        const Vec2 place = own ? world.motions()[*own].position : Vec2{};
        const float side = (tick / 20 + player.id) % 2 == 0 ? 1.0f : -1.0f;
        if (now % 20 == 0) say(player.id, ApplyImpulse{player.body, {6.0f * side, 9.0f}, place});
        if (now % 3 == 0) say(player.id, ApplyForce{player.body, {30.0f * side, 0.0f}, place});
        if (now % 60 == 10) {
            BodyDef thrown;
            thrown.type = BodyType::Dynamic;
            thrown.position = place + Vec2{0.0f, 1.5f};
            thrown.velocity = {4.0f * side, 2.0f};
            thrown.shapes = {now % 120 == 10 ? ShapeDef::box(0.3f, 0.2f)
                                             : ShapeDef::capsule({-0.2f, 0}, {0.2f, 0}, 0.15f)};
            say(player.id, Spawn{{thrown, thrown}, {}});
        }
        const BodyId wanted = 20 + 5 * player.id;
        if (now % 80 == 20 && world.find(wanted)) {
            const Vec2 held = world.motions()[*world.find(wanted)].position;
            say(player.id, Grab{wanted, held, held + Vec2{0.0f, 3.0f}});
        }
        if (now % 80 > 25 && now % 5 == 0) say(player.id, MoveGrab{place + Vec2{side, 4.0f}});
        if (now % 80 == 75) say(player.id, Release{});
        if (now % 70 == 60) {
            for (const BodyInfo& body : world.bodies()) {
                if (body.owner != player.id || body.id == player.body) continue;
                say(player.id, RemoveBody{body.id});
                break;
            }
        }
        if (now % 50 == 0) say(player.id, RemoveBody{1});  // not its own: rejected
    }
    return commands;
}

}  // namespace huestep::test
