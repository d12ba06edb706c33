/// Resume tokens: the right to take up a player's seat again.
///
/// A token is {player u32, epoch u16, issue u16, tag u64}, where tag = SipHash-2-4 of the first
/// eight bytes and the session's name under a secret of 16 bytes that lies in the session's
/// folder. It is derived, not stored: issuing one writes nothing, and it outlives the server
/// because the secret does. SipHash is a keyed function made for short messages (Aumasson and
/// Bernstein, 2012); guessing a tag takes 2^63 tries on average, each a connection.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/scene/scene.h"
#include "protocol/messages.h"

namespace huestep::server {

using ResumeKey = std::array<std::uint8_t, 16>;

/// What a token says once its tag holds.
struct ResumeClaim {
    PlayerId player = 0;
    std::uint16_t epoch = 0;  ///< low bits of the epoch it was issued in
    std::uint16_t issue = 0;  ///< counts the tokens of this seat in that epoch
    friend bool operator==(const ResumeClaim&, const ResumeClaim&) = default;
};

protocol::ResumeToken makeToken(const ResumeKey& key, std::string_view session,
                                const ResumeClaim& claim);

/// None: not a token of this session.
std::optional<ResumeClaim> readToken(const ResumeKey& key, std::string_view session,
                                     const protocol::ResumeToken& token);

/// SipHash-2-4, 64 bits.
std::uint64_t sipHash(const ResumeKey& key, std::span<const std::uint8_t> bytes);

}  // namespace huestep::server
