/// The broad phase: which pairs of shapes are near enough to be looked at.
///
/// An accelerator only. It keeps a fat box around every shape that any other may touch, and the
/// sorted list of pairs whose fat boxes overlap; whoever reads the list tests the tight bounds, so
/// no result can depend on how fat the boxes are or when they were renewed.
///
/// Method: a hierarchical grid without pointers. A fat box of extent e lives in the cell of its
/// centre on the level of cell size 2^l ≥ e; boxes of one level overlap only if their cells are
/// neighbours. Entries are sorted by (level, row, column), so neighbours are three contiguous runs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/collision/shape_pair.h"
#include "core/collision/shape_proxy.h"
#include "core/math/vec.h"
#include "core/parallel/executor.h"

namespace huestep {

class BroadPhase {
 public:
    /// Forgets everything; the next update starts from nothing.
    void clear();

    /// Whether the bounds are within the shape's fat box; not before the first update.
    [[nodiscard]] bool holds(std::uint32_t shape, const Bounds& tight) const {
        return shape < m_fat.size() && contains(m_fat[shape], tight);
    }

    /// Shapes have come or gone. `placeOf`: by the place a shape had before, the one it has now, in
    /// the same order, or `noPlace` if it is gone; empty if all are where they were. `proxies`: of
    /// all that there are now; of those that stay `alone` is as it was. The next update must be
    /// told of every newcomer as one that moved.
    void renumber(std::span<const std::uint32_t> placeOf, std::span<const ShapeProxy> proxies);

    /// Does not hold the shape any more: its pairs are found anew by the next update.
    void letGo(std::uint32_t shape);

    /// Brings the pair list up to date. `tight`: bounds by shape; `travel`: how far each shape may
    /// move in a few ticks (m), a hint; `moved`: places of the shapes that the broad phase does not
    /// hold any more, none of them alone; at first it means nothing; `proxies`: the same from one
    /// `clear` or `renumber` to the next; `forbidden`: sorted pairs of body places that a joint
    /// keeps from touching. Bounds and travel of a shape alone are not read. Returns whether
    /// `pairs()` changed.
    bool update(std::span<const Bounds> tight, std::span<const Vec2> travel,
                std::span<const std::uint32_t> moved, std::span<const ShapeProxy> proxies,
                std::span<const ShapePair> forbidden, Executor* executor);

    /// Appends the shapes that are not dynamic, that a shape may pair with and whose fat boxes
    /// overlap `box`; which order, and how many beyond those whose bounds do, means nothing.
    void findFixed(std::uint32_t shape, const Bounds& box, std::span<const ShapeProxy> proxies,
                   std::span<const ShapePair> forbidden, std::vector<std::uint32_t>& out) const;

    /// Sorted by (a, b).
    [[nodiscard]] std::span<const ShapePair> pairs() const { return m_pairs; }

    /// Shapes that left their fat box in the last update.
    [[nodiscard]] std::uint32_t movedCount() const { return m_movedCount; }

 private:
    /// A fat box in its cell. Highs are negated: two boxes overlap if the one's four numbers are
    /// nowhere above the four of the other's `Query`, which is one comparison in lanes.
    struct alignas(32) Entry {
        float lowX = 0, lowY = 0, minusHighX = 0, minusHighY = 0;
        std::uint64_t key = 0;
        std::uint32_t tag = 0;   // shape in bits 0 to 23, kind in bits 24 to 30, fixed in bit 31
        std::uint32_t body = 0;  // place

        [[nodiscard]] std::uint32_t shape() const { return tag & 0xffffffu; }
        [[nodiscard]] std::uint32_t kind() const { return tag >> 24 & 0x7fu; }
        /// Whether its body is not dynamic.
        [[nodiscard]] bool fixed() const { return tag >> 31 != 0; }
    };
    static_assert(caps::maxShapes <= 0x1000000u);
    struct Query;
    class Cursor;
    struct Level {
        int level = 0;
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };

    /// Memory of one update, kept for the next; a copy starts with none.
    struct Scratch {
        Scratch() = default;
        Scratch(const Scratch&) {}
        Scratch& operator=(const Scratch&) { return *this; }
        std::vector<Entry> entries;
        std::vector<ShapePair> found, stay, all;
        PairSorter sorter;
    };

    [[nodiscard]] static std::uint32_t tagOf(std::uint32_t shape, const ShapeProxy& proxy);
    [[nodiscard]] Entry entryOf(std::uint32_t shape, const ShapeProxy& proxy) const;
    void learnKinds(std::span<const ShapeProxy> proxies);
    void rebuildAll(std::span<const Bounds> tight, std::span<const Vec2> travel,
                    std::span<const ShapeProxy> proxies, Executor* executor);
    void moveEntries(std::span<const std::uint32_t> moved, std::span<const ShapeProxy> proxies);
    void sortEntries();
    [[nodiscard]] bool mayPair(const Entry& a, const Entry& b, std::span<const ShapeProxy> proxies,
                               std::span<const ShapePair> forbidden) const;
    void findLevels();
    template <class Visit>
    static void visitOverlaps(std::span<const Entry> entries, const Level& level, const Bounds& box,
                              Visit visit);
    void joinBlock(std::uint32_t begin, std::uint32_t end, std::span<const ShapeProxy> proxies,
                   std::span<const ShapePair> forbidden, std::vector<ShapePair>& out) const;
    void joinAll(std::span<const ShapeProxy> proxies, std::span<const ShapePair> forbidden,
                 Executor* executor);
    void joinMoved(std::span<const std::uint32_t> moved, std::span<const ShapeProxy> proxies,
                   std::span<const ShapePair> forbidden);

    std::vector<Bounds> m_fat;  // by shape
    // By kind, a bit a kind: with whom it may pair at all, and where a joint may forbid that.
    std::array<std::uint64_t, ShapeProxy::unknownKind> m_mayPair{}, m_mayForbid{};
    std::vector<Entry> m_entries;  // sorted by key; which of equals is first means nothing
    std::vector<Level> m_levels;
    std::vector<Entry> m_fixed;  // those of them whose body is not dynamic
    std::vector<Level> m_fixedLevels;
    std::vector<ShapePair> m_pairs;
    std::vector<std::uint8_t> m_isMoved;  // by shape; all zero between updates
    std::uint32_t m_movedCount = 0;

    Scratch m_scratch;
};

}  // namespace huestep
