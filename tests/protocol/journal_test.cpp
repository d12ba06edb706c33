#include "protocol/journal.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/protocol/journals.h"

namespace huestep::protocol {
namespace {

using namespace journals;

TEST(Journal, AnEmptyFolderIsAnEmptyJournal) {
    MemoryStore store;
    const auto contents = readJournal(store);
    ASSERT_TRUE(contents.ok());
    EXPECT_TRUE(contents->identity.session.empty());
    EXPECT_TRUE(contents->entries.empty());
    EXPECT_EQ(contents->nextTick, 0u);
    EXPECT_FALSE(contents->snapshotTick.has_value());
}

TEST(Journal, ReadsBackEveryEntryInOrderOverRollsAndRestarts) {
    constexpr std::uint64_t seed = 5;
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    Draw draw(seed);
    MemoryStore store;
    std::vector<JournalEntry> written;
    std::uint64_t tick = 0;
    for (std::uint32_t epoch = 1; epoch <= 4; ++epoch) {
        JournalIdentity who = identity;
        who.epoch = epoch;
        JournalWriter writer = openWriter(store, who);
        for (int roll = 0; roll < 3; ++roll) {
            for (int i = 0; i < 10; ++i) {
                const std::vector<JournalEntry> batch{frameOf(tick, draw), fullRootOf(tick + 1)};
                ++tick;
                ASSERT_TRUE(writer.append(batch).ok());
                written.insert(written.end(), batch.begin(), batch.end());
            }
            ASSERT_TRUE(writer.roll(tick).ok());
        }
    }
    const auto contents = readJournal(store);
    ASSERT_TRUE(contents.ok()) << contents.error().message;
    EXPECT_TRUE(isPrefix(contents->entries, written, written.size()));
    EXPECT_EQ(contents->nextTick, tick);
    EXPECT_EQ(contents->identity.epoch, 4u);
    EXPECT_EQ(contents->identity.session, "sandbox");
    EXPECT_EQ(contents->identity.fingerprint, identity.fingerprint);
    EXPECT_EQ(contents->tornBytes, 0u);
    EXPECT_EQ(contents->entries.front().epoch, 1u);
    EXPECT_EQ(contents->entries.back().epoch, 4u);
}

TEST(Journal, LeavesOutEntriesBelowATickAndDoesNotReadOlderSegments) {
    MemoryStore store;
    Draw draw(6);
    JournalWriter writer = openWriter(store);
    for (std::uint64_t tick = 0; tick < 30; ++tick) {
        const std::vector<JournalEntry> batch{frameOf(tick, draw)};
        ASSERT_TRUE(writer.append(batch).ok());
        if (tick % 10 != 9) continue;
        ASSERT_TRUE(writer.roll(tick + 1).ok());
    }
    const auto contents = readJournal(store, 15);
    ASSERT_TRUE(contents.ok());
    ASSERT_EQ(contents->entries.size(), 15u);
    EXPECT_EQ(std::get<Frame>(contents->entries.front().content).tick, 15u);
    store.bytes(firstSegment)[200] ^= std::byte{1};
    EXPECT_TRUE(readJournal(store, 15).ok());
    EXPECT_FALSE(readJournal(store, 0).ok());
    const auto end = readJournal(store, ~std::uint64_t{0});
    ASSERT_TRUE(end.ok());
    EXPECT_TRUE(end->entries.empty());
    EXPECT_EQ(end->nextTick, 30u);
}

TEST(Journal, ARestartWithoutTicksReplacesTheSegmentThatHoldsNone) {
    MemoryStore store;
    for (std::uint32_t epoch = 1; epoch <= 3; ++epoch) {
        JournalIdentity who = identity;
        who.epoch = epoch;
        openWriter(store, who);
    }
    EXPECT_EQ(store.list()->size(), 1u);
    EXPECT_EQ(readJournal(store)->identity.epoch, 3u);
    const auto entries = fill(store, 2, 7);
    EXPECT_TRUE(isPrefix(readJournal(store)->entries, entries, entries.size()));
}

TEST(Journal, KilledAtAnyByteRecoversExactlyTheWholeRecords) {
    MemoryStore whole;
    std::vector<std::size_t> ends;
    const auto entries = fill(whole, 6, 8, &ends);
    const auto bytes = whole.bytes(firstSegment);
    // Where each record ends, found by asking for every cut at a time when it was whole.
    std::size_t lastCount = 0;
    for (std::size_t cut = 128; cut <= bytes.size(); ++cut) {
        MemoryStore store;
        ASSERT_TRUE(store.replace(firstSegment, {}).ok());
        ASSERT_TRUE(store.append(firstSegment, std::span(bytes).first(cut)).ok());
        const auto contents = readJournal(store);
        ASSERT_TRUE(contents.ok()) << cut << ": " << contents.error().message;
        const std::size_t count = contents->entries.size();
        ASSERT_TRUE(isPrefix(contents->entries, entries, count));
        ASSERT_GE(count, lastCount);
        ASSERT_LE(count, lastCount + 1);
        lastCount = count;
        ASSERT_EQ(contents->segmentBytes + contents->tornBytes, cut);
        ASSERT_EQ(contents->tornFile.empty(), contents->tornBytes == 0);
    }
    EXPECT_EQ(lastCount, entries.size());
    for (const std::size_t end : ends) EXPECT_LE(end, bytes.size());
    EXPECT_EQ(ends.back(), bytes.size());
}

TEST(Journal, GoesOnAfterATornTail) {
    MemoryStore store;
    const auto entries = fill(store, 5, 9);
    store.bytes(firstSegment).resize(store.bytes(firstSegment).size() - 20);
    const auto torn = readJournal(store);
    ASSERT_TRUE(torn.ok());
    ASSERT_GT(torn->tornBytes, 0u);
    EXPECT_EQ(torn->tornFile, "memory/" + firstSegment);
    const std::size_t kept = torn->entries.size();
    const auto more = fill(store, 5, 10);
    const auto contents = readJournal(store);
    ASSERT_TRUE(contents.ok()) << contents.error().message;
    ASSERT_EQ(contents->entries.size(), kept + more.size());
    EXPECT_EQ(contents->tornBytes, 0u);
    EXPECT_TRUE(isPrefix(
        {contents->entries.begin(), contents->entries.begin() + static_cast<std::ptrdiff_t>(kept)},
        entries, kept));
}

TEST(Journal, EveryFlippedByteIsRefusedNamingFileAndOffset) {
    MemoryStore store;
    fill(store, 6, 11);
    auto& bytes = store.bytes(firstSegment);
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        bytes[at] ^= std::byte{0x10};
        const std::string refusal = refusalOf(store);
        ASSERT_EQ(refusal.rfind("memory/" + firstSegment + ": byte ", 0), 0u)
            << "byte " << at << ": " << refusal;
        const std::size_t named = std::stoul(refusal.substr(refusal.find("byte ") + 5));
        ASSERT_LE(named, at);
        // The record that holds the byte: records here are shorter than this.
        ASSERT_LT(at - named, 4'000u) << refusal;
        bytes[at] ^= std::byte{0x10};
    }
    EXPECT_EQ(refusalOf(store), "accepted");
}

TEST(Journal, EveryFlippedBitOfASmallJournalIsRefused) {
    MemoryStore store;
    JournalWriter writer = openWriter(store);
    const std::vector<JournalEntry> batch{{1, Frame{0, {}, {}, 1, 0}}, fullRootOf(1)};
    ASSERT_TRUE(writer.append(batch).ok());
    auto& bytes = store.bytes(firstSegment);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        bytes[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
        ASSERT_NE(refusalOf(store), "accepted") << "bit " << bit;
        bytes[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    }
}

TEST(Journal, AnOlderSegmentMayNotBeTorn) {
    MemoryStore store;
    fill(store, 3, 12);
    fill(store, 3, 13);
    ASSERT_EQ(store.list()->size(), 2u);
    auto& bytes = store.bytes(firstSegment);
    bytes.resize(bytes.size() - 8);
    const std::string refusal = refusalOf(store);
    EXPECT_NE(refusal.find(firstSegment + ": byte "), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("the file ends within a record"), std::string::npos) << refusal;
}

TEST(Journal, ALostSegmentIsNoticed) {
    MemoryStore store;
    Draw draw(14);
    JournalWriter writer = openWriter(store);
    for (std::uint64_t tick = 0; tick < 3; ++tick) {
        const std::vector<JournalEntry> batch{frameOf(tick, draw)};
        ASSERT_TRUE(writer.append(batch).ok());
        ASSERT_TRUE(writer.roll(tick + 1).ok());
    }
    ASSERT_TRUE(store.remove("segment-000000000001.log").ok());
    EXPECT_EQ(refusalOf(store),
              "memory/segment-000000000002.log: byte 40: the segment starts at tick 2 where tick "
              "1 is due");
}

TEST(Journal, ASegmentOfAnotherHistoryIsNoticed) {
    MemoryStore one;
    MemoryStore other;
    for (MemoryStore* store : {&one, &other}) {
        Draw draw(store == &one ? 15 : 16);
        JournalWriter writer = openWriter(*store);
        const std::vector<JournalEntry> first{frameOf(0, draw)};
        ASSERT_TRUE(writer.append(first).ok());
        ASSERT_TRUE(writer.roll(1).ok());
    }
    one.bytes("segment-000000000001.log") = other.bytes("segment-000000000001.log");
    EXPECT_EQ(refusalOf(one),
              "memory/segment-000000000001.log: byte 48: the segment does not continue the one "
              "before it");
    one.bytes(firstSegment) = other.bytes(firstSegment);
    EXPECT_EQ(refusalOf(one), "accepted");
    one.bytes("segment-000000000001.log") = one.bytes(firstSegment);
    EXPECT_EQ(refusalOf(one),
              "memory/segment-000000000001.log: byte 40: the segment starts at tick 0, which is "
              "not what the file is called");
}

TEST(Journal, BlocksLostFromTheLastBatchAreATornTailAndFromAnEarlierOneCorruption) {
    MemoryStore store;
    Draw draw(17);
    JournalWriter writer = openWriter(store);
    std::vector<JournalEntry> written;
    std::vector<std::size_t> ends;
    for (std::uint64_t tick = 0; tick < 60; tick += 30) {
        std::vector<JournalEntry> batch;
        for (std::uint64_t k = 0; k < 30; ++k) batch.push_back(frameOf(tick + k, draw));
        ASSERT_TRUE(writer.append(batch).ok());
        written.insert(written.end(), batch.begin(), batch.end());
        ends.push_back(static_cast<std::size_t>(writer.segmentBytes()));
    }
    const auto whole = store.bytes(firstSegment);
    ASSERT_GT(ends[1] - ends[0], 4'096u);
    const auto lose = [&](std::size_t sector) {
        store.bytes(firstSegment) = whole;
        const auto from = store.bytes(firstSegment).begin();
        std::fill(from + static_cast<std::ptrdiff_t>(512 * sector),
                  from + static_cast<std::ptrdiff_t>(512 * sector + 512), std::byte{0});
        return readJournal(store);
    };
    const auto earlier = lose(ends[0] / 1'024);
    ASSERT_FALSE(earlier.ok());
    EXPECT_NE(earlier.error().message.find(firstSegment + ": byte "), std::string::npos);
    const auto last = lose((ends[0] + ends[1]) / 1'024);
    ASSERT_TRUE(last.ok()) << last.error().message;
    EXPECT_GT(last->tornBytes, 0u);
    EXPECT_GE(last->entries.size(), 30u);
    EXPECT_LT(last->entries.size(), 60u);
    EXPECT_TRUE(isPrefix(last->entries, written, last->entries.size()));
}

TEST(Journal, AFlippedBitBesideABlockThatWasWrittenAsZerosIsNotTakenForATornTail) {
    // Bodies as a scene's defaults are nearly all zeros on the wire.
    MemoryStore store;
    JournalWriter writer = openWriter(store);
    Spawn spawn;
    spawn.bodies.resize(64);
    const std::vector<JournalEntry> batch{{1, Frame{0, {}, {}, 1, 0}},
                                          {1, Frame{1, {{0, 1, spawn}}, {}, 2, 0}}};
    ASSERT_TRUE(writer.append(batch).ok());
    auto& bytes = store.bytes(firstSegment);
    std::size_t zeroBlocks = 0;
    for (std::size_t at = 512; at + 512 <= bytes.size(); at += 512) {
        const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(at);
        zeroBlocks += std::all_of(from, from + 512, [](std::byte b) { return b == std::byte{0}; });
    }
    ASSERT_GT(zeroBlocks, 0u) << "or this test shows nothing";
    ASSERT_EQ(refusalOf(store), "accepted");
    const std::size_t firstRecord = 128;
    const std::size_t secondRecord = 128 + 48 + 16 + 48 + 8;  // a frame without commands between
    for (const std::size_t at : {firstRecord + 1, firstRecord + 50, secondRecord + 5,
                                 secondRecord + 40, bytes.size() - 8, bytes.size() - 1}) {
        bytes[at] ^= std::byte{4};
        EXPECT_NE(refusalOf(store), "accepted") << "byte " << at;
        bytes[at] ^= std::byte{4};
    }
}

}  // namespace
}  // namespace huestep::protocol
