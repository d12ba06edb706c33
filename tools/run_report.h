/// What a run says of itself: as text and as JSON.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/engine.h"
#include "core/solver/method.h"
#include "core/world/world.h"
#include "tools/accuracy.h"
#include "tools/metrics/metric.h"
#include "tools/statistics.h"
#include "tools/text.h"

namespace huestep::tools {

/// Bytes of state and what a hash of it costs, measured on a world as it is.
struct StateCost {
    std::size_t snapshotBytes = 0;
    double motionRootNs = 0.0;  ///< ns a body
    double fullRootNs = 0.0;    ///< ns a body
};

/// The least of a few measurements of each hash, definitions unchanged since the last, as in a run.
StateCost measureState(const World& world);

/// What only Huestep says of a run.
struct RunInside {
    const MethodTraits* method = nullptr;
    std::uint32_t substeps = 0;  ///< of a tick, or iterations; 0: planned for each island
    std::uint64_t fullRoot = 0;
    StepReport last;
    std::array<std::uint64_t, static_cast<std::size_t>(Stage::Count)> stageNanoseconds{};
    std::uint64_t constraints = 0;  ///< sum over ticks
    std::uint64_t overflow = 0;     ///< sum over ticks
    std::uint64_t inBuckets = 0;    ///< sum over ticks
    std::uint32_t mostColours = 0;
    std::size_t jointCount = 0;
    std::vector<std::uint64_t> waited;  ///< ns, by worker
    std::optional<StepLayout> layout;   ///< of the last step, where it is to be explained
    StateCost state;
};

struct RunReport {
    struct TickHash {
        std::uint64_t tick = 0;
        std::uint64_t motion = 0;
        std::uint64_t full = 0;  ///< 0 of a peer, which has no state of ours
    };

    std::string scene;
    std::string engine;
    std::string simd;
    int threads = 1;
    std::uint64_t ticksAsked = 0;
    std::uint64_t ticks = 0;  ///< taken; fewer than asked after Ctrl-C
    Histogram tickNanoseconds;
    std::vector<TickHash> hashes;  ///< for `asJson` alone
    std::uint64_t motionRoot = 0;
    std::uint64_t bodies = 0;
    std::uint32_t contacts = 0;
    AccuracyResult accuracy;
    struct Judged {
        const MetricCase* metric = nullptr;
        double error = 0.0;  ///< in the case's unit
    };
    std::vector<Judged> metrics;  ///< whose scene this is, and whose time was run

    std::optional<RunInside> inside;

    static void print(const TickHash& hash, bool full);  ///< a line of text, as it comes
    void add(const StepReport& step);                    ///< after each step of Huestep
    void close(const Engine& engine, bool explain);      ///< after the last step
    [[nodiscard]] Json asJson() const;
    void print() const;

 private:
    void printMetrics() const;
    void printInside() const;
    void printLayout() const;
};

}  // namespace huestep::tools
