/// Messages to bytes and back without Cap'n Proto's library: for WebAssembly, where that cannot be.
///
/// The bytes are the same, and so is what is refused, but for sentences and for encodings that no
/// writer of ours makes: a list that says it has other elements than its schema has is refused
/// here, where the library tries to make the best of it. Thread rule: pure functions.
#pragma once

#include "protocol/codec.h"

namespace huestep::protocol::flat {

/// As `protocol::encode`.
std::vector<std::byte> encode(const Message& message);

/// As `protocol::decode`; but a View, which pages read themselves, is refused.
Result<Message> decode(MessageType type, std::span<const std::byte> payload);

/// As `protocol::commandBytes`.
std::size_t commandBytes(const Command& command);

}  // namespace huestep::protocol::flat
