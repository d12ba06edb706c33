/// What `huestep chart` runs and times: fixed work, its time and the hash it ends with.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/scene/scene.h"
#include "core/solver/effort.h"
#include "tools/scene_source.h"
#include "tools/text.h"

namespace huestep::tools::chart {

/// How much is measured.
enum class Extent : std::uint8_t {
    Smoke,  ///< that it works: some seconds, times worth nothing
    Quick,  ///< within two minutes on two cores
    Full
};

/// Timed runs of each piece of work: quartiles need seven.
int repeatsOf(Extent extent);

/// Order statistics over the repeats of fixed work, each repeat's mean, µs a step.
struct Spread {
    double min = 0.0;
    double q1 = 0.0;
    double median = 0.0;
    double q3 = 0.0;
};
Spread spreadOf(std::span<const double> samples);

/// A way to solve a scene: one of Huestep's methods with so many substeps, or a peer.
struct Contender {
    std::string engine = "huestep";
    Method method = Method::SoftStep;
    std::uint32_t substeps = 0;  ///< 0: planned, of the product; peers: their own, and 0

    /// As charts call it: a method's name, or the peer's.
    [[nodiscard]] std::string name() const;
    /// Whether it is what a scene gets that says nothing of methods and substeps, or the only way
    /// in which the peer is run.
    [[nodiscard]] bool standard() const;
    /// Whether it is the product as it comes.
    [[nodiscard]] bool product() const;
    /// The scene as it solves it, without sleep: fixed work.
    [[nodiscard]] Scene applied(Scene scene) const;
};

/// What the product does where effort is not planned, and what other methods are given.
inline constexpr std::uint32_t standardSubsteps = substepsOf(standardEffort);

/// Every method of this build with each of `substeps`, the product as planned too, and Box2D 2.4.
std::vector<Contender> allContenders(std::span<const std::uint32_t> substeps);

/// A piece of fixed work and what it took. A time is never without its hash.
struct Run {
    std::shared_ptr<const NamedScene> scene;
    Contender contender;
    int threads = 1;
    bool shareAll = false;           ///< see `StepResources::shareAll`
    std::uint64_t settle = 0;        ///< ticks before those that are timed
    std::uint64_t ticks = 1;         ///< timed
    std::vector<double> cpu;         ///< µs a step, of each repeat: of all threads together
    std::vector<double> wall;        ///< µs a step, of each repeat
    std::uint64_t hash = 0;          ///< of all motions at the end of the last repeat
    std::set<std::uint64_t> hashes;  ///< of all repeats
};

/// Runs each once more and adds its times and its hash; all of them in turn, so that each meets the
/// same weather. Stops early, with false, when interrupted.
Result<bool> timeOnce(std::span<Run* const> runs);

/// The same as often as asked: A B C, A B C, …
Result<bool> timeRepeatedly(std::span<Run* const> runs, int repeats);

/// Share of the threads' time in which they waited for each other, [0, 1], in a run of its own, for
/// a clock at every barrier costs time too.
Result<double> waitedShare(const Run& run);

/// What all rows of measurements have, flat: scene, method, substeps, threads, times, hash.
Json asJson(const Run& run);

}  // namespace huestep::tools::chart
