#include "core/graph/islands.h"

#include <numeric>

namespace huestep {

void UnionFind::reset(std::uint32_t count) {
    m_parent.resize(count);
    std::iota(m_parent.begin(), m_parent.end(), 0u);
}

std::uint32_t UnionFind::find(std::uint32_t i) {
    // Path halving (Tarjan and van Leeuwen 1984).
    while (m_parent[i] != i) {
        m_parent[i] = m_parent[m_parent[i]];
        i = m_parent[i];
    }
    return i;
}

void UnionFind::unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a < b) {
        m_parent[b] = a;
    } else {
        m_parent[a] = b;
    }
}

void findIslands(std::span<const Link> links, std::span<const std::uint8_t> dynamic,
                 UnionFind& sets) {
    sets.reset(static_cast<std::uint32_t>(dynamic.size()));
    for (const Link& link : links) {
        if (dynamic[link.a] && dynamic[link.b]) sets.unite(link.a, link.b);
    }
}

}  // namespace huestep
