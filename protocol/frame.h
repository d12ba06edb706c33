/// The frame: a fixed 16-byte header and one payload, the same on TCP, in a WebSocket message, in
/// a datagram and in the journal, so there is one parser and one fuzz target.
///
///   offset 0  u16  magic 0x4875 ("uH" in memory)
///          2  u8   version, 1
///          3  u8   type (MessageType)
///          4  u32  payload bytes, a multiple of 8
///          8  u64  XXH3-64 of bytes 0 to 7 and the 8 bytes of the payload's own XXH3-64
///
/// Numbers are little-endian. Thread rule: pure functions, and a splitter a connection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "protocol/codec.h"

namespace huestep::protocol {

inline constexpr std::size_t headerBytes = 16;

struct Header {
    MessageType type = MessageType::Bye;
    std::uint32_t payloadBytes = 0;
    std::uint64_t checksum = 0;
    std::uint64_t head = 0;  ///< bytes 0 to 7 as they are, which the checksum covers
};

/// Reads and checks a header's 16 bytes: magic, version, type, length against the type's cap.
Result<Header> readHeader(std::span<const std::byte, headerBytes> bytes);

/// Fills in the header of a frame whose payload stands behind `headerBytes` bytes of room.
void writeHeader(MessageType type, std::span<std::byte> frame);

/// Whether the payload is the one the header was made for.
bool checksumHolds(const Header& header, std::span<const std::byte> payload);

/// A whole frame, as a WebSocket message or a journal's record holds it.
Result<Message> readFrame(std::span<const std::byte> frame);

/// Cuts a stream of bytes, in whatever pieces it arrives, into messages. Holds at most one frame
/// and what `feed` was given. After an error it stays failed: the connection must end.
class FrameSplitter {
 public:
    /// Whether a message of this type and size may arrive now; lowers the caps by state. Called
    /// once a frame, as soon as its header is complete and before its payload is waited for.
    using Gate = bool (*)(MessageType type, std::uint32_t payloadBytes, const void* context);
    explicit FrameSplitter(Gate gate = nullptr, const void* context = nullptr);

    /// Takes bytes in; appends complete messages to `out`, also those before an error. The
    /// sentence names the byte of the stream where the bad frame starts, and the reason.
    Status feed(std::span<const std::byte> bytes, std::vector<Message>& out);

    /// Bytes held of a frame that is not complete.
    [[nodiscard]] std::size_t buffered() const { return m_pending.size(); }
    /// Bytes that the frame begun has as far as is known: of its header, or in all.
    [[nodiscard]] std::size_t expected() const { return m_need; }
    /// Bytes of the stream that have become messages: where the next frame starts.
    [[nodiscard]] std::uint64_t offset() const { return m_offset; }
    [[nodiscard]] bool failed() const { return m_failed; }

 private:
    Result<std::size_t> frameSize(std::span<const std::byte> start) const;
    Status take(std::span<const std::byte> frame, std::vector<Message>& out);
    Status fail(const std::string& reason);

    Gate m_gate;
    const void* m_context;
    std::vector<std::byte> m_pending;
    std::size_t m_need = headerBytes;  ///< bytes that `m_pending` is to grow to
    std::uint64_t m_offset = 0;
    bool m_failed = false;
};

}  // namespace huestep::protocol
