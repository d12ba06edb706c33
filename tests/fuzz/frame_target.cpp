/// The frame splitter and the decoder of every message.
///
/// The input is taken twice: as a stream, cut in two ways that must agree; and as one payload,
/// past the checksum that would keep a fuzzer out: byte 0 is the type, bytes 1 to 7 are skipped.
/// The payload is also read by the codec of pages, whose answer must be the library's or stricter.
#include "protocol/flat/flat_codec.h"
#include "protocol/frame.h"
#include "tests/fuzz/target.h"

namespace {

using namespace huestep::protocol;
using huestep::fuzz::require;

struct Outcome {
    std::vector<Message> messages;
    bool failed = false;
};

Outcome split(std::span<const std::byte> stream, std::size_t piece) {
    FrameSplitter splitter;
    Outcome outcome;
    for (std::size_t at = 0; at < stream.size() && !outcome.failed; at += piece) {
        const auto part = stream.subspan(at, std::min(piece, stream.size() - at));
        outcome.failed = !splitter.feed(part, outcome.messages);
        require(splitter.failed() == outcome.failed, "a splitter knows whether it failed");
    }
    return outcome;
}

/// Decode, encode, decode: the same value, and bytes that no longer change.
void decodeTwice(MessageType type, std::span<const std::byte> payload) {
    const auto first = decode(type, payload);
    if (!first) {
        require(!first.error().message.empty(), "a refusal has a sentence");
        return;
    }
    const auto bytes = encode(*first);
    const auto second = readFrame(bytes);
    require(second.ok(), "what was accepted is accepted again");
    require(*second == *first, "a second round trip changes nothing");
    require(encode(*second) == bytes, "equal messages have equal bytes");
}

/// What the codec of pages reads is what the library reads; what it writes, byte for byte.
void decodeFlat(MessageType type, std::span<const std::byte> payload) {
    const auto ours = flat::decode(type, payload);
    if (!ours) {
        require(!ours.error().message.empty(), "a refusal has a sentence");
        return;
    }
    const auto theirs = decode(type, payload);
    require(theirs.ok(), "what pages accept, servers accept");
    require(*ours == *theirs, "both codecs read the same");
    require(flat::encode(*ours) == encode(*ours), "both codecs write the same");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = huestep::fuzz::bytesOf(data, size);
    const Outcome whole = split(bytes, size + 1);
    const Outcome pieces = split(bytes, 7);
    require(whole.messages == pieces.messages && whole.failed == pieces.failed,
            "how a stream is cut does not matter");
    if (size >= 8) {
        const auto type = static_cast<MessageType>(data[0] % 16);
        decodeTwice(type, bytes.subspan(8));
        decodeFlat(type, bytes.subspan(8));
    }
    return 0;
}
