/// The journal of a session: an append-only, chained log of frames in segments, with snapshots.
///
/// A journal is a folder: `segment-<first tick>.log` and `snapshot-<tick>.snap`, ticks with 12
/// digits. Other files are left alone. A segment starts with {magic, version, epoch, fingerprint,
/// session, first tick, chain hash so far}; each record is {magic, length, tick, epoch, type, start
/// of its batch, XXH3 of payload, hash of this header}, a payload and the chain hash. A payload is
/// an encoded Frame, or a FullRoot. The chain hash of a record covers all
/// before it. Layouts: journal_format.h.
///
/// What a crash may leave and what it may not: a batch is written and synced before the next one
/// starts, so only the last batch of the newest segment can be torn. It shows as a file that ends
/// before its last record does, or as a block of 512 bytes that reads as zeros since it never
/// reached the disk, where its record is wrong. Everything else that is wrong, a flipped bit in the
/// very last record too, is corruption and is refused: nobody can say what else the disk lost. One
/// case cannot be told: if the payload of the last record holds a whole block of zeros as written
/// (a spawn of many default bodies does), a flipped bit in that payload passes for a torn record.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/result.h"
#include "protocol/log_store.h"
#include "protocol/messages.h"

namespace huestep::protocol {

/// Who writes: part of every segment's header.
struct JournalIdentity {
    std::string session;
    Fingerprint fingerprint;
    std::uint32_t epoch = 0;
};

/// The hash of everything in a world after a tick.
struct FullRoot {
    std::uint64_t tick = 0;
    std::uint64_t root = 0;
    friend bool operator==(const FullRoot&, const FullRoot&) = default;
};

struct JournalEntry {
    std::uint32_t epoch = 0;  ///< read: of its segment; written: the writer's own is taken
    std::variant<Frame, FullRoot> content;
};

/// What reading a journal from its start found.
struct JournalContents {
    JournalIdentity identity;           ///< of the newest segment; empty: there is no journal yet
    std::vector<JournalEntry> entries;  ///< in order
    /// Bytes after the last whole record of the newest segment that do not form one: a torn tail.
    std::uint64_t tornBytes = 0;
    std::string tornFile;                       ///< path
    std::optional<std::uint64_t> snapshotTick;  ///< newest that reads back whole, at or below
                                                ///< `nextTick`
    std::vector<std::string> refusedSnapshots;  ///< why newer ones were passed over, for the log

    std::uint64_t nextTick = 0;      ///< of the frame that comes next
    std::string segment;             ///< newest, as a file name
    std::uint64_t segmentBytes = 0;  ///< its whole records and what is before them
    std::uint64_t chain = 0;         ///< that the next segment starts with
};

/// Reads segments and checks headers, checksums, chain and order: frames come tick by tick without
/// a gap. A torn tail of the newest segment is reported; anything else that is wrong is refused
/// with a sentence naming file and offset. `fromTick`: entries below it are left out, and segments
/// that end below it are not even read. An empty folder is an empty journal.
Result<JournalContents> readJournal(LogStore& store, std::uint64_t fromTick = 0);

/// The bytes of the snapshot of a tick, checked against its name and checksums. The sentence of a
/// failure names file and offset.
Result<std::vector<std::byte>> readSnapshot(LogStore& store, std::uint64_t tick);

/// Name of the file that holds the snapshot of a tick.
std::string snapshotFile(std::uint64_t tick);

/// The ticks of the snapshots a folder holds, ascending, whether or not they read back.
Result<std::vector<std::uint64_t>> snapshotTicks(LogStore& store);

/// Appends to a journal. Not for the loop's thread: calls block on the disk. After the first
/// failure of an append or a sync the writer stays failed for good: what the disk holds is unknown.
/// Reopening the journal finds out. The store must outlive the writer.
class JournalWriter {
 public:
    /// Continues the journal after `contents` (cutting off a torn tail), in a new segment. Locks
    /// the folder. `nextTick` must be `contents.nextTick` unless the journal is empty.
    static Result<JournalWriter> open(LogStore& store, JournalIdentity identity,
                                      const JournalContents& contents, std::uint64_t nextTick);

    /// Appends one batch of entries and syncs once. On success they are committed. A frame that is
    /// not the next one is refused before anything is written.
    Status append(std::span<const JournalEntry> batch);

    /// Writes a snapshot beside the log; keeps the two newest, and that of tick 0 from which the
    /// whole journal can be replayed. A failure leaves the log as it is.
    Status writeSnapshot(std::uint64_t tick, std::span<const std::byte> bytes);

    /// Starts a new segment at this tick, which must be the next one. Without frames in the
    /// current segment nothing happens.
    Status roll(std::uint64_t tick);

    [[nodiscard]] std::uint64_t nextTick() const { return m_nextTick; }
    /// Bytes of the current segment, to decide when to `roll`.
    [[nodiscard]] std::uint64_t segmentBytes() const { return m_segmentBytes; }

 private:
    JournalWriter(LogStore& store, JournalIdentity identity);
    Status startSegment(std::uint64_t tick);
    Status fail(Error error);

    LogStore* m_store;
    JournalIdentity m_identity;
    std::string m_segment;
    std::uint64_t m_segmentBytes = 0;
    std::uint64_t m_segmentSeed = 0;  ///< chain hash right after the segment's header
    std::uint64_t m_firstTick = 0;
    std::uint64_t m_nextTick = 0;
    std::uint64_t m_chain = 0;
    std::string m_failure;  ///< the first one's sentence; empty: none
};

}  // namespace huestep::protocol
