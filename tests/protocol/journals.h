/// Journals to test with.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "protocol/journal.h"
#include "protocol/memory_store.h"
#include "tests/protocol/samples.h"

namespace huestep::protocol::journals {

using samples::Draw;

inline const JournalIdentity identity{"sandbox", {11, 22, 1}, 1};
inline const std::string firstSegment = "segment-000000000000.log";

inline JournalEntry frameOf(std::uint64_t tick, Draw& draw) {
    return {1, Frame{tick, samples::randomCommands(draw, 2), {}, draw.bits(), tick / 2}};
}
inline JournalEntry fullRootOf(std::uint64_t tick) {
    return {1, FullRoot{tick, tick * 7}};
}

inline bool same(const JournalEntry& a, const JournalEntry& b) {
    return a.content == b.content;
}

/// Whether `read` is exactly the first `count` of `written`.
inline ::testing::AssertionResult isPrefix(const std::vector<JournalEntry>& read,
                                           const std::vector<JournalEntry>& written,
                                           std::size_t count) {
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

inline JournalWriter openWriter(LogStore& store, JournalIdentity who = identity) {
    const auto contents = readJournal(store);
    EXPECT_TRUE(contents.ok()) << (contents ? "" : contents.error().message);
    who.epoch = std::max(who.epoch, contents->identity.epoch);
    auto writer = JournalWriter::open(store, std::move(who), *contents, contents->nextTick);
    EXPECT_TRUE(writer.ok()) << (writer ? "" : writer.error().message);
    return std::move(writer).value();
}

/// A journal of one segment with `batches` batches of one to three entries, and the entries.
inline std::vector<JournalEntry> fill(LogStore& store, std::size_t batches, std::uint64_t seed,
                                      std::vector<std::size_t>* ends = nullptr) {
    Draw draw(seed);
    JournalWriter writer = openWriter(store);
    std::vector<JournalEntry> all;
    std::uint64_t tick = writer.nextTick();
    for (std::size_t i = 0; i < batches; ++i) {
        std::vector<JournalEntry> batch;
        for (std::size_t k = 1 + draw.below(3); k > 0; --k) batch.push_back(frameOf(tick++, draw));
        if (draw.coin()) batch.push_back(fullRootOf(tick));
        const Status status = writer.append(batch);
        EXPECT_TRUE(status.ok()) << (status ? "" : status.error().message);
        all.insert(all.end(), batch.begin(), batch.end());
        if (ends != nullptr) ends->push_back(static_cast<std::size_t>(writer.segmentBytes()));
    }
    return all;
}

inline std::string reasonOf(const Status& status) {
    return status ? "done" : status.error().message;
}

inline std::string refusalOf(LogStore& store) {
    const auto contents = readJournal(store);
    return contents ? "accepted" : contents.error().message;
}

}  // namespace huestep::protocol::journals
