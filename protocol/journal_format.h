/// The bytes of segments, records and snapshot files. Numbers are little-endian.
///
///   segment header, 128 bytes            record: 48 bytes, payload, 8 bytes
///     0  char[8] "HSTEPLOG"                0  u32  "HREC"
///     8  u32  version, 1                   4  u32  payload bytes, a multiple of 8
///    12  u32  epoch                        8  u64  tick
///    16  u64  fingerprint: self-test      16  u32  epoch
///    24  u64  fingerprint: schema         20  u32  type: 1 Frame, 2 FullRoot
///    32  u32  fingerprint: scene          24  u64  offset of the first record of its batch
///    36  u32  bytes of the session name   32  u64  XXH3 of the payload
///    40  u64  first tick                  40  u64  XXH3 of bytes 0 to 39 and the segment's seed
///    48  u64  chain hash so far           48  payload
///    56  char[64] session name, zeros     48 + payload  u64  chain hash
///   120  u64  XXH3 of bytes 0 to 119
///
/// The seed of a segment is XXH3 of its header. The chain hash of a record is XXH3 of the chain
/// hash before it (at first the seed) and of the hash at its offset 40; so it covers, through the
/// hashes, every byte of the journal up to itself.
///
/// A record starts and ends with bytes that are not zero, so that any block of it which never
/// reached the disk can be told: it reads as zeros.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "protocol/journal.h"

namespace huestep::protocol::journal {

inline constexpr std::size_t segmentHeaderBytes = 128;
inline constexpr std::size_t recordHeaderBytes = 48;
inline constexpr std::size_t recordTrailerBytes = 8;
inline constexpr std::size_t sectorBytes = 512;  ///< what a disk writes whole or not at all

struct SegmentHeader {
    JournalIdentity identity;
    std::uint64_t firstTick = 0;
    std::uint64_t chain = 0;
};

enum class RecordType : std::uint32_t { Frame = 1, FullRoot = 2 };

struct RecordHeader {
    std::uint32_t payloadBytes = 0;
    std::uint64_t tick = 0;
    std::uint32_t epoch = 0;
    RecordType type = RecordType::Frame;
    std::uint64_t batchStart = 0;
    std::uint64_t payloadHash = 0;
    std::uint64_t headerHash = 0;

    [[nodiscard]] std::size_t recordBytes() const {
        return recordHeaderBytes + payloadBytes + recordTrailerBytes;
    }
};

std::string segmentName(std::uint64_t firstTick);
std::string snapshotName(std::uint64_t tick);
/// The tick in the name, if it is exactly the name of a segment or snapshot.
std::optional<std::uint64_t> tickOfSegment(const std::string& name);
std::optional<std::uint64_t> tickOfSnapshot(const std::string& name);

std::array<std::byte, segmentHeaderBytes> write(const SegmentHeader& header);
/// The sentence says which byte is wrong, without the file.
Result<SegmentHeader> readSegmentHeader(std::span<const std::byte> bytes);
std::uint64_t seedOf(std::span<const std::byte> segmentHeader);

/// Appends a record to `out` and moves `chain` on.
void write(const JournalEntry& entry, std::uint32_t epoch, std::uint64_t batchStart,
           std::uint64_t seed, std::uint64_t& chain, std::vector<std::byte>& out);
/// The header at the start of `bytes` if there is one of this segment: magic, hash and sizes hold.
std::optional<RecordHeader> readRecordHeader(std::span<const std::byte> bytes, std::uint64_t seed);
std::uint64_t nextChain(std::uint64_t chain, std::uint64_t headerHash);
/// The payload of a record whose hashes hold.
Result<JournalEntry> readEntry(const RecordHeader& header, std::span<const std::byte> payload);

/// A snapshot's file: {"HSTEPSNP", u32 version, u32 block bytes, u64 tick, u64 image bytes, u64
/// XXH3 of the header before it and the table}, a table of the XXH3 of each block, the image.
std::vector<std::byte> wrapSnapshot(std::uint64_t tick, std::span<const std::byte> image);
/// The sentence says which bytes are wrong, without the file.
Result<std::vector<std::byte>> unwrapSnapshot(std::uint64_t tick, std::span<const std::byte> file);

}  // namespace huestep::protocol::journal
