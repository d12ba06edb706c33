/// Messages to bytes and back.
///
/// Encoding cannot fail for values within the limits below. Decoding treats every byte as hostile:
/// it never throws, never reads out of bounds, allocates no more than a small multiple of the
/// input, and answers with a sentence. Bytes: frame header (see frame.h), then exactly one flat
/// Cap'n Proto segment, never packed.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/result.h"
#include "protocol/messages.h"

namespace huestep::protocol {

/// The place of the message in `Message`, as the header's type. Part of the protocol.
enum class MessageType : std::uint8_t {
    Hello, Welcome, Intent, Frame, SnapshotBegin, SnapshotChunk, SnapshotEnd, SnapshotRequest,
    HashQuery, HashNodes, DesyncReport, Ping, Bye, View, Count
};
std::string_view nameOf(MessageType type);

/// Most bytes of a message's payload, by type. A longer one is refused from its header alone.
std::size_t maxPayload(MessageType type);

/// Header and payload, ready to send or to append to a file.
std::vector<std::byte> encode(const Message& message);

/// A payload whose header has been checked. The sentence of a failure names message and field.
Result<Message> decode(MessageType type, std::span<const std::byte> payload);

}  // namespace huestep::protocol
