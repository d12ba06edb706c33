// Keys, signatures and seals against the published vectors, and key files against what breaks them.
#include "protocol/keys.h"

#include <gtest/gtest.h>

namespace huestep::protocol {
namespace {

std::vector<std::byte> bytesOf(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
    return {bytes.begin(), bytes.end()};
}

TEST(Keys, BelongTogetherAsTheStandardSays) {
    // RFC 8032, 7.1, test 1.
    const Result<Keys> keys = parseKeys(
        "huestep key 1\n"
        "signing 9d61b19deffd5a60ba844af492ec2cc44449c5697b326919703bac031cae7f60\n");
    ASSERT_TRUE(keys.ok()) << keys.error().message;
    EXPECT_EQ(toText(withoutSigning(*keys)),
              "huestep key 1\n"
              "verifying d75a980182b10ab7d54bfed3c964073a0ee172f3daa62325af021a68f707511a\n");
}

TEST(Keys, OfTwoCallsDiffer) {
    const Keys a = makeKeys(true);
    const Keys b = makeKeys(true);
    EXPECT_NE(*a.verifying, *b.verifying);
    EXPECT_NE(toText({{}, {}, a.sealing}), toText({{}, {}, b.sealing}));
    EXPECT_FALSE(makeKeys(false).sealing.has_value());
}

TEST(Signature, HoldsForItsKeyPurposeAndBytesAlone) {
    const Keys keys = makeKeys(false);
    const auto bytes = bytesOf("tick 600");
    const Signature good = sign(*keys.signing, "test 1", bytes);
    EXPECT_TRUE(verify(*keys.verifying, "test 1", bytes, good));
    EXPECT_FALSE(verify(*keys.verifying, "test 2", bytes, good));
    EXPECT_FALSE(verify(*keys.verifying, "test 1", bytesOf("tick 601"), good));
    EXPECT_FALSE(verify(*makeKeys(false).verifying, "test 1", bytes, good));
    for (std::size_t place = 0; place < good.size(); ++place) {
        Signature bad = good;
        bad[place] ^= 1;
        EXPECT_FALSE(verify(*keys.verifying, "test 1", bytes, bad)) << place;
    }
}

TEST(Seal, OpensOnlyUnchangedAndUnderItsKey) {
    const Keys keys = makeKeys(true);
    const auto bytes = bytesOf("who may play");
    const auto sealed = seal(*keys.sealing, SealNonce{1, 2, 3}, bytes);
    EXPECT_EQ(sealed.size(), bytes.size() + sealBytes);
    EXPECT_EQ(unseal(*keys.sealing, sealed), bytes);
    EXPECT_EQ(unseal(*makeKeys(true).sealing, sealed), std::nullopt);
    for (std::size_t place = 0; place < sealed.size(); ++place) {
        auto bad = sealed;
        bad[place] ^= std::byte{0x80};
        EXPECT_EQ(unseal(*keys.sealing, bad), std::nullopt) << place;
    }
    for (std::size_t size = 0; size < sealed.size(); ++size)
        EXPECT_EQ(unseal(*keys.sealing, std::span(sealed).first(size)), std::nullopt) << size;
}

TEST(KeyFile, ComesBackAsItWent) {
    const Keys keys = makeKeys(true);
    for (const Keys& each : {keys, withoutSigning(keys), Keys{{}, {}, keys.sealing}}) {
        const Result<Keys> back = parseKeys("# of the club\n\n" + toText(each) + "\r\n");
        ASSERT_TRUE(back.ok()) << back.error().message;
        EXPECT_EQ(toText(*back), toText(each));
    }
}

TEST(KeyFile, IsRefusedWithItsLine) {
    const std::string head = "huestep key 1\n";
    const std::string hex(64, 'a');
    const auto refusal = [](const std::string& text) {
        const Result<Keys> keys = parseKeys(text);
        return keys ? std::string("taken") : keys.error().message;
    };
    EXPECT_EQ(refusal(""), "it holds no key");
    EXPECT_EQ(refusal(head), "it holds no key");
    EXPECT_EQ(refusal("verifying " + hex),
              "line 1: not 'huestep key 1', with which a key file begins");
    EXPECT_EQ(refusal(head + "secret " + hex), "line 2: neither signing, verifying nor sealing");
    EXPECT_EQ(refusal(head + "\nsealing " + hex + "0"),
              "line 3: sealing is not followed by 64 hex digits");
    EXPECT_EQ(refusal(head + "sealing"), "line 2: sealing is not followed by 64 hex digits");
    EXPECT_EQ(refusal(head + "sealing " + std::string(64, 'x')),
              "line 2: sealing is not followed by 64 hex digits");
    EXPECT_EQ(refusal(head + "sealing " + hex + "\nsealing " + hex),
              "line 3: a second sealing key");
    EXPECT_EQ(refusal(head + "signing " + hex + "\nverifying " + hex),
              "its verifying key does not belong to its signing key");
    EXPECT_EQ(refusal(head + std::string(maxKeyFileBytes, '#')), "more bytes than a key file has");
}

TEST(UrlText, GoesThereAndBackAndTakesNothingElse) {
    for (std::size_t size = 0; size < 70; ++size) {
        std::vector<std::byte> bytes(size);
        for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 37 + size);
        const std::string text = toUrlText(bytes);
        EXPECT_EQ(text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                         "0123456789-_"),
                  std::string::npos);
        EXPECT_EQ(fromUrlText(text), bytes);
    }
    EXPECT_EQ(toUrlText(bytesOf("f")), "Zg");  // RFC 4648
    EXPECT_EQ(fromUrlText("Zg=="), std::nullopt);
    EXPECT_EQ(fromUrlText("Z+"), std::nullopt);
    EXPECT_EQ(fromUrlText("Zm9v\n"), std::nullopt);
}

}  // namespace
}  // namespace huestep::protocol
