/// The frame: a fixed 16-byte header and one payload, the same on TCP, in a WebSocket message, in
/// a datagram and in the journal, so there is one parser and one fuzz target.
///
///   offset 0  u16  magic 0x4875 ("uH" in memory)
///          2  u8   version, 1
///          3  u8   type (MessageType)
///          4  u32  payload bytes, a multiple of 8
///          8  u64  XXH3-64 of bytes 0 to 7 and the payload
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/result.h"
#include "protocol/codec.h"

namespace huestep::protocol {

inline constexpr std::size_t headerBytes = 16;

struct Header {
    MessageType type = MessageType::Bye;
    std::uint32_t payloadBytes = 0;
    std::uint64_t checksum = 0;
};

/// Reads and checks a header's 16 bytes: magic, version, type, length against the type's cap.
Result<Header> readHeader(std::span<const std::byte, headerBytes> bytes);

/// Whether the payload is the one the header was made for.
bool checksumHolds(const Header& header, std::span<const std::byte> payload);

/// Cuts a stream of bytes, in whatever pieces it arrives, into messages. Holds at most one frame
/// and what `feed` was given. After an error it stays failed: the connection must end.
class FrameSplitter {
   public:
    /// `allowed`: whether a message of this type may arrive now; lowers the caps by state.
    using Gate = bool (*)(MessageType type, std::uint32_t payloadBytes, const void* context);
    explicit FrameSplitter(Gate gate = nullptr, const void* context = nullptr);

    /// Takes bytes in; appends complete messages to `out`. The sentence names byte and reason.
    Status feed(std::span<const std::byte> bytes, std::vector<Message>& out);

    [[nodiscard]] std::size_t buffered() const { return m_pending.size(); }
    /// Bytes of the stream taken in so far.
    [[nodiscard]] std::uint64_t offset() const { return m_offset; }

   private:
    Gate m_gate;
    const void* m_context;
    std::vector<std::byte> m_pending;
    std::uint64_t m_offset = 0;
    bool m_failed = false;
};

}  // namespace huestep::protocol
