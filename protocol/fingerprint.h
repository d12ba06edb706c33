/// What two builds must share to step the same bits.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "protocol/messages.h"

namespace huestep::protocol {

/// The hash of the schemas this program was built with and the versions of the scene and snapshot
/// layout. `selfTest` is 0.
Fingerprint buildFingerprint();

/// The same with its self-test: the full root of the scene `mixed` after 120 ticks, stepped here
/// and now, so that a processor or library that computes otherwise shows itself.
Result<Fingerprint> selfTest();

/// What a Hello says of a game's rules that a build has.
std::uint64_t rulesMark(std::string_view name, std::uint32_t version);
/// Of all rules that this program has built in.
std::vector<std::uint64_t> builtInRulesMarks();

/// XXH3-64 of a schema's text without comments and runs of white space, so that better prose in a
/// schema does not keep builds from playing together.
std::uint64_t schemaHash(std::string_view text);

}  // namespace huestep::protocol
