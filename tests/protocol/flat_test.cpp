// The codec that needs no library, against the one that is Cap'n Proto's.
#include <gtest/gtest.h>

#include "protocol/flat/flat_codec.h"
#include "protocol/frame.h"
#include "tests/protocol/samples.h"

namespace huestep::protocol {
namespace {

using samples::Draw;
using samples::reasonOf;

constexpr std::uint64_t seed = 20'261'122;

std::span<const std::byte> payloadOf(const std::vector<std::byte>& frame) {
    return std::span(frame).subspan(headerBytes);
}

/// Whether the flat codec says of these bytes what the library says. A View is for pages to read.
void expectTheSame(MessageType type, std::span<const std::byte> payload) {
    const Result<Message> ours = flat::decode(type, payload);
    const Result<Message> theirs = decode(type, payload);
    if (type == MessageType::View) {
        EXPECT_FALSE(ours.ok());
        return;
    }
    ASSERT_EQ(ours.ok(), theirs.ok())
        << nameOf(type) << ": ours " << reasonOf(ours) << ", the library's " << reasonOf(theirs);
    if (ours.ok()) {
        ASSERT_EQ(*ours, *theirs) << nameOf(type);
    }
}

TEST(FlatCodec, WritesWhatTheLibraryWritesByteForByte) {
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    Draw draw(seed);
    for (int round = 0; round < 300; ++round) {
        for (std::size_t i = 0; i < samples::messageTypes; ++i) {
            const Message message = samples::randomMessage(draw, static_cast<MessageType>(i));
            ASSERT_EQ(flat::encode(message), encode(message))
                << nameOf(typeOf(message)) << ", round " << round;
        }
    }
    for (const Message& message : samples::sampleMessages()) {
        ASSERT_EQ(flat::encode(message), encode(message)) << nameOf(typeOf(message));
    }
}

TEST(FlatCodec, ReadsWhatTheLibraryWrites) {
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed + 1));
    Draw draw(seed + 1);
    for (int round = 0; round < 300; ++round) {
        for (std::size_t i = 0; i < samples::messageTypes; ++i) {
            const auto type = static_cast<MessageType>(i);
            const std::vector<std::byte> frame = encode(samples::randomMessage(draw, type));
            expectTheSame(type, payloadOf(frame));
            if (HasFatalFailure()) return;
        }
    }
}

TEST(FlatCodec, ReadsEveryActionAndCountsItsBytes) {
    Draw draw(seed + 2);
    for (std::size_t kind = 0; kind < samples::actionKinds; ++kind) {
        for (int round = 0; round < 50; ++round) {
            const Command command{3, 4, samples::randomAction(draw, kind)};
            const Frame frame{1, {command}, {}, 5, 6};
            const Result<Message> back =
                flat::decode(MessageType::Frame, payloadOf(encode(Message(frame))));
            ASSERT_TRUE(back.ok()) << reasonOf(back);
            ASSERT_EQ(std::get<Frame>(*back), frame) << "action " << kind;
            ASSERT_EQ(flat::commandBytes(command), commandBytes(command)) << "action " << kind;
        }
    }
}

/// The message as its first schema wrote it: a struct that is cut to fewer words.
TEST(FlatCodec, ReadsMessagesOfBuildsThatKnewFewerFields) {
    std::vector<std::byte> frame = encode(Welcome{.session = "a"});
    std::vector<std::byte> payload(frame.begin() + headerBytes, frame.end());
    for (std::uint8_t words = 0; words < 6; ++words) {
        // Fewer words of numbers make the words that follow pointers; none of those is set.
        std::vector<std::byte> cut(8 * (1 + std::size_t{words}));
        cut[4] = std::byte{words};
        if (words == 0) cut[0] = std::byte{0xfc}, cut[1] = cut[2] = cut[3] = std::byte{0xff};
        std::copy_n(payload.begin() + 8, 8 * static_cast<std::ptrdiff_t>(words), cut.begin() + 8);
        expectTheSame(MessageType::Welcome, cut);
        expectTheSame(MessageType::Frame, cut);
        expectTheSame(MessageType::Ping, cut);
        if (HasFatalFailure()) return;
    }
    const std::vector<std::byte> nothing(8);
    for (std::size_t i = 0; i < samples::messageTypes; ++i) {
        expectTheSame(static_cast<MessageType>(i), nothing);
    }
}

/// What was accepted by ours although damaged must be what the library reads. The other way round,
/// the library also reads lists with other elements than their schema has.
void expectNoMoreIsAccepted(MessageType type, std::span<const std::byte> payload,
                            std::size_t& accepted, std::size_t& stricter) {
    const Result<Message> ours = flat::decode(type, payload);
    const Result<Message> theirs = decode(type, payload);
    if (!ours.ok()) {
        if (theirs.ok()) ++stricter;
        ASSERT_EQ(ours.error().message.rfind(nameOf(type), 0), 0u) << ours.error().message;
        return;
    }
    ++accepted;
    ASSERT_TRUE(theirs.ok()) << nameOf(type) << ": " << reasonOf(theirs);
    ASSERT_EQ(*ours, *theirs) << nameOf(type);
}

TEST(FlatCodec, ABitFlippedInAPayloadIsRefusedOrReadAsTheLibraryReadsIt) {
    std::size_t accepted = 0, stricter = 0, all = 0;
    for (const Message& message : samples::sampleMessages()) {
        if (typeOf(message) == MessageType::View) continue;
        const auto frame = encode(message);
        std::vector<std::byte> payload(frame.begin() + headerBytes, frame.end());
        for (std::size_t bit = 0; bit < 8 * payload.size(); ++bit, ++all) {
            const auto mask = static_cast<std::byte>(1u << (bit % 8));
            payload[bit / 8] ^= mask;
            expectNoMoreIsAccepted(typeOf(message), payload, accepted, stricter);
            if (HasFatalFailure()) return;
            payload[bit / 8] ^= mask;
        }
    }
    EXPECT_GT(accepted, all / 4);
    EXPECT_LT(accepted, all);
    EXPECT_LT(stricter, all / 50);
    std::printf("%zu flips: %zu accepted, %zu by the library alone\n", all, accepted, stricter);
}

TEST(FlatCodec, DamagedMessagesAreRefusedOrReadAsTheLibraryReadsThem) {
    Draw draw(seed + 3);
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed + 3));
    std::size_t accepted = 0, stricter = 0;
    constexpr int rounds = 40'000;
    for (int round = 0; round < rounds; ++round) {
        const auto type = static_cast<MessageType>(draw.below(samples::messageTypes - 1));
        std::vector<std::byte> payload;
        if (draw.coin()) {
            const auto frame = encode(samples::randomMessage(draw, type));
            payload.assign(frame.begin() + headerBytes, frame.end());
            for (std::size_t flips = 1 + draw.below(4); flips > 0; --flips) {
                payload[draw.below(payload.size())] ^= static_cast<std::byte>(1u << draw.below(8));
            }
        } else {
            // Small bytes make pointers that stay inside the message more often.
            payload.resize(8 * (1 + draw.below(40)));
            for (auto& byte : payload) {
                byte = static_cast<std::byte>(draw.below(draw.below(4) == 0 ? 256 : 8));
            }
        }
        expectNoMoreIsAccepted(type, payload, accepted, stricter);
        if (HasFatalFailure()) FAIL() << "round " << round;
    }
    EXPECT_GT(accepted, rounds / 20);
    std::printf("%d messages: %zu accepted, %zu by the library alone\n", rounds, accepted,
                stricter);
}

TEST(FlatCodec, RefusesWithASentenceThatSaysWhere) {
    const auto reason = [](const Message& message) {
        return reasonOf(flat::decode(typeOf(message), payloadOf(encode(message))));
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    BodyDef body;
    body.shapes = {ShapeDef::circle({}, 1.0f), ShapeDef::circle({}, nan)};
    const Command good{1, 1, Release{}};
    EXPECT_EQ(reason(Frame{1, {good, {1, 2, Spawn{{body}, {}}}}, {}, 0, 0}),
              "Frame.commands[1].spawn.bodies[0].shapes[1].radius: not a finite number");
    EXPECT_EQ(reason(Intent{std::vector<Command>(maxCommandsPerIntent + 1, good), std::nullopt}),
              "Intent.commands: 65 entries, at most 64");
    EXPECT_EQ(reason(Welcome{.session = "A"}),
              "Welcome.session: not a name of 1 to 64 of a-z, 0-9, _ and -");
    EXPECT_EQ(reason(Bye{ByeReason::Done, "a\nb", false}),
              "Bye.text: not UTF-8 text without control characters");
    EXPECT_EQ(reasonOf(flat::decode(MessageType::Ping, std::vector<std::byte>(12))),
              "Ping: not a whole number of 8-byte words");
    EXPECT_EQ(reasonOf(flat::decode(MessageType::Ping, std::vector<std::byte>(1u << 20))),
              "Ping: 1048576 bytes, at most 4096");
}

/// A few words that say they hold millions of structs, each a view of the same words.
TEST(FlatCodec, MakesNoMoreOfAMessageThanItHasBytesFor) {
    const auto word = [](std::uint32_t low, std::uint32_t high) {
        return std::uint64_t{high} << 32 | low;
    };
    // Frame: a struct of no numbers and one pointer to a list of 4096 structs without words.
    const std::vector<std::uint64_t> words = {word(0, 1u << 16), word(1, 7), word(4096u << 2, 0)};
    const auto bytes = std::as_bytes(std::span(words));
    EXPECT_NE(reasonOf(flat::decode(MessageType::Frame, bytes)), "accepted");
    EXPECT_NE(reasonOf(decode(MessageType::Frame, bytes)), "accepted");
}

}  // namespace
}  // namespace huestep::protocol
