#include "server/log_writer.h"

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

Status commitBatch(protocol::JournalWriter& writer, std::span<const ClosedTick> batch,
                   std::string& warning) {
    std::vector<protocol::JournalEntry> entries;
    const ClosedTick* snapshot = nullptr;
    for (const ClosedTick& closed : batch) {
        entries.insert(entries.end(), closed.entries.begin(), closed.entries.end());
        if (closed.snapshot) snapshot = &closed;
        // A new segment begins exactly behind the tick that asked for it.
        if (closed.newSegment) {
            if (Status appended = writer.append(entries); !appended) return appended;
            entries.clear();
            if (Status rolled = writer.roll(closed.commits); !rolled) return rolled;
        }
    }
    if (!entries.empty()) {
        if (Status appended = writer.append(entries); !appended) return appended;
    }
    if (!snapshot) return Done{};
    Status kept = verify(*snapshot);
    if (kept) kept = writer.writeSnapshot(snapshot->snapshot->tick, snapshot->snapshot->bytes);
    if (!kept) warning = kept.error().message;
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
            m_changed.wait(lock, [this] { return m_ending || !m_waiting.empty(); });
            if (m_waiting.empty()) return;
            work = std::exchange(m_waiting, {});
        }
        std::vector<JournalNews> news = writeAll(work);
        {
            const std::lock_guard lock(m_mutex);
            m_news.insert(m_news.end(), std::make_move_iterator(news.begin()),
                          std::make_move_iterator(news.end()));
        }
        m_wake();
    }
}

std::vector<JournalNews> LogWriter::writeAll(const Work& work) {
    std::vector<JournalNews> out;
    for (const auto& [session, batch] : work) {
        Journal* journal = nullptr;
        {
            const std::lock_guard lock(m_mutex);
            const auto found = m_journals.find(session);
            if (found != m_journals.end()) journal = &found->second;  // a map's places stay put
        }
        if (!journal || journal->failed) continue;
        JournalNews news{session, batch.back().commits, std::nullopt, {}};
        const Status written = commitBatch(journal->writer, batch, news.warning);
        if (!written) {
            journal->failed = true;
            news.failure = written.error().message;
        }
        out.push_back(std::move(news));
    }
    return out;
}

}  // namespace huestep::server
