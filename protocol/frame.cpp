#include "protocol/frame.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/state/hash.h"
#include "protocol/bytes.h"

namespace huestep::protocol {

namespace {

constexpr std::uint16_t magic = 0x4875;
constexpr std::uint8_t frameVersion = 1;
constexpr std::size_t hashedHeaderBytes = 8;

/// XXH3 of the first half of the header, then of that with the payload's own hash: one pass over
/// the payload and no copy, though header and payload may lie apart.
std::uint64_t checksumOf(std::span<const std::byte, hashedHeaderBytes> head,
                         std::span<const std::byte> payload) {
    std::array<std::byte, 2 * hashedHeaderBytes> both{};
    std::copy(head.begin(), head.end(), both.begin());
    store(both, hashedHeaderBytes, hash64(payload));
    return hash64(both);
}

}  // namespace

void writeHeader(MessageType type, std::span<std::byte> frame) {
    const auto payload = frame.subspan(headerBytes);
    store(frame, 0, magic);
    store(frame, 2, frameVersion);
    store(frame, 3, static_cast<std::uint8_t>(type));
    store(frame, 4, static_cast<std::uint32_t>(payload.size()));
    store(frame, 8, checksumOf(frame.first<hashedHeaderBytes>(), payload));
}

Result<Header> readHeader(std::span<const std::byte, headerBytes> bytes) {
    if (load<std::uint16_t>(bytes, 0) != magic) {
        return Error{"no frame starts here: the first two bytes are not the magic"};
    }
    const auto version = load<std::uint8_t>(bytes, 2);
    if (version != frameVersion) {
        return Error{"frame version " + std::to_string(version) + ", this program speaks " +
                     std::to_string(frameVersion)};
    }
    const auto number = load<std::uint8_t>(bytes, 3);
    if (number >= static_cast<std::uint8_t>(MessageType::Count)) {
        return Error{"message type " + std::to_string(number) + " is unknown"};
    }
    Header header;
    header.type = static_cast<MessageType>(number);
    header.payloadBytes = load<std::uint32_t>(bytes, 4);
    header.checksum = load<std::uint64_t>(bytes, 8);
    header.head = load<std::uint64_t>(bytes, 0);
    const std::string name(nameOf(header.type));
    if (header.payloadBytes == 0 || header.payloadBytes % 8 != 0) {
        return Error{name + ": " + std::to_string(header.payloadBytes) +
                     " bytes are not a whole number of 8-byte words"};
    }
    if (header.payloadBytes > maxPayload(header.type)) {
        return Error{name + ": " + std::to_string(header.payloadBytes) + " bytes, at most " +
                     std::to_string(maxPayload(header.type))};
    }
    return header;
}

bool checksumHolds(const Header& header, std::span<const std::byte> payload) {
    std::array<std::byte, hashedHeaderBytes> head{};
    store(head, 0, header.head);
    return payload.size() == header.payloadBytes && checksumOf(head, payload) == header.checksum;
}

Result<Message> readFrame(std::span<const std::byte> frame) {
    if (frame.size() < headerBytes) {
        return Error{std::to_string(frame.size()) + " bytes are too few for a frame's header"};
    }
    const Result<Header> header = readHeader(frame.first<headerBytes>());
    if (!header) return header.error();
    const auto payload = frame.subspan(headerBytes);
    if (payload.size() != header->payloadBytes) {
        return Error{std::string(nameOf(header->type)) + ": " + std::to_string(payload.size()) +
                     " bytes of payload where the header says " +
                     std::to_string(header->payloadBytes)};
    }
    if (!checksumHolds(*header, payload)) {
        return Error{std::string(nameOf(header->type)) + ": the checksum does not match"};
    }
    return decode(header->type, payload);
}

FrameSplitter::FrameSplitter(Gate gate, const void* context) : m_gate(gate), m_context(context) {}

Status FrameSplitter::feed(std::span<const std::byte> bytes, std::vector<Message>& out) {
    if (m_failed) return Error{"the stream has already failed"};
    while (!bytes.empty()) {
        if (m_pending.empty() && bytes.size() >= headerBytes) {
            // A frame that lies whole in the bytes at hand is read there; only a piece is kept.
            const Result<std::size_t> size = frameSize(bytes);
            if (!size) return fail(size.error().message);
            m_need = *size;
            if (*size <= bytes.size()) {
                if (Status status = take(bytes.first(*size), out); !status) return status;
                bytes = bytes.subspan(*size);
                continue;
            }
        }
        const std::size_t piece = std::min(m_need - m_pending.size(), bytes.size());
        m_pending.insert(m_pending.end(), bytes.begin(),
                         bytes.begin() + static_cast<std::ptrdiff_t>(piece));
        bytes = bytes.subspan(piece);
        if (m_pending.size() < m_need) break;
        if (m_need == headerBytes) {
            const Result<std::size_t> size = frameSize(m_pending);
            if (!size) return fail(size.error().message);
            m_need = *size;
            continue;
        }
        if (Status status = take(m_pending, out); !status) return status;
        m_pending.clear();
    }
    return Done{};
}

Result<std::size_t> FrameSplitter::frameSize(std::span<const std::byte> start) const {
    const Result<Header> header = readHeader(start.first<headerBytes>());
    if (!header) return header.error();
    if (m_gate != nullptr && !m_gate(header->type, header->payloadBytes, m_context)) {
        return Error{std::string(nameOf(header->type)) + ": " +
                     std::to_string(header->payloadBytes) + " bytes are not expected now"};
    }
    return headerBytes + header->payloadBytes;
}

Status FrameSplitter::take(std::span<const std::byte> frame, std::vector<Message>& out) {
    Result<Message> message = readFrame(frame);
    if (!message) return fail(message.error().message);
    out.push_back(std::move(message).value());
    m_offset += frame.size();
    m_need = headerBytes;
    return Done{};
}

Status FrameSplitter::fail(const std::string& reason) {
    m_failed = true;
    m_pending.clear();
    m_pending.shrink_to_fit();
    return Error{"byte " + std::to_string(m_offset) + " of the stream: " + reason};
}

}  // namespace huestep::protocol
