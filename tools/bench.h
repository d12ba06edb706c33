/// Results of `bench`, and the forms in which they are given.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/accuracy.h"
#include "tools/text.h"

namespace huestep::tools {

/// One engine on one scene with one number of threads.
struct BenchResult {
    std::string scene;
    std::string engine;
    int threads = 1;
    std::uint64_t ticks = 0;
    std::vector<double> repeats;             ///< ms a tick, mean of each repeat
    std::vector<std::uint64_t> leastByTick;  ///< ns, least over the repeats
    std::uint64_t hash = 0;                  ///< of all motions at the end
    bool sameHash = true;                    ///< every repeat ended with it
    AccuracyResult errors;
    std::vector<std::string> notes;  ///< what the engine leaves out or approximates

    /// Sum over ticks of the least time of each, divided by the ticks, ms: what the engine needs
    /// when nothing else disturbs the machine.
    [[nodiscard]] double psm() const;
};

/// `finished`: of all scenes that were asked for.
Json benchJson(const std::vector<BenchResult>& results, bool finished);
void printBench(const std::vector<BenchResult>& results);
std::string benchCsv(const std::vector<BenchResult>& results);

}  // namespace huestep::tools
