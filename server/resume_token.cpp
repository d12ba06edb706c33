#include "server/resume_token.h"

#include <bit>
#include <vector>

namespace huestep::server {

namespace {

std::uint64_t loadLittle(std::span<const std::uint8_t> bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) value |= std::uint64_t{bytes[i]} << (8 * i);
    return value;
}

struct SipState {
    std::uint64_t v0, v1, v2, v3;

    void round() {
        v0 += v1;
        v2 += v3;
        v1 = std::rotl(v1, 13) ^ v0;
        v3 = std::rotl(v3, 16) ^ v2;
        v0 = std::rotl(v0, 32);
        v2 += v1;
        v0 += v3;
        v1 = std::rotl(v1, 17) ^ v2;
        v3 = std::rotl(v3, 21) ^ v0;
        v2 = std::rotl(v2, 32);
    }
    void absorb(std::uint64_t word) {
        v3 ^= word;
        round();
        round();
        v0 ^= word;
    }
};

void putLittle(std::uint8_t* to, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint64_t tagOf(const ResumeKey& key, std::string_view session,
                    std::span<const std::uint8_t> claim) {
    std::vector<std::uint8_t> message(claim.begin(), claim.end());
    message.insert(message.end(), session.begin(), session.end());
    return sipHash(key, message);
}

}  // namespace

std::uint64_t sipHash(const ResumeKey& key, std::span<const std::uint8_t> bytes) {
    const std::uint64_t k0 = loadLittle({key.data(), 8});
    const std::uint64_t k1 = loadLittle({key.data() + 8, 8});
    SipState s{k0 ^ 0x736f6d6570736575u, k1 ^ 0x646f72616e646f6du, k0 ^ 0x6c7967656e657261u,
               k1 ^ 0x7465646279746573u};
    const std::size_t whole = bytes.size() / 8 * 8;
    for (std::size_t at = 0; at < whole; at += 8) s.absorb(loadLittle(bytes.subspan(at, 8)));
    s.absorb(loadLittle(bytes.subspan(whole)) | std::uint64_t{bytes.size() & 0xffu} << 56);
    s.v2 ^= 0xffu;
    for (int i = 0; i < 4; ++i) s.round();
    return s.v0 ^ s.v1 ^ s.v2 ^ s.v3;
}

protocol::ResumeToken makeToken(const ResumeKey& key, std::string_view session,
                                const ResumeClaim& claim) {
    protocol::ResumeToken token{};
    putLittle(token.data(), claim.player, 4);
    putLittle(token.data() + 4, claim.epoch, 2);
    putLittle(token.data() + 6, claim.issue, 2);
    putLittle(token.data() + 8, tagOf(key, session, {token.data(), 8}), 8);
    return token;
}

std::optional<ResumeClaim> readToken(const ResumeKey& key, std::string_view session,
                                     const protocol::ResumeToken& token) {
    const std::span<const std::uint8_t> bytes(token);
    if (loadLittle(bytes.subspan(8)) != tagOf(key, session, bytes.first(8))) return std::nullopt;
    return ResumeClaim{static_cast<PlayerId>(loadLittle(bytes.first(4))),
                       static_cast<std::uint16_t>(loadLittle(bytes.subspan(4, 2))),
                       static_cast<std::uint16_t>(loadLittle(bytes.subspan(6, 2)))};
}

}  // namespace huestep::server
