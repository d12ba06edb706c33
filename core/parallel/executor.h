/// Runs `f(index)` over a range on a fixed team of threads. Knows no physics.
///
/// Index i owns place i: work items never share a place they write, so which worker runs an item,
/// and in which order, cannot be seen in the output. A test shuffles the assignment.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace huestep {

inline constexpr int maxThreads = 64;

/// Reads a clock in nanoseconds. The core has none of its own: whoever wants times hands one in.
using Clock = std::uint64_t (*)();

/// A team of `threads` workers: the caller's thread and `threads − 1` of its own, which sleep
/// between uses. Thread rule: one caller at a time; the destructor joins.
class Executor {
 public:
    /// `threads`: 1 to 64. `shuffleSeed` ≠ 0 hands blocks to workers in an order drawn from it,
    /// for tests. `clock`, if given, measures how long workers wait for each other. `judge`, if
    /// given, is the clock by which the caller is left alone where the team does not pay: see
    /// `workersNow`.
    explicit Executor(int threads, std::uint64_t shuffleSeed = 0, Clock clock = nullptr,
                      Clock judge = nullptr);
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    [[nodiscard]] int threads() const { return m_threads; }

    /// Calls `f(begin, end)` for every block of `grain` indices of [0, count), on any worker.
    /// Returns when all are done. With one block, or one thread, runs in the caller alone.
    void forBlocks(std::uint32_t count, std::uint32_t grain,
                   const std::function<void(std::uint32_t begin, std::uint32_t end)>& f);

    /// How many workers the next piece of work between barriers should have: all, or the caller
    /// alone for a while. That is where other programs want the cores: who waits at a barrier for a
    /// worker that is not let run waits for milliseconds, and does so at every barrier. Four uses
    /// of `onAllWorkers` in a row that would have been shorter alone are enough; then one use is
    /// tried again after 64 calls, and after twice as many as long as it does not pay, up to 4096.
    /// Time says who works here, and never what comes of it.
    [[nodiscard]] int workersNow();

    /// Runs `f(worker)` once on every worker; within, `barrier()` may be called, by all alike.
    void onAllWorkers(const std::function<void(int worker)>& f);

    /// Waits until every worker of the running `onAllWorkers` has come here.
    void barrier(int worker);

    /// Nanoseconds each worker has waited at barriers and for the end of uses; zeros without clock.
    [[nodiscard]] std::vector<std::uint64_t> waited() const;

 private:
    struct Team;
    int m_threads;
    std::unique_ptr<Team> m_team;
};

}  // namespace huestep
