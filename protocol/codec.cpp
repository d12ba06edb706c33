#include "protocol/codec.h"

#include <algorithm>
#include <array>
#include <utility>

#include "protocol/frame.h"
#include "protocol/wire/command_wire.h"
#include "protocol/wire/message_wire.h"

namespace huestep::protocol {

namespace {

constexpr std::size_t typeCount = std::variant_size_v<Message>;

template <class M>
struct SchemaOf;
// clang-format off
template <> struct SchemaOf<Hello> { using Type = schema::Hello; };
template <> struct SchemaOf<Welcome> { using Type = schema::Welcome; };
template <> struct SchemaOf<Intent> { using Type = schema::Intent; };
template <> struct SchemaOf<Frame> { using Type = schema::Frame; };
template <> struct SchemaOf<SnapshotBegin> { using Type = schema::SnapshotBegin; };
template <> struct SchemaOf<SnapshotChunk> { using Type = schema::SnapshotChunk; };
template <> struct SchemaOf<SnapshotEnd> { using Type = schema::SnapshotEnd; };
template <> struct SchemaOf<SnapshotRequest> { using Type = schema::SnapshotRequest; };
template <> struct SchemaOf<HashQuery> { using Type = schema::HashQuery; };
template <> struct SchemaOf<HashNodes> { using Type = schema::HashNodes; };
template <> struct SchemaOf<DesyncReport> { using Type = schema::DesyncReport; };
template <> struct SchemaOf<Ping> { using Type = schema::Ping; };
template <> struct SchemaOf<Bye> { using Type = schema::Bye; };
template <> struct SchemaOf<View> { using Type = schema::View; };
// clang-format on

template <class M>
std::vector<std::byte> encodeAs(const M& message) {
    using Schema = typename SchemaOf<M>::Type;
    const std::size_t words = 1 + wire::structWords<Schema>() + wire::contentWords(message);
    return wire::writeMessage<Schema>(headerBytes, words,
                                      [&](auto root) { wire::put(root, message); });
}

template <class M>
Result<Message> decodeAs(MessageType type, std::span<const std::byte> payload) {
    using Schema = typename SchemaOf<M>::Type;
    return wire::readMessage<Schema, Message>(
        nameOf(type), payload,
        [](wire::Reading& in, typename Schema::Reader root) { return wire::read(in, root); });
}

using Decoder = Result<Message> (*)(MessageType, std::span<const std::byte>);

template <std::size_t... I>
constexpr std::array<Decoder, sizeof...(I)> makeDecoders(std::index_sequence<I...>) {
    return {&decodeAs<std::variant_alternative_t<I, Message>>...};
}
constexpr auto decoders = makeDecoders(std::make_index_sequence<typeCount>{});

}  // namespace

std::size_t commandBytes(const Command& command) {
    return 8 * (wire::structWords<schema::Command>() + wire::contentWords(command));
}

std::vector<std::byte> encode(const Message& message) {
    std::vector<std::byte> bytes =
        std::visit([](const auto& content) { return encodeAs(content); }, message);
    writeHeader(typeOf(message), bytes);
    return bytes;
}

Result<Message> decode(MessageType type, std::span<const std::byte> payload) {
    const auto place = static_cast<std::size_t>(type);
    if (place >= decoders.size()) {
        return Error{"message type " + std::to_string(place) + " is unknown"};
    }
    if (payload.size() > maxPayload(type)) {
        return Error{std::string(nameOf(type)) + ": " + std::to_string(payload.size()) +
                     " bytes, at most " + std::to_string(maxPayload(type))};
    }
    return decoders[place](type, payload);
}

}  // namespace huestep::protocol
