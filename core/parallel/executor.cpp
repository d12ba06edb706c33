#include "core/parallel/executor.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <numeric>

#include "core/parallel/thread.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace huestep {

namespace {

// A barrier costs about 100 ns among running threads and several µs through the kernel. So a
// worker looks a while before it sleeps, unless there are more workers than cores: then whoever
// looks keeps the one he waits for from running. How long is a matter of who else wants the cores.
// The tumbler on two workers of two cores, where one takes 1.1 ms: with 200 looks 1.0 to 1.7 ms,
// as serial stages put the crew to sleep a dozen times a tick, with 1,000 0.84 to 0.95; beside two
// other busy threads 1.8 and 3.6 ms. There 4,000 looks made two workers seven times slower than
// one.
constexpr int looksBeforeSleep = 1000;

void pauseBriefly() {
#if defined(__x86_64__)
    _mm_pause();
#endif
}

// When the caller goes on alone, in uses with barriers: see `Executor::workersNow`.
constexpr int strikesToLeave = 4;
constexpr std::uint32_t firstPause = 64;
constexpr std::uint32_t longestPause = 4096;

// The door of a use: its number, whether it is closed, and how many have entered.
constexpr std::uint64_t doorClosed = 1u << 31;
constexpr std::uint64_t doorOf(std::uint32_t use) {
    return static_cast<std::uint64_t>(use) << 32;
}
constexpr std::uint32_t enteredAt(std::uint64_t door) {
    return static_cast<std::uint32_t>(door & (doorClosed - 1));
}

std::uint64_t mix(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

}  // namespace

/// The shared state of a team. A use is announced by opening its door and raising `use`. Who enters
/// raises `finished` when he has done. A use without barriers closes its door when the caller finds
/// nothing left to do: whoever has not come by then is not waited for. Barriers count arrivals and
/// raise `phase`.
struct Executor::Team {
    explicit Team(int threads, std::uint64_t seed, Clock clockToUse, Clock judgeToUse)
        : count(threads),
          looks(static_cast<unsigned>(threads) <= hardwareThreads() ? looksBeforeSleep : 0),
          shuffleSeed(seed),
          clock(clockToUse),
          judge(judgeToUse),
          waits(static_cast<std::size_t>(threads)) {}

    /// Waits until `value` is no longer `old`. `slept`, if given, gets the nanoseconds for which
    /// looking was not enough.
    void waitWhile(std::atomic<std::uint32_t>& value, std::uint32_t old,
                   std::uint64_t* slept = nullptr) const {
        for (int i = 0; i < looks; ++i) {
            if (value.load(std::memory_order_acquire) != old) return;
            pauseBriefly();
        }
        const std::uint64_t from = slept != nullptr ? judge() : 0;
        while (value.load(std::memory_order_acquire) == old) {
            sleepWhile(value, old);
        }
        if (slept != nullptr) *slept += judge() - from;
    }
    /// Of the caller's waits, where there is a clock to judge by.
    std::uint64_t* sleptOf(int worker) { return worker == 0 && judge ? &callerSlept : nullptr; }

    void arrive(int worker) {
        const std::uint64_t from = clock ? clock() : 0;
        const std::uint32_t now = phase.load(std::memory_order_acquire);
        if (arrived.fetch_add(1, std::memory_order_acq_rel) + 1 ==
            static_cast<std::uint32_t>(count)) {
            arrived.store(0, std::memory_order_relaxed);
            phase.store(now + 1, std::memory_order_release);
            phase.notify_all();
        } else {
            waitWhile(phase, now, sleptOf(worker));
        }
        if (clock) waits[static_cast<std::size_t>(worker)].nanoseconds += clock() - from;
    }

    void serve(int worker) {
        std::uint32_t seen = 0;
        std::uint32_t last = 0;  // the use that it took part in
        for (;;) {
            waitWhile(use, seen);
            seen = use.load(std::memory_order_acquire);
            if (stop.load(std::memory_order_acquire)) return;
            if (!enter(last)) continue;
            (*job)(worker);
            finished.fetch_add(1, std::memory_order_acq_rel);
            finished.notify_one();
        }
    }

    /// Enters the use whose door is open, which may be a later one than that by which the worker
    /// was woken. False: too late, or it is `last` again; else `last` is it.
    bool enter(std::uint32_t& last) {
        std::uint64_t seen = door.load(std::memory_order_acquire);
        for (;;) {
            const auto number = static_cast<std::uint32_t>(seen >> 32);
            if ((seen & doorClosed) != 0 || number == last) return false;
            if (!door.compare_exchange_weak(seen, seen + 1, std::memory_order_acq_rel)) continue;
            last = number;
            return true;
        }
    }

    enum class Who : std::uint8_t {
        All,      ///< every worker: they meet at barriers
        WhoComes  ///< while there is something to do
    };
    void run(const std::function<void(int)>& f, Who who) {
        job = &f;
        finished.store(0, std::memory_order_relaxed);
        const std::uint32_t number = use.load(std::memory_order_relaxed) + 1;
        door.store(doorOf(number), std::memory_order_release);
        use.store(number, std::memory_order_release);
        use.notify_all();
        f(0);
        const std::uint64_t from = clock ? clock() : 0;
        auto others = static_cast<std::uint32_t>(count - 1);
        if (who == Who::WhoComes)
            others = enteredAt(door.fetch_or(doorClosed, std::memory_order_acq_rel));
        for (;;) {
            const std::uint32_t done = finished.load(std::memory_order_acquire);
            if (done == others) break;
            waitWhile(finished, done, sleptOf(0));
        }
        if (clock) waits[0].nanoseconds += clock() - from;
    }

    /// After a use with barriers that took the caller so long: alone, all workers' work would have
    /// been his, but none of the sleep.
    void judgeUse(std::uint64_t nanoseconds) {
        const std::uint64_t worked = nanoseconds - std::min(callerSlept, nanoseconds);
        if (static_cast<std::uint64_t>(count) * worked >= nanoseconds) {
            strikes = 0;
            pause = firstPause;
            return;
        }
        if (++strikes < strikesToLeave) return;
        strikes = strikesToLeave - 1;  // the next one decides
        alone = pause;
        pause = std::min(2 * pause, longestPause);
    }

    // A line of its own for each, so that looking at one does not slow another down.
    struct alignas(64) Wait {
        std::uint64_t nanoseconds = 0;
    };
    const int count;
    const int looks;
    const std::uint64_t shuffleSeed;
    const Clock clock;
    const Clock judge;
    std::uint64_t uses = 0;
    // The caller's own.
    std::uint64_t callerSlept = 0;  // ns, in this use
    int strikes = 0;                // uses in a row that did not pay
    std::uint32_t pause = firstPause;
    std::uint32_t alone = 0;  // uses that he is still to take alone
    const std::function<void(int)>* job = nullptr;
    std::vector<Wait> waits;
    alignas(64) std::atomic<std::uint32_t> use{0};
    alignas(64) std::atomic<std::uint64_t> door{doorClosed};
    alignas(64) std::atomic<std::uint32_t> finished{0};
    alignas(64) std::atomic<std::uint32_t> arrived{0};
    alignas(64) std::atomic<std::uint32_t> phase{0};
    std::atomic<bool> stop{false};
    std::vector<Thread> crew;
};

Executor::Executor(int threads, std::uint64_t shuffleSeed, Clock clock, Clock judge)
    : m_threads(threads), m_team(std::make_unique<Team>(threads, shuffleSeed, clock, judge)) {
    assert(threads >= 1 && threads <= maxThreads);
    for (int worker = 1; worker < threads; ++worker) {
        m_team->crew.emplace_back([team = m_team.get(), worker] { team->serve(worker); });
    }
}

Executor::~Executor() {
    m_team->stop.store(true, std::memory_order_release);
    m_team->use.fetch_add(1, std::memory_order_acq_rel);
    m_team->use.notify_all();
    for (Thread& thread : m_team->crew) thread.join();
}

void Executor::forBlocks(std::uint32_t count, std::uint32_t grain,
                         const std::function<void(std::uint32_t, std::uint32_t)>& f) {
    assert(grain > 0);
    const std::uint32_t blocks = (count + grain - 1) / grain;
    if (blocks == 0) return;
    if (blocks == 1 || m_threads == 1) {
        f(0, count);
        return;
    }
    // Blocks are claimed by a counter: who is free takes the next. With a seed, the n-th claim is
    // the n-th of a shuffled order instead; nothing downstream may be able to tell.
    std::vector<std::uint32_t> order;
    if (m_team->shuffleSeed != 0) {
        order.resize(blocks);
        std::iota(order.begin(), order.end(), 0u);
        const std::uint64_t draw = mix(m_team->shuffleSeed + ++m_team->uses);
        for (std::uint32_t i = blocks - 1; i > 0; --i) {
            std::swap(order[i], order[mix(draw + i) % (i + 1)]);
        }
    }
    std::atomic<std::uint32_t> claimed{0};
    const auto claimBlocks = [&](int) {
        for (;;) {
            const std::uint32_t claim = claimed.fetch_add(1, std::memory_order_relaxed);
            if (claim >= blocks) return;
            const std::uint32_t block = order.empty() ? claim : order[claim];
            const std::uint32_t begin = block * grain;
            f(begin, count - begin < grain ? count : begin + grain);
        }
    };
    m_team->run(claimBlocks, Team::Who::WhoComes);
}

int Executor::workersNow() {
    if (m_team->alone == 0) return m_threads;
    --m_team->alone;
    return 1;
}

void Executor::onAllWorkers(const std::function<void(int)>& f) {
    if (m_threads == 1) {
        f(0);
        return;
    }
    Team& team = *m_team;
    team.callerSlept = 0;
    const std::uint64_t from = team.judge ? team.judge() : 0;
    team.run(f, Team::Who::All);
    if (team.judge) team.judgeUse(team.judge() - from);
}

void Executor::barrier(int worker) {
    if (m_threads > 1) m_team->arrive(worker);
}

std::vector<std::uint64_t> Executor::waited() const {
    std::vector<std::uint64_t> nanoseconds;
    for (const Team::Wait& wait : m_team->waits) nanoseconds.push_back(wait.nanoseconds);
    return nanoseconds;
}

}  // namespace huestep
