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

/// Writes the entries of closed ticks of one session, in order, in one append with one sync. A
/// segment that has reached `segmentBytes` is the last with these. Blocks on the disk.
Status appendBatch(protocol::JournalWriter& writer, std::span<const ClosedTick> batch,
                   std::uint64_t segmentBytes = Limits{}.segmentBytes);
/// Writes the snapshot of a closed tick, verified by restoring it. A failure leaves the journal as
/// it is: it goes on without.
Status keepSnapshot(protocol::JournalWriter& writer, const ClosedTick& closed);
/// Both: the entries, then the newest snapshot among them, whose failure is told in `warning`.
Status commitBatch(protocol::JournalWriter& writer, std::span<const ClosedTick> batch,
                   std::string& warning);

/// What became of a batch, or of a snapshot.
struct JournalNews {
    std::string session;
    std::uint64_t commits = 0;  ///< frames below this tick are on disk
    std::optional<std::string> failure;
    std::string warning;
};

/// Snapshots take their time, so one is written only when no entries wait, of any session.
///
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
    Journal* find(const std::string& session);
    void appendAll(Work& work);
    void keepOneSnapshot();
    void publish(std::vector<JournalNews> news);

    std::function<void()> m_wake;
    std::mutex m_mutex;
    std::condition_variable m_changed;
    std::map<std::string, Journal> m_journals;  ///< entries are only touched by the writer's thread
    Work m_waiting;
    std::map<std::string, ClosedTick> m_snapshots;  ///< the newest of each; the writer's thread's
    std::vector<JournalNews> m_news;
    bool m_ending = false;
    std::thread m_thread;
};

}  // namespace huestep::server
