/// A message to the coder of its type and back: what every codec of these messages does alike,
/// limits among it.
///
/// A Coder has `static std::vector<std::byte> encode(const M&)`, which leaves `headerBytes` free in
/// front, and `static Result<Message> decode<M>(MessageType, std::span<const std::byte>)`, for each
/// alternative M of `Message`. Thread rule: pure functions.
#pragma once

#include <array>
#include <string>
#include <utility>

#include "protocol/codec.h"
#include "protocol/frame.h"

namespace huestep::protocol {

template <class Coder>
std::vector<std::byte> encodeBy(const Message& message) {
    std::vector<std::byte> bytes =
        std::visit([](const auto& content) { return Coder::encode(content); }, message);
    writeHeader(typeOf(message), bytes);
    return bytes;
}

template <class Coder, std::size_t... I>
Result<Message> decodeAmong(MessageType type, std::span<const std::byte> payload,
                            std::index_sequence<I...>) {
    using Decoder = Result<Message> (*)(MessageType, std::span<const std::byte>);
    static constexpr std::array<Decoder, sizeof...(I)> decoders{
        &Coder::template decode<std::variant_alternative_t<I, Message>>...};
    return decoders[static_cast<std::size_t>(type)](type, payload);
}

/// As `decode` of codec.h says.
template <class Coder>
Result<Message> decodeBy(MessageType type, std::span<const std::byte> payload) {
    if (type >= MessageType::Count) {
        return Error{"message type " + std::to_string(static_cast<std::size_t>(type)) +
                     " is unknown"};
    }
    if (payload.size() > maxPayload(type)) {
        return Error{std::string(nameOf(type)) + ": " + std::to_string(payload.size()) +
                     " bytes, at most " + std::to_string(maxPayload(type))};
    }
    return decodeAmong<Coder>(type, payload,
                              std::make_index_sequence<std::variant_size_v<Message>>{});
}

}  // namespace huestep::protocol
