#include "core/collision/shape_pair.h"

#include <algorithm>

#include "core/parallel/over_range.h"

namespace huestep {

namespace {

constexpr int leastRangeBits = 9;        // of shapes: their counters fill half of a first cache
constexpr std::size_t mostRanges = 256;  // else blocks times ranges would be quadratic in shapes
constexpr std::ptrdiff_t handful = 16;   // pairs of one shape that are sorted by insertion

}  // namespace

void renumberPairs(std::vector<ShapePair>& pairs, std::span<const std::uint32_t> placeOf) {
    auto to = pairs.begin();
    for (const ShapePair& pair : pairs) {
        const ShapePair now{placeOf[pair.a], placeOf[pair.b]};
        if (now.a != noPlace && now.b != noPlace) *to++ = now;
    }
    pairs.erase(to, pairs.end());
}

void PairSorter::begin(std::size_t shapeCount, std::size_t count) {
    m_rangeBits = leastRangeBits;
    while (shapeCount >> m_rangeBits >= mostRanges) ++m_rangeBits;
    m_ranges = (shapeCount >> m_rangeBits) + 1;
    m_count = count;
    if (m_blocks.size() < count) m_blocks.resize(count);
    for (std::size_t i = 0; i < count; ++i) m_blocks[i].pairs.clear();
}

void PairSorter::sortInto(std::vector<ShapePair>& out, Executor* executor) {
    overRange(executor, m_count, 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            Block& block = m_blocks[i];
            block.next.assign(m_ranges, 0);
            for (const ShapePair& p : block.pairs) ++block.next[p.a >> m_rangeBits];
        }
    });
    m_rangeStart.resize(m_ranges + 1);
    std::uint32_t sum = 0;
    for (std::size_t range = 0; range < m_ranges; ++range) {
        m_rangeStart[range] = sum;
        for (std::size_t i = 0; i < m_count; ++i) {
            const std::uint32_t of = m_blocks[i].next[range];
            m_blocks[i].next[range] = sum;
            sum += of;
        }
    }
    m_rangeStart[m_ranges] = sum;
    m_scattered.resize(sum);
    overRange(executor, m_count, 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            Block& block = m_blocks[i];
            for (const ShapePair& p : block.pairs) {
                m_scattered[block.next[p.a >> m_rangeBits]++] = p;
            }
        }
    });
    out.resize(sum);
    overRange(executor, m_ranges, 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t range = begin; range < end; ++range) sortRange(range, out);
    });
}

void PairSorter::sortRange(std::uint32_t range, std::vector<ShapePair>& out) const {
    const std::uint32_t first = m_rangeStart[range], last = m_rangeStart[range + 1];
    if (first == last) return;
    const std::uint32_t shapes = 1u << m_rangeBits;
    std::vector<std::uint32_t> start(shapes + 1, 0);
    const auto slot = [&](const ShapePair& p) { return p.a & (shapes - 1); };
    for (std::uint32_t i = first; i < last; ++i) ++start[slot(m_scattered[i]) + 1];
    start[0] = first;
    for (std::uint32_t s = 0; s < shapes; ++s) start[s + 1] += start[s];
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for (std::uint32_t i = first; i < last; ++i) {
        out[next[slot(m_scattered[i])]++] = m_scattered[i];
    }
    for (std::uint32_t s = 0; s < shapes; ++s) {
        // A handful mostly: by insertion. What is crowded is sorted as anything large is.
        const auto from = out.begin() + start[s], to = out.begin() + start[s + 1];
        if (to - from > handful) {
            std::sort(from, to);
            continue;
        }
        for (auto at = from; at != to; ++at) {
            const ShapePair pair = *at;
            auto place = at;
            for (; place != from && pair.b < (place - 1)->b; --place) *place = *(place - 1);
            *place = pair;
        }
    }
}

}  // namespace huestep
