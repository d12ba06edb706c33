#include "server/log_writer.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace huestep::server {

namespace {

/// A snapshot that cannot be restored to the root recorded with it must not become the base of
/// a restart.
Status verify(const ClosedTick& closed) {
    const std::string which = "snapshot of tick " + std::to_string(closed.snapshot->tick);
    const Result<World> restored = World::restore(closed.snapshot->bytes);
    if (!restored) return Error{which + ": " + restored.error().message};
    for (const protocol::JournalEntry& entry : closed.entries) {
        const auto* full = std::get_if<protocol::FullRoot>(&entry.content);
        if (!full || full->tick != restored->tick()) continue;
        if (full->root == restored->fullRoot()) return Done{};
        return Error{which + ": restored, its root is not the world's"};
    }
    return Error{which + ": no full root is recorded with it"};
}

}  // namespace

Status appendBatch(protocol::JournalWriter& writer, std::span<const ClosedTick> batch,
                   std::uint64_t segmentBytes) {
    std::vector<protocol::JournalEntry> entries;
    for (const ClosedTick& closed : batch) {
        entries.insert(entries.end(), closed.entries.begin(), closed.entries.end());
        // A new segment begins exactly behind the tick that asked for it.
        if (closed.newSegment) {
            if (Status appended = writer.append(entries); !appended) return appended;
            entries.clear();
            if (Status rolled = writer.roll(closed.commits); !rolled) return rolled;
        }
    }
    if (Status appended = writer.append(entries); !appended) return appended;
    if (writer.segmentBytes() < segmentBytes) return Done{};
    return writer.roll(writer.nextTick());
}

Status keepSnapshot(protocol::JournalWriter& writer, const ClosedTick& closed) {
    if (Status verified = verify(closed); !verified) return verified;
    return writer.writeSnapshot(closed.snapshot->tick, closed.snapshot->bytes);
}

Status commitBatch(protocol::JournalWriter& writer, std::span<const ClosedTick> batch,
                   std::string& warning) {
    if (Status appended = appendBatch(writer, batch); !appended) return appended;
    const auto newest = std::find_if(batch.rbegin(), batch.rend(),
                                     [](const ClosedTick& closed) { return closed.snapshot; });
    if (newest == batch.rend()) return Done{};
    if (const Status kept = keepSnapshot(writer, *newest); !kept) warning = kept.error().message;
    return Done{};
}

LogWriter::LogWriter(std::function<void()> wake)
    : m_wake(std::move(wake)), m_thread([this] { run(); }) {}

LogWriter::~LogWriter() {
    finish();
}

void LogWriter::add(const std::string& session, std::unique_ptr<protocol::LogStore> store,
                    protocol::JournalWriter writer) {
    const std::lock_guard lock(m_mutex);
    m_journals.emplace(session, Journal{std::move(store), std::move(writer)});
}

void LogWriter::write(const std::string& session, ClosedTick closed) {
    {
        const std::lock_guard lock(m_mutex);
        m_waiting[session].push_back(std::move(closed));
    }
    m_changed.notify_one();
}

std::vector<JournalNews> LogWriter::takeNews() {
    const std::lock_guard lock(m_mutex);
    return std::exchange(m_news, {});
}

void LogWriter::finish() {
    {
        const std::lock_guard lock(m_mutex);
        m_ending = true;
    }
    m_changed.notify_one();
    if (m_thread.joinable()) m_thread.join();
}

void LogWriter::run() {
    for (;;) {
        Work work;
        {
            std::unique_lock lock(m_mutex);
            m_changed.wait(
                lock, [this] { return m_ending || !m_waiting.empty() || !m_snapshots.empty(); });
            if (m_waiting.empty() && m_snapshots.empty()) return;
            work = std::exchange(m_waiting, {});
        }
        if (work.empty()) {
            keepOneSnapshot();
        } else {
            appendAll(work);
        }
    }
}

LogWriter::Journal* LogWriter::find(const std::string& session) {
    const std::lock_guard lock(m_mutex);
    const auto found = m_journals.find(session);
    return found == m_journals.end() ? nullptr : &found->second;  // a map's places stay put
}

void LogWriter::publish(std::vector<JournalNews> news) {
    if (news.empty()) return;
    {
        const std::lock_guard lock(m_mutex);
        m_news.insert(m_news.end(), std::make_move_iterator(news.begin()),
                      std::make_move_iterator(news.end()));
    }
    m_wake();
}

void LogWriter::appendAll(Work& work) {
    std::vector<JournalNews> out;
    for (auto& [session, batch] : work) {
        Journal* journal = find(session);
        if (!journal || journal->failed) continue;
        JournalNews news{session, batch.back().commits, std::nullopt, {}};
        if (const Status written = appendBatch(journal->writer, batch); !written) {
            journal->failed = true;
            news.failure = written.error().message;
        }
        out.push_back(std::move(news));
        for (ClosedTick& closed : batch) {
            if (closed.snapshot) m_snapshots.insert_or_assign(session, std::move(closed));
        }
    }
    publish(std::move(out));
}

void LogWriter::keepOneSnapshot() {
    const auto taken = m_snapshots.extract(m_snapshots.begin());
    const std::string& session = taken.key();
    const ClosedTick& closed = taken.mapped();
    Journal* journal = find(session);
    if (!journal || journal->failed) return;
    const Status kept = keepSnapshot(journal->writer, closed);
    if (!kept) publish({{session, closed.commits, std::nullopt, kept.error().message}});
}

}  // namespace huestep::server
