/// Keys, signatures and seals, by libsodium: Ed25519 and XChaCha20-Poly1305.
///
///     Keys keys = makeKeys(true);                          // of an issuer of tickets
///     Signature mark = sign(*keys.signing, "ticket 1", bytes);
///     verify(*keys.verifying, "ticket 1", bytes, mark);    // true
///     std::string file = toText(withoutSigning(keys));     // for a host
///
/// Whoever holds a signing key can make signatures; whoever holds a verifying key can check them. A
/// sealing key is shared: both ends hold it. Thread rule: pure functions but for the random bytes,
/// which are the system's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace huestep::protocol {

using VerifyingKey = std::array<std::uint8_t, 32>;
using Signature = std::array<std::uint8_t, 64>;
/// Never twice with the same key; 24 random bytes never are.
using SealNonce = std::array<std::uint8_t, 24>;

/// 32 bytes that nobody else may know; wiped when they go.
class SecretKey {
 public:
    explicit SecretKey(std::span<const std::uint8_t, 32> bytes);
    ~SecretKey();
    SecretKey(const SecretKey&) = default;
    SecretKey& operator=(const SecretKey&) = default;
    [[nodiscard]] std::span<const std::uint8_t, 32> bytes() const { return m_bytes; }

 private:
    std::array<std::uint8_t, 32> m_bytes{};
};

/// What a key file holds: any of these, at least one.
struct Keys {
    std::optional<SecretKey> signing;       ///< an Ed25519 seed
    std::optional<VerifyingKey> verifying;  ///< the public key that belongs to it
    std::optional<SecretKey> sealing;       ///< of XChaCha20-Poly1305

    /// Whether someone who reads the file could do harm.
    [[nodiscard]] bool secret() const { return signing || sealing; }
};

/// New ones, from the system's random bytes: a pair to sign with, and a sealing key if asked for.
Keys makeKeys(bool withSealing);
/// What may be given to those who only check.
Keys withoutSigning(const Keys& keys);
VerifyingKey verifyingKeyOf(const SecretKey& signing);

/// `purpose` says what is signed, as in "ticket 1": a signature holds for no other.
Signature sign(const SecretKey& key, std::string_view purpose, std::span<const std::byte> bytes);
bool verify(const VerifyingKey& key, std::string_view purpose, std::span<const std::byte> bytes,
            const Signature& signature);

/// The nonce, the bytes under the key and a tag over them.
std::vector<std::byte> seal(const SecretKey& key, const SealNonce& nonce,
                            std::span<const std::byte> bytes);
/// None: not sealed with this key, or changed since.
std::optional<std::vector<std::byte>> unseal(const SecretKey& key,
                                             std::span<const std::byte> sealed);
inline constexpr std::size_t sealBytes = 24 + 16;  ///< longer than what is sealed

/// Random bytes of the system.
void fillRandom(std::span<std::uint8_t> bytes);

/// A key file: the line `huestep key 1`, then a line each of `signing`, `verifying` and `sealing`
/// with 64 hex digits. Empty lines and those that begin with # are skipped.
std::string toText(const Keys& keys);
/// The sentence names the line.
Result<Keys> parseKeys(std::string_view text);
inline constexpr std::size_t maxKeyFileBytes = 4'096;

/// Bytes as text that may stand in a URL or on a line (base64url without padding), and back; none:
/// it is something else.
std::string toUrlText(std::span<const std::byte> bytes);
std::optional<std::vector<std::byte>> fromUrlText(std::string_view text);

}  // namespace huestep::protocol
