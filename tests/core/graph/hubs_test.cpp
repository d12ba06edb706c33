// Hubs: who is one, and whose contacts go where; against a recount with maps.

#include "core/graph/hubs.h"

#include <map>
#include <set>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

using Contacts = std::vector<ConstraintBodies>;

Contacts randomContacts(Random& random, std::uint32_t bodies) {
    Contacts contacts;
    for (std::uint32_t i = random.below(600); i > 0; --i) {
        // The first few bodies get most of the contacts, with each other too.
        const auto hub = static_cast<BodyPlace>(random.below(std::min(bodies, 4u)));
        const auto other = static_cast<BodyPlace>(random.below(bodies));
        if (hub == other) continue;
        ConstraintBodies c{hub, random.once(4) ? ~other : other};
        if (random.once(2)) std::swap(c.a, c.b);
        contacts.push_back(c);
    }
    return contacts;
}

TEST(Hubs, AreBodiesOfMoreContactsThanTheDegreeAndTheirRunsHoldEachContactOfOneHubOnce) {
    Random random(91);
    SCOPED_TRACE(random.trace());
    int withRuns = 0;
    for (int trial = 0; trial < 200; ++trial) {
        SCOPED_TRACE("trial " + std::to_string(trial));
        const std::uint32_t bodies = 2 + random.below(300);
        const std::uint32_t degree = random.below(60);
        const Contacts contacts = randomContacts(random, bodies);
        std::map<std::pair<BodyPlace, bool>, std::uint32_t> degrees;
        for (const ConstraintBodies& c : contacts) {
            const bool fixed = c.a < 0 || c.b < 0;
            if (c.a >= 0) ++degrees[{c.a, fixed}];
            if (c.b >= 0) ++degrees[{c.b, fixed}];
        }
        const auto isHubOf = [&](BodyPlace place, bool fixed) {
            return place >= 0 && degrees[{place, fixed}] > degree;
        };
        std::set<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < contacts.size(); ++i) {
            const bool fixed = contacts[i].a < 0 || contacts[i].b < 0;
            if (isHubOf(contacts[i].a, fixed) != isHubOf(contacts[i].b, fixed)) expected.insert(i);
        }

        std::set<std::uint32_t> found;
        std::pair<bool, BodyPlace> last{false, -1};
        std::map<std::pair<BodyPlace, BodyPlace>, std::uint32_t> lastOfPair;
        for (const HubRun& run : findHubs(contacts, bodies, degree)) {
            ASSERT_GE(std::pair(run.fixed, run.hub), last) << "in order";
            last = {run.fixed, run.hub};
            ASSERT_TRUE(isHubOf(run.hub, run.fixed));
            ASSERT_FALSE(run.constraints.empty());
            std::set<BodyPlace> others;
            for (std::size_t k = 0; k < run.constraints.size(); ++k) {
                const std::uint32_t i = run.constraints[k];
                ASSERT_TRUE(k == 0 || i > run.constraints[k - 1]) << "key order";
                ASSERT_TRUE(found.insert(i).second) << "contact " << i << " twice";
                const ConstraintBodies& c = contacts[i];
                ASSERT_TRUE(c.a == run.hub || c.b == run.hub);
                const BodyPlace other = c.a == run.hub ? c.b : c.a;
                ASSERT_EQ(other < 0, run.fixed);
                if (run.fixed) continue;
                ASSERT_TRUE(others.insert(other).second) << "two lanes write one body";
                std::uint32_t& before = lastOfPair[{run.hub, other}];
                ASSERT_TRUE(before == 0 || before - 1 < i) << "the first meeting comes first";
                before = i + 1;
            }
        }
        ASSERT_EQ(found, expected);
        withRuns += !expected.empty();
    }
    EXPECT_GT(withRuns, 100);
}

TEST(Hubs, AreNoneWhereNobodyHasManyContacts) {
    EXPECT_TRUE(findHubs({}, 0).empty());
    Contacts chain;
    for (BodyPlace i = 0; i < 500; ++i) chain.push_back({i, i + 1});
    EXPECT_TRUE(findHubs(chain, 501).empty());
    Contacts star;
    for (BodyPlace i = 1; i <= 32; ++i) star.push_back({0, i});
    EXPECT_TRUE(findHubs(star, 40).empty()) << "as many as a hub may have before it is one";
    star.push_back({33, 0});
    EXPECT_EQ(findHubs(star, 40).size(), 1u);
}

}  // namespace
}  // namespace huestep::test
