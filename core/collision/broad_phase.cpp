#include "core/collision/broad_phase.h"

#include <algorithm>
#include <array>
#include <bit>

namespace huestep {

namespace {

constexpr int lowestLevel = -7;   // cells of 1/128 m
constexpr int highestLevel = 21;  // cells of 2,097 km: any box fits, as speeds have a cap
constexpr std::int64_t cellBias = std::int64_t{1} << 27;
constexpr std::uint64_t cellMask = (std::uint64_t{1} << 28) - 1;
constexpr std::uint32_t joinGrain = 128;
constexpr std::uint32_t joinSerially = 1024;  // entries: fewer are joined before a team is awake
constexpr std::uint32_t sparseLevel = 16;     // entries: a level of so few is read whole
constexpr float farthestTravel = 1000.0f;     // m: no fat box may outgrow the widest cell

float cellSize(int level) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(level + 127) << 23);
}

/// Cell of a coordinate. Clamping is monotone, so neighbours stay neighbours at the rim.
std::int64_t cellOf(float x, float inverseSize) {
    const float scaled = clampTo(x * inverseSize, -1.0e8f, 1.0e8f);
    const auto whole = static_cast<std::int64_t>(scaled);
    return whole - (static_cast<float>(whole) > scaled ? 1 : 0);
}

std::uint64_t keyOf(int level, std::int64_t row, std::int64_t column) {
    return (static_cast<std::uint64_t>(level - lowestLevel) << 56) |
           ((static_cast<std::uint64_t>(row + cellBias) & cellMask) << 28) |
           (static_cast<std::uint64_t>(column + cellBias) & cellMask);
}

int levelOf(const Bounds& box) {
    // A little more than the extent: centres and edges are rounded, the more the farther out.
    const float farthest = maxOf(maxOf(-box.low.x, box.high.x), maxOf(-box.low.y, box.high.y));
    const float extent = 1.01f * maxOf(box.high.x - box.low.x, box.high.y - box.low.y) +
                         2e-6f * maxOf(farthest, 0.0f);
    int level = lowestLevel;
    while (level < highestLevel && cellSize(level) < extent) ++level;
    return level;
}

std::uint64_t keyOf(const Bounds& box) {
    const int level = levelOf(box);
    const float inverse = 1.0f / cellSize(level);
    return keyOf(level, cellOf(0.5f * (box.low.y + box.high.y), inverse),
                 cellOf(0.5f * (box.low.x + box.high.x), inverse));
}

/// Cells in which the centres of boxes lie that overlap a box: at most half a cell beyond it.
struct Cells {
    std::int64_t row0, row1, column0, column1;
};
Cells cellsAround(int level, const Bounds& box) {
    const float size = cellSize(level);
    const float inverse = 1.0f / size;
    return {cellOf(box.low.y - 0.5f * size, inverse), cellOf(box.high.y + 0.5f * size, inverse),
            cellOf(box.low.x - 0.5f * size, inverse), cellOf(box.high.x + 0.5f * size, inverse)};
}

/// A little room all around, and the way the shape will go in the next ticks.
Bounds fattened(const Bounds& tight, Vec2 travel) {
    const float size = maxOf(tight.high.x - tight.low.x, tight.high.y - tight.low.y);
    const float margin = minOf(0.1f, 0.01f + 0.05f * size);
    Bounds fat = grown(tight, margin);
    const float x = clampTo(travel.x, -farthestTravel, farthestTravel);
    const float y = clampTo(travel.y, -farthestTravel, farthestTravel);
    (x < 0 ? fat.low.x : fat.high.x) += x;
    (y < 0 ? fat.low.y : fat.high.y) += y;
    return fat;
}

bool mayPair(const ShapeProxy& a, const ShapeProxy& b, std::span<const ShapePair> forbidden) {
    if (a.body == b.body || !(a.dynamic || b.dynamic)) return false;
    if (!mayTouch(a.filter, b.filter)) return false;
    if (!(a.jointed && b.jointed)) return true;
    const ShapePair bodies{std::min(a.body, b.body), std::max(a.body, b.body)};
    return !std::binary_search(forbidden.begin(), forbidden.end(), bodies);
}

ShapePair ordered(std::uint32_t a, std::uint32_t b) {
    return a < b ? ShapePair{a, b} : ShapePair{b, a};
}

/// Sorts pairs by buckets of `a`: a counting sort, then a handful in each bucket.
void sortPairs(std::vector<ShapePair>& pairs, std::size_t shapeCount,
               std::vector<ShapePair>& scratch) {
    std::vector<std::uint32_t> start(shapeCount + 1, 0);
    for (const ShapePair& p : pairs) ++start[p.a + 1];
    for (std::size_t i = 1; i <= shapeCount; ++i) start[i] += start[i - 1];
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    scratch.resize(pairs.size());
    for (const ShapePair& p : pairs) scratch[next[p.a]++] = p;
    for (std::size_t i = 0; i < shapeCount; ++i) {
        std::sort(scratch.begin() + start[i], scratch.begin() + start[i + 1]);
    }
    pairs.swap(scratch);
}

}  // namespace

void markAlone(std::span<ShapeProxy> proxies) {
    constexpr std::size_t mostKinds = 64;  // each is compared with each
    struct Kind {
        Filter filter;
        bool dynamic = false;
        std::uint32_t body = 0;
        bool manyBodies = false;
        bool alone = true;
    };
    for (ShapeProxy& p : proxies) p.alone = false;
    std::vector<Kind> kinds;
    const auto kindOf = [&](const ShapeProxy& p) {
        return std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) {
            return k.filter == p.filter && k.dynamic == p.dynamic;
        });
    };
    for (const ShapeProxy& p : proxies) {
        const auto known = kindOf(p);
        if (known != kinds.end()) {
            known->manyBodies = known->manyBodies || known->body != p.body;
        } else {
            if (kinds.size() == mostKinds) return;
            kinds.push_back({p.filter, p.dynamic, p.body});
        }
    }
    for (Kind& a : kinds) {
        for (const Kind& b : kinds) {
            if (&a == &b && !a.manyBodies) continue;
            if (mayTouch(a.filter, b.filter) && (a.dynamic || b.dynamic)) a.alone = false;
        }
    }
    for (ShapeProxy& p : proxies) p.alone = kindOf(p)->alone;
}

void BroadPhase::clear() {
    m_fat.clear();
    m_entries.clear();
    m_levels.clear();
    m_pairs.clear();
    m_isMoved.clear();
}

void BroadPhase::rebuildAll(std::span<const Bounds> tight, std::span<const Vec2> travel,
                            std::span<const ShapeProxy> proxies) {
    m_fat.resize(tight.size());
    m_isMoved.assign(tight.size(), 0);
    m_entries.clear();
    for (std::uint32_t i = 0; i < tight.size(); ++i) {
        if (proxies[i].alone) continue;
        m_fat[i] = fattened(tight[i], travel[i]);
        m_entries.push_back({keyOf(m_fat[i]), i, m_fat[i]});
    }
    std::sort(m_entries.begin(), m_entries.end(), [](const Entry& a, const Entry& b) {
        return a.key != b.key ? a.key < b.key : a.shape < b.shape;
    });
    findLevels();
}

void BroadPhase::findLevels() {
    m_levels.clear();
    for (std::uint32_t i = 0; i < m_entries.size(); ++i) {
        const int level = static_cast<int>(m_entries[i].key >> 56) + lowestLevel;
        if (m_levels.empty() || m_levels.back().level != level) m_levels.push_back({level, i, i});
        m_levels.back().end = i + 1;
    }
}

/// Takes the moved entries out, sorts them by their new cells, and merges them in again.
void BroadPhase::moveEntries(std::span<const std::uint32_t> moved) {
    const auto before = [](const Entry& a, const Entry& b) {
        return a.key != b.key ? a.key < b.key : a.shape < b.shape;
    };
    std::vector<Entry> changed;
    changed.reserve(moved.size());
    for (const std::uint32_t shape : moved) {
        changed.push_back({keyOf(m_fat[shape]), shape, m_fat[shape]});
    }
    std::sort(changed.begin(), changed.end(), before);
    std::erase_if(m_entries, [this](const Entry& e) { return m_isMoved[e.shape] != 0; });
    m_entryScratch.resize(m_entries.size() + changed.size());
    std::merge(m_entries.begin(), m_entries.end(), changed.begin(), changed.end(),
               m_entryScratch.begin(), before);
    m_entries.swap(m_entryScratch);
    findLevels();
}

/// Calls `visit(entry)` for the entries of a level whose boxes overlap `box`.
template <class Visit>
void BroadPhase::visitOverlaps(const Level& level, const Bounds& box, Visit visit) const {
    const auto scan = [&](std::uint32_t from, std::uint32_t to, std::uint64_t lastKey) {
        for (std::uint32_t i = from; i < to && m_entries[i].key <= lastKey; ++i) {
            if (overlaps(m_entries[i].box, box)) visit(m_entries[i]);
        }
    };
    const Cells cells = cellsAround(level.level, box);
    const std::uint32_t population = level.end - level.begin;
    if (population <= sparseLevel ||
        cells.row1 - cells.row0 >= static_cast<std::int64_t>(population) / 8) {
        scan(level.begin, level.end, ~std::uint64_t{0});
        return;
    }
    for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
        const std::uint64_t first = keyOf(level.level, row, cells.column0);
        const auto from =
            std::lower_bound(m_entries.begin() + level.begin, m_entries.begin() + level.end, first,
                             [](const Entry& e, std::uint64_t key) { return e.key < key; });
        scan(static_cast<std::uint32_t>(from - m_entries.begin()), level.end,
             keyOf(level.level, row, cells.column1));
    }
}

/// Walks entries in key order beside a run of others that moves up with them.
///
/// `first(key)` is the first entry at or after a key. Entries of a row come with rising columns, so
/// the run mostly moves a step; a new row is found by bisection.
class BroadPhase::Cursor {
 public:
    std::uint32_t first(std::span<const Entry> entries, std::uint64_t key) {
        const auto end = static_cast<std::uint32_t>(entries.size());
        if (m_at >= end || key < m_key || (entries[m_at].key + farKeys < key)) {
            m_at = static_cast<std::uint32_t>(
                std::lower_bound(entries.begin(), entries.end(), key,
                                 [](const Entry& e, std::uint64_t k) { return e.key < k; }) -
                entries.begin());
        }
        m_key = key;
        while (m_at < end && entries[m_at].key < key) ++m_at;
        return m_at;
    }

 private:
    static constexpr std::uint64_t farKeys = 64;  // columns: past that bisection is quicker
    std::uint64_t m_key = 0;
    std::uint32_t m_at = 0;
};

/// All pairs of an entry of [begin, end) with later ones of its level and with coarser levels.
void BroadPhase::joinBlock(std::uint32_t begin, std::uint32_t end,
                           std::span<const ShapeProxy> proxies,
                           std::span<const ShapePair> forbidden,
                           std::vector<ShapePair>& out) const {
    const std::span<const Entry> entries(m_entries);
    std::array<std::uint32_t, 64> near{};  // entries that overlap the one at hand
    // Tests entries from `j` on up to `lastKey`. Most runs are short and hits hard to foresee: each
    // is written down and counted only if it overlaps, without a branch.
    const auto join = [&](const Entry& e, std::uint32_t j, std::uint64_t lastKey) {
        while (j < entries.size() && entries[j].key <= lastKey) {
            std::size_t hits = 0;
            for (; hits < near.size() && j < entries.size() && entries[j].key <= lastKey; ++j) {
                near[hits] = j;
                hits += overlaps(e.box, entries[j].box) ? 1u : 0u;
            }
            for (std::size_t k = 0; k < hits; ++k) {
                const std::uint32_t other = entries[near[k]].shape;
                if (mayPair(proxies[e.shape], proxies[other], forbidden)) {
                    out.push_back(ordered(e.shape, other));
                }
            }
        }
    };
    constexpr std::uint64_t nextRow = std::uint64_t{1} << 28;
    constexpr std::size_t rowsAtOnce = 4;  // a box meets at most three rows of a coarser level
    std::vector<std::array<Cursor, rowsAtOnce>> coarser(m_levels.size());
    Cursor above;
    for (std::uint32_t i = begin; i < end; ++i) {
        const Entry& e = entries[i];
        // The same row: this cell and the next. The row above: three cells.
        join(e, i + 1, e.key + 1);
        join(e, above.first(entries, e.key + nextRow - 1), e.key + nextRow + 1);
        for (std::size_t l = 0; l < m_levels.size(); ++l) {
            const Level& level = m_levels[l];
            if (static_cast<std::uint64_t>(level.level - lowestLevel) <= e.key >> 56) continue;
            if (level.end - level.begin <= sparseLevel) {
                join(e, level.begin, entries[level.end - 1].key);
                continue;
            }
            const Cells cells = cellsAround(level.level, e.box);
            for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
                Cursor& cursor = coarser[l][static_cast<std::uint64_t>(row) % rowsAtOnce];
                join(e, cursor.first(entries, keyOf(level.level, row, cells.column0)),
                     keyOf(level.level, row, cells.column1));
            }
        }
    }
}

void BroadPhase::joinAll(std::span<const ShapeProxy> proxies, std::span<const ShapePair> forbidden,
                         Executor* executor, std::vector<ShapePair>& out) {
    const auto count = static_cast<std::uint32_t>(m_entries.size());
    if (executor == nullptr || executor->threads() == 1 || count < joinSerially) {
        joinBlock(0, count, proxies, forbidden, out);
    } else {
        std::vector<std::vector<ShapePair>> parts((count + joinGrain - 1) / joinGrain);
        executor->forBlocks(count, joinGrain, [&](std::uint32_t begin, std::uint32_t end) {
            joinBlock(begin, end, proxies, forbidden, parts[begin / joinGrain]);
        });
        for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
    }
    sortPairs(out, m_fat.size(), m_scratch);
}

/// Pairs without a moved shape stay; those with one are found anew.
void BroadPhase::joinMoved(std::span<const std::uint32_t> moved,
                           std::span<const ShapeProxy> proxies,
                           std::span<const ShapePair> forbidden, std::vector<ShapePair>& out) {
    std::vector<ShapePair> found;
    for (const std::uint32_t shape : moved) {
        for (const Level& level : m_levels) {
            visitOverlaps(level, m_fat[shape], [&](const Entry& other) {
                // Two moved shapes find each other: the lower one keeps the pair.
                if (other.shape == shape || (m_isMoved[other.shape] && other.shape < shape)) return;
                if (mayPair(proxies[shape], proxies[other.shape], forbidden)) {
                    found.push_back(ordered(shape, other.shape));
                }
            });
        }
    }
    std::sort(found.begin(), found.end());
    m_scratch.clear();
    for (const ShapePair& p : m_pairs) {
        if (!(m_isMoved[p.a] | m_isMoved[p.b])) m_scratch.push_back(p);
    }
    out.resize(m_scratch.size() + found.size());
    std::merge(m_scratch.begin(), m_scratch.end(), found.begin(), found.end(), out.begin());
}

bool BroadPhase::update(std::span<const Bounds> tight, std::span<const Vec2> travel,
                        std::span<const std::uint32_t> moved, std::span<const ShapeProxy> proxies,
                        std::span<const ShapePair> forbidden, Executor* executor) {
    std::vector<ShapePair> fresh;
    if (m_fat.size() != tight.size()) {
        rebuildAll(tight, travel, proxies);
        m_movedCount = static_cast<std::uint32_t>(m_entries.size());
        joinAll(proxies, forbidden, executor, fresh);
        m_pairs.swap(fresh);
        return true;
    }
    m_movedCount = static_cast<std::uint32_t>(moved.size());
    if (moved.empty()) return false;
    for (const std::uint32_t shape : moved) {
        m_fat[shape] = fattened(tight[shape], travel[shape]);
        m_isMoved[shape] = 1;
    }
    moveEntries(moved);
    // A query searches every level from its top, a step of the join moves a cursor: the join of all
    // costs about as much as queries of a sixteenth. Either way the same pairs come out.
    if (moved.size() * 16 > m_entries.size()) {
        joinAll(proxies, forbidden, executor, fresh);
    } else {
        joinMoved(moved, proxies, forbidden, fresh);
    }
    for (const std::uint32_t shape : moved) m_isMoved[shape] = 0;
    const bool changed = fresh != m_pairs;
    m_pairs.swap(fresh);
    return changed;
}

}  // namespace huestep
