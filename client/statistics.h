/// Numbers of a client's life.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/world/command.h"
#include "protocol/messages.h"

namespace huestep::client {

/// ns since some fixed moment; an argument, never a clock.
using Instant = std::uint64_t;

/// What prediction did, and where it stands.
struct PredictionFigures {
    std::uint64_t predicted = 0;  ///< ticks stepped before their frame came, each counted once
    std::uint64_t rollbacks = 0;  ///< ways back
    std::uint64_t undone = 0;     ///< ticks that were undone in all: the sum of the depths
    std::uint32_t deepest = 0;    ///< ticks undone by one way back, at most 60
    std::uint64_t again = 0;      ///< ticks predicted again after a way back
    /// ns of ways back: the restoring and all steps up to where the world had been; 0 without a
    /// clock.
    std::uint64_t nanoseconds = 0;
    std::uint64_t nanosecondsMost = 0;  ///< of one
    /// m, summed over ways back and largest: how far a body was predicted wrongly, of those the one
    /// that was furthest.
    double errorSum = 0.0;
    double errorMost = 0.0;
    std::uint64_t late = 0;  ///< frames that had own commands later than these asked for
    // Now:
    std::uint32_t lead = 0;        ///< ticks ahead of what is confirmed
    std::uint32_t inputDelay = 0;  ///< ticks
    double roundTrip = 0.0;        ///< s, median of the newest
    double jitter = 0.0;           ///< s, that slow round trips take more
};

/// Over all connections of a client.
struct Statistics {
    PlayerId player = 0;
    std::uint64_t tick = 0;   ///< of the world now
    std::uint64_t root = 0;   ///< its motion root
    std::uint64_t ticks = 0;  ///< frames applied
    std::uint64_t hashesCompared = 0;
    std::uint64_t mismatches = 0;
    std::uint64_t corrections = 0;    ///< snapshots adopted because of a mismatch
    std::uint64_t snapshots = 0;      ///< all snapshots adopted
    std::uint64_t connections = 0;    ///< Welcomes
    std::uint64_t resumes = 0;        ///< of them into the old seat
    std::uint64_t rolledBack = 0;     ///< ticks undone because the server lost them uncommitted
    std::uint64_t committedLost = 0;  ///< committed ticks the server did not have: must be 0
    std::uint64_t commandsSent = 0;
    std::uint64_t commandsResent = 0;
    std::uint64_t commandsSeen = 0;      ///< own commands found in frames
    std::uint64_t commandsLost = 0;      ///< never ordered: a later one was, so they never will be
    std::uint64_t commandsRejected = 0;  ///< of them rejected by the world
    std::uint64_t bytesIn = 0;           ///< set by the connection
    std::uint64_t bytesOut = 0;
    double latencyMedian = 0.0;  ///< s, from own command to the frame that has it
    double latencyP99 = 0.0;
    std::string score;  ///< how the game stands by the rules of the world; empty: none
    std::optional<protocol::DesyncReport> lastDesync;
    std::optional<PredictionFigures> prediction;  ///< none: this client does not predict
};

}  // namespace huestep::client
