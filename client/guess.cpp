#include "client/guess.h"

#include <optional>
#include <utility>

#include "client/centre.h"

namespace huestep::client {

namespace {

/// The same push at where its body is now; none: it was none, or the body is gone.
std::optional<Action> again(const World& world, const Action& action) {
    if (const auto* impulse = std::get_if<ApplyImpulse>(&action)) {
        const std::optional<Vec2> at = centreOf(world, impulse->body);
        if (at) return ApplyImpulse{impulse->body, impulse->impulse, *at};
    } else if (const auto* force = std::get_if<ApplyForce>(&action)) {
        const std::optional<Vec2> at = centreOf(world, force->body);
        if (at) return ApplyForce{force->body, force->force, *at};
    }
    return std::nullopt;
}

std::uint64_t lastSequence(const World& world, PlayerId author) {
    for (const PlayerRecord& player : world.players()) {
        if (player.id == author) return player.lastSequence;
    }
    return 0;
}

}  // namespace

Guess pushesGoOn(std::uint32_t ticks) {
    return [ticks](const GuessInput& in) {
        std::vector<Command> out;
        if (in.age >= ticks) return out;
        PlayerId author = 0;
        std::uint64_t sequence = 0;
        for (const Command& command : in.last) {  // in key order: authors come together
            if (command.author == in.self) continue;
            std::optional<Action> action = again(in.world, command.action);
            if (!action) continue;
            if (out.empty() || command.author != author) {
                author = command.author;
                sequence = lastSequence(in.world, author);
            }
            out.push_back({author, ++sequence, std::move(*action)});
        }
        return out;
    };
}

}  // namespace huestep::client
