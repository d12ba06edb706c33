#include "protocol/journal_format.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/state/hash.h"
#include "protocol/bytes.h"
#include "protocol/memory_store.h"
#include "tests/protocol/samples.h"

namespace huestep::protocol::journal {
namespace {

TEST(JournalFormat, NamesOfFilesHoldTheirTickAndNoOtherNamesDo) {
    EXPECT_EQ(segmentName(0), "segment-000000000000.log");
    EXPECT_EQ(segmentName(1'234'567), "segment-000001234567.log");
    EXPECT_EQ(snapshotName(9'999'999'999'999), "snapshot-9999999999999.snap");
    for (const std::uint64_t tick : {0ul, 7ul, 999'999'999'999ul, 1'000'000'000'000ul}) {
        EXPECT_EQ(tickOfSegment(segmentName(tick)), tick);
        EXPECT_EQ(tickOfSnapshot(snapshotName(tick)), tick);
        EXPECT_FALSE(tickOfSegment(snapshotName(tick)).has_value());
    }
    for (const char* name :
         {"segment-0.log", "segment-00000000000x.log", "segment-000000000000.log.tmp",
          "segment-0000000000000.log", "segment-.log", "segment-99999999999999999999999.log",
          "scene.bin", "", "segment-+00000000001.log"}) {
        EXPECT_FALSE(tickOfSegment(name).has_value()) << name;
    }
}

TEST(JournalFormat, ASegmentHeaderIsLaidOutAsItsHeaderSays) {
    const SegmentHeader header{{"sandbox", {11, 22, 33}, 44}, 55, 66};
    const auto bytes = write(header);
    const std::span<const std::byte> from(bytes);
    EXPECT_EQ(0, std::memcmp(bytes.data(), "HSTEPLOG", 8));
    EXPECT_EQ(load<std::uint32_t>(from, 8), 1u);
    EXPECT_EQ(load<std::uint32_t>(from, 12), 44u);
    EXPECT_EQ(load<std::uint64_t>(from, 16), 11u);
    EXPECT_EQ(load<std::uint64_t>(from, 24), 22u);
    EXPECT_EQ(load<std::uint32_t>(from, 32), 33u);
    EXPECT_EQ(load<std::uint32_t>(from, 36), 7u);
    EXPECT_EQ(load<std::uint64_t>(from, 40), 55u);
    EXPECT_EQ(load<std::uint64_t>(from, 48), 66u);
    EXPECT_EQ(0, std::memcmp(bytes.data() + 56, "sandbox\0", 8));
    EXPECT_EQ(load<std::uint64_t>(from, 120), hash64(from.first(120)));
    const auto back = readSegmentHeader(bytes);
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(back->identity.session, "sandbox");
    EXPECT_EQ(back->identity.epoch, 44u);
    EXPECT_EQ(back->identity.fingerprint, header.identity.fingerprint);
    EXPECT_EQ(back->firstTick, 55u);
    EXPECT_EQ(back->chain, 66u);
}

TEST(JournalFormat, ARecordIsLaidOutAsItsHeaderSays) {
    std::vector<std::byte> out;
    std::uint64_t chain = 5;
    write(JournalEntry{0, FullRoot{7, 8}}, 9, 128, 6, chain, out);
    ASSERT_EQ(out.size(), recordHeaderBytes + 16 + recordTrailerBytes);
    const std::span<const std::byte> from(out);
    EXPECT_EQ(0, std::memcmp(out.data(), "HREC", 4));
    EXPECT_EQ(load<std::uint32_t>(from, 4), 16u);
    EXPECT_EQ(load<std::uint64_t>(from, 8), 7u);
    EXPECT_EQ(load<std::uint32_t>(from, 16), 9u);
    EXPECT_EQ(load<std::uint32_t>(from, 20), 2u);
    EXPECT_EQ(load<std::uint64_t>(from, 24), 128u);
    EXPECT_EQ(load<std::uint64_t>(from, 32), hash64(from.subspan(48, 16)));
    std::vector<std::byte> hashed(out.begin(), out.begin() + 40);
    hashed.resize(48);
    store(std::span(hashed), 40, std::uint64_t{6});
    EXPECT_EQ(load<std::uint64_t>(from, 40), hash64(hashed));
    EXPECT_EQ(load<std::uint64_t>(from, 48), 7u);
    EXPECT_EQ(load<std::uint64_t>(from, 56), 8u);
    const std::array<std::uint64_t, 2> link{5, load<std::uint64_t>(from, 40)};
    EXPECT_EQ(load<std::uint64_t>(from, 64), hash64Of<std::uint64_t>(link));
    EXPECT_EQ(chain, load<std::uint64_t>(from, 64));
    EXPECT_TRUE(readRecordHeader(out, 6).has_value());
    EXPECT_FALSE(readRecordHeader(out, 7).has_value()) << "a record of another segment";
}

// ---- a journal written by the first form of this program reads back for good --------------------

const std::filesystem::path kept =
    std::filesystem::path(HUESTEP_SOURCE_DIR) / "tests/protocol/corpus/journal-1";

std::vector<JournalEntry> sampleEntries() {
    std::vector<JournalEntry> entries;
    for (const Message& message : samples::sampleMessages()) {
        if (const auto* frame = std::get_if<Frame>(&message)) entries.push_back({2, *frame});
    }
    std::get<Frame>(entries[0].content).tick = 0;
    entries.push_back({2, Frame{1, {}, {3}, 77, 1}});
    entries.push_back({2, FullRoot{2, 0xabcdef}});
    return entries;
}

std::vector<std::byte> sampleImage() {
    std::vector<std::byte> image;
    for (int i = 0; i < 5'000; ++i) image.push_back(static_cast<std::byte>(i * 31 >> 2));
    return image;
}

TEST(JournalFormat, AJournalOfTheFirstFormReadsBack) {
    if (std::getenv("HUESTEP_MINT_CORPUS") != nullptr && !std::filesystem::exists(kept)) {
        const auto folder = openFolder(kept.string());
        auto writer = JournalWriter::open(**folder, {"sample", {1, 2, 3}, 2}, {}, 0);
        ASSERT_TRUE(writer->append(sampleEntries()).ok());
        ASSERT_TRUE(writer->writeSnapshot(2, sampleImage()).ok());
    }
    // Read through memory: a test must not open its own source folder for writing.
    MemoryStore store;
    ASSERT_TRUE(std::filesystem::exists(kept));
    for (const auto& entry : std::filesystem::directory_iterator(kept)) {
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string text((std::istreambuf_iterator<char>(file)), {});
        const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
        ASSERT_TRUE(store.replace(entry.path().filename().string(), bytes).ok());
    }
    const auto contents = readJournal(store);
    ASSERT_TRUE(contents.ok()) << contents.error().message;
    EXPECT_EQ(contents->identity.session, "sample");
    EXPECT_EQ(contents->identity.epoch, 2u);
    const auto expected = sampleEntries();
    ASSERT_EQ(contents->entries.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_TRUE(contents->entries[i].content == expected[i].content) << i;
    }
    EXPECT_EQ(contents->snapshotTick, 2u);
    EXPECT_EQ(*readSnapshot(store, 2), sampleImage());
}

}  // namespace
}  // namespace huestep::protocol::journal
