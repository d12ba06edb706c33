#include "core/collision/broad_phase.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "core/math/lanes.h"
#include "core/parallel/over_range.h"

namespace huestep {

namespace {

constexpr int lowestLevel = -7;   // cells of 1/128 m
constexpr int highestLevel = 21;  // cells of 2,097 km: any box fits, as speeds have a cap
constexpr std::int64_t cellBias = std::int64_t{1} << 27;
constexpr std::uint64_t cellMask = (std::uint64_t{1} << 28) - 1;
constexpr std::uint32_t joinGrain = 256;
constexpr std::uint32_t mostJoinBlocks = 256;
constexpr std::uint32_t entryGrain = 512;
constexpr std::size_t joinAllFrom = 8;        // from an eighth of all shapes on
constexpr std::uint32_t joinSerially = 1024;  // entries: fewer are joined before a team is awake
constexpr std::uint32_t sparseLevel = 16;     // entries: a level of so few is read whole
// What flies by many times its size a tick hits something before it comes where its box would
// reach: in a crowd that is thrown about, long boxes would pair all with all.
constexpr float farthestTravel = 1.0f;  // of its size

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
    const float most = farthestTravel * size;
    const float x = clampTo(travel.x, -most, most);
    const float y = clampTo(travel.y, -most, most);
    (x < 0 ? fat.low.x : fat.high.x) += x;
    (y < 0 ? fat.low.y : fat.high.y) += y;
    return fat;
}

bool isForbidden(std::uint32_t bodyA, std::uint32_t bodyB, std::span<const ShapePair> forbidden) {
    const ShapePair bodies{std::min(bodyA, bodyB), std::max(bodyA, bodyB)};
    return std::binary_search(forbidden.begin(), forbidden.end(), bodies);
}

ShapePair ordered(std::uint32_t a, std::uint32_t b) {
    return a < b ? ShapePair{a, b} : ShapePair{b, a};
}

}  // namespace

void BroadPhase::clear() {
    m_fat.clear();
    m_entries.clear();
    m_levels.clear();
    m_fixed.clear();
    m_fixedLevels.clear();
    m_pairs.clear();
    m_isMoved.clear();
}

std::uint32_t BroadPhase::tagOf(std::uint32_t shape, const ShapeProxy& proxy) {
    const std::uint32_t fixed = proxy.dynamic ? 0u : 1u;
    return shape | static_cast<std::uint32_t>(proxy.kind) << 24 | fixed << 31;
}

BroadPhase::Entry BroadPhase::entryOf(std::uint32_t shape, const ShapeProxy& proxy) const {
    const Bounds& box = m_fat[shape];
    return {box.low.x,  box.low.y,           -box.high.x, -box.high.y,
            keyOf(box), tagOf(shape, proxy), proxy.body};
}

void BroadPhase::renumber(std::span<const std::uint32_t> placeOf,
                          std::span<const ShapeProxy> proxies) {
    learnKinds(proxies);
    const auto placeNow = [&](std::uint32_t shape) {
        return placeOf.empty() ? shape : placeOf[shape];
    };
    auto to = m_entries.begin();
    for (Entry entry : m_entries) {
        const std::uint32_t shape = placeNow(entry.shape());
        if (shape == noPlace) continue;
        entry.tag = tagOf(shape, proxies[shape]);
        entry.body = proxies[shape].body;
        *to++ = entry;
    }
    m_entries.erase(to, m_entries.end());
    findLevels();
    if (placeOf.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < m_fat.size(); ++i) {
        if (placeOf[i] == noPlace) continue;
        m_fat[placeOf[i]] = m_fat[i];
        kept = placeOf[i] + 1;
    }
    m_fat.resize(kept);
    m_isMoved.resize(kept);
    renumberPairs(m_pairs, placeOf);
}

void BroadPhase::letGo(std::uint32_t shape) {
    constexpr float far = std::numeric_limits<float>::max();
    if (shape < m_fat.size()) m_fat[shape] = {{far, far}, {-far, -far}};
}

void BroadPhase::learnKinds(std::span<const ShapeProxy> proxies) {
    std::array<const ShapeProxy*, ShapeProxy::unknownKind> of{};
    for (const ShapeProxy& p : proxies) {
        if (p.kind < of.size()) of[p.kind] = &p;
    }
    for (std::size_t a = 0; a < of.size(); ++a) {
        m_mayPair[a] = m_mayForbid[a] = 0;
        for (std::size_t b = 0; b < of.size() && of[a] != nullptr; ++b) {
            if (of[b] == nullptr || !mayTouch(of[a]->filter, of[b]->filter)) continue;
            if (!of[a]->dynamic && !of[b]->dynamic) continue;
            m_mayPair[a] |= std::uint64_t{1} << b;
            if (of[a]->jointed && of[b]->jointed) m_mayForbid[a] |= std::uint64_t{1} << b;
        }
    }
}

bool BroadPhase::mayPair(const Entry& a, const Entry& b, std::span<const ShapeProxy> proxies,
                         std::span<const ShapePair> forbidden) const {
    if (a.body == b.body) return false;
    const std::uint32_t kindA = a.kind(), kindB = b.kind();
    if (kindA < ShapeProxy::unknownKind && kindB < ShapeProxy::unknownKind) {
        if ((m_mayPair[kindA] >> kindB & 1) == 0) return false;
        return (m_mayForbid[kindA] >> kindB & 1) == 0 || !isForbidden(a.body, b.body, forbidden);
    }
    const ShapeProxy& p = proxies[a.shape()];
    const ShapeProxy& q = proxies[b.shape()];
    if (!(p.dynamic || q.dynamic) || !mayTouch(p.filter, q.filter)) return false;
    return !(p.jointed && q.jointed) || !isForbidden(a.body, b.body, forbidden);
}

/// New fat boxes for all, so that they run out together and not a few every tick.
void BroadPhase::rebuildAll(std::span<const Bounds> tight, std::span<const Vec2> travel,
                            std::span<const ShapeProxy> proxies, Executor* executor) {
    if (m_fat.size() != tight.size()) {
        m_fat.resize(tight.size());
        m_isMoved.assign(tight.size(), 0);
        m_entries.clear();
        for (std::uint32_t i = 0; i < tight.size(); ++i) {
            if (!proxies[i].alone) m_entries.push_back({0, 0, 0, 0, 0, i, 0});
        }
        learnKinds(proxies);
    }
    overRange(executor, m_entries.size(), entryGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t shape = m_entries[i].shape();
            m_fat[shape] = fattened(tight[shape], travel[shape]);
            m_entries[i] = entryOf(shape, proxies[shape]);
        }
    });
    sortEntries();
    findLevels();
}

/// Sorts all entries by key: least significant digit first. Rows and columns are counted from the
/// lowest that there is, so that few digits are left.
void BroadPhase::sortEntries() {
    struct Place {
        std::uint64_t key;
        std::uint32_t entry;
    };
    constexpr int digitBits = 8;
    constexpr std::uint64_t digitMask = (1u << digitBits) - 1;
    const std::size_t count = m_entries.size();
    if (count == 0) return;
    const auto rowOf = [](std::uint64_t key) { return key >> 28 & cellMask; };
    const auto columnOf = [](std::uint64_t key) { return key & cellMask; };
    std::uint64_t row0 = cellMask, row1 = 0, column0 = cellMask, column1 = 0;
    for (const Entry& e : m_entries) {
        row0 = std::min(row0, rowOf(e.key));
        row1 = std::max(row1, rowOf(e.key));
        column0 = std::min(column0, columnOf(e.key));
        column1 = std::max(column1, columnOf(e.key));
    }
    const auto columnBits = std::bit_width(column1 - column0);
    const auto rowBits = std::bit_width(row1 - row0);
    std::vector<Place> places(count), next(count);
    std::uint64_t used = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint64_t key = m_entries[i].key;
        const std::uint64_t row = rowOf(key) - row0, column = columnOf(key) - column0;
        places[i] = {((key >> 56) << rowBits | row) << columnBits | column, i};
        used |= places[i].key;
    }
    for (int shift = 0; shift < 64 && used >> shift != 0; shift += digitBits) {
        if ((used >> shift & digitMask) == 0) continue;
        std::array<std::uint32_t, digitMask + 1> start{};
        for (const Place& p : places) ++start[p.key >> shift & digitMask];
        std::uint32_t sum = 0;
        for (std::uint32_t& s : start) {
            const std::uint32_t of = s;
            s = sum;
            sum += of;
        }
        for (const Place& p : places) next[start[p.key >> shift & digitMask]++] = p;
        places.swap(next);
    }
    m_scratch.entries.resize(count);
    for (std::size_t i = 0; i < count; ++i) m_scratch.entries[i] = m_entries[places[i].entry];
    m_entries.swap(m_scratch.entries);
}

void BroadPhase::findLevels() {
    m_fixed.clear();
    for (const Entry& e : m_entries) {
        if (e.fixed()) m_fixed.push_back(e);
    }
    const auto find = [](std::span<const Entry> entries, std::vector<Level>& levels) {
        levels.clear();
        for (std::uint32_t i = 0; i < entries.size(); ++i) {
            const int level = static_cast<int>(entries[i].key >> 56) + lowestLevel;
            if (levels.empty() || levels.back().level != level) levels.push_back({level, i, i});
            levels.back().end = i + 1;
        }
    };
    find(m_entries, m_levels);
    find(m_fixed, m_fixedLevels);
}

/// Takes the moved entries out, sorts them by their new cells, and merges them in again.
void BroadPhase::moveEntries(std::span<const std::uint32_t> moved,
                             std::span<const ShapeProxy> proxies) {
    const auto before = [](const Entry& a, const Entry& b) { return a.key < b.key; };
    std::vector<Entry> changed;
    changed.reserve(moved.size());
    for (const std::uint32_t shape : moved) {
        changed.push_back(entryOf(shape, proxies[shape]));
    }
    std::sort(changed.begin(), changed.end(), before);
    std::erase_if(m_entries, [this](const Entry& e) { return m_isMoved[e.shape()] != 0; });
    m_scratch.entries.resize(m_entries.size() + changed.size());
    std::merge(m_entries.begin(), m_entries.end(), changed.begin(), changed.end(),
               m_scratch.entries.begin(), before);
    m_entries.swap(m_scratch.entries);
    findLevels();
}

/// The box whose overlaps are wanted: highs, and lows negated.
struct BroadPhase::Query {
    explicit Query(const Entry& e) : Query(e.lowX, e.lowY, e.minusHighX, e.minusHighY) {}
    explicit Query(const Bounds& b) : Query(b.low.x, b.low.y, -b.high.x, -b.high.y) {}

    [[nodiscard]] bool overlaps(const Entry& e) const {
        return allSet(loadLanes<4>(&e.lowX) <= m_limits);
    }

 private:
    Query(float lowX, float lowY, float minusHighX, float minusHighY)
        : m_limits{-minusHighX, -minusHighY, -lowX, -lowY} {}
    LaneF<4> m_limits;
};

/// Calls `visit(entry)` for those of sorted entries of a level whose boxes overlap `box`.
template <class Visit>
void BroadPhase::visitOverlaps(std::span<const Entry> entries, const Level& level,
                               const Bounds& box, Visit visit) {
    const Query query(box);
    const auto scan = [&](std::uint32_t from, std::uint32_t to, std::uint64_t lastKey) {
        for (std::uint32_t i = from; i < to && entries[i].key <= lastKey; ++i) {
            if (query.overlaps(entries[i])) visit(entries[i]);
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
            std::lower_bound(entries.begin() + level.begin, entries.begin() + level.end, first,
                             [](const Entry& e, std::uint64_t key) { return e.key < key; });
        scan(static_cast<std::uint32_t>(from - entries.begin()), level.end,
             keyOf(level.level, row, cells.column1));
    }
}

void BroadPhase::findFixed(std::uint32_t shape, const Bounds& box,
                           std::span<const ShapeProxy> proxies,
                           std::span<const ShapePair> forbidden,
                           std::vector<std::uint32_t>& out) const {
    const Entry mine = entryOf(shape, proxies[shape]);
    for (const Level& level : m_fixedLevels) {
        visitOverlaps(m_fixed, level, box, [&](const Entry& other) {
            if (mayPair(mine, other, proxies, forbidden)) out.push_back(other.shape());
        });
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
        const Query query(e);
        while (j < entries.size() && entries[j].key <= lastKey) {
            std::size_t hits = 0;
            for (; hits < near.size() && j < entries.size() && entries[j].key <= lastKey; ++j) {
                near[hits] = j;
                hits += query.overlaps(entries[j]) ? 1u : 0u;
            }
            for (std::size_t k = 0; k < hits; ++k) {
                const Entry& other = entries[near[k]];
                if (mayPair(e, other, proxies, forbidden)) {
                    out.push_back(ordered(e.shape(), other.shape()));
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
            const Cells cells =
                cellsAround(level.level, {{e.lowX, e.lowY}, {-e.minusHighX, -e.minusHighY}});
            for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
                Cursor& cursor = coarser[l][static_cast<std::uint64_t>(row) % rowsAtOnce];
                join(e, cursor.first(entries, keyOf(level.level, row, cells.column0)),
                     keyOf(level.level, row, cells.column1));
            }
        }
    }
}

void BroadPhase::joinAll(std::span<const ShapeProxy> proxies, std::span<const ShapePair> forbidden,
                         Executor* executor) {
    const auto count = static_cast<std::uint32_t>(m_entries.size());
    // Fewer are joined and sorted before a team is awake.
    if (count < joinSerially) executor = nullptr;
    const std::uint32_t grain = std::max(joinGrain, count / mostJoinBlocks + 1);
    m_scratch.sorter.begin(m_fat.size(), (count + grain - 1) / grain);
    overBlocks(executor, count, grain, [&](std::uint32_t begin, std::uint32_t end) {
        joinBlock(begin, end, proxies, forbidden, m_scratch.sorter.block(begin / grain));
    });
    m_scratch.sorter.sortInto(m_scratch.all, executor);
}

/// Pairs without a moved shape stay; those with one are found anew.
void BroadPhase::joinMoved(std::span<const std::uint32_t> moved,
                           std::span<const ShapeProxy> proxies,
                           std::span<const ShapePair> forbidden) {
    std::vector<ShapePair>& found = m_scratch.found;
    found.clear();
    for (const std::uint32_t shape : moved) {
        const Entry mine = entryOf(shape, proxies[shape]);
        for (const Level& level : m_levels) {
            visitOverlaps(m_entries, level, m_fat[shape], [&](const Entry& other) {
                const std::uint32_t s = other.shape();
                // Two moved shapes find each other: the lower one keeps the pair.
                if (s == shape || (m_isMoved[s] && s < shape)) return;
                if (mayPair(mine, other, proxies, forbidden)) found.push_back(ordered(shape, s));
            });
        }
    }
    std::sort(found.begin(), found.end());
    std::vector<ShapePair>& stay = m_scratch.stay;
    stay.clear();
    for (const ShapePair& p : m_pairs) {
        if (!(m_isMoved[p.a] | m_isMoved[p.b])) stay.push_back(p);
    }
    m_scratch.all.resize(stay.size() + found.size());
    std::merge(stay.begin(), stay.end(), found.begin(), found.end(), m_scratch.all.begin());
}

bool BroadPhase::update(std::span<const Bounds> tight, std::span<const Vec2> travel,
                        std::span<const std::uint32_t> moved, std::span<const ShapeProxy> proxies,
                        std::span<const ShapePair> forbidden, Executor* executor) {
    const bool first = m_fat.empty() && !tight.empty();
    if (!first && moved.empty()) {
        m_movedCount = 0;
        return false;
    }
    // A query searches every level from its top, a step of the join moves a cursor: the join of all
    // costs about as much as queries of a part of them. Either way the pairs are right.
    if (first || moved.size() * joinAllFrom > m_entries.size()) {
        rebuildAll(tight, travel, proxies, executor);
        m_movedCount = static_cast<std::uint32_t>(first ? m_entries.size() : moved.size());
        joinAll(proxies, forbidden, executor);
    } else {
        m_movedCount = static_cast<std::uint32_t>(moved.size());
        m_fat.resize(tight.size());
        m_isMoved.resize(tight.size(), 0);
        for (const std::uint32_t shape : moved) {
            m_fat[shape] = fattened(tight[shape], travel[shape]);
            m_isMoved[shape] = 1;
        }
        moveEntries(moved, proxies);
        joinMoved(moved, proxies, forbidden);
        for (const std::uint32_t shape : moved) m_isMoved[shape] = 0;
    }
    const bool changed = first || m_scratch.all != m_pairs;
    m_pairs.swap(m_scratch.all);
    return changed;
}

}  // namespace huestep
