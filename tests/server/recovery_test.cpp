// A session that comes back from its folder, and journals that must not be believed.
#include "server/recovery.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>

#include "core/state/hash.h"
#include "desk.h"
#include "protocol/memory_store.h"
#include "server/log_writer.h"

namespace huestep::server {
namespace {

using protocol::MemoryStore;
using test::deskPrint;
using test::deskScene;

struct Life {
    Life(MemoryStore& disk, Limits given, const Scene* scene)
        : store(disk), limits(given), request{"play", deskPrint, scene, ResumeKey{4, 2}, {}} {}

    Status open() {
        Result<RecoveredSession> recovered = recoverSession(store, request);
        if (!recovered) return recovered.error();
        created = recovered->created;
        otherScene = recovered->otherScene;
        Result<protocol::JournalWriter> opened = protocol::JournalWriter::open(
            store, recovered->identity, recovered->contents, recovered->start.world.tick());
        if (!opened) return opened.error();
        writer.emplace(std::move(*opened));
        session.emplace(std::move(recovered->start), limits, second);
        return Done{};
    }
    void play(int ticks, bool save = true) {
        for (int i = 0; i < ticks; ++i) {
            if (session->seats().taken() == 0 && session->tick() == 3) session->seats().join();
            if (session->seats().has(1)) {
                session->queue(
                    1, {0, session->lastSequence(1) + 1,
                        ApplyImpulse{3, {0.1f, 0.8f}, session->world().motions()[2].position}});
            }
            const ClosedTick closed = session->closeTick(second, {});
            if (!save) continue;
            std::string warning;
            ASSERT_TRUE(commitBatch(*writer, {&closed, 1}, warning).ok());
            EXPECT_EQ(warning, "");
            session->committed(closed.commits);
        }
    }

    MemoryStore& store;
    Limits limits;
    RecoveryRequest request;
    bool created = false;
    bool otherScene = false;
    std::optional<protocol::JournalWriter> writer;
    std::optional<Session> session;
};

std::string newest(MemoryStore& disk, const std::string& prefix) {
    std::string out;
    const std::vector<std::string> names = *disk.list();
    for (const std::string& name : names) {
        if (name.rfind(prefix, 0) == 0) out = name;
    }
    return out;
}

Limits often() {
    Limits limits;
    limits.journalSnapshotTicks = 50;
    limits.segmentTicks = 100;
    return limits;
}

TEST(Recovery, RefusesAMethodWhoseBitsDifferFromRunToRun) {
    Scene scene = deskScene();
    scene.method = Method::Locks;
    MemoryStore disk;
    const Status refused = Life(disk, {}, &scene).open();
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().message,
              "session play: its scene is solved by 'locks', whose results differ from run to run; "
              "only deterministic methods are hosted");
    EXPECT_TRUE(disk.list()->empty()) << "nothing is left of it";
    scene.method = Method::Pgs;
    EXPECT_TRUE(Life(disk, {}, &scene).open().ok());
}

TEST(Recovery, AnEmptyFolderStartsFromTheScene) {
    MemoryStore disk;
    const Scene scene = deskScene();
    Life life(disk, {}, &scene);
    ASSERT_TRUE(life.open().ok());
    EXPECT_TRUE(life.created);
    EXPECT_EQ(life.session->tick(), 0u);
    EXPECT_EQ(life.session->epoch(), 1u);
    EXPECT_EQ(life.session->world().fullRoot(), World::create(scene)->fullRoot());
}

TEST(Recovery, AFolderKeepsItsSceneAndSaysSoWhereAnotherIsAskedFor) {
    MemoryStore disk;
    const Scene scene = deskScene();
    {
        Life first(disk, {}, &scene);
        ASSERT_TRUE(first.open().ok());
        EXPECT_FALSE(first.otherScene);
    }
    {
        Life same(disk, {}, &scene);
        ASSERT_TRUE(same.open().ok());
        EXPECT_FALSE(same.otherScene);
    }
    Scene other = scene;
    other.gravity.y = -3.0f;
    Life asked(disk, {}, &other);
    ASSERT_TRUE(asked.open().ok());
    EXPECT_TRUE(asked.otherScene);
    EXPECT_EQ(asked.session->world().fullRoot(), World::create(scene)->fullRoot());
}

TEST(Recovery, WithoutASceneThereIsNothingToStartFrom) {
    MemoryStore disk;
    Life life(disk, {}, nullptr);
    EXPECT_FALSE(life.open().ok());
}

TEST(Recovery, ASessionGoesOnBitForBitWhereverItsJournalEnds) {
    const Scene scene = deskScene();
    for (const int ticks : {0, 1, 49, 50, 51, 99, 100, 101, 230}) {
        MemoryStore disk;
        Life before(disk, often(), &scene);
        ASSERT_TRUE(before.open().ok());
        before.play(ticks);
        const std::uint64_t root = before.session->world().fullRoot();
        Life after(disk, often(), nullptr);  // the folder has its own scene
        const Status opened = after.open();
        ASSERT_TRUE(opened.ok()) << ticks << ": " << opened.error().message;
        EXPECT_FALSE(after.created);
        EXPECT_EQ(after.session->tick(), static_cast<std::uint64_t>(ticks));
        EXPECT_EQ(after.session->world().fullRoot(), root);
        EXPECT_EQ(after.session->epoch(), 2u);
        // And both futures are the same.
        before.play(20, false);
        after.play(20);
        EXPECT_EQ(after.session->world().fullRoot(), before.session->world().fullRoot());
    }
}

TEST(Recovery, SeveralStartsAtOneTickCountTheirEpochs) {
    MemoryStore disk;
    const Scene scene = deskScene();
    for (std::uint32_t epoch = 1; epoch <= 4; ++epoch) {
        Life life(disk, {}, &scene);
        const Status opened = life.open();
        ASSERT_TRUE(opened.ok()) << opened.error().message;
        EXPECT_EQ(life.session->epoch(), epoch);
    }
}

TEST(Recovery, TokensOfBeforeAreGoodAfter) {
    MemoryStore disk;
    const Scene scene = deskScene();
    Life before(disk, {}, &scene);
    ASSERT_TRUE(before.open().ok());
    before.play(10);
    const protocol::ResumeToken token = before.session->seats().issue(1);
    Life after(disk, {}, &scene);
    after.request.freshKey = ResumeKey{7, 7, 7};  // not taken: the folder has a key
    ASSERT_TRUE(after.open().ok());
    EXPECT_EQ(after.session->seats().resume(token, second)->player, 1u);
}

TEST(Recovery, AnotherBuildsJournalIsRefused) {
    MemoryStore disk;
    const Scene scene = deskScene();
    Life before(disk, {}, &scene);
    ASSERT_TRUE(before.open().ok());
    before.play(5);
    Life after(disk, {}, &scene);
    after.request.fingerprint.selfTest = 12;
    const Status opened = after.open();
    ASSERT_FALSE(opened.ok());
    EXPECT_NE(opened.error().message.find("self-test"), std::string::npos);
}

TEST(Recovery, AFrameThatDoesNotFitItsWorldIsRefusedByTick) {
    // A journal that is whole, but whose scene is another: its chain cannot tell, its roots can.
    MemoryStore disk;
    const Scene scene = deskScene();
    Life before(disk, {}, &scene);
    ASSERT_TRUE(before.open().ok());
    before.play(20);
    Scene other = scene;
    other.gravity.y = -9.0f;
    MemoryStore elsewhere;
    Life stranger(elsewhere, {}, &other);
    ASSERT_TRUE(stranger.open().ok());
    disk.bytes(sceneFile) = elsewhere.bytes(sceneFile);
    Life after(disk, {}, &scene);
    const Status opened = after.open();
    ASSERT_FALSE(opened.ok());
    EXPECT_NE(opened.error().message.find("motion root of tick 1 "), std::string::npos)
        << opened.error().message;
}

TEST(Recovery, AFlippedByteInAJournalIsRefusedWithFileAndOffset) {
    const Scene scene = deskScene();
    MemoryStore disk;
    Life before(disk, {}, &scene);
    ASSERT_TRUE(before.open().ok());
    before.play(30);
    const std::string segment = newest(disk, "segment-");
    disk.bytes(segment)[disk.bytes(segment).size() / 2] ^= std::byte{1};
    Life after(disk, {}, &scene);
    const Status opened = after.open();
    ASSERT_FALSE(opened.ok());
    EXPECT_NE(opened.error().message.find(segment), std::string::npos);
}

TEST(Recovery, ADamagedSnapshotIsPassedOverForTheOneBefore) {
    const Scene scene = deskScene();
    MemoryStore disk;
    Life before(disk, often(), &scene);
    ASSERT_TRUE(before.open().ok());
    before.play(120);
    const std::uint64_t root = before.session->world().fullRoot();
    std::vector<std::byte>& bytes = disk.bytes(newest(disk, "snapshot-"));
    bytes[bytes.size() / 2] ^= std::byte{8};
    Life after(disk, often(), &scene);
    ASSERT_TRUE(after.open().ok());
    EXPECT_EQ(after.session->world().fullRoot(), root);
}

TEST(Recovery, ADamagedKeyIsNamed) {
    MemoryStore disk;
    const Scene scene = deskScene();
    Life before(disk, {}, &scene);
    ASSERT_TRUE(before.open().ok());
    disk.bytes(keyFile).pop_back();
    Life after(disk, {}, &scene);
    const Status opened = after.open();
    ASSERT_FALSE(opened.ok());
    EXPECT_NE(opened.error().message.find(keyFile), std::string::npos);
}

TEST(Recovery, NamesThatAreNoPlainFolderAreRefused) {
    for (const char* name : {"", ".", "../up", "Upper", "a b", "a/b"}) {
        EXPECT_FALSE(checkSessionName(name).ok()) << name;
    }
    EXPECT_TRUE(checkSessionName("play-2_x").ok());
    EXPECT_FALSE(checkSessionName(std::string(65, 'a')).ok());
}

// The log writer ---------------------------------------------------------------------------------

TEST(Recovery, ASnapshotThatDoesNotRestoreIsNamedByItsFile) {
    const Scene scene = deskScene();
    MemoryStore disk;
    Life life(disk, {}, &scene);
    ASSERT_TRUE(life.open().ok());
    life.play(5);
    // Whole as a file, and no world.
    ASSERT_TRUE(life.writer->writeSnapshot(5, std::vector<std::byte>(100)).ok());
    Life again(disk, {}, &scene);
    const Status opened = again.open();
    ASSERT_FALSE(opened.ok());
    EXPECT_EQ(opened.error().message.rfind("memory/snapshot-000000000005.snap: ", 0), 0u)
        << opened.error().message;
}

TEST(LogWriter, TellsWhatIsOnDiskAndWritesTheRestAtTheEnd) {
    const Scene scene = deskScene();
    auto store = std::make_unique<MemoryStore>();
    MemoryStore& disk = *store;
    Life life(disk, {}, &scene);
    ASSERT_TRUE(life.open().ok());
    LogWriter writer([] {});
    writer.add("play", std::move(store), std::move(*life.writer));
    for (int i = 0; i < 50; ++i) writer.write("play", life.session->closeTick(second, {}));
    writer.write("play", life.session->finalRecord());
    writer.finish();
    std::uint64_t commits = 0;
    for (const JournalNews& news : writer.takeNews()) {
        EXPECT_FALSE(news.failure.has_value());
        EXPECT_EQ(news.warning, "");
        EXPECT_GE(news.commits, commits);
        commits = news.commits;
    }
    EXPECT_EQ(commits, 50u);
    const Result<protocol::JournalContents> journal = protocol::readJournal(disk);
    ASSERT_TRUE(journal.ok());
    EXPECT_EQ(journal->nextTick, 50u);
    EXPECT_EQ(journal->snapshotTick, 50u);
}

/// A disk whose changes wait while it is shut.
class GatedStore : public MemoryStore {
 public:
    explicit GatedStore(const std::string& path) : MemoryStore(path) {}
    Status append(const std::string& name, std::span<const std::byte> bytes) override {
        wait(m_appendsShut);
        return MemoryStore::append(name, bytes);
    }
    Status replace(const std::string& name, std::span<const std::byte> bytes) override {
        if (name.ends_with(".snap")) wait(m_snapshotsShut);
        return MemoryStore::replace(name, bytes);
    }
    void shut(bool appends, bool snapshots) {
        const std::lock_guard lock(m_mutex);
        m_appendsShut = appends;
        m_snapshotsShut = snapshots;
        m_changed.notify_all();
    }
    void awaitCaller() {
        std::unique_lock lock(m_mutex);
        m_changed.wait(lock, [this] { return m_inside; });
    }

 private:
    void wait(const bool& shut) {
        std::unique_lock lock(m_mutex);
        m_inside = true;
        m_changed.notify_all();
        m_changed.wait(lock, [&] { return !shut; });
        m_inside = false;
    }
    std::mutex m_mutex;
    std::condition_variable m_changed;
    bool m_appendsShut = false;
    bool m_snapshotsShut = false;
    bool m_inside = false;
};

TEST(LogWriter, ASnapshotOfOneSessionHoldsUpNoCommitOfAnother) {
    const Scene scene = deskScene();
    std::mutex mutex;
    std::condition_variable woken;
    int wakes = 0;
    LogWriter writer([&] {
        const std::lock_guard lock(mutex);
        ++wakes;
        woken.notify_all();
    });
    std::map<std::string, GatedStore*> disks;
    std::map<std::string, std::unique_ptr<Life>> lives;
    for (const std::string name : {"a", "b"}) {
        auto store = std::make_unique<GatedStore>(name);
        disks[name] = store.get();
        lives[name] = std::make_unique<Life>(*store, Limits{}, &scene);
        ASSERT_TRUE(lives[name]->open().ok());
        writer.add(name, std::move(store), std::move(*lives[name]->writer));
    }
    // Holds the writer's thread, so that it finds the snapshot of one and the tick of both at once.
    disks["a"]->shut(true, true);
    writer.write("a", lives["a"]->session->closeTick(second, {}));
    disks["a"]->awaitCaller();
    ClosedTick last = lives["a"]->session->closeTick(second, {});
    const ClosedTick record = lives["a"]->session->finalRecord();
    last.entries.insert(last.entries.end(), record.entries.begin(), record.entries.end());
    last.snapshot = record.snapshot;
    writer.write("a", std::move(last));
    writer.write("b", lives["b"]->session->closeTick(second, {}));
    disks["a"]->shut(false, true);
    std::vector<std::string> committed;
    {
        std::unique_lock lock(mutex);
        woken.wait_for(lock, std::chrono::seconds(10), [&] { return wakes >= 2; });
    }
    for (const JournalNews& news : writer.takeNews()) committed.push_back(news.session);
    EXPECT_EQ(committed, (std::vector<std::string>{"a", "a", "b"})) << "with the snapshot to come";
    disks["a"]->shut(false, false);
    writer.finish();
}

TEST(LogWriter, ASegmentThatHasReachedItsSizeIsFollowedByAnother) {
    const Scene scene = deskScene();
    MemoryStore disk;
    Life life(disk, {}, &scene);
    ASSERT_TRUE(life.open().ok());
    for (int i = 0; i < 60; ++i) {
        const ClosedTick closed = life.session->closeTick(second, {});
        ASSERT_TRUE(appendBatch(*life.writer, {&closed, 1}, 1'000).ok());
    }
    std::size_t segments = 0;
    const std::vector<std::string> names = *disk.list();
    for (const std::string& name : names) {
        if (name.rfind("segment-", 0) != 0) continue;
        ++segments;
        EXPECT_LE(disk.bytes(name).size(), 1'000u + 200u) << name << ": one frame more at most";
    }
    EXPECT_GT(segments, 5u);
    const auto journal = protocol::readJournal(disk);
    ASSERT_TRUE(journal.ok()) << journal.error().message;
    EXPECT_EQ(journal->nextTick, 60u);
}

TEST(LogWriter, AFullDiskFailsTheJournalForGood) {
    const Scene scene = deskScene();
    auto store = std::make_unique<MemoryStore>();
    MemoryStore& disk = *store;
    Life life(disk, {}, &scene);
    ASSERT_TRUE(life.open().ok());
    disk.setCapacity(disk.totalBytes() + 1'000);
    LogWriter writer([] {});
    writer.add("play", std::move(store), std::move(*life.writer));
    for (int i = 0; i < 100; ++i) writer.write("play", life.session->closeTick(second, {}));
    writer.finish();
    int failures = 0;
    for (const JournalNews& news : writer.takeNews()) failures += news.failure.has_value();
    EXPECT_EQ(failures, 1);
}

TEST(LogWriter, ASnapshotThatDoesNotRestoreToItsRootIsNotWritten) {
    const Scene scene = deskScene();
    MemoryStore disk;
    Life life(disk, {}, &scene);
    ASSERT_TRUE(life.open().ok());
    life.play(5);
    ClosedTick record = life.session->finalRecord();
    std::get<protocol::FullRoot>(record.entries.back().content).root ^= 1;
    std::string warning;
    ASSERT_TRUE(commitBatch(*life.writer, {&record, 1}, warning).ok());
    EXPECT_NE(warning, "");
    EXPECT_EQ(protocol::readJournal(disk)->snapshotTick, std::nullopt);
}

}  // namespace
}  // namespace huestep::server
