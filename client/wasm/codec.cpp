// The codec of a page's client: that which needs no library, under the names of the one that does.
#include "protocol/codec.h"

#include "protocol/flat/flat_codec.h"

namespace huestep::protocol {

std::vector<std::byte> encode(const Message& message) {
    return flat::encode(message);
}

Result<Message> decode(MessageType type, std::span<const std::byte> payload) {
    return flat::decode(type, payload);
}

std::size_t commandBytes(const Command& command) {
    return flat::commandBytes(command);
}

}  // namespace huestep::protocol
