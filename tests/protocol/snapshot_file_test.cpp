#include "protocol/journal.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/protocol/journals.h"

namespace huestep::protocol {
namespace {

using namespace journals;

std::vector<std::byte> image(std::size_t size, std::uint64_t seed) {
    Draw draw(seed);
    std::vector<std::byte> bytes(size);
    for (auto& byte : bytes) byte = static_cast<std::byte>(draw.below(256));
    return bytes;
}

TEST(JournalSnapshots, ReadBackWholeAtAnySize) {
    MemoryStore store;
    JournalWriter writer = openWriter(store);
    for (const std::size_t size : {0u, 1u, 4'095u, 4'096u, 4'097u, 100'000u}) {
        const auto bytes = image(size, size);
        ASSERT_TRUE(writer.writeSnapshot(0, bytes).ok());
        const auto back = readSnapshot(store, 0);
        ASSERT_TRUE(back.ok()) << back.error().message;
        EXPECT_EQ(*back, bytes);
    }
}

TEST(JournalSnapshots, KeepTheTwoNewestAndTheFirst) {
    MemoryStore store;
    Draw draw(26);
    JournalWriter writer = openWriter(store);
    for (std::uint64_t tick = 0; tick <= 50; ++tick) {
        if (tick % 10 == 0) {
            ASSERT_TRUE(writer.writeSnapshot(tick, image(100, tick)).ok());
        }
        const std::vector<JournalEntry> batch{frameOf(tick, draw)};
        ASSERT_TRUE(writer.append(batch).ok());
    }
    EXPECT_EQ(*snapshotTicks(store), (std::vector<std::uint64_t>{0, 40, 50}));
    EXPECT_EQ(readJournal(store)->snapshotTick, 50u);
}

TEST(JournalSnapshots, AFlippedByteIsRefusedNamingFileAndOffsetAndTheOlderOneTaken) {
    MemoryStore store;
    Draw draw(27);
    JournalWriter writer = openWriter(store);
    ASSERT_TRUE(writer.writeSnapshot(0, image(10'000, 1)).ok());
    const std::vector<JournalEntry> batch{frameOf(0, draw)};
    ASSERT_TRUE(writer.append(batch).ok());
    ASSERT_TRUE(writer.writeSnapshot(1, image(10'000, 2)).ok());
    const std::string name = "snapshot-000000000001.snap";
    auto& bytes = store.bytes(name);
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        bytes[at] ^= std::byte{4};
        const auto refused = readSnapshot(store, 1);
        ASSERT_FALSE(refused.ok()) << "byte " << at;
        ASSERT_EQ(refused.error().message.rfind("memory/" + name + ": byte", 0), 0u);
        if (at % 1'000 == 0) {
            const auto contents = readJournal(store);
            ASSERT_TRUE(contents.ok());
            EXPECT_EQ(contents->snapshotTick, 0u);
            EXPECT_EQ(contents->refusedSnapshots,
                      std::vector<std::string>{refused.error().message});
        }
        bytes[at] ^= std::byte{4};
    }
    bytes[40 + 3 * 8 + 5'000] ^= std::byte{1};
    EXPECT_EQ(readSnapshot(store, 1).error().message,
              "memory/" + name + ": bytes 4160 to 8255 are not what was written");
}

TEST(JournalSnapshots, OfATickTheJournalHasNotReachedAreNotTaken) {
    MemoryStore store;
    JournalWriter writer = openWriter(store);
    ASSERT_TRUE(writer.writeSnapshot(5, image(10, 1)).ok());
    const auto contents = readJournal(store);
    EXPECT_FALSE(contents->snapshotTick.has_value());
    EXPECT_EQ(contents->refusedSnapshots,
              std::vector<std::string>{
                  "memory/snapshot-000000000005.snap: is of a tick after the journal's end"});
}

TEST(JournalSnapshots, AFailureLeavesTheOldOneAndTheLog) {
    MemoryStore store;
    Draw draw(28);
    JournalWriter writer = openWriter(store);
    ASSERT_TRUE(writer.writeSnapshot(0, image(1'000, 1)).ok());
    store.setCapacity(store.totalBytes() + 900);
    EXPECT_EQ(reasonOf(writer.writeSnapshot(0, image(1'000, 2))),
              "memory/snapshot-000000000000.snap: cannot write: No space left on device");
    EXPECT_EQ(*readSnapshot(store, 0), image(1'000, 1));
    const std::vector<JournalEntry> batch{{1, Frame{}}};
    EXPECT_TRUE(writer.append(batch).ok());
}

}  // namespace
}  // namespace huestep::protocol
