#include "protocol/journal.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/protocol/journals.h"

namespace huestep::protocol {
namespace {

using namespace journals;

TEST(JournalWriter, RefusesWhatCannotFollowAndWritesNothing) {
    MemoryStore store;
    Draw draw(18);
    JournalWriter writer = openWriter(store);
    const std::vector<JournalEntry> gap{frameOf(0, draw), frameOf(2, draw)};
    Status status = writer.append(gap);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().message,
              "memory/" + firstSegment + ": an entry of tick 2 cannot follow, tick 1 is due");
    const std::vector<JournalEntry> early{fullRootOf(1)};
    EXPECT_FALSE(writer.append(early).ok());
    EXPECT_FALSE(writer.roll(1).ok());
    const std::vector<JournalEntry> good{frameOf(0, draw), fullRootOf(1)};
    EXPECT_TRUE(writer.append(good).ok());
    EXPECT_TRUE(writer.append({}).ok());
    EXPECT_EQ(readJournal(store)->entries.size(), 2u);
}

TEST(JournalWriter, OpensOnlyWhatItMayContinue) {
    MemoryStore store;
    fill(store, 2, 19);
    const auto contents = readJournal(store);
    const auto reason = [&](const JournalIdentity& who, std::uint64_t tick) {
        const auto writer = JournalWriter::open(store, who, *contents, tick);
        return writer ? "opened" : writer.error().message;
    };
    JournalIdentity other = identity;
    other.session = "elsewhere";
    EXPECT_EQ(reason(other, contents->nextTick),
              "memory/" + firstSegment + ": is of session sandbox, not of elsewhere");
    other = identity;
    other.epoch = 0;
    EXPECT_EQ(reason(other, contents->nextTick),
              "memory/" + firstSegment + ": is of epoch 1, epoch 0 cannot continue it");
    EXPECT_EQ(reason(identity, contents->nextTick + 1),
              "memory/" + firstSegment + ": tick " + std::to_string(contents->nextTick) +
                  " is due, not " + std::to_string(contents->nextTick + 1));
    other.session = "no/name";
    EXPECT_EQ(reason(other, 0), "a journal needs a session name of 1 to 64 of a-z, 0-9, _ and -");
    EXPECT_EQ(reason(identity, contents->nextTick), "opened");
}

TEST(JournalWriter, StaysFailedAfterASyncThatFailed) {
    MemoryStore store;
    Draw draw(20);
    JournalWriter writer = openWriter(store);
    const std::vector<JournalEntry> first{frameOf(0, draw)};
    const std::vector<JournalEntry> second{frameOf(1, draw)};
    ASSERT_TRUE(writer.append(first).ok());
    store.setFailingSyncs(true);
    const Status failed = writer.append(second);
    ASSERT_FALSE(failed.ok());
    const std::string reason = "memory/" + firstSegment + ": cannot sync: Input/output error";
    EXPECT_EQ(failed.error().message, reason);
    store.setFailingSyncs(false);
    const std::string closed = "the journal is closed since: " + reason;
    EXPECT_EQ(reasonOf(writer.append(second)), closed);
    EXPECT_EQ(reasonOf(writer.roll(1)), closed);
    EXPECT_EQ(reasonOf(writer.writeSnapshot(1, {})), closed);
    store.crash(21);
    const auto contents = readJournal(store);
    ASSERT_TRUE(contents.ok()) << contents.error().message;
    EXPECT_GE(contents->entries.size(), 1u);
}

TEST(JournalWriter, AFullDiskFailsTheAppendAndLosesNothingCommitted) {
    MemoryStore store;
    Draw draw(22);
    JournalWriter writer = openWriter(store);
    std::vector<JournalEntry> committed;
    store.setCapacity(3'000);
    for (std::uint64_t tick = 0;; ++tick) {
        const std::vector<JournalEntry> batch{frameOf(tick, draw)};
        const Status status = writer.append(batch);
        if (!status) {
            EXPECT_EQ(status.error().message,
                      "memory/" + firstSegment + ": cannot write: No space left on device");
            break;
        }
        committed.push_back(batch[0]);
        ASSERT_LT(tick, 1'000u) << "the disk never filled up";
    }
    const auto contents = readJournal(store);
    ASSERT_TRUE(contents.ok()) << contents.error().message;
    EXPECT_TRUE(isPrefix(contents->entries, committed, committed.size()));
    store.setCapacity({});
    fill(store, 3, 23);
    EXPECT_EQ(refusalOf(store), "accepted");
}

TEST(JournalWriter, KilledAtAnyChangeLosesNothingCommittedAndCanGoOn) {
    constexpr std::uint64_t seed = 24;
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    for (std::uint64_t round = 0; round < 400; ++round) {
        Draw draw(seed + round);
        MemoryStore store;
        std::vector<JournalEntry> sent;
        std::size_t committed = 0;
        std::uint32_t epoch = 0;
        for (int start = 0; start < 4; ++start) {
            const auto contents = readJournal(store);
            ASSERT_TRUE(contents.ok()) << "round " << round << ": " << contents.error().message;
            ASSERT_GE(contents->entries.size(), committed) << "round " << round;
            ASSERT_TRUE(isPrefix(contents->entries, sent, contents->entries.size()));
            sent.resize(contents->entries.size());
            committed = sent.size();
            store.dieAfter(draw.below(25));
            JournalIdentity who = identity;
            who.epoch = ++epoch;
            auto writer = JournalWriter::open(store, who, *contents, contents->nextTick);
            for (std::uint64_t tick = contents->nextTick; writer; ++tick) {
                std::vector<JournalEntry> batch;
                for (std::size_t k = draw.below(4); k > 0; --k) {
                    batch.push_back(frameOf(tick++, draw));
                }
                batch.push_back(frameOf(tick, draw));
                sent.insert(sent.end(), batch.begin(), batch.end());
                if (!writer->append(batch)) break;
                committed = sent.size();
                if (draw.below(3) == 0 && !writer->roll(tick + 1)) break;
                if (draw.below(3) == 0 && !writer->writeSnapshot(tick + 1, {})) break;
            }
            store.crash(draw.bits());
        }
    }
}

TEST(JournalWriter, WhatAProcessReadAndWentOnFromOutlivesThePowerEvenIfItsWriterDiedUnsynced) {
    constexpr std::uint64_t seed = 2'700;
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    for (std::uint64_t round = 0; round < 100; ++round) {
        MemoryStore store;
        Draw draw(seed + round);
        std::vector<JournalEntry> known = fill(store, 1 + draw.below(3), seed + round);
        {
            JournalWriter writer = openWriter(store);
            store.dieAfter(1);  // the append is complete, its sync is not
            const std::vector<JournalEntry> batch{frameOf(writer.nextTick(), draw)};
            ASSERT_FALSE(writer.append(batch).ok());
            known.push_back(batch[0]);
            store.revive();  // the process starts again; the system has been up all the time
        }
        const auto contents = readJournal(store);
        ASSERT_TRUE(contents.ok()) << contents.error().message;
        ASSERT_TRUE(isPrefix(contents->entries, known, known.size()));
        JournalWriter writer = openWriter(store);
        const std::vector<JournalEntry> next{frameOf(writer.nextTick(), draw)};
        if (draw.coin()) {
            ASSERT_TRUE(writer.append(next).ok());
            known.push_back(next[0]);
        }
        store.crash(draw.bits());
        const auto after = readJournal(store);
        ASSERT_TRUE(after.ok()) << "round " << round << ": " << after.error().message;
        ASSERT_TRUE(isPrefix(after->entries, known, known.size())) << "round " << round;
    }
}

TEST(JournalWriter, ALyingDiskIsNoticedOrLosesOnlyTheEnd) {
    // Nothing can save what a disk lied about; but what is read is a true beginning, or refused.
    for (std::uint64_t round = 0; round < 200; ++round) {
        MemoryStore store;
        store.setLyingSyncs(true);
        const auto entries = fill(store, 6, 25 + round);
        store.crash(round);
        const auto contents = readJournal(store);
        if (!contents) {
            ASSERT_EQ(contents.error().message.rfind("memory/segment-", 0), 0u);
            continue;
        }
        ASSERT_TRUE(isPrefix(contents->entries, entries, contents->entries.size()));
    }
}

}  // namespace
}  // namespace huestep::protocol
