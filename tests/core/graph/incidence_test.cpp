// Incidence: every side of every row at a body that moves once, in rising order.

#include "core/graph/incidence.h"

#include "tests/core/support.h"

namespace huestep::test {
namespace {

std::vector<ConstraintBodies> randomRows(Random& random, std::uint32_t places) {
    std::vector<ConstraintBodies> rows(random.below(60));
    const auto place = [&] {
        const auto at = static_cast<BodyPlace>(1 + random.below(places - 1));
        return random.once(4) ? ~at : at;
    };
    for (ConstraintBodies& row : rows) {
        if (!random.once(6)) row = {place(), place()};  // else padding
    }
    return rows;
}

TEST(Incidence, HoldsEverySideOfARowAtABodyThatMovesOnceAndInOrder) {
    Random random(405);
    SCOPED_TRACE(random.trace());
    for (int round = 0; round < 50; ++round) {
        const std::uint32_t places = 2 + random.below(30);
        const auto joints = randomRows(random, places), revolutes = randomRows(random, places),
                   contacts = randomRows(random, places);
        const Incidence all = incidenceOf(joints, revolutes, contacts, places);
        ASSERT_EQ(all.slots(), 2 * (joints.size() + revolutes.size() + contacts.size()));
        // What the rows say of each place, looked up row by row.
        for (std::uint32_t place = 0; place < places; ++place) {
            std::vector<std::uint32_t> expected;
            const auto look = [&](const std::vector<ConstraintBodies>& rows, std::uint32_t first) {
                for (std::uint32_t i = 0; i < rows.size(); ++i) {
                    const auto at = static_cast<BodyPlace>(place);
                    if (rows[i].a == at && rows[i].b != at) expected.push_back(first + 2 * i);
                    if (rows[i].b == at) expected.push_back(first + 2 * i + 1);
                }
            };
            look(joints, 0);
            look(revolutes, all.slotOfRevolute(0));
            look(contacts, all.slotOfContact(0));
            const auto touches = all.touchesOf(place);
            EXPECT_EQ(std::vector<std::uint32_t>(touches.begin(), touches.end()), expected);
        }
    }
}

}  // namespace
}  // namespace huestep::test
