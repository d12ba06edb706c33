#include "protocol/memory_store.h"

#include <gtest/gtest.h>

#include <set>

namespace huestep::protocol {
namespace {

std::vector<std::byte> bytesOf(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
    return {bytes.begin(), bytes.end()};
}

TEST(MemoryStore, ACrashKeepsWhatWasSyncedAndAtMostWhatWasWritten) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        MemoryStore store;
        ASSERT_TRUE(store.replace("f", {}).ok());
        ASSERT_TRUE(store.append("f", std::vector<std::byte>(1'000, std::byte{1})).ok());
        ASSERT_TRUE(store.sync("f").ok());
        ASSERT_TRUE(store.append("f", std::vector<std::byte>(3'000, std::byte{2})).ok());
        store.crash(seed);
        const auto bytes = *store.read("f");
        ASSERT_GE(bytes.size(), 1'000u);
        ASSERT_LE(bytes.size(), 4'000u);
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            const bool allowed = i < 1'000 ? bytes[i] == std::byte{1}
                                           : bytes[i] == std::byte{2} || bytes[i] == std::byte{0};
            ASSERT_TRUE(allowed) << "seed " << seed << ", byte " << i;
        }
    }
}

TEST(MemoryStore, DiesInTheMiddleOfAChangeAndAnswersNothingAfterIt) {
    MemoryStore store;
    ASSERT_TRUE(store.replace("f", {}).ok());
    store.dieAfter(1);
    EXPECT_TRUE(store.append("f", bytesOf("abc")).ok());
    EXPECT_TRUE(store.read("f").ok());
    EXPECT_FALSE(store.append("f", bytesOf("defghi")).ok());
    EXPECT_FALSE(store.read("f").ok());
    EXPECT_FALSE(store.list().ok());
    EXPECT_FALSE(store.replace("g", {}).ok());
    store.revive();
    EXPECT_GE(store.read("f")->size(), 3u);
    EXPECT_LE(store.read("f")->size(), 9u);
}

TEST(MemoryStore, CrashesTearInManyWaysAndTheSameWayForTheSameSeed) {
    std::set<std::string> outcomes;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        std::vector<std::byte> first;
        for (int run = 0; run < 2; ++run) {
            MemoryStore store;
            ASSERT_TRUE(store.replace("f", {}).ok());
            ASSERT_TRUE(store.append("f", std::vector<std::byte>(2'000, std::byte{7})).ok());
            store.crash(seed);
            if (run == 0) first = *store.read("f");
            EXPECT_EQ(*store.read("f"), first);
        }
        outcomes.emplace(reinterpret_cast<const char*>(first.data()), first.size());
    }
    EXPECT_GT(outcomes.size(), 30u);
}

TEST(MemoryStore, ALyingSyncKeepsNothingSafe) {
    MemoryStore honest;
    MemoryStore liar;
    liar.setLyingSyncs(true);
    int lost = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        for (MemoryStore* store : {&honest, &liar}) {
            ASSERT_TRUE(store->replace("f" + std::to_string(seed), {}).ok());
            ASSERT_TRUE(store->append("f" + std::to_string(seed), bytesOf("abcdefgh")).ok());
            ASSERT_TRUE(store->sync("f" + std::to_string(seed)).ok());
            store->crash(seed);
        }
        EXPECT_EQ(*honest.read("f" + std::to_string(seed)), bytesOf("abcdefgh"));
        lost += *liar.read("f" + std::to_string(seed)) != bytesOf("abcdefgh") ? 1 : 0;
    }
    EXPECT_GT(lost, 10);
}

TEST(MemoryStore, AFullDiskTakesAPartOfAnAppendAndNothingOfAReplace) {
    MemoryStore store;
    store.setCapacity(10);
    ASSERT_TRUE(store.replace("f", {}).ok());
    EXPECT_FALSE(store.append("f", bytesOf("0123456789abc")).ok());
    EXPECT_EQ(*store.read("f"), bytesOf("0123456789"));
    EXPECT_FALSE(store.replace("f", bytesOf("x")).ok());
    EXPECT_EQ(*store.read("f"), bytesOf("0123456789"));
    EXPECT_EQ(store.totalBytes(), 10u);
}

}  // namespace
}  // namespace huestep::protocol
