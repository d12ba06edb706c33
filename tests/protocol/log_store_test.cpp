#include "protocol/log_store.h"

#include <gtest/gtest.h>

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "protocol/journal.h"
#include "protocol/memory_store.h"

namespace {

/// Paths that `fsync` was called on, if anybody listens; and one where it fails.
std::vector<std::string>* syncedPaths = nullptr;
std::string failingPath;

}  // namespace

// Takes the place of the C library's in this program: which folders reach the disk cannot be told
// otherwise without pulling a plug.
extern "C" int fsync(int file) {
    std::array<char, 4096> path{};
    const std::string link = "/proc/self/fd/" + std::to_string(file);
    const ssize_t length = ::readlink(link.c_str(), path.data(), path.size() - 1);
    if (syncedPaths != nullptr && length > 0) syncedPaths->emplace_back(path.data());
    if (!failingPath.empty() && failingPath == path.data()) {
        errno = EIO;
        return -1;
    }
    return static_cast<int>(::syscall(SYS_fsync, file));
}

namespace huestep::protocol {
namespace {

namespace fs = std::filesystem;

/// A folder of its own that is gone at the end.
class Folder {
 public:
    Folder() {
        std::string name = (fs::temp_directory_path() / "huestep-test-XXXXXX").string();
        m_path = ::mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(m_path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] const std::string& path() const { return m_path; }

 private:
    std::string m_path;
};

std::vector<std::byte> bytesOf(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
    return {bytes.begin(), bytes.end()};
}

std::string reasonOf(const Status& status) {
    return status ? "done" : status.error().message;
}

/// What every store must do, whatever keeps its bytes.
void behavesAsAFolder(LogStore& store, const std::string& path) {
    EXPECT_TRUE(store.list()->empty());
    EXPECT_EQ(reasonOf(store.append("b.log", bytesOf("x"))),
              path + "/b.log: cannot open: No such file or directory");
    EXPECT_EQ(reasonOf(store.replace("b.log", {})), "done");
    EXPECT_EQ(reasonOf(store.append("b.log", bytesOf("one "))), "done");
    EXPECT_EQ(reasonOf(store.append("b.log", bytesOf("two"))), "done");
    EXPECT_EQ(reasonOf(store.sync("b.log")), "done");
    EXPECT_EQ(*store.read("b.log"), bytesOf("one two"));
    EXPECT_EQ(reasonOf(store.truncate("b.log", 3)), "done");
    EXPECT_EQ(reasonOf(store.append("b.log", bytesOf("!"))), "done");
    EXPECT_EQ(*store.read("b.log"), bytesOf("one!"));
    EXPECT_EQ(reasonOf(store.replace("a.snap", bytesOf("first"))), "done");
    EXPECT_EQ(reasonOf(store.replace("a.snap", bytesOf("second, longer"))), "done");
    EXPECT_EQ(*store.read("a.snap"), bytesOf("second, longer"));
    EXPECT_EQ(reasonOf(store.replace("b.log", bytesOf("new"))), "done");
    EXPECT_EQ(reasonOf(store.append("b.log", bytesOf("er"))), "done");
    EXPECT_EQ(*store.read("b.log"), bytesOf("newer"));
    EXPECT_EQ(*store.list(), (std::vector<std::string>{"a.snap", "b.log"}));
    EXPECT_EQ(reasonOf(store.remove("a.snap")), "done");
    EXPECT_EQ(*store.list(), std::vector<std::string>{"b.log"});
    const std::string missing = ": No such file or directory";
    EXPECT_EQ(store.read("a.snap").error().message, path + "/a.snap: cannot open" + missing);
    EXPECT_EQ(reasonOf(store.remove("a.snap")), path + "/a.snap: cannot remove" + missing);
    EXPECT_EQ(reasonOf(store.append("c.log", {})), path + "/c.log: cannot open" + missing);
}

TEST(LogStore, AFolderKeepsFiles) {
    const Folder folder;
    const auto store = openFolder(folder.path());
    ASSERT_TRUE(store.ok()) << store.error().message;
    behavesAsAFolder(**store, folder.path());
}

TEST(LogStore, MemoryKeepsFilesTheSameWay) {
    MemoryStore store("disk");
    behavesAsAFolder(store, "disk");
}

TEST(LogStore, NamesCannotLeaveTheFolder) {
    const Folder folder;
    std::ofstream(fs::path(folder.path()) / "outside.txt") << "secret";
    const auto store = openFolder(folder.path() + "/inside/deeper");
    ASSERT_TRUE(store.ok()) << store.error().message;
    MemoryStore memory;
    for (const std::string& name :
         {std::string("../outside.txt"), std::string("/etc/passwd"), std::string(".."),
          std::string("."), std::string(), std::string(".hidden"), std::string("a/b"),
          std::string("a\0b", 3), std::string(101, 'a')}) {
        const std::string reason = "'" + name + "' is not a plain file name";
        for (LogStore* each : {store->get(), static_cast<LogStore*>(&memory)}) {
            EXPECT_EQ(each->read(name).error().message, reason);
            EXPECT_EQ(reasonOf(each->append(name, {})), reason);
            EXPECT_EQ(reasonOf(each->sync(name)), reason);
            EXPECT_EQ(reasonOf(each->truncate(name, 0)), reason);
            EXPECT_EQ(reasonOf(each->replace(name, {})), reason);
            EXPECT_EQ(reasonOf(each->remove(name)), reason);
        }
    }
    fs::create_symlink("../../outside.txt", folder.path() + "/inside/deeper/link");
    EXPECT_FALSE((*store)->read("link").ok());
    EXPECT_FALSE((*store)->append("link", bytesOf("x")).ok());
    EXPECT_TRUE((*store)->list()->empty());
}

TEST(LogStore, OneStoreAtATimeMayWrite) {
    const Folder folder;
    auto first = openFolder(folder.path());
    const auto second = openFolder(folder.path());
    EXPECT_EQ(reasonOf((*first)->lockForWriting()), "done");
    EXPECT_EQ(reasonOf((*first)->lockForWriting()), "done");
    EXPECT_EQ(reasonOf((*second)->lockForWriting()),
              folder.path() + ": is being written by another server");
    EXPECT_TRUE((*second)->list().ok());
    first->reset();
    EXPECT_EQ(reasonOf((*second)->lockForWriting()), "done");
}

/// Listens to `fsync` while it lives.
struct Listening {
    Listening() { syncedPaths = &paths; }
    ~Listening() {
        syncedPaths = nullptr;
        failingPath.clear();
    }
    std::vector<std::string> paths;
    [[nodiscard]] bool heard(const std::string& path) const {
        return std::find(paths.begin(), paths.end(), path) != paths.end();
    }
};

TEST(LogStore, EveryFolderOnTheWayIsOnDiskBeforeAnythingIsInIt) {
    const Folder folder;
    Listening listening;
    ASSERT_TRUE(openFolder(folder.path() + "/a/b/c/").ok());
    EXPECT_TRUE(listening.heard(folder.path())) << "holds a";
    EXPECT_TRUE(listening.heard(folder.path() + "/a")) << "holds b";
    EXPECT_TRUE(listening.heard(folder.path() + "/a/b")) << "holds c";
    listening.paths.clear();
    ASSERT_TRUE(openFolder(folder.path() + "/a/b/c").ok());
    EXPECT_TRUE(listening.heard(folder.path() + "/a/b")) << "its maker may have died";
}

TEST(LogStore, AFolderThatDoesNotReachTheDiskIsRefused) {
    const Folder folder;
    Listening listening;
    failingPath = folder.path() + "/a";
    const auto store = openFolder(folder.path() + "/a/b");
    ASSERT_FALSE(store.ok());
    EXPECT_EQ(store.error().message, folder.path() +
                                         "/a/b: cannot create the folder: " + folder.path() +
                                         "/a: cannot sync the folder: Input/output error");
    EXPECT_FALSE(openFolder(folder.path() + "/a/b").ok()) << "and not taken for made";
}

TEST(LogStore, AFolderThatCannotBeMadeIsNamed) {
    const Folder folder;
    std::ofstream(fs::path(folder.path()) / "file") << "x";
    const auto store = openFolder(folder.path() + "/file/inside");
    ASSERT_FALSE(store.ok());
    EXPECT_EQ(store.error().message.rfind(folder.path() + "/file/inside: cannot ", 0), 0u);
}

TEST(LogStore, AJournalInAFolderReadsBackAndLeftoversOfAReplaceAreRemoved) {
    const Folder folder;
    const JournalIdentity identity{"s", {}, 1};
    for (std::uint64_t start = 0; start < 3; ++start) {
        const auto store = openFolder(folder.path());
        const auto contents = readJournal(**store);
        ASSERT_TRUE(contents.ok()) << contents.error().message;
        ASSERT_EQ(contents->nextTick, start);
        auto writer = JournalWriter::open(**store, identity, *contents, start);
        ASSERT_TRUE(writer.ok()) << writer.error().message;
        EXPECT_FALSE(fs::exists(fs::path(folder.path()) / "segment-000000000009.log.tmp"));
        const std::vector<JournalEntry> batch{{1, Frame{start, {}, {}, start, 0}}};
        ASSERT_TRUE(writer->append(batch).ok());
        ASSERT_TRUE(writer->writeSnapshot(start, bytesOf("world")).ok());
        std::ofstream(fs::path(folder.path()) / "segment-000000000009.log.tmp") << "half";
    }
    const auto store = openFolder(folder.path());
    const auto contents = readJournal(**store);
    ASSERT_TRUE(contents.ok()) << contents.error().message;
    EXPECT_EQ(contents->entries.size(), 3u);
    EXPECT_EQ(contents->snapshotTick, 2u);
}

}  // namespace
}  // namespace huestep::protocol
