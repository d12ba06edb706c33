/// Pairs of shapes, and how those that many workers find come into the order of their key.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel/executor.h"

namespace huestep {

/// Places of two shapes, a < b.
struct ShapePair {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    friend auto operator<=>(const ShapePair&, const ShapePair&) = default;
};

/// Where something is that is gone.
inline constexpr std::uint32_t noPlace = 0xffffffffu;

/// Gives both ends their new places: `placeOf` is by old place and rises, but for `noPlace`: pairs
/// with an end that is gone go. What was sorted stays so.
void renumberPairs(std::vector<ShapePair>& pairs, std::span<const std::uint32_t> placeOf);

/// Collects pairs block by block, each worker into the block it works on, and sorts them all: a
/// scatter to ranges of `a`, then a counting sort of each range in a core's first cache. Memory
/// stays for the next use.
class PairSorter {
 public:
    /// Empties `count` blocks. Pairs to come are of shapes below `shapeCount`.
    void begin(std::size_t shapeCount, std::size_t count);
    /// Thread rule: one worker a block.
    [[nodiscard]] std::vector<ShapePair>& block(std::size_t i) { return m_blocks[i].pairs; }
    /// All pairs of all blocks, rising. What is found twice is there twice.
    void sortInto(std::vector<ShapePair>& out, Executor* executor);

 private:
    struct Block {
        std::vector<ShapePair> pairs;
        std::vector<std::uint32_t> next;  // by range: where its next pair goes
    };

    void sortRange(std::uint32_t range, std::vector<ShapePair>& out) const;

    int m_rangeBits = 0;  // shapes of a range, as a power of two
    std::size_t m_ranges = 0;
    std::size_t m_count = 0;  // blocks in use
    std::vector<Block> m_blocks;
    std::vector<std::uint32_t> m_rangeStart;
    std::vector<ShapePair> m_scattered;
};

}  // namespace huestep
