#include "protocol/codec.h"

#include "protocol/by_type.h"
#include "protocol/wire/command_wire.h"
#include "protocol/wire/message_wire.h"

namespace huestep::protocol {

namespace {

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

struct Wire {
    template <class M>
    static std::vector<std::byte> encode(const M& message) {
        using Schema = typename SchemaOf<M>::Type;
        const std::size_t words = 1 + wire::structWords<Schema>() + wire::contentWords(message);
        return wire::writeMessage<Schema>(headerBytes, words,
                                          [&](auto root) { wire::put(root, message); });
    }
    template <class M>
    static Result<Message> decode(MessageType type, std::span<const std::byte> payload) {
        using Schema = typename SchemaOf<M>::Type;
        return wire::readMessage<Schema, Message>(
            nameOf(type), payload,
            [](wire::Reading& in, typename Schema::Reader root) { return wire::read(in, root); });
    }
};

}  // namespace

std::size_t commandBytes(const Command& command) {
    return 8 * (wire::structWords<schema::Command>() + wire::contentWords(command));
}

std::vector<std::byte> encode(const Message& message) {
    return encodeBy<Wire>(message);
}

Result<Message> decode(MessageType type, std::span<const std::byte> payload) {
    return decodeBy<Wire>(type, payload);
}

}  // namespace huestep::protocol
