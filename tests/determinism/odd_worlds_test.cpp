// Worlds at the edge of what there is, left alone and with a host who does anything to them: the
// same in every configuration.

#include "tests/core/odd_worlds.h"
#include "tests/determinism/random_scene.h"
#include "tests/determinism/together.h"

namespace huestep::test {
namespace {

class OddRuns : public testing::TestWithParam<OddWorld> {};

INSTANTIATE_TEST_SUITE_P(All, OddRuns, testing::ValuesIn(oddWorlds()), nameOfOdd);

TEST_P(OddRuns, AreTheSameInEveryConfiguration) {
    runTogether(worldOf(GetParam().scene), 50, silence, 6);
}

TEST_P(OddRuns, WithAHostWhoDoesAnythingAreTheSameInEveryConfiguration) {
    Random random(9'500);
    SCOPED_TRACE(random.trace());
    std::uint64_t sequence = 0;
    std::size_t applied = 0;
    runTogether(
        worldOf(GetParam().scene), 50,
        [&](const World& world) { return randomCommands(random, world, sequence); }, random.roll(),
        [&](const World& world) {
            for (const CommandOutcome& outcome : world.events().commands)
                applied += outcome.reason == Rejection::None;
        });
    if (HasFatalFailure()) return;
    EXPECT_GE(applied, 3u) << "the commands must do something";
}

}  // namespace
}  // namespace huestep::test
