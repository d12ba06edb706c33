// What is known of each type of message without reading one.
#include <algorithm>
#include <array>

#include "protocol/codec.h"

namespace huestep::protocol {

namespace {

constexpr std::size_t typeCount = std::variant_size_v<Message>;
static_assert(typeCount == static_cast<std::size_t>(MessageType::Count));

struct TypeInfo {
    std::string_view name;
    std::size_t maxPayload;
};

constexpr std::size_t control = 4u << 10;
constexpr std::array<TypeInfo, typeCount> types{{
    {"Hello", 1u << 10},
    {"Welcome", control},
    {"Intent", 16u << 10},
    {"Frame", 256u << 10},
    {"SnapshotBegin", control},
    {"SnapshotChunk", 64u << 10},
    {"SnapshotEnd", control},
    {"SnapshotRequest", control},
    {"HashQuery", control},
    {"HashNodes", 33u << 10},
    {"DesyncReport", control},
    {"Ping", control},
    {"Bye", control},
    {"View", 32u << 20},
}};

}  // namespace

std::string_view nameOf(MessageType type) {
    const auto place = static_cast<std::size_t>(type);
    return place < types.size() ? types[place].name : "unknown";
}

MessageType typeOf(const Message& message) {
    return static_cast<MessageType>(message.index());
}

std::size_t maxPayload(MessageType type) {
    const auto place = static_cast<std::size_t>(type);
    return place < types.size() ? types[place].maxPayload : 0;
}

bool isSessionName(std::string_view name) {
    return !name.empty() && name.size() <= maxSessionName &&
           std::all_of(name.begin(), name.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
           });
}

}  // namespace huestep::protocol
