/// A client without a screen: a connection, a replica and a bot on a loop of their own.
///
///     PlayerConfig config;
///     config.address = "127.0.0.1:7777";
///     config.session = "play";
///     config.fingerprint = ...;                      // what this build's self-test gave
///     config.bot = makeWanderBot(seed);              // or makeIdleBot(), or readScript(FILE)
///     config.ticks = 600;                            // 0: until SIGINT or SIGTERM
///     Result<Statistics> played = play(std::move(config));
///     if (!played) -> print played.error().message, exit 2
///     exit status 1 if played->mismatches > 0
///
/// `play` blocks; several may run at once, each in a thread of its own (with `handleSignals` in
/// at most one of them, and `stop` for the others). The process must ignore SIGPIPE, as `main`
/// does: a server that goes while bytes are sent to it would end the process.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/bot.h"
#include "client/lag.h"
#include "client/lookup.h"
#include "client/replica.h"
#include "core/result.h"
#include "protocol/messages.h"
#include "protocol/tls.h"

namespace huestep::client {

struct PlayerConfig {
    std::string address;  ///< HOST:PORT
    std::string session;
    protocol::Role role = protocol::Role::Player;
    protocol::Fingerprint fingerprint;
    std::vector<std::byte> ticket{};                    ///< where the server asks for one
    std::shared_ptr<const protocol::TlsContext> tls{};  ///< null: none is spoken
    std::unique_ptr<Bot> bot;                           ///< none: idle
    std::uint64_t ticks = 0;  ///< frames to follow before leaving; 0: no end
    int threads = 1;          ///< that step this client's world
    bool handleSignals = true;
    std::atomic<bool>* stop = nullptr;  ///< set it to end within 100 ms, whatever is waited for
    /// How long to try: for the first connection, and for each reconnection.
    double connectSeconds = 10.0;
    double reconnectSeconds = 30.0;
    /// A connection over which nothing comes for so long, or while waiting for the session's state
    /// nothing of it, is given up and made anew.
    double silenceSeconds = 10.0;
    /// Run ahead of the frames by these rules; the bot then acts on the predicted world.
    std::optional<PredictionRules> prediction;
    /// Makes the line longer, for trying; in both directions alike.
    LagRules lag;
    Resolve resolve = askSystem;
    /// Called once a second with the numbers so far; may be empty.
    std::function<void(const Statistics&)> onProgress;
    /// Called for what a person should know: refusals, connections made and
    /// lost, desyncs; may be empty.
    std::function<void(const std::string& sentence)> onNotice;
    /// Called once, before `play` returns, if it ever was in the session: also where `play` then
    /// fails, so that what was verified is known. May be empty.
    std::function<void(const Statistics&)> onEnd;
};

/// Plays to the end. Fails with a sentence if it never got in, also because it was stopped before,
/// was refused, or lost the server
/// for longer than `reconnectSeconds`.
Result<Statistics> play(PlayerConfig config);

}  // namespace huestep::client
