// Hubs: bodies with more joints than there are colours. What is left over is solved one by one in
// key order, on any machine.

#include "tests/core/odd_worlds.h"
#include "tests/determinism/together.h"

namespace huestep::test {
namespace {

TEST(Hubs, OfMorePinsThanColoursAreTheSameInEveryConfiguration) {
    for (const std::uint32_t count : {1u, 8u}) {
        const World start = worldOf(hubsOfJoints(count));
        std::uint32_t overflow = 0;
        runTogether(
            start, 40, [](const World&) { return std::vector<Command>(); }, 5,
            [&](const World& world) { overflow = std::max(overflow, world.report().overflow); });
        EXPECT_GE(overflow, 32 * count) << "the scene has no hub";
        if (HasFatalFailure()) return;
    }
}

}  // namespace
}  // namespace huestep::test
