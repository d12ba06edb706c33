// The plan: every link once, islands whole, lanes disjoint, whatever the size of a batch.

#include "core/graph/plan.h"

#include <algorithm>
#include <map>
#include <set>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

/// Bodies of all kinds with links that could be a world's: at least one end moves.
struct Case {
    std::vector<std::uint8_t> moves;
    std::vector<Link> links;
    std::uint32_t jointLinks = 0;
    std::vector<std::uint32_t> awake;
};

Case randomCase(Random& random) {
    Case c;
    const std::uint32_t bodies = 2 + random.below(400);
    for (std::uint32_t i = 0; i < bodies; ++i) {
        c.moves.push_back(!random.once(6));
        if (c.moves.back()) c.awake.push_back(i);
    }
    // Near neighbours are linked, so that islands of all sizes come out.
    const std::uint32_t reach = 1 + random.below(6);
    const std::uint32_t wanted = random.below(bodies * 3);
    for (std::uint32_t i = 0; i < wanted; ++i) {
        const std::uint32_t a = random.below(bodies);
        const std::uint32_t b = (a + 1 + random.below(reach)) % bodies;
        if (a == b || (!c.moves[a] && !c.moves[b])) continue;
        c.links.push_back({a, b, 0});
    }
    if (random.once(3)) {
        // A few hubs that many touch, some of them more than once.
        for (std::uint32_t i = random.below(bodies * 2); i > 0; --i) {
            const std::uint32_t hub = random.below(3), rim = random.below(bodies);
            if (hub >= bodies || hub == rim || (!c.moves[hub] && !c.moves[rim])) continue;
            c.links.push_back({hub, rim, 0});
        }
    }
    c.jointLinks = c.links.empty() ? 0 : random.below(c.links.size());
    for (std::uint32_t i = 0; i < c.links.size(); ++i) {
        c.links[i].source = i < c.jointLinks ? i : i - c.jointLinks;
        c.links[i].revolute = i < c.jointLinks && !random.once(3);
    }
    return c;
}

Plan planOf(const Case& c, std::uint32_t batchSize, std::uint32_t hubDegree = standardHubDegree) {
    Plan plan;
    makePlan(plan, std::vector<Link>(c.links), c.jointLinks, std::vector<std::uint32_t>(c.awake),
             static_cast<std::uint32_t>(c.moves.size()), {batchSize, hubDegree});
    return plan;
}

/// Checks one lane or joint of a run: its places lead to the bodies of its link.
void expectPlaces(const Case& c, const Plan& plan, const Batch& batch, const Link& link,
                  const ConstraintBodies& places) {
    const std::pair<std::uint32_t, BodyPlace> ends[] = {{link.a, places.a}, {link.b, places.b}};
    for (const auto& [body, place] : ends) {
        ASSERT_EQ(place >= 0, c.moves[body] != 0) << "only what moves is written";
        const auto at = static_cast<std::uint32_t>(readPlace(place));
        ASSERT_EQ(plan.bodyOfPlace[at], body);
        ASSERT_GE(at, batch.firstPlace);
        ASSERT_LT(at, batch.endCopy) << "batches share no place";
    }
}

void expectSound(const Case& c, const Plan& plan) {
    std::vector<int> jointSeen(c.jointLinks), contactSeen(c.links.size() - c.jointLinks);
    std::map<std::uint32_t, std::size_t> batchOfIsland;
    std::vector<int> placed(c.moves.size());
    for (std::size_t k = 0; k < plan.batches.size(); ++k) {
        const Batch& batch = plan.batches[k];
        for (std::uint32_t p = batch.firstPlace; p < batch.endPlace; ++p) {
            placed[plan.bodyOfPlace[p]] += c.moves[plan.bodyOfPlace[p]];
        }
        std::uint32_t inBatch = 0;
        int lastColour = -1;
        for (std::uint32_t r = batch.firstColour; r < batch.endColour; ++r) {
            const ColourRun& run = plan.runs[r];
            const bool hubAgain = isHub(run.colour) && run.colour == lastColour;
            ASSERT_TRUE(hubAgain || run.colour > lastColour) << "in solving order";
            lastColour = run.colour;
            inBatch += run.contactCount + run.revoluteCount + run.jointCount;
            std::set<BodyPlace> written;
            std::uint32_t lastLink = 0;
            const auto visit = [&](std::uint32_t linkIndex, const ConstraintBodies& places) {
                const Link& link = c.links[linkIndex];
                ASSERT_GE(linkIndex, lastLink) << "in key order within a colour";
                lastLink = linkIndex;
                ASSERT_EQ(plan.colourOfLink[linkIndex], run.colour);
                expectPlaces(c, plan, batch, link, places);
                const std::uint32_t island = plan.islandOf[c.moves[link.a] ? link.a : link.b];
                ASSERT_EQ(batchOfIsland.try_emplace(island, k).first->second, k)
                    << "island " << island << " is split";
                for (const BodyPlace place : {places.a, places.b}) {
                    if (place < 0 || isSerial(run.colour)) continue;
                    if (plan.isCopy[static_cast<std::size_t>(place)]) continue;
                    ASSERT_TRUE(written.insert(place).second) << "two lanes write one body";
                }
            };
            for (std::uint32_t i = 0; i < run.jointCount; ++i) {
                const std::uint32_t joint = plan.jointOrder[run.firstJoint + i];
                ++jointSeen[joint];
                visit(joint, plan.jointPlaces[run.firstJoint + i]);
            }
            lastLink = 0;
            const std::uint32_t pinLanes =
                (run.revoluteCount + blockLanes - 1) / blockLanes * blockLanes;
            for (std::uint32_t i = 0; i < pinLanes; ++i) {
                const std::uint32_t at = run.firstRevoluteBlock * blockLanes + i;
                const std::uint32_t joint = plan.revoluteOfLane[at];
                ASSERT_EQ(joint == none, i >= run.revoluteCount) << "padding comes last";
                if (joint == none) continue;
                ++jointSeen[joint];
                ASSERT_TRUE(c.links[joint].revolute);
                ASSERT_FALSE(isSerial(run.colour)) << "the overflow is solved in key order";
                visit(joint, plan.revolutePlaces[at]);
            }
            const std::uint32_t lanes =
                (run.contactCount + blockLanes - 1) / blockLanes * blockLanes;
            for (std::uint32_t i = 0; i < lanes; ++i) {
                const std::uint32_t contact = plan.contactOfLane[run.firstBlock * blockLanes + i];
                ASSERT_EQ(contact == none, i >= run.contactCount) << "padding comes last";
                if (contact == none) continue;
                ++contactSeen[contact];
                const ConstraintBodies& places = plan.lanePlaces[run.firstBlock * blockLanes + i];
                visit(contact + c.jointLinks, places);
                if (!isHub(run.colour)) continue;
                const auto copy = static_cast<BodyPlace>(run.firstCopy + i % blockLanes);
                ASSERT_TRUE(places.a == copy || places.b == copy) << "a lane's own copy";
                ASSERT_EQ(plan.bodyOfPlace[static_cast<std::size_t>(copy)],
                          plan.bodyOfPlace[run.hub]);
                ASSERT_GE(static_cast<std::uint32_t>(copy), batch.endPlace);
            }
            if (testing::Test::HasFatalFailure()) return;
        }
        ASSERT_EQ(inBatch, batch.constraints);
    }
    for (const int seen : jointSeen) ASSERT_EQ(seen, 1);
    for (const int seen : contactSeen) ASSERT_EQ(seen, 1);
    for (const std::uint32_t body : plan.freeBodies) ++placed[body];
    for (std::size_t body = 0; body < placed.size(); ++body) {
        ASSERT_EQ(placed[body], c.moves[body] ? 1 : 0) << "body " << body;
    }
}

TEST(Plan, HoldsEveryLinkAndBodyOnceAndKeepsIslandsWholeForAnySizeOfBatch) {
    Random random(84);
    SCOPED_TRACE(random.trace());
    int buckets = 0;
    for (int trial = 0; trial < 90 && !HasFatalFailure(); ++trial) {
        const Case c = randomCase(random);
        const Plan standard = planOf(c, standardBatchSize);
        buckets += standard.inBuckets > 0;
        for (const std::uint32_t batchSize : {1u, 7u, 64u, standardBatchSize, 100'000u}) {
            SCOPED_TRACE("batches of " + std::to_string(batchSize));
            const Plan plan = planOf(c, batchSize);
            expectSound(c, plan);
            if (HasFatalFailure()) return;
            EXPECT_EQ(plan.colourOfLink, standard.colourOfLink)
                << "a colour does not depend on the batch";
            EXPECT_EQ(plan.islandOf, standard.islandOf);
            EXPECT_EQ(plan.islands, standard.islands);
            for (const Batch& batch : plan.batches) {
                EXPECT_EQ(batch.giant, batch.constraints > batchSize);
            }
        }
    }
    EXPECT_GT(buckets, 5) << "cases with hubs";
}

/// Bodies that all move, with links of contacts between them.
Case movers(std::uint32_t bodies, std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs) {
    Case c;
    c.moves.assign(bodies, 1);
    for (std::uint32_t i = 0; i < bodies; ++i) c.awake.push_back(i);
    for (const auto& [a, b] : pairs) {
        c.links.push_back({a, b, static_cast<std::uint32_t>(c.links.size())});
    }
    return c;
}

TEST(Plan, OfAPathACliqueAndAForestIsSoundAndHasTheirColours) {
    constexpr std::uint32_t length = 3000, members = 30, trees = 495;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> path, clique, forest;
    for (std::uint32_t i = 1; i < length; ++i) path.push_back({i - 1, i});
    for (std::uint32_t i = 0; i < members; ++i) {
        for (std::uint32_t j = i + 1; j < members; ++j) clique.push_back({i, j});
    }
    for (std::uint32_t i = 0; i < trees; ++i) {
        for (std::uint32_t leaf = 1; leaf < 4; ++leaf) forest.push_back({4 * i, 4 * i + leaf});
    }
    for (const std::uint32_t batchSize : {0u, 1u, 99u, standardBatchSize, 100'000u}) {
        SCOPED_TRACE("batches of " + std::to_string(batchSize));
        const Case one = movers(length, path), all = movers(members, clique),
                   many = movers(4 * trees, forest);
        const Plan thin = planOf(one, batchSize);
        ASSERT_NO_FATAL_FAILURE(expectSound(one, thin));
        EXPECT_EQ(thin.islands, 1u);
        EXPECT_EQ(thin.batches.size(), 1u);
        EXPECT_EQ(thin.colours, 2u);
        const Plan dense = planOf(all, batchSize);
        ASSERT_NO_FATAL_FAILURE(expectSound(all, dense));
        EXPECT_GE(dense.colours, members - 1);  // as many as links at a body
        EXPECT_LE(dense.colours, 2 * (members - 1) - 1);
        EXPECT_EQ(dense.overflow, 0u);
        const Plan wide = planOf(many, batchSize);
        ASSERT_NO_FATAL_FAILURE(expectSound(many, wide));
        EXPECT_EQ(wide.islands, trees);
        EXPECT_EQ(wide.colours, 3u);
        // Each tree has three links: a batch takes as many as fit, but one at least.
        const std::uint32_t fit = std::max(1u, batchSize / 3);
        EXPECT_EQ(wide.batches.size(), (trees + fit - 1) / fit);
    }
}

TEST(Plan, OfSleepersAndFixedBodiesHasNothingToSolve) {
    Case c;
    c.moves.assign(100, 0);
    const Plan plan = planOf(c, standardBatchSize);
    expectSound(c, plan);
    EXPECT_EQ(plan.islands, 0u);
    EXPECT_TRUE(plan.batches.empty());
    EXPECT_TRUE(plan.freeBodies.empty());
}

TEST(Plan, KeepsWhatOverflowsAtAHubInKeyOrderOutOfTheLanes) {
    // Two hubs: one pinned to 80 bodies that move, one to 80 that do not. Colours are 64.
    Case c;
    const auto body = [&](bool moves) {
        c.moves.push_back(moves);
        const auto place = static_cast<std::uint32_t>(c.moves.size() - 1);
        if (moves) c.awake.push_back(place);
        return place;
    };
    for (const bool movingRim : {true, false}) {
        const std::uint32_t hub = body(true);
        for (int i = 0; i < 80; ++i) {
            const std::uint32_t rim = body(movingRim);
            c.links.push_back({hub, rim, static_cast<std::uint32_t>(c.links.size()), true});
        }
    }
    c.jointLinks = static_cast<std::uint32_t>(c.links.size());
    for (const std::uint32_t batchSize : {10u, standardBatchSize}) {
        const Plan plan = planOf(c, batchSize);
        expectSound(c, plan);
        EXPECT_EQ(plan.overflow, 32u);
        std::uint32_t serial = 0;
        for (const ColourRun& run : plan.runs) {
            if (!isSerial(run.colour)) continue;
            ++serial;
            EXPECT_EQ(run.jointCount, 16u);
            EXPECT_EQ(run.revoluteCount, 0u);
        }
        EXPECT_EQ(serial, 2u);
    }
}

TEST(Plan, OfNothingIsEmptyAndOfFreeBodiesHasNoBatch) {
    Case c;
    EXPECT_TRUE(planOf(c, 64).batches.empty());
    c.moves = {1, 0, 1};
    c.awake = {0, 2};
    const Plan plan = planOf(c, 64);
    EXPECT_TRUE(plan.batches.empty());
    EXPECT_EQ(plan.freeBodies, c.awake);
    EXPECT_EQ(plan.islands, 0u);
}

}  // namespace
}  // namespace huestep::test
