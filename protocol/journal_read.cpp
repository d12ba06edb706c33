#include <algorithm>

#include "core/state/hash.h"
#include "protocol/bytes.h"
#include "protocol/journal_format.h"

namespace huestep::protocol {

using journal::RecordHeader;
using journal::SegmentHeader;

namespace {

/// What is wrong with a record.
struct Damage {
    std::string reason;
    bool cutShort = false;  ///< the file ends before the record does
    // Bytes of the file of which some are not what was written; none: no crash explains it.
    std::uint64_t from = 0;
    std::uint64_t end = 0;
};

/// Walks the records of one segment.
struct SegmentWalk {
    std::span<const std::byte> bytes;
    std::uint64_t seed = 0;
    std::uint32_t epoch = 0;
    std::uint64_t chain = 0;
    std::uint64_t nextTick = 0;
    std::uint64_t offset = journal::segmentHeaderBytes;
    bool anyFrame = false;

    Result<RecordHeader> next(Damage& damage);
    Status inOrder(const RecordHeader& record);
};

Error cutShort(Damage& damage, std::string reason) {
    damage = {std::move(reason), true, 0, 0};
    return Error{damage.reason};
}
Error wrong(Damage& damage, std::string reason, std::uint64_t from = 0, std::size_t bytes = 0) {
    damage = {std::move(reason), false, from, from + bytes};
    return Error{damage.reason};
}

/// The record at `offset`, checked against its own hashes and the chain. Does not move on.
Result<RecordHeader> SegmentWalk::next(Damage& damage) {
    const auto rest = bytes.subspan(offset);
    if (rest.size() < journal::recordHeaderBytes) {
        return cutShort(damage, "the file ends within a record's header");
    }
    const auto header = journal::readRecordHeader(rest, seed);
    if (!header) {
        return wrong(damage, "the record's header is not what was written", offset,
                     journal::recordHeaderBytes);
    }
    if (header->recordBytes() > rest.size()) {
        return cutShort(damage, "the file ends within a record of " +
                                    std::to_string(header->recordBytes()) + " bytes");
    }
    const auto payload = rest.subspan(journal::recordHeaderBytes, header->payloadBytes);
    if (hash64(payload) != header->payloadHash) {
        return wrong(damage,
                     "the record's payload (" + std::to_string(payload.size()) +
                         " bytes) is not what was written",
                     offset + journal::recordHeaderBytes, payload.size());
    }
    const std::uint64_t expected = journal::nextChain(chain, header->headerHash);
    const std::size_t trailer = journal::recordHeaderBytes + payload.size();
    if (load<std::uint64_t>(rest, trailer) != expected) {
        return wrong(damage, "the record does not continue the chain of those before it",
                     offset + trailer, journal::recordTrailerBytes);
    }
    if (Status order = inOrder(*header); !order) return wrong(damage, order.error().message);
    return *header;
}

Status SegmentWalk::inOrder(const RecordHeader& record) {
    if (record.epoch != epoch) {
        return Error{"the record is of epoch " + std::to_string(record.epoch) +
                     " in a segment of epoch " + std::to_string(epoch)};
    }
    const bool frame = record.type == journal::RecordType::Frame;
    if (frame ? record.tick != nextTick : record.tick > nextTick) {
        return Error{"the record is of tick " + std::to_string(record.tick) + " where tick " +
                     std::to_string(nextTick) + " is due"};
    }
    return Done{};
}

/// Whether a block of the file that the damage touches reads as zeros, as far as the record at
/// `record` and what follows it have a part in it: it never reached the disk.
bool hasLostSector(std::span<const std::byte> bytes, std::uint64_t record, const Damage& damage) {
    constexpr std::uint64_t block = journal::sectorBytes;
    for (std::uint64_t at = damage.from / block * block; at < damage.end; at += block) {
        const std::uint64_t from = std::max(at, record);
        const std::uint64_t end = std::min<std::uint64_t>(bytes.size(), at + block);
        const auto part = bytes.subspan(from, end - from);
        if (std::all_of(part.begin(), part.end(), [](std::byte b) { return b == std::byte{0}; })) {
            return true;
        }
    }
    return false;
}

/// Whether a record of a batch that started after `from` stands behind it. Such a batch was begun
/// only when all before it was on disk.
bool hasLaterBatch(const SegmentWalk& walk, std::uint64_t from) {
    for (std::uint64_t at = from + 8; at + journal::recordHeaderBytes <= walk.bytes.size();
         at += 8) {
        const auto rest = walk.bytes.subspan(at);
        const auto header = journal::readRecordHeader(rest, walk.seed);
        if (!header || header->batchStart <= from || header->recordBytes() > rest.size()) continue;
        const auto payload = rest.subspan(journal::recordHeaderBytes, header->payloadBytes);
        if (hash64(payload) == header->payloadHash) return true;
    }
    return false;
}

/// Whether an interrupted append explains what is wrong with the record the walk stands at.
bool tornThere(const SegmentWalk& walk, const Damage& damage) {
    if (damage.cutShort) return true;
    return hasLostSector(walk.bytes, walk.offset, damage) && !hasLaterBatch(walk, walk.offset);
}

Error refusal(const LogStore& store, const std::string& name, std::uint64_t offset,
              const std::string& reason) {
    return Error{store.describe(name) + ": byte " + std::to_string(offset) + ": " + reason};
}

/// The header of a segment, which must continue what `contents` holds if there is any.
Result<SegmentHeader> readFittingHeader(const LogStore& store, const std::string& name,
                                        std::span<const std::byte> file,
                                        const JournalContents& contents) {
    Result<SegmentHeader> header = journal::readSegmentHeader(file);
    if (!header) return Error{store.describe(name) + ": " + header.error().message};
    const std::string start = "the segment starts at tick " + std::to_string(header->firstTick);
    if (journal::segmentName(header->firstTick) != name) {
        return refusal(store, name, 40, start + ", which is not what the file is called");
    }
    if (contents.segment.empty()) return header;
    if (header->firstTick != contents.nextTick) {
        return refusal(store, name, 40,
                       start + " where tick " + std::to_string(contents.nextTick) + " is due");
    }
    if (header->chain != contents.chain) {
        return refusal(store, name, 48, "the segment does not continue the one before it");
    }
    if (header->identity.session != contents.identity.session) {
        return refusal(store, name, 56,
                       "the segment is of session " + header->identity.session +
                           ", the one before it of " + contents.identity.session);
    }
    return header;
}

/// Moves the walk over the record it stands at, and keeps its entry unless it is below `fromTick`.
Status takeRecord(SegmentWalk& walk, const RecordHeader& record, std::uint64_t fromTick,
                  std::vector<JournalEntry>& entries) {
    if (record.tick >= fromTick) {
        Result<JournalEntry> entry = journal::readEntry(
            record,
            walk.bytes.subspan(walk.offset + journal::recordHeaderBytes, record.payloadBytes));
        if (!entry) return entry.error();
        entries.push_back(std::move(entry).value());
    }
    walk.chain = journal::nextChain(walk.chain, record.headerHash);
    walk.offset += record.recordBytes();
    if (record.type == journal::RecordType::Frame) {
        walk.anyFrame = true;
        ++walk.nextTick;
    }
    return Done{};
}

/// Reads one segment into `contents`, which stand where the segment before it ended.
Status readSegment(LogStore& store, const std::string& name, bool newest, std::uint64_t fromTick,
                   JournalContents& contents) {
    const Result<std::vector<std::byte>> file = store.read(name);
    if (!file) return file.error();
    Result<SegmentHeader> header = readFittingHeader(store, name, *file, contents);
    if (!header) return header.error();
    SegmentWalk walk{*file, journal::seedOf(*file), header->identity.epoch, 0, header->firstTick};
    walk.chain = walk.seed;
    while (walk.offset < file->size()) {
        Damage damage;
        const Result<RecordHeader> record = walk.next(damage);
        if (!record) {
            if (!newest || !tornThere(walk, damage)) {
                return refusal(store, name, walk.offset, damage.reason);
            }
            contents.tornBytes = file->size() - walk.offset;
            contents.tornFile = store.describe(name);
            break;
        }
        const Status taken = takeRecord(walk, *record, fromTick, contents.entries);
        if (!taken) return refusal(store, name, walk.offset, taken.error().message);
    }
    contents.identity = std::move(header->identity);
    contents.segment = name;
    contents.segmentBytes = walk.offset;
    contents.nextTick = walk.nextTick;
    // A segment without frames is written over by the next one, which has the same name.
    contents.chain = walk.anyFrame ? walk.chain : header->chain;
    return Done{};
}

/// The segments to read, oldest first: not those that end below `fromTick`.
std::vector<std::string> segmentsFrom(const std::vector<std::string>& names,
                                      std::uint64_t fromTick) {
    std::vector<std::pair<std::uint64_t, std::string>> segments;
    for (const std::string& name : names) {
        if (const auto tick = journal::tickOfSegment(name)) segments.emplace_back(*tick, name);
    }
    std::sort(segments.begin(), segments.end());
    std::vector<std::string> kept;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        if (i + 1 < segments.size() && segments[i + 1].first <= fromTick) continue;
        kept.push_back(segments[i].second);
    }
    return kept;
}

}  // namespace

std::string snapshotFile(std::uint64_t tick) {
    return journal::snapshotName(tick);
}

Result<std::vector<std::uint64_t>> snapshotTicks(LogStore& store) {
    const Result<std::vector<std::string>> names = store.list();
    if (!names) return names.error();
    std::vector<std::uint64_t> ticks;
    for (const std::string& name : *names) {
        if (const auto tick = journal::tickOfSnapshot(name)) ticks.push_back(*tick);
    }
    std::sort(ticks.begin(), ticks.end());
    return ticks;
}

Result<std::vector<std::byte>> readSnapshot(LogStore& store, std::uint64_t tick) {
    const std::string name = journal::snapshotName(tick);
    const Result<std::vector<std::byte>> file = store.read(name);
    if (!file) return file.error();
    Result<std::vector<std::byte>> image = journal::unwrapSnapshot(tick, *file);
    if (!image) return Error{store.describe(name) + ": " + image.error().message};
    return image;
}

Result<JournalContents> readJournal(LogStore& store, std::uint64_t fromTick) {
    const Result<std::vector<std::string>> names = store.list();
    if (!names) return names.error();
    const std::vector<std::string> segments = segmentsFrom(*names, fromTick);
    JournalContents contents;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const bool newest = i + 1 == segments.size();
        const Status status = readSegment(store, segments[i], newest, fromTick, contents);
        if (!status) return status.error();
    }
    const Result<std::vector<std::uint64_t>> ticks = snapshotTicks(store);
    if (!ticks) return ticks.error();
    for (auto tick = ticks->rbegin(); tick != ticks->rend() && !contents.snapshotTick; ++tick) {
        if (*tick > contents.nextTick) {
            contents.refusedSnapshots.push_back(store.describe(journal::snapshotName(*tick)) +
                                                ": is of a tick after the journal's end");
            continue;
        }
        const Result<std::vector<std::byte>> image = readSnapshot(store, *tick);
        if (image) {
            contents.snapshotTick = *tick;
        } else {
            contents.refusedSnapshots.push_back(image.error().message);
        }
    }
    return contents;
}

}  // namespace huestep::protocol
