// Colouring: correct on random graphs, and exactly first fit.

#include "core/graph/coloring.h"

#include <map>
#include <set>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

using Graph = std::vector<ConstraintBodies>;

Graph randomGraph(Random& random, std::uint32_t bodies, std::uint32_t constraints) {
    Graph graph;
    // A few bodies get most of the constraints, as the ground or a hub does.
    const auto body = [&] {
        return static_cast<BodyPlace>(random.once(3) ? random.below(1 + bodies / 20)
                                                     : random.below(bodies));
    };
    for (std::uint32_t i = 0; i < constraints; ++i) {
        ConstraintBodies c{body(), body()};
        if (c.a == c.b || random.once(4)) (random.once(2) ? c.a : c.b) = ~body();
        graph.push_back(c);
    }
    return graph;
}

/// First fit as the header states it, with sets.
std::vector<std::uint8_t> firstFit(const Graph& graph) {
    std::map<BodyPlace, std::set<int>> moving, fixed;
    std::vector<std::uint8_t> colours;
    for (const ConstraintBodies& c : graph) {
        int colour = 0;
        if (c.a >= 0 && c.b >= 0) {
            while (colour < 64 && (moving[c.a].contains(colour) || moving[c.b].contains(colour))) {
                ++colour;
            }
            if (colour < 64) {
                moving[c.a].insert(colour);
                moving[c.b].insert(colour);
            }
            colours.push_back(static_cast<std::uint8_t>(colour));
        } else {
            const BodyPlace body = c.a >= 0 ? c.a : c.b;
            while (colour < 64 && fixed[body].contains(colour)) ++colour;
            if (colour < 64) fixed[body].insert(colour);
            colours.push_back(static_cast<std::uint8_t>(colour < 64 ? firstFixedColour + colour
                                                                    : fixedOverflowColour));
        }
    }
    return colours;
}

TEST(Colouring, GivesNoMovingBodyTwoConstraintsOfOneColour) {
    Random random(81);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 60; ++trial) {
        const std::uint32_t bodies = 2 + random.below(200);
        const Graph graph = randomGraph(random, bodies, random.below(1200));
        std::vector<std::uint8_t> colours;
        color(graph, bodies, colours);
        ASSERT_EQ(colours.size(), graph.size());
        std::set<std::pair<int, BodyPlace>> taken;
        for (std::size_t i = 0; i < graph.size(); ++i) {
            ASSERT_LT(colours[i], colourCount);
            if (isSerial(colours[i])) continue;
            const bool both = graph[i].a >= 0 && graph[i].b >= 0;
            ASSERT_EQ(colours[i] < overflowColour, both) << "static ones come last";
            for (const BodyPlace body : {graph[i].a, graph[i].b}) {
                if (body >= 0) {
                    ASSERT_TRUE(taken.emplace(colours[i], body).second) << "constraint " << i;
                }
            }
        }
        ASSERT_EQ(colours, firstFit(graph));
    }
}

TEST(Colouring, SendsWhatAHubHasBeyond64ToTheOverflow) {
    Graph graph;
    for (BodyPlace i = 1; i <= 100; ++i) graph.push_back({0, i});
    graph.push_back({5, 6});
    std::vector<std::uint8_t> colours;
    color(graph, 101, colours);
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_EQ(colours[i], i < 64 ? static_cast<int>(i) : static_cast<int>(overflowColour));
    }
    EXPECT_EQ(colours[100], 0) << "others keep the low colours";
    graph.clear();
    for (int i = 0; i < 70; ++i) graph.push_back({0, fixedWorld});
    color(graph, 1, colours);
    EXPECT_EQ(colours[63], firstFixedColour + 63);
    EXPECT_EQ(colours[64], fixedOverflowColour) << "which comes after all others";
}

TEST(Colouring, OfAPartIsThatOfTheWholeSoBatchesMayBeCutAnyhow) {
    Random random(82);
    SCOPED_TRACE(random.trace());
    // Two graphs that share no body, mixed in order: each keeps the colours it has alone.
    const Graph one = randomGraph(random, 40, 200), other = randomGraph(random, 40, 200);
    Graph mixed;
    std::vector<std::size_t> source;
    std::size_t i = 0, j = 0;
    while (i < one.size() || j < other.size()) {
        const bool first = j == other.size() || (i < one.size() && random.once(2));
        ConstraintBodies c = first ? one[i++] : other[j++];
        if (!first) {
            if (c.a >= 0) c.a += 40;
            if (c.b >= 0) c.b += 40;
        }
        source.push_back(first ? 0 : 1);
        mixed.push_back(c);
    }
    std::vector<std::uint8_t> all, alone[2];
    color(mixed, 80, all);
    color(one, 40, alone[0]);
    color(other, 40, alone[1]);
    std::size_t next[2]{};
    for (std::size_t k = 0; k < all.size(); ++k)
        EXPECT_EQ(all[k], alone[source[k]][next[source[k]]++]);
}

}  // namespace
}  // namespace huestep::test
