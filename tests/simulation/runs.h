/// How many seeds, and which: HUESTEP_SEED names one, HUESTEP_SIMULATION_RUNS how many follow.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <iostream>

namespace huestep::test {

inline std::uint64_t numberFromEnvironment(const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// Calls `f(seed)` for each; prints every seed before its run.
template <class F>
void forEachSeed(const char* what, std::uint64_t runs, F f) {
    const std::uint64_t first = numberFromEnvironment("HUESTEP_SEED", 1);
    const bool one = std::getenv("HUESTEP_SEED") != nullptr;
    const std::uint64_t count = numberFromEnvironment("HUESTEP_SIMULATION_RUNS", one ? 1 : runs);
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        std::cout << what << " HUESTEP_SEED=" << seed << std::endl;
        f(seed);
        if (testing::Test::HasFailure()) return;
    }
}

}  // namespace huestep::test
