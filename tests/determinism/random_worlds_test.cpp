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
        start, 150,
        [&](const World& world) {
            std::vector<Command> commands;
            // Quiet stretches let things fall asleep.
            if (world.tick() % 100 > 60) return commands;
            const std::uint32_t count = random.below(4);
            for (std::uint32_t i = 0; i < count; ++i) {
                const PlayerId author = random.once(2) ? 0 : random.below(5);
                commands.push_back({author, ++sequence, randomAction(random, world)});
            }
            return commands;
        },
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
