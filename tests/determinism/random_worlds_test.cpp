// Worlds and commands drawn from a seed, stepped in every configuration side by side. A failing
// run is repeated with HUESTEP_SEED=… as printed.

#include "tests/determinism/random_scene.h"
#include "tests/determinism/together.h"

namespace huestep::test {
namespace {

class RandomWorld : public testing::TestWithParam<int> {};

TEST_P(RandomWorld, IsTheSameInEveryConfiguration) {
    Random random(9000 + static_cast<std::uint64_t>(GetParam()));
    SCOPED_TRACE(random.trace());
    const World start = worldOf(randomScene(random));
    std::uint64_t sequence = 0;
    std::size_t applied = 0;
    runTogether(
        start, 150, [&](const World& world) { return randomCommands(random, world, sequence); },
        random.roll(),
        [&](const World& world) {
            for (const CommandOutcome& outcome : world.events().commands) {
                applied += outcome.reason == Rejection::None;
            }
        });
    if (HasFatalFailure()) return;
    EXPECT_GT(applied, 10u) << "the commands must do something";
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomWorld, testing::Range(0, 24));

}  // namespace
}  // namespace huestep::test
