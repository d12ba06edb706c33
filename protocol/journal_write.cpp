#include <algorithm>
#include <utility>

#include "protocol/codec.h"
#include "protocol/journal_format.h"

namespace huestep::protocol {

JournalWriter::JournalWriter(LogStore& store, JournalIdentity identity)
    : m_store(&store), m_identity(std::move(identity)) {}

Result<JournalWriter> JournalWriter::open(LogStore& store, JournalIdentity identity,
                                          const JournalContents& contents, std::uint64_t nextTick) {
    if (!isSessionName(identity.session)) {
        return Error{"a journal needs a session name of 1 to 64 of a-z, 0-9, _ and -"};
    }
    if (Status lock = store.lockForWriting(); !lock) return lock.error();
    const bool empty = contents.segment.empty();
    if (!empty && contents.identity.session != identity.session) {
        return Error{store.describe(contents.segment) + ": is of session " +
                     contents.identity.session + ", not of " + identity.session};
    }
    if (!empty && identity.epoch < contents.identity.epoch) {
        return Error{store.describe(contents.segment) + ": is of epoch " +
                     std::to_string(contents.identity.epoch) + ", epoch " +
                     std::to_string(identity.epoch) + " cannot continue it"};
    }
    if (!empty && nextTick != contents.nextTick) {
        return Error{store.describe(contents.segment) + ": tick " +
                     std::to_string(contents.nextTick) + " is due, not " +
                     std::to_string(nextTick)};
    }
    // Before a newer segment exists: in an older one a torn record is corruption. What was read may
    // never have reached the disk, if the writer died between a write and its sync; whoever goes on
    // from it takes it for committed, so it is synced first.
    if (contents.tornBytes > 0) {
        const Status cut = store.truncate(contents.segment, contents.segmentBytes);
        if (!cut) return cut.error();
    }
    if (!empty) {
        const Status synced = store.sync(contents.segment);
        if (!synced) return synced.error();
    }
    JournalWriter writer(store, std::move(identity));
    writer.m_chain = contents.chain;
    if (Status start = writer.startSegment(nextTick); !start) return start.error();
    return writer;
}

Status JournalWriter::startSegment(std::uint64_t tick) {
    // All or nothing, so that no segment is ever found without its header. A segment of this name
    // can exist only without frames, from a start that never closed a tick.
    const auto header = journal::write(journal::SegmentHeader{m_identity, tick, m_chain});
    const std::string name = journal::segmentName(tick);
    if (Status written = m_store->replace(name, header); !written) return fail(written.error());
    m_segment = name;
    m_segmentBytes = header.size();
    m_segmentSeed = journal::seedOf(header);
    m_chain = m_segmentSeed;
    m_firstTick = tick;
    m_nextTick = tick;
    return Done{};
}

Status JournalWriter::fail(Error error) {
    if (m_failure.empty()) m_failure = error.message;
    return error;
}

Status JournalWriter::append(std::span<const JournalEntry> batch) {
    if (!m_failure.empty()) return Error{"the journal is closed since: " + m_failure};
    if (batch.empty()) return Done{};
    std::vector<std::byte> bytes;
    std::uint64_t tick = m_nextTick;
    std::uint64_t chain = m_chain;
    for (const JournalEntry& entry : batch) {
        const auto* frame = std::get_if<Frame>(&entry.content);
        const std::uint64_t own = frame ? frame->tick : std::get<FullRoot>(entry.content).tick;
        if (frame ? own != tick : own > tick) {
            return Error{m_store->describe(m_segment) + ": an entry of tick " +
                         std::to_string(own) + " cannot follow, tick " + std::to_string(tick) +
                         " is due"};
        }
        if (frame) ++tick;
        journal::write(entry, m_identity.epoch, m_segmentBytes, m_segmentSeed, chain, bytes);
    }
    if (Status written = m_store->append(m_segment, bytes); !written) return fail(written.error());
    if (Status synced = m_store->sync(m_segment); !synced) return fail(synced.error());
    m_segmentBytes += bytes.size();
    m_nextTick = tick;
    m_chain = chain;
    return Done{};
}

Status JournalWriter::writeSnapshot(std::uint64_t tick, std::span<const std::byte> bytes) {
    if (!m_failure.empty()) return Error{"the journal is closed since: " + m_failure};
    const std::string name = journal::snapshotName(tick);
    if (bytes.size() > maxSnapshotBytes) {
        return Error{m_store->describe(name) + ": a snapshot of " + std::to_string(bytes.size()) +
                     " bytes is above " + std::to_string(maxSnapshotBytes)};
    }
    const auto file = journal::wrapSnapshot(tick, bytes);
    if (Status written = m_store->replace(name, file); !written) return written;
    const Result<std::vector<std::uint64_t>> ticks = snapshotTicks(*m_store);
    if (!ticks) return ticks.error();
    for (std::size_t i = 0; i + 2 < ticks->size(); ++i) {
        if ((*ticks)[i] == 0) continue;
        Status removed = m_store->remove(journal::snapshotName((*ticks)[i]));
        if (!removed) return removed;
    }
    return Done{};
}

Status JournalWriter::roll(std::uint64_t tick) {
    if (!m_failure.empty()) return Error{"the journal is closed since: " + m_failure};
    if (tick != m_nextTick) {
        return Error{m_store->describe(m_segment) + ": a segment of tick " + std::to_string(tick) +
                     " cannot follow, tick " + std::to_string(m_nextTick) + " is due"};
    }
    if (m_nextTick == m_firstTick) return Done{};
    return startSegment(tick);
}

}  // namespace huestep::protocol
