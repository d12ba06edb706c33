/// Islands: what is connected by contacts and joints, as a pure function of the links.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace huestep {

/// A constraint between two bodies, by their places in the world. `source` is the place of the
/// joint or contact. The list of a step holds joints by id, then contacts by key.
struct Link {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::uint32_t source = 0;
    bool revolute = false;  ///< a joint that is solved in lanes
};

/// Union-find whose representative is always the lowest place of the set, so that the result does
/// not depend on the order of unions.
class UnionFind {
 public:
    void reset(std::uint32_t count);
    std::uint32_t find(std::uint32_t i);
    void unite(std::uint32_t a, std::uint32_t b);

 private:
    std::vector<std::uint32_t> m_parent;
};

/// For each body the lowest body of its island. `dynamic[i]` ≠ 0: body i can be moved; others are
/// in no island and connect nothing (they are their own representative).
void findIslands(std::span<const Link> links, std::span<const std::uint8_t> dynamic,
                 UnionFind& sets);

}  // namespace huestep
