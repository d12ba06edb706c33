#include "protocol/keys.h"

#include <sodium.h>

#include <algorithm>
#include <cassert>

namespace huestep::protocol {

namespace {

static_assert(crypto_sign_SEEDBYTES == 32 && crypto_sign_PUBLICKEYBYTES == 32);
static_assert(crypto_sign_BYTES == std::tuple_size_v<Signature>);
static_assert(crypto_aead_xchacha20poly1305_ietf_KEYBYTES == 32);
static_assert(crypto_aead_xchacha20poly1305_ietf_NPUBBYTES == std::tuple_size_v<SealNonce>);
static_assert(crypto_aead_xchacha20poly1305_ietf_ABYTES + std::tuple_size_v<SealNonce> ==
              sealBytes);

/// libsodium chooses its code for this processor once.
void ready() {
    static const bool done = sodium_init() >= 0;
    assert(done);  // it fails only where the system has no random bytes at all
    static_cast<void>(done);
}

const std::uint8_t* numbers(std::span<const std::byte> bytes) {
    return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

/// What is signed: the purpose, a zero, the bytes.
std::vector<std::uint8_t> statement(std::string_view purpose, std::span<const std::byte> bytes) {
    std::vector<std::uint8_t> out(purpose.begin(), purpose.end());
    out.push_back(0);
    out.insert(out.end(), numbers(bytes), numbers(bytes) + bytes.size());
    return out;
}

/// Both halves of an Ed25519 pair; the secret one as libsodium wants it.
struct Pair {
    explicit Pair(const SecretKey& seed) {
        ready();
        crypto_sign_seed_keypair(open.data(), closed.data(), seed.bytes().data());
    }
    ~Pair() { sodium_memzero(closed.data(), closed.size()); }
    Pair(const Pair&) = delete;
    Pair& operator=(const Pair&) = delete;
    VerifyingKey open{};
    std::array<std::uint8_t, crypto_sign_SECRETKEYBYTES> closed{};
};

SecretKey randomSecret() {
    std::array<std::uint8_t, 32> bytes{};
    fillRandom(bytes);
    const SecretKey key(bytes);
    sodium_memzero(bytes.data(), bytes.size());
    return key;
}

constexpr std::string_view headLine = "huestep key 1";

std::string hexLine(std::string_view name, std::span<const std::uint8_t, 32> bytes) {
    std::array<char, 65> hex{};
    sodium_bin2hex(hex.data(), hex.size(), bytes.data(), bytes.size());
    std::string line = std::string(name) + " " + hex.data() + "\n";
    sodium_memzero(hex.data(), hex.size());
    return line;
}

bool parseHex(std::string_view text, std::array<std::uint8_t, 32>& into) {
    std::size_t size = 0;
    return text.size() == 64 &&
           sodium_hex2bin(into.data(), into.size(), text.data(), text.size(), nullptr, &size,
                          nullptr) == 0 &&
           size == into.size();
}

std::string_view trimmed(std::string_view line) {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!line.empty() && blank(line.back())) line.remove_suffix(1);
    while (!line.empty() && blank(line.front())) line.remove_prefix(1);
    return line;
}

/// A line `NAME 64HEX` after the first. The sentence does not name the line.
Status takeLine(std::string_view line, Keys& keys) {
    const std::size_t space = line.find(' ');
    const std::string_view name = line.substr(0, space);
    if (name != "signing" && name != "verifying" && name != "sealing")
        return Error{"neither signing, verifying nor sealing"};
    const bool twice = (name == "signing" && keys.signing) ||
                       (name == "verifying" && keys.verifying) ||
                       (name == "sealing" && keys.sealing);
    if (twice) return Error{"a second " + std::string(name) + " key"};
    std::array<std::uint8_t, 32> bytes{};
    const bool whole =
        space != std::string_view::npos && parseHex(trimmed(line.substr(space + 1)), bytes);
    if (whole && name == "signing") keys.signing.emplace(bytes);
    if (whole && name == "sealing") keys.sealing.emplace(bytes);
    if (whole && name == "verifying") keys.verifying = bytes;
    sodium_memzero(bytes.data(), bytes.size());
    if (!whole) return Error{std::string(name) + " is not followed by 64 hex digits"};
    return Done{};
}

}  // namespace

SecretKey::SecretKey(std::span<const std::uint8_t, 32> bytes) {
    std::copy(bytes.begin(), bytes.end(), m_bytes.begin());
}
SecretKey::~SecretKey() {
    sodium_memzero(m_bytes.data(), m_bytes.size());
}

void fillRandom(std::span<std::uint8_t> bytes) {
    ready();
    randombytes_buf(bytes.data(), bytes.size());
}

Keys makeKeys(bool withSealing) {
    Keys keys;
    keys.signing = randomSecret();
    keys.verifying = verifyingKeyOf(*keys.signing);
    if (withSealing) keys.sealing = randomSecret();
    return keys;
}

Keys withoutSigning(const Keys& keys) {
    Keys out = keys;
    out.signing.reset();
    return out;
}

VerifyingKey verifyingKeyOf(const SecretKey& signing) {
    return Pair(signing).open;
}

Signature sign(const SecretKey& key, std::string_view purpose, std::span<const std::byte> bytes) {
    const Pair pair(key);
    const std::vector<std::uint8_t> message = statement(purpose, bytes);
    Signature signature{};
    crypto_sign_detached(signature.data(), nullptr, message.data(), message.size(),
                         pair.closed.data());
    return signature;
}

bool verify(const VerifyingKey& key, std::string_view purpose, std::span<const std::byte> bytes,
            const Signature& signature) {
    ready();
    const std::vector<std::uint8_t> message = statement(purpose, bytes);
    return crypto_sign_verify_detached(signature.data(), message.data(), message.size(),
                                       key.data()) == 0;
}

std::vector<std::byte> seal(const SecretKey& key, const SealNonce& nonce,
                            std::span<const std::byte> bytes) {
    ready();
    std::vector<std::byte> out(sealBytes + bytes.size());
    auto* const to = reinterpret_cast<std::uint8_t*>(out.data());
    std::copy(nonce.begin(), nonce.end(), to);
    crypto_aead_xchacha20poly1305_ietf_encrypt(to + nonce.size(), nullptr, numbers(bytes),
                                               bytes.size(), nullptr, 0, nullptr, nonce.data(),
                                               key.bytes().data());
    return out;
}

std::optional<std::vector<std::byte>> unseal(const SecretKey& key,
                                             std::span<const std::byte> sealed) {
    ready();
    if (sealed.size() < sealBytes) return std::nullopt;
    const std::span<const std::byte> nonce = sealed.first(std::tuple_size_v<SealNonce>);
    const std::span<const std::byte> rest = sealed.subspan(nonce.size());
    std::vector<std::byte> out(sealed.size() - sealBytes);
    const int status = crypto_aead_xchacha20poly1305_ietf_decrypt(
        reinterpret_cast<std::uint8_t*>(out.data()), nullptr, nullptr, numbers(rest), rest.size(),
        nullptr, 0, numbers(nonce), key.bytes().data());
    if (status != 0) return std::nullopt;
    return out;
}

std::string toText(const Keys& keys) {
    std::string text = std::string(headLine) + "\n";
    if (keys.signing) text += hexLine("signing", keys.signing->bytes());
    if (keys.verifying) text += hexLine("verifying", *keys.verifying);
    if (keys.sealing) text += hexLine("sealing", keys.sealing->bytes());
    return text;
}

Result<Keys> parseKeys(std::string_view text) {
    if (text.size() > maxKeyFileBytes) return Error{"more bytes than a key file has"};
    Keys keys;
    bool headed = false;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find('\n');
        const std::string_view line = trimmed(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (line.empty() || line.front() == '#') continue;
        const auto refuse = [number](const std::string& why) {
            return Error{"line " + std::to_string(number) + ": " + why};
        };
        if (!headed) {
            if (line != headLine)
                return refuse("not '" + std::string(headLine) + "', with which a key file begins");
            headed = true;
        } else if (const Status taken = takeLine(line, keys); !taken) {
            return refuse(taken.error().message);
        }
    }
    if (!keys.signing && !keys.verifying && !keys.sealing) return Error{"it holds no key"};
    if (keys.signing && !keys.verifying) keys.verifying = verifyingKeyOf(*keys.signing);
    if (keys.signing && *keys.verifying != verifyingKeyOf(*keys.signing))
        return Error{"its verifying key does not belong to its signing key"};
    return keys;
}

std::string toUrlText(std::span<const std::byte> bytes) {
    ready();
    constexpr int variant = sodium_base64_VARIANT_URLSAFE_NO_PADDING;
    std::string text(sodium_base64_ENCODED_LEN(bytes.size(), variant), '\0');
    sodium_bin2base64(text.data(), text.size(), numbers(bytes), bytes.size(), variant);
    text.pop_back();  // the zero at its end
    return text;
}

std::optional<std::vector<std::byte>> fromUrlText(std::string_view text) {
    ready();
    std::vector<std::byte> bytes(text.size() / 4 * 3 + 3);
    std::size_t size = 0;
    const int status = sodium_base642bin(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                         bytes.size(), text.data(), text.size(), nullptr, &size,
                                         nullptr, sodium_base64_VARIANT_URLSAFE_NO_PADDING);
    if (status != 0) return std::nullopt;
    bytes.resize(size);
    return bytes;
}

}  // namespace huestep::protocol
