// The executor: every index once, whatever the team, the grain and the order.

#include "core/parallel/executor.h"

#include <atomic>
#include <numeric>
#include <set>
#include <thread>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

constexpr int mostThreads = 8;

TEST(Executor, CallsEveryIndexOnceForAnyTeamGrainAndSeed) {
    for (int threads = 1; threads <= mostThreads; ++threads) {
        for (const std::uint64_t seed : {0u, 77u}) {
            Executor executor(threads, seed);
            ASSERT_EQ(executor.threads(), threads);
            for (const std::uint32_t count : {0u, 1u, 2u, 63u, 64u, 65u, 1000u}) {
                for (const std::uint32_t grain : {1u, 7u, 64u, 5000u}) {
                    std::vector<int> calls(count, 0);  // index i owns place i
                    executor.forBlocks(count, grain, [&](std::uint32_t begin, std::uint32_t end) {
                        ASSERT_LT(begin, end);
                        ASSERT_EQ(begin % grain, 0u);
                        for (std::uint32_t i = begin; i < end; ++i) ++calls[i];
                    });
                    for (const int n : calls) ASSERT_EQ(n, 1);
                }
            }
        }
    }
}

TEST(Executor, RunsEveryWorkerOnceAndMeetsAtBarriers) {
    for (int threads = 1; threads <= mostThreads; ++threads) {
        Executor executor(threads);
        constexpr int rounds = 40;
        std::vector<std::vector<int>> wrote(static_cast<std::size_t>(threads),
                                            std::vector<int>(rounds, 0));
        std::atomic<int> early{0};
        executor.onAllWorkers([&](int worker) {
            for (std::size_t round = 0; round < rounds; ++round) {
                wrote[static_cast<std::size_t>(worker)][round] = 1;
                executor.barrier(worker);
                for (const auto& other : wrote) early += other[round] == 0;
                executor.barrier(worker);
            }
        });
        EXPECT_EQ(early.load(), 0) << "someone passed a barrier before all had come";
        for (const auto& each : wrote)
            EXPECT_EQ(std::accumulate(each.begin(), each.end(), 0), rounds);
    }
}

TEST(Executor, UsesAtMostItsTeamAndItsCaller) {
    Executor executor(3);
    std::vector<std::thread::id> ids(200);
    executor.forBlocks(200, 1, [&](std::uint32_t begin, std::uint32_t) {
        ids[begin] = std::this_thread::get_id();
    });
    EXPECT_LE(std::set<std::thread::id>(ids.begin(), ids.end()).size(), 3u);
    executor.forBlocks(5, 10,
                       [&](std::uint32_t, std::uint32_t) { ids[0] = std::this_thread::get_id(); });
    EXPECT_EQ(ids[0], std::this_thread::get_id()) << "one block: the caller alone";
}

TEST(Executor, ManyShortUsesInARowLoseNothing) {
    Executor executor(4, 5);
    std::uint64_t sum = 0;
    for (std::uint32_t use = 0; use < 3000; ++use) {
        std::uint32_t parts[4]{};
        executor.forBlocks(4, 1, [&](std::uint32_t begin, std::uint32_t) { parts[begin] = use; });
        for (const std::uint32_t part : parts) sum += part;
    }
    EXPECT_EQ(sum, 4ull * 2999 * 3000 / 2);
}

TEST(Executor, ShufflesBlocksWithItsSeedAlone) {
    // One thread of two may claim all: the order of claims is what the seed decides.
    const auto orderOf = [](std::uint64_t seed) {
        Executor executor(2, seed);
        std::atomic<std::uint32_t> next{0};
        std::vector<std::uint32_t> turn(64);
        executor.forBlocks(64, 1,
                           [&](std::uint32_t begin, std::uint32_t) { turn[begin] = next++; });
        return turn;
    };
    const std::vector<std::uint32_t> turn = orderOf(9);
    std::uint32_t moved = 0;
    for (std::uint32_t i = 0; i < 64; ++i) moved += turn[i] > i + 8 || turn[i] + 8 < i;
    EXPECT_GT(moved, 20u);
}

TEST(Executor, MeasuresWaitsOnlyWithAClock) {
    static std::atomic<std::uint64_t> now{0};
    Executor timed(2, 0, [] { return ++now; });
    timed.onAllWorkers([&](int worker) { timed.barrier(worker); });
    ASSERT_EQ(timed.waited().size(), 2u);
    EXPECT_GT(timed.waited()[0] + timed.waited()[1], 0u);
    Executor plain(2);
    plain.onAllWorkers([&](int worker) { plain.barrier(worker); });
    EXPECT_EQ(plain.waited(), (std::vector<std::uint64_t>{0, 0}));
}

/// A clock that says what a test tells it, and how often it has been asked.
struct ToldClock {
    static inline std::atomic<std::uint64_t> now{0};
    static inline std::atomic<int> asked{0};
    static std::uint64_t read() {
        ++asked;
        return ++now;
    }
};

/// A use with one barrier, to which the second worker comes once the caller sleeps, and so late.
void useWhereTheCallerSleeps(Executor& executor, std::uint64_t nanoseconds) {
    const int before = ToldClock::asked;
    executor.onAllWorkers([&](int worker) {
        if (worker == 1) {
            // It is asked at the start of the use, and before the caller sleeps.
            while (ToldClock::asked < before + 2) std::this_thread::yield();
            ToldClock::now += nanoseconds;
        }
        executor.barrier(worker);
    });
}

TEST(Executor, LeavesTheCallerAloneForAWhileWhereBarriersTakeLongerThanTheWork) {
    constexpr std::uint64_t aWhile = 1'000'000'000;
    Executor executor(2, 0, nullptr, ToldClock::read);
    const auto usesAlone = [&] {
        int uses = 0;
        while (executor.workersNow() == 1) ++uses;
        return uses;
    };
    for (int use = 0; use < 4; ++use) {
        EXPECT_EQ(usesAlone(), 0) << "four in a row are needed, not " << use;
        useWhereTheCallerSleeps(executor, aWhile);
    }
    EXPECT_EQ(usesAlone(), 64);
    useWhereTheCallerSleeps(executor, aWhile);
    EXPECT_EQ(usesAlone(), 128) << "tried again once, and in vain";
    for (int use = 0; use < 10; ++use) useWhereTheCallerSleeps(executor, aWhile);
    EXPECT_EQ(usesAlone(), 4096) << "and never longer than this";
    useWhereTheCallerSleeps(executor, 0);
    for (int use = 0; use < 4; ++use) {
        EXPECT_EQ(usesAlone(), 0) << "one that pays is a new beginning";
        useWhereTheCallerSleeps(executor, aWhile);
    }
    EXPECT_EQ(usesAlone(), 64);

    Executor without(2);
    for (int use = 0; use < 10; ++use)
        without.onAllWorkers([&](int worker) { without.barrier(worker); });
    EXPECT_EQ(without.workersNow(), 2) << "without a clock nobody judges";
}

TEST(Executor, UsesOfBothKindsInTurnLoseNothing) {
    Executor executor(3);
    std::atomic<std::uint32_t> early{0};
    for (int use = 0; use < 500; ++use) {
        std::vector<int> calls(6, 0);  // index i owns place i
        executor.forBlocks(6, 1, [&](std::uint32_t begin, std::uint32_t) { ++calls[begin]; });
        EXPECT_EQ(calls, std::vector<int>(6, 1));
        std::atomic<std::uint32_t> came{0};
        executor.onAllWorkers([&](int worker) {
            ++came;
            executor.barrier(worker);
            early += came != 3;
        });
    }
    EXPECT_EQ(early, 0u) << "someone passed a barrier before all had come";
}

}  // namespace
}  // namespace huestep::test
