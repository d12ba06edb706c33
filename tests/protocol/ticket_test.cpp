// Tickets come back as they were issued; every other sequence of bytes is refused with a sentence.
#include "protocol/ticket.h"

#include <gtest/gtest.h>

#include "protocol/codec.h"

namespace huestep::protocol {
namespace {

const Ticket sample{"arena-3",         Role::Player,      "ann",
                    1'700'000'000'000, 1'700'000'045'000, {1, 2, 3}};

std::vector<std::byte> sealed(const Ticket& ticket, const Keys& keys) {
    SealNonce nonce{};
    fillRandom(nonce);
    const auto out = sealTicket(ticket, keys, nonce);
    EXPECT_TRUE(out.ok()) << (out ? "" : out.error().message);
    return out ? *out : std::vector<std::byte>();
}

std::string refusal(std::span<const std::byte> bytes, const Keys& keys) {
    const Result<Ticket> ticket = openTicket(bytes, *keys.verifying, *keys.sealing);
    return ticket ? "taken" : ticket.error().message;
}

TEST(Ticket, ComesBackAsItWasIssued) {
    const Keys keys = makeKeys(true);
    Ticket longest = sample;
    longest.session = std::string(maxSessionName, 's');
    longest.player = std::string(maxPlayerName, 'p');
    longest.role = Role::Spectator;
    longest.expires = longest.issued + 1'000 * maxTicketSeconds;
    for (const Ticket& ticket : {sample, longest}) {
        const auto bytes = sealed(ticket, keys);
        EXPECT_LE(bytes.size(), maxTicketBytes);
        const Result<Ticket> back = openTicket(bytes, *keys.verifying, *keys.sealing);
        ASSERT_TRUE(back.ok()) << back.error().message;
        EXPECT_EQ(*back, ticket);
    }
}

TEST(Ticket, OfAnotherIssuerIsForged) {
    const Keys keys = makeKeys(true);
    const std::string forged = "no issuer of this server's made this ticket";
    EXPECT_EQ(refusal(sealed(sample, makeKeys(true)), keys), forged);
    // A host knows the sealing key, and still cannot make a ticket.
    Keys host = makeKeys(false);
    host.sealing = keys.sealing;
    EXPECT_EQ(refusal(sealed(sample, host), keys), forged);
    EXPECT_FALSE(sealTicket(sample, withoutSigning(keys), {}).ok());
}

TEST(Ticket, WithAnyBitTurnedIsForged) {
    const Keys keys = makeKeys(true);
    const auto good = sealed(sample, keys);
    for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
        auto bad = good;
        bad[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
        EXPECT_NE(refusal(bad, keys), "taken") << "bit " << bit;
    }
    for (std::size_t size = 0; size < good.size(); ++size)
        EXPECT_NE(refusal(std::span(good).first(size), keys), "taken") << size << " bytes";
}

TEST(Ticket, ShowsNothingOfItselfToWhoeverCarriesIt) {
    const auto bytes = sealed(sample, makeKeys(true));
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    EXPECT_EQ(text.find("arena"), std::string::npos);
    EXPECT_EQ(text.find("ann"), std::string::npos);
}

TEST(Ticket, BeyondALimitIsNeitherIssuedNorTaken) {
    const Keys keys = makeKeys(true);
    const auto issue = [&](auto change) {
        Ticket ticket = sample;
        change(ticket);
        const auto out = sealTicket(ticket, keys, {});
        return out ? std::string("issued") : out.error().message;
    };
    EXPECT_EQ(issue([](Ticket& t) { t.session = "A"; }),
              "session: not a name of 1 to 64 of a-z, 0-9, _ and -");
    EXPECT_EQ(issue([](Ticket& t) { t.player = std::string(33, 'p'); }),
              "player: not a name of 1 to 32 of a-z, 0-9, _ and -");
    EXPECT_EQ(issue([](Ticket& t) { t.expires = t.issued; }), "expires: not after it was issued");
    EXPECT_EQ(issue([](Ticket& t) { t.expires = t.issued + 1'000 * maxTicketSeconds + 1; }),
              "expires: more than 86400 s ahead");
    EXPECT_EQ(issue([](Ticket& t) { t.role = static_cast<Role>(2); }),
              "role: neither player nor spectator");
}

TEST(Ticket, IsReadWithinItsBytes) {
    const auto refused = [](std::vector<std::byte> plain) {
        const Result<Ticket> ticket = parseTicket(plain);
        return ticket ? std::string("taken") : ticket.error().message;
    };
    EXPECT_EQ(refused({}), "this ticket is cut short");
    std::vector<std::byte> plain(36);
    EXPECT_EQ(refused(plain), "this ticket is of version 0, not 1");
    plain[0] = std::byte{1};
    plain[34] = std::byte{255};
    EXPECT_EQ(refused(plain), "this ticket's names are cut short or too long");
    plain[34] = std::byte{0};
    EXPECT_EQ(refused(plain), "this ticket's session: not a name of 1 to 64 of a-z, 0-9, _ and -");
}

}  // namespace
}  // namespace huestep::protocol
