#include "protocol/journal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "protocol/memory_store.h"
#include "tests/protocol/samples.h"

namespace huestep::protocol {
namespace {

using samples::Draw;

const JournalIdentity identity{"sandbox", {11, 22, 1}, 1};
const std::string firstSegment = "segment-000000000000.log";

JournalEntry frameOf(std::uint64_t tick, Draw& draw) {
    return {1, Frame{tick, samples::randomCommands(draw, 2), {}, draw.bits(), tick / 2}};
}
JournalEntry checkpointOf(std::uint64_t tick) {
    return {1, Checkpoint{tick, tick * 7}};
}

bool same(const JournalEntry& a, const JournalEntry& b) {
    return a.content == b.content;
}

/// Whether `read` is exactly the first `count` of `written`.
::testing::AssertionResult isPrefix(const std::vector<JournalEntry>& read,
                                    const std::vector<JournalEntry>& written, std::size_t count) {
    if (read.size() != count) {
        return ::testing::AssertionFailure() << read.size() << " entries instead of " << count;
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (!same(read[i], written[i])) {
            return ::testing::AssertionFailure() << "entry " << i << " differs";
        }
    }
    return ::testing::AssertionSuccess();
}

JournalWriter openWriter(LogStore& store, JournalIdentity who = identity) {
    const auto contents = readJournal(store);
    EXPECT_TRUE(contents.ok()) << (contents ? "" : contents.error().message);
    who.epoch = std::max(who.epoch, contents->identity.epoch);
    auto writer = JournalWriter::open(store, std::move(who), *contents, contents->nextTick);
    EXPECT_TRUE(writer.ok()) << (writer ? "" : writer.error().message);
    return std::move(writer).value();
}

/// A journal of one segment with `batches` batches of one to three entries, and the entries.
std::vector<JournalEntry> fill(LogStore& store, std::size_t batches, std::uint64_t seed,
                               std::vector<std::size_t>* ends = nullptr) {
    Draw draw(seed);
    JournalWriter writer = openWriter(store);
    std::vector<JournalEntry> all;
    std::uint64_t tick = writer.nextTick();
    for (std::size_t i = 0; i < batches; ++i) {
        std::vector<JournalEntry> batch;
        for (std::size_t k = 1 + draw.below(3); k > 0; --k) batch.push_back(frameOf(tick++, draw));
        if (draw.coin()) batch.push_back(checkpointOf(tick));
        const Status status = writer.append(batch);
        EXPECT_TRUE(status.ok()) << (status ? "" : status.error().message);
        all.insert(all.end(), batch.begin(), batch.end());
        if (ends != nullptr) ends->push_back(static_cast<std::size_t>(writer.segmentBytes()));
    }
    return all;
}

std::string reasonOf(const Status& status) {
    return status ? "done" : status.error().message;
}

std::string refusalOf(LogStore& store) {
    const auto contents = readJournal(store);
    return contents ? "accepted" : contents.error().message;
}

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
                const std::vector<JournalEntry> batch{frameOf(tick, draw), checkpointOf(tick + 1)};
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
        ASSERT_TRUE(store.create(firstSegment).ok());
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
    const std::vector<JournalEntry> batch{{1, Frame{0, {}, {}, 1, 0}}, checkpointOf(1)};
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
    for (std::uint64_t tick = 0; tick < 40; tick += 20) {
        std::vector<JournalEntry> batch;
        for (std::uint64_t k = 0; k < 20; ++k) batch.push_back(frameOf(tick + k, draw));
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
    EXPECT_GE(last->entries.size(), 20u);
    EXPECT_LT(last->entries.size(), 40u);
    EXPECT_TRUE(isPrefix(last->entries, written, last->entries.size()));
}

TEST(JournalWriter, RefusesWhatCannotFollowAndWritesNothing) {
    MemoryStore store;
    Draw draw(18);
    JournalWriter writer = openWriter(store);
    const std::vector<JournalEntry> gap{frameOf(0, draw), frameOf(2, draw)};
    Status status = writer.append(gap);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().message,
              "memory/" + firstSegment + ": an entry of tick 2 cannot follow, tick 1 is due");
    const std::vector<JournalEntry> early{checkpointOf(1)};
    EXPECT_FALSE(writer.append(early).ok());
    EXPECT_FALSE(writer.roll(1).ok());
    const std::vector<JournalEntry> good{frameOf(0, draw), checkpointOf(1)};
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
