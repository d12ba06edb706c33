/// The journal of a session: an append-only, chained log of frames in segments, with snapshots.
///
/// A journal is a folder: `segment-<first tick, 12 digits>.log`, `snapshot-<tick>.snap`. A segment
/// starts with {magic, version, fingerprint, session, epoch, chain hash so far}; each record is
/// {length, type, tick, epoch, XXH3 of payload, chain hash} and a payload: an encoded Frame, or a
/// Checkpoint with the full root. The chain hash of a record covers all before it.
///
/// Reading and writing of bytes is behind `LogStore`, so that a test can tear, lose, lie and fail.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "protocol/messages.h"

namespace huestep::protocol {

/// The few things a journal needs of a file system, in one folder. Names are plain file names.
/// Every call may fail with a sentence that names the file.
class LogStore {
 public:
    virtual ~LogStore() = default;
    virtual Result<std::vector<std::string>> list() = 0;  ///< sorted
    virtual Result<std::vector<std::byte>> read(const std::string& name) = 0;
    virtual Status create(const std::string& name) = 0;  ///< empty; fails if there; folder synced
    virtual Status append(const std::string& name, std::span<const std::byte> bytes) = 0;
    virtual Status sync(const std::string& name) = 0;  ///< data is on disk on return
    virtual Status truncate(const std::string& name, std::uint64_t size) = 0;
    /// Temporary file, sync, rename, sync of the folder: all or nothing.
    virtual Status replace(const std::string& name, std::span<const std::byte> bytes) = 0;
    virtual Status remove(const std::string& name) = 0;
    [[nodiscard]] virtual std::string describe(const std::string& name) const = 0;  ///< path
};

/// A store in a folder of the file system, created if missing.
Result<std::unique_ptr<LogStore>> openFolder(const std::string& path);

/// Who writes: part of every segment's header.
struct JournalIdentity {
    std::string session;
    Fingerprint fingerprint;
    std::uint32_t epoch = 0;
};

struct JournalEntry {
    std::uint32_t epoch = 0;
    /// A frame of the session, or the full root of the world after a tick.
    std::variant<Frame, Checkpoint> content;
};

/// What reading a journal from its start found.
struct JournalContents {
    JournalIdentity identity;           ///< of the newest segment
    std::vector<JournalEntry> entries;  ///< in order
    /// Bytes after the last whole record of the newest segment that do not form one: a torn tail.
    std::uint64_t tornBytes = 0;
    std::string tornFile;
    std::optional<std::uint64_t> snapshotTick;  ///< newest snapshot that reads back whole
};

/// Reads segments and checks header, checksums and chain. A torn tail of the newest segment is
/// reported; anything else that is wrong is refused with a sentence naming file and offset.
/// `fromTick`: entries below it may be left out.
Result<JournalContents> readJournal(LogStore& store, std::uint64_t fromTick = 0);

/// The bytes of the snapshot of a tick, checked against its name and checksum.
Result<std::vector<std::byte>> readSnapshot(LogStore& store, std::uint64_t tick);

/// Appends to a journal. Not for the loop's thread: calls block on the disk. After the first
/// failure of a sync the writer stays failed for good: what the disk holds is unknown.
class JournalWriter {
 public:
    /// Continues the journal after `contents` (cutting off a torn tail), in a new segment.
    static Result<JournalWriter> open(LogStore& store, JournalIdentity identity,
                                      const JournalContents& contents, std::uint64_t nextTick);

    /// Appends one batch of entries and syncs once. On success they are committed.
    Status append(std::span<const JournalEntry> batch);

    /// Writes a snapshot beside the log; keeps the two newest.
    Status writeSnapshot(std::uint64_t tick, std::span<const std::byte> bytes);

    /// Starts a new segment at this tick.
    Status roll(std::uint64_t tick);

 private:
    JournalWriter(LogStore& store, JournalIdentity identity);
    LogStore* m_store;
    JournalIdentity m_identity;
    std::string m_segment;
    std::uint64_t m_chain = 0;
    bool m_failed = false;
};

}  // namespace huestep::protocol
