// Islands against a breadth-first walk.

#include "core/graph/islands.h"

#include <algorithm>
#include <queue>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

/// For each body the lowest body that can be reached from it over dynamic bodies.
std::vector<std::uint32_t> reachable(const std::vector<Link>& links,
                                     const std::vector<std::uint8_t>& dynamic) {
    std::vector<std::vector<std::uint32_t>> next(dynamic.size());
    for (const Link& link : links) {
        if (!dynamic[link.a] || !dynamic[link.b]) continue;
        next[link.a].push_back(link.b);
        next[link.b].push_back(link.a);
    }
    std::vector<std::uint32_t> lowest(dynamic.size(), 0xffffffffu);
    for (std::uint32_t start = 0; start < dynamic.size(); ++start) {
        if (lowest[start] != 0xffffffffu) continue;
        std::queue<std::uint32_t> open;
        open.push(start);
        lowest[start] = start;
        for (; !open.empty(); open.pop()) {
            for (const std::uint32_t body : next[open.front()]) {
                if (lowest[body] != 0xffffffffu) continue;
                lowest[body] = start;
                open.push(body);
            }
        }
    }
    return lowest;
}

TEST(Islands, AreWhatAWalkReachesNamedByTheirLowestBodyInAnyOrderOfLinks) {
    Random random(83);
    SCOPED_TRACE(random.trace());
    UnionFind sets;
    for (int trial = 0; trial < 100; ++trial) {
        const std::uint32_t bodies = 1 + random.below(300);
        std::vector<std::uint8_t> dynamic(bodies);
        for (auto& d : dynamic) d = !random.once(5);
        std::vector<Link> links(random.below(bodies * 2));
        for (Link& link : links) link = {random.below(bodies), random.below(bodies), 0};
        const std::vector<std::uint32_t> expected = reachable(links, dynamic);
        for (int order = 0; order < 3; ++order) {
            findIslands(links, dynamic, sets);
            for (std::uint32_t i = 0; i < bodies; ++i) ASSERT_EQ(sets.find(i), expected[i]);
            for (std::size_t i = links.size(); i > 1; --i) {
                std::swap(links[i - 1], links[random.below(i)]);
                std::swap(links[i - 1].a, links[i - 1].b);
            }
        }
    }
}

}  // namespace
}  // namespace huestep::test
