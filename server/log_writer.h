/// The thread that writes journals, so that the loop never waits for a disk.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "protocol/journal.h"
#include "server/hub.h"

namespace huestep::server {

/// Writes closed ticks of one session, in order: all entries in one append with one sync, then the
/// newest snapshot among them, verified by restoring it. Blocks on the disk. A failed snapshot is
/// told in `warning`: the journal goes on without it.
Status commitBatch(protocol::JournalWriter& writer, std::span<const ClosedTick> batch,
                   std::string& warning);

/// What became of a batch.
struct JournalNews {
    std::string session;
    std::uint64_t commits = 0;  ///< frames below this tick are on disk
    std::optional<std::string> failure;
    std::string warning;
};

/// Thread rule: `write`, `takeNews` and `finish` belong to one thread, the loop's; `wake` is called
/// on the writer's.
class LogWriter : public JournalSink {
 public:
    /// `wake`: news are there.
    explicit LogWriter(std::function<void()> wake);
    ~LogWriter() override;
    LogWriter(const LogWriter&) = delete;
    LogWriter& operator=(const LogWriter&) = delete;

    /// Before the first `write` to that session.
    void add(const std::string& session, std::unique_ptr<protocol::LogStore> store,
             protocol::JournalWriter writer);
    void write(const std::string& session, ClosedTick closed) override;
    std::vector<JournalNews> takeNews();
    /// Writes what is left and ends the thread.
    void finish();

 private:
    struct Journal {
        std::unique_ptr<protocol::LogStore> store;
        protocol::JournalWriter writer;
        bool failed = false;  ///< for good: what its disk holds is unknown
    };
    using Work = std::map<std::string, std::vector<ClosedTick>>;

    void run();
    std::vector<JournalNews> writeAll(const Work& work);

    std::function<void()> m_wake;
    std::mutex m_mutex;
    std::condition_variable m_changed;
    std::map<std::string, Journal> m_journals;  ///< entries are only touched by the writer's thread
    Work m_waiting;
    std::vector<JournalNews> m_news;
    bool m_ending = false;
    std::thread m_thread;
};

}  // namespace huestep::server
