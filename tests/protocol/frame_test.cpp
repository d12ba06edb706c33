#include "protocol/frame.h"

#include <gtest/gtest.h>

#include "core/state/hash.h"
#include "tests/protocol/samples.h"

namespace huestep::protocol {
namespace {

using samples::Draw;

std::vector<std::byte> joined(const std::vector<Message>& messages) {
    std::vector<std::byte> stream;
    for (const Message& message : messages) {
        const auto frame = encode(message);
        stream.insert(stream.end(), frame.begin(), frame.end());
    }
    return stream;
}

std::string reasonOf(const Status& status) {
    return status.ok() ? "accepted" : status.error().message;
}

TEST(Frame, HeaderIsSixteenBytesAsTheProtocolPageSays) {
    const auto frame = encode(Ping{7, false});
    ASSERT_EQ(frame.size(), 16u + 32u);
    EXPECT_EQ(frame[0], std::byte{'u'});
    EXPECT_EQ(frame[1], std::byte{'H'});
    EXPECT_EQ(frame[2], std::byte{1});
    EXPECT_EQ(frame[3], std::byte{11});
    EXPECT_EQ(frame[4], std::byte{32});
    EXPECT_EQ(frame[5], std::byte{0});
    // The checksum, made again from its description.
    std::vector<std::byte> covered(frame.begin(), frame.begin() + 8);
    const std::uint64_t payloadHash = hash64(std::span(frame).subspan(16));
    for (unsigned i = 0; i < 8; ++i) {
        covered.push_back(static_cast<std::byte>(payloadHash >> (8 * i) & 0xffu));
    }
    const std::uint64_t checksum = hash64(covered);
    for (unsigned i = 0; i < 8; ++i) {
        EXPECT_EQ(frame[8 + i], static_cast<std::byte>(checksum >> (8 * i) & 0xffu));
    }
}

TEST(Frame, EveryFlippedBitOfAFrameIsRefused) {
    for (const Message& message : samples::sampleMessages()) {
        auto frame = encode(message);
        for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
            const auto mask = static_cast<std::byte>(1u << (bit % 8));
            frame[bit / 8] ^= mask;
            ASSERT_FALSE(readFrame(frame).ok())
                << nameOf(typeOf(message)) << ", bit " << bit << " flipped";
            frame[bit / 8] ^= mask;
        }
    }
}

TEST(Frame, EveryTruncationAndExtensionIsRefused) {
    for (const Message& message : samples::sampleMessages()) {
        auto frame = encode(message);
        for (std::size_t size = 0; size < frame.size(); ++size) {
            ASSERT_FALSE(readFrame(std::span(frame).first(size)).ok());
        }
        frame.resize(frame.size() + 8);
        ASSERT_FALSE(readFrame(frame).ok());
    }
}

TEST(Frame, AHeaderIsRefusedForWhatIsWrongWithIt) {
    auto frame = encode(Ping{});
    const auto readsAs = [&](std::size_t at, int value) {
        auto bytes = frame;
        bytes[at] = static_cast<std::byte>(value);
        const auto header = readHeader(std::span(bytes).first<headerBytes>());
        return header.ok() ? std::string("accepted") : header.error().message;
    };
    EXPECT_EQ(readsAs(0, 'u'), "accepted");
    EXPECT_EQ(readsAs(0, 'x'), "no frame starts here: the first two bytes are not the magic");
    EXPECT_EQ(readsAs(2, 2), "frame version 2, this program speaks 1");
    EXPECT_EQ(readsAs(3, 14), "message type 14 is unknown");
    EXPECT_EQ(readsAs(4, 25), "Ping: 25 bytes are not a whole number of 8-byte words");
    EXPECT_EQ(readsAs(4, 0), "Ping: 0 bytes are not a whole number of 8-byte words");
    EXPECT_EQ(readsAs(5, 16), "Ping: 4128 bytes, at most 4096");
}

TEST(FrameSplitter, GivesTheSameMessagesHoweverTheStreamIsCut) {
    constexpr std::uint64_t seed = 77;
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    Draw draw(seed);
    for (int round = 0; round < 200; ++round) {
        std::vector<Message> sent;
        for (std::size_t i = 1 + draw.below(8); i > 0; --i) {
            const auto type = static_cast<MessageType>(draw.below(samples::messageTypes));
            sent.push_back(samples::randomMessage(draw, type));
        }
        const auto stream = joined(sent);
        FrameSplitter splitter;
        std::vector<Message> received;
        const std::size_t longest = 1 + draw.below(round % 2 == 0 ? 20 : stream.size());
        for (std::size_t at = 0; at < stream.size();) {
            const std::size_t size = std::min(1 + draw.below(longest), stream.size() - at);
            const Status status = splitter.feed(std::span(stream).subspan(at, size), received);
            ASSERT_TRUE(status.ok()) << reasonOf(status);
            at += size;
        }
        ASSERT_EQ(received, sent);
        EXPECT_EQ(splitter.offset(), stream.size());
        EXPECT_EQ(splitter.buffered(), 0u);
    }
}

TEST(FrameSplitter, HoldsOnlyWhatIsMissingItsEnd) {
    const auto frame = encode(Ping{1, false});
    FrameSplitter splitter;
    std::vector<Message> out;
    for (std::size_t i = 0; i + 1 < frame.size(); ++i) {
        ASSERT_TRUE(splitter.feed(std::span(frame).subspan(i, 1), out).ok());
        ASSERT_EQ(splitter.buffered(), i + 1);
        ASSERT_TRUE(out.empty());
    }
    ASSERT_TRUE(splitter.feed(std::span(frame).last(1), out).ok());
    EXPECT_EQ(out, (std::vector<Message>{Ping{1, false}}));
}

TEST(FrameSplitter, KeepsMessagesBeforeAnErrorAndThenStaysFailed) {
    auto stream = joined({Ping{1, false}, Ping{2, false}, Ping{3, false}});
    stream[2 * 48 + 20] ^= std::byte{1};
    FrameSplitter splitter;
    std::vector<Message> out;
    EXPECT_EQ(reasonOf(splitter.feed(stream, out)),
              "byte 96 of the stream: Ping: the checksum does not match");
    EXPECT_EQ(out.size(), 2u);
    EXPECT_TRUE(splitter.failed());
    EXPECT_EQ(splitter.buffered(), 0u);
    const auto good = encode(Ping{4, false});
    EXPECT_EQ(reasonOf(splitter.feed(good, out)), "the stream has already failed");
    EXPECT_EQ(out.size(), 2u);
}

TEST(FrameSplitter, RefusesALengthFromTheHeaderAloneAndWithoutRoomForIt) {
    auto frame = encode(Ping{});
    frame[7] = std::byte{0x7f};  // 2 GB
    FrameSplitter splitter;
    std::vector<Message> out;
    EXPECT_EQ(reasonOf(splitter.feed(std::span(frame).first(16), out)),
              "byte 0 of the stream: Ping: 2130706464 bytes, at most 4096");
}

TEST(FrameSplitter, GateLowersWhatMayComeByState) {
    struct State {
        bool greeted = false;
    };
    const auto gate = [](MessageType type, std::uint32_t bytes, const void* context) {
        if (static_cast<const State*>(context)->greeted) return true;
        return type == MessageType::Hello && bytes <= 1024;
    };
    State state;
    FrameSplitter splitter(gate, &state);
    std::vector<Message> out;
    Hello hello;
    hello.session = "s";
    ASSERT_TRUE(splitter.feed(encode(hello), out).ok());
    const auto ping = encode(Ping{});
    FrameSplitter fresh(gate, &state);
    EXPECT_EQ(reasonOf(fresh.feed(std::span(ping).first(16), out)),
              "byte 0 of the stream: Ping: 32 bytes are not expected now");
    state.greeted = true;
    EXPECT_TRUE(splitter.feed(ping, out).ok());
}

TEST(FrameSplitter, GateIsAskedOnceAFrame) {
    static int asked;
    asked = 0;
    const auto gate = [](MessageType, std::uint32_t, const void*) {
        ++asked;
        return true;
    };
    FrameSplitter splitter(gate);
    std::vector<Message> out;
    const auto stream = joined({Ping{}, Ping{}});
    for (const std::byte& byte : stream) ASSERT_TRUE(splitter.feed({&byte, 1}, out).ok());
    ASSERT_TRUE(splitter.feed(stream, out).ok());
    EXPECT_EQ(out.size(), 4u);
    EXPECT_EQ(asked, 4);
}

}  // namespace
}  // namespace huestep::protocol
