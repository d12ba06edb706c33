/// Bots: players made of rules. They play fairly: what they do, a person could do.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "core/world/world.h"

namespace huestep::client {

/// What a bot sees before a tick of its own world.
struct Situation {
    const World& world;
    PlayerId player = 0;
    BodyId body = 0;           ///< of the player; 0: it has none
    std::uint64_t played = 0;  ///< ticks since this client began to play
};

class Bot {
 public:
    virtual ~Bot() = default;
    /// What to do now; mostly nothing.
    virtual std::vector<Action> act(const Situation& now) = 0;
};

/// Does nothing.
std::unique_ptr<Bot> makeIdleBot();

/// Pushes its body about, grabs what is near, now and then spawns a few small bodies and removes
/// them again, within the scene's budget. The same seed and worlds give the same actions.
std::unique_ptr<Bot> makeWanderBot(std::uint64_t seed);

/// Plays the game whose rules the world has, if it knows them (core/games), else wanders.
std::unique_ptr<Bot> makeGameBot(std::uint64_t seed);

/// Acts by a script; see `parseScript`.
struct ScriptLine {
    std::uint64_t tick = 0;  ///< ticks since this client began to play
    Action action;
    bool onSelf = false;    ///< the action's body is the player's own
    bool atCenter = false;  ///< the action's point is the body's centre
    bool onLastSpawn = false;
};
std::unique_ptr<Bot> makeScriptBot(std::vector<ScriptLine> lines);

/// A script has a line an action, ticks rising; `#` starts a comment. BODY is a body's id, `me`
/// for the player's own body, or `spawned` for the newest body it spawned. Numbers are in metres,
/// N·s, N, rad/s.
///
///     TICK impulse BODY IX IY [X Y]      at a point of the world; without: at the centre
///     TICK force BODY FX FY [X Y]
///     TICK grab BODY X Y TX TY           take BODY at (X, Y), draw it to (TX, TY)
///     TICK move TX TY                    move the target of the grab
///     TICK release
///     TICK spawn circle RADIUS X Y
///     TICK spawn box HALFWIDTH HALFHEIGHT X Y
///     TICK remove BODY
///     TICK motor JOINT on|off SPEED
///     TICK custom KIND [X Y [NUMBER [ID]]]     what the world's rules understand
///
/// The sentence of a failure begins with `NAME:LINE: `.
Result<std::vector<ScriptLine>> parseScript(std::string_view text, const std::string& name);

/// The bot of a script file.
Result<std::unique_ptr<Bot>> readScript(const std::string& path);

}  // namespace huestep::client
