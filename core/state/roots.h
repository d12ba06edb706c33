/// The hashes of a state: leaves of 64 records under a 16-ary tree, an array a tree.
///
/// A leaf is XXH3-64 of the bytes of 64 records (the last leaf of fewer), an inner node XXH3-64 of
/// the hashes below it. Two peers find the first different leaf in O(log n) nodes. Arrays keep
/// their own trees, because a run of one array is contiguous memory and can be hashed as it lies.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/state/state.h"

namespace huestep {

inline constexpr std::size_t recordsPerLeaf = 64;
inline constexpr std::size_t childrenPerNode = 16;

/// Hashes of the blocks of 64 records of `recordBytes` each.
std::vector<std::uint64_t> leavesOf(std::span<const std::byte> bytes, std::size_t recordBytes);

/// The top of the tree over the leaves; 0 for none.
std::uint64_t rootOf(std::vector<std::uint64_t> nodes);

/// Over every body's motion, the tick, the counters and, if there are rules, their state.
std::uint64_t motionRoot(const WorldState& state);
std::vector<std::uint64_t> motionLeaves(const WorldState& state);

/// Definitions change by command alone: their roots are kept until `definitionsKnown` is
/// cleared, by whoever changes one.
struct RootCache {
    bool definitionsKnown = false;
    std::uint64_t definitions = 0;
};
std::uint64_t fullRoot(const WorldState& state, RootCache& cache);

}  // namespace huestep
