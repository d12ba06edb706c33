/// Messages to bytes and back.
///
/// Encoding cannot fail for values within the limits below; a message beyond them is encoded all
/// the same, and refused by whoever decodes it. Decoding treats every byte as hostile: it never
/// throws, never reads out of bounds, allocates no more than a small multiple of the input, and
/// answers with a sentence. Bytes: frame header (see frame.h), then exactly one flat Cap'n Proto
/// segment, never packed. Thread rule: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "protocol/messages.h"

namespace huestep::protocol {

/// The place of the message in `Message`, as the header's type. Part of the protocol.
enum class MessageType : std::uint8_t {
    Hello,
    Welcome,
    Intent,
    Frame,
    SnapshotBegin,
    SnapshotChunk,
    SnapshotEnd,
    SnapshotRequest,
    HashQuery,
    HashNodes,
    DesyncReport,
    Ping,
    Bye,
    View,
    Count
};
/// "Hello", "SnapshotChunk"; "unknown" beyond the last.
std::string_view nameOf(MessageType type);
MessageType typeOf(const Message& message);

// Most entries of each list, bytes of each text and highest values, checked by `decode`.
inline constexpr std::size_t maxSessionName = 64;
inline constexpr std::size_t maxTicketBytes = 256;
inline constexpr std::size_t maxByeText = 256;
inline constexpr std::size_t maxReportText = 128;
inline constexpr std::size_t maxRules = 48;
inline constexpr std::size_t maxCommandsPerIntent = 64;
inline constexpr std::size_t maxCommandsPerFrame = 4'096;
inline constexpr std::size_t maxSubstituted = 4'096;
inline constexpr std::size_t maxSpawnBodies = 1'024;
inline constexpr std::size_t maxSpawnJoints = 1'024;
inline constexpr std::size_t maxSnapshotBytes = std::size_t{256} << 20;
inline constexpr std::size_t maxChunkBytes = 60'000;
inline constexpr std::size_t maxLeaves = 4'096;
inline constexpr std::size_t maxScoreText = 128;
inline constexpr std::size_t maxViewBodies = 131'072;
inline constexpr std::size_t maxViewShapes = 262'144;
inline constexpr std::size_t maxViewContacts = 262'144;
inline constexpr std::size_t maxViewJoints = 131'072;
inline constexpr float maxTicksPerSecond = 10'000.0f;  ///< a step of `minStepSeconds`
inline constexpr std::uint32_t maxInputDelay = 600;
inline constexpr std::uint32_t maxQueuedCommands = 65'536;
inline constexpr std::uint32_t minQueuedBytes = 16u << 10;  ///< room for the largest command
inline constexpr std::uint32_t maxQueuedBytes = 16u << 20;

/// Most bytes of a message's payload, by type. A longer one is refused from its header alone.
///
///   Hello          1 KiB    sent by a stranger
///   Intent         16 KiB   64 plain commands take 3 KiB; the largest spawn that a world takes of
///                           a player, 8 bodies, each with 8 polygons of 8 vertices, takes 9 KiB
///   Frame          256 KiB  all a client may have queued; 4,096 plain commands and 4,096
///                           substitutions take 208 KiB. The server budgets by `commandBytes`.
///   SnapshotChunk  64 KiB
///   HashNodes      33 KiB   4,096 leaves
///   View           32 MiB   the limits above, every shape with 8 vertices; comes from the server
///   others         4 KiB    control
std::size_t maxPayload(MessageType type);

/// Bytes that a command takes in an Intent or Frame. The payload of a Frame is at most
/// `frameBytes` + Σ commandBytes + 4 bytes for each substituted player, rounded up to 8.
std::size_t commandBytes(const Command& command);
inline constexpr std::size_t frameBytes = 64;

/// Whether the name is 1 to 64 of [a-z0-9_-].
bool isSessionName(std::string_view name);

/// Header and payload, ready to send or to append to a file.
std::vector<std::byte> encode(const Message& message);

/// A payload whose header has been checked. The sentence of a failure names message and field.
Result<Message> decode(MessageType type, std::span<const std::byte> payload);

}  // namespace huestep::protocol
