/// Tickets: the right to enter a session once, for a short time, given by an issuer.
///
/// An issuer (a game's log-in, a matchmaker) holds the signing key and the sealing key; hosts hold
/// the verifying key and the sealing key, so a host that is taken cannot make tickets. A ticket is
///
///   u8   version, 1
///   u8   role
///   u64  issued, u64 expires     ms since 1970-01-01 UTC
///   16   id                      random; a host takes each once
///   u8   bytes of session, u8 bytes of player, then both
///   64   Ed25519 signature of all before, for the purpose "huestep ticket 1"
///
/// all of it sealed with XChaCha20-Poly1305, so that who carries it learns nothing from it, and
/// bytes that no issuer made are told before anything of them is read. Numbers are little-endian.
/// Thread rule: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "protocol/keys.h"
#include "protocol/messages.h"

namespace huestep::protocol {

using TicketId = std::array<std::uint8_t, 16>;

struct Ticket {
    std::string session;  ///< 1 to 64 of [a-z0-9_-]
    Role role = Role::Player;
    std::string player;         ///< who comes, as the issuer knows him: 1 to 32 of [a-z0-9_-]
    std::uint64_t issued = 0;   ///< ms since 1970-01-01 UTC
    std::uint64_t expires = 0;  ///< the same; above `issued`
    TicketId id{};
    friend bool operator==(const Ticket&, const Ticket&) = default;
};

inline constexpr std::size_t maxPlayerName = 32;
inline constexpr std::uint64_t ticketSeconds = 45;  ///< from issue to expiry, unless said
inline constexpr std::uint64_t maxTicketSeconds = 86'400;

/// Whether the name is 1 to 32 of [a-z0-9_-].
bool isPlayerName(std::string_view name);

/// The bytes for `Hello::ticket`; at most `maxTicketBytes`. Fails where `keys` lack the signing or
/// the sealing key, or a field is out of its range, with a sentence. `nonce` is never used again.
Result<std::vector<std::byte>> sealTicket(const Ticket& ticket, const Keys& keys,
                                          const SealNonce& nonce);

/// What was sealed, if an issuer of these keys did it; the sentence of a failure says what is
/// wrong. Whether it fits time, session and role is for the caller to ask.
Result<Ticket> openTicket(std::span<const std::byte> sealed, const VerifyingKey& verifying,
                          const SecretKey& sealing);

/// The part of `openTicket` after the seal and the signature: for it and for a fuzzer.
Result<Ticket> parseTicket(std::span<const std::byte> plain);

}  // namespace huestep::protocol
