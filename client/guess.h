/// What others are expected to do in ticks that no frame has shown yet.
///
/// A guess is right for nothing and wrong for nothing but time: a tick whose frame has other
/// commands is stepped again. What players hold goes on without a guess, for grabs and motors are
/// state; so with none, others go on as they are.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/world/world.h"

namespace huestep::client {

struct GuessInput {
    const World& world;             ///< before the tick that is guessed
    PlayerId self = 0;              ///< whose commands are known, and not to be guessed
    std::span<const Command> last;  ///< commands of the newest frame
    std::uint32_t age = 0;          ///< ticks between that frame and this tick: 0 is the next one
};

/// Commands of others for one tick, each with the sequence it would have: above its author's
/// `PlayerRecord::lastSequence`. What a game knows better than this client, it supplies so.
using Guess = std::function<std::vector<Command>(const GuessInput&)>;

/// Whoever pushed in the newest frame pushes on for so many ticks, by the same impulses and forces
/// at the centres of the same bodies.
Guess pushesGoOn(std::uint32_t ticks);

}  // namespace huestep::client
