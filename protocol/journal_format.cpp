#include "protocol/journal_format.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>

#include "core/state/hash.h"
#include "protocol/bytes.h"
#include "protocol/codec.h"
#include "protocol/frame.h"

namespace huestep::protocol::journal {

namespace {

constexpr std::array<char, 8> segmentMagic{'H', 'S', 'T', 'E', 'P', 'L', 'O', 'G'};
constexpr std::uint32_t segmentVersion = 1;
constexpr std::uint32_t recordMagic = 0x43455248;  // "HREC"
constexpr std::size_t fullRootBytes = 16;
constexpr std::size_t nameOffset = 56;

std::string numbered(const char* format, std::uint64_t tick) {
    std::array<char, 48> name{};
    // The only formats are the two literals below.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    std::snprintf(name.data(), name.size(), format, tick);
#pragma GCC diagnostic pop
    return name.data();
}

std::optional<std::uint64_t> tickBetween(const std::string& name, std::string_view before,
                                         std::string_view after) {
    if (name.size() < before.size() + after.size() || name.rfind(before, 0) != 0) return {};
    const std::string digits =
        name.substr(before.size(), name.size() - before.size() - after.size());
    if (digits.empty() || digits.size() > 19) return {};
    std::uint64_t tick = 0;
    for (const char c : digits) {
        if (c < '0' || c > '9') return {};
        tick = 10 * tick + static_cast<std::uint64_t>(c - '0');
    }
    return tick;
}

std::uint64_t hashWith(std::span<const std::byte> bytes, std::uint64_t number) {
    std::array<std::byte, 64> both{};
    assert(bytes.size() + 8 <= both.size());
    std::copy(bytes.begin(), bytes.end(), both.begin());
    store(std::span(both), bytes.size(), number);
    return hash64(std::span(both).first(bytes.size() + 8));
}

std::vector<std::byte> payloadOf(const JournalEntry& entry) {
    if (const auto* frame = std::get_if<Frame>(&entry.content)) return encode(*frame);
    const auto& full = std::get<FullRoot>(entry.content);
    std::vector<std::byte> bytes(fullRootBytes);
    store(std::span(bytes), 0, full.tick);
    store(std::span(bytes), 8, full.root);
    return bytes;
}

std::uint64_t tickOf(const JournalEntry& entry) {
    return std::visit([](const auto& content) { return content.tick; }, entry.content);
}

}  // namespace

std::string segmentName(std::uint64_t firstTick) {
    return numbered("segment-%012" PRIu64 ".log", firstTick);
}
std::string snapshotName(std::uint64_t tick) {
    return numbered("snapshot-%012" PRIu64 ".snap", tick);
}

std::optional<std::uint64_t> tickOfSegment(const std::string& name) {
    const auto tick = tickBetween(name, "segment-", ".log");
    return tick && segmentName(*tick) == name ? tick : std::nullopt;
}
std::optional<std::uint64_t> tickOfSnapshot(const std::string& name) {
    const auto tick = tickBetween(name, "snapshot-", ".snap");
    return tick && snapshotName(*tick) == name ? tick : std::nullopt;
}

std::array<std::byte, segmentHeaderBytes> write(const SegmentHeader& header) {
    std::array<std::byte, segmentHeaderBytes> bytes{};
    const std::span<std::byte> to(bytes);
    const JournalIdentity& identity = header.identity;
    assert(isSessionName(identity.session));
    store(to, 0, segmentMagic);
    store(to, 8, segmentVersion);
    store(to, 12, identity.epoch);
    store(to, 16, identity.fingerprint.selfTest);
    store(to, 24, identity.fingerprint.schema);
    store(to, 32, identity.fingerprint.scene);
    store(to, 36, static_cast<std::uint32_t>(identity.session.size()));
    store(to, 40, header.firstTick);
    store(to, 48, header.chain);
    std::memcpy(bytes.data() + nameOffset, identity.session.data(), identity.session.size());
    store(to, 120, hash64(to.first(120)));
    return bytes;
}

Result<SegmentHeader> readSegmentHeader(std::span<const std::byte> bytes) {
    if (bytes.size() < segmentHeaderBytes) {
        return Error{"byte 0: " + std::to_string(bytes.size()) +
                     " bytes are too few for a segment's header of 128"};
    }
    if (load<std::array<char, 8>>(bytes, 0) != segmentMagic) {
        return Error{"byte 0: this is no journal segment"};
    }
    if (load<std::uint64_t>(bytes, 120) != hash64(bytes.first(120))) {
        return Error{"byte 0: the segment's header (bytes 0 to 127) is not what was written"};
    }
    if (const auto version = load<std::uint32_t>(bytes, 8); version != segmentVersion) {
        return Error{"byte 8: segment version " + std::to_string(version) +
                     ", this program reads " + std::to_string(segmentVersion)};
    }
    const auto nameBytes = load<std::uint32_t>(bytes, 36);
    SegmentHeader header;
    if (nameBytes <= maxSessionName) {
        const char* name = reinterpret_cast<const char*>(bytes.data() + nameOffset);
        header.identity.session.assign(name, nameBytes);
    }
    if (!isSessionName(header.identity.session)) return Error{"byte 56: no session name"};
    header.identity.epoch = load<std::uint32_t>(bytes, 12);
    header.identity.fingerprint = {load<std::uint64_t>(bytes, 16), load<std::uint64_t>(bytes, 24),
                                   load<std::uint32_t>(bytes, 32)};
    header.firstTick = load<std::uint64_t>(bytes, 40);
    header.chain = load<std::uint64_t>(bytes, 48);
    return header;
}

std::uint64_t seedOf(std::span<const std::byte> segmentHeader) {
    return hash64(segmentHeader.first(segmentHeaderBytes));
}

std::uint64_t nextChain(std::uint64_t chain, std::uint64_t headerHash) {
    std::array<std::byte, 8> before{};
    store(std::span(before), 0, chain);
    const std::uint64_t hash = hashWith(before, headerHash);
    // A record's last word must not read as a block that was never written.
    return hash == 0 ? 1 : hash;
}

void write(const JournalEntry& entry, std::uint32_t epoch, std::uint64_t batchStart,
           std::uint64_t seed, std::uint64_t& chain, std::vector<std::byte>& out) {
    const std::vector<std::byte> payload = payloadOf(entry);
    assert(payload.size() % 8 == 0);
    std::array<std::byte, recordHeaderBytes> header{};
    const std::span<std::byte> to(header);
    store(to, 0, recordMagic);
    store(to, 4, static_cast<std::uint32_t>(payload.size()));
    store(to, 8, tickOf(entry));
    store(to, 16, epoch);
    store(to, 20,
          std::holds_alternative<Frame>(entry.content) ? RecordType::Frame : RecordType::FullRoot);
    store(to, 24, batchStart);
    store(to, 32, hash64(payload));
    const std::uint64_t headerHash = hashWith(to.first(40), seed);
    store(to, 40, headerHash);
    chain = nextChain(chain, headerHash);
    std::array<std::byte, recordTrailerBytes> trailer{};
    store(std::span(trailer), 0, chain);
    out.insert(out.end(), header.begin(), header.end());
    out.insert(out.end(), payload.begin(), payload.end());
    out.insert(out.end(), trailer.begin(), trailer.end());
}

std::optional<RecordHeader> readRecordHeader(std::span<const std::byte> bytes, std::uint64_t seed) {
    if (bytes.size() < recordHeaderBytes || load<std::uint32_t>(bytes, 0) != recordMagic) return {};
    RecordHeader header;
    header.headerHash = load<std::uint64_t>(bytes, 40);
    if (header.headerHash != hashWith(bytes.first(40), seed)) return {};
    header.payloadBytes = load<std::uint32_t>(bytes, 4);
    header.tick = load<std::uint64_t>(bytes, 8);
    header.epoch = load<std::uint32_t>(bytes, 16);
    header.type = load<RecordType>(bytes, 20);
    header.batchStart = load<std::uint64_t>(bytes, 24);
    header.payloadHash = load<std::uint64_t>(bytes, 32);
    const bool fits = header.payloadBytes <= headerBytes + maxPayload(MessageType::Frame) &&
                      header.payloadBytes % 8 == 0;
    return fits ? std::optional(header) : std::nullopt;
}

Result<JournalEntry> readEntry(const RecordHeader& header, std::span<const std::byte> payload) {
    if (header.type == RecordType::FullRoot && payload.size() == fullRootBytes) {
        const FullRoot full{load<std::uint64_t>(payload, 0), load<std::uint64_t>(payload, 8)};
        if (full.tick != header.tick) return Error{"the full root is of another tick"};
        return JournalEntry{header.epoch, full};
    }
    if (header.type != RecordType::Frame) {
        return Error{"a record of type " + std::to_string(static_cast<std::uint32_t>(header.type)) +
                     " and " + std::to_string(payload.size()) + " bytes is unknown"};
    }
    Result<Message> message = readFrame(payload);
    if (!message) return message.error();
    auto* frame = std::get_if<Frame>(&*message);
    if (frame == nullptr || frame->tick != header.tick) {
        return Error{"the record holds no frame of its tick"};
    }
    return JournalEntry{header.epoch, std::move(*frame)};
}

}  // namespace huestep::protocol::journal
