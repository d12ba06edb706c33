// Games by rules: the same on every thread count, width and from every image, whatever is sent.

#include "tests/determinism/games.h"

#include <limits>
#include <set>

#include "tests/determinism/random_scene.h"
#include "tests/determinism/together.h"

namespace huestep::test {
namespace {

/// What nobody should send, as a function of the world: a game's own actions with any number in
/// them, and everything that worlds without rules are sent.
CommandsOf noiseFrom(std::uint64_t seed) {
    return [seed](const World& world) {
        Random random(seed * 1'000'003 + world.tick());
        std::vector<Command> commands;
        std::uint64_t sequence = 100 * (world.tick() + 1);
        if (world.tick() < 3) commands.push_back({0, ++sequence, AddPlayer{1 + random.below(4)}});
        for (std::uint32_t i = random.below(5); i > 0; --i) {
            const PlayerId author = random.below(5);
            if (random.once(3)) {
                commands.push_back({author, ++sequence, randomAction(random, world)});
                continue;
            }
            const auto place = world.find(1 + random.below(world.info().nextBody));
            Custom custom;
            custom.kind = random.once(9) ? random.below(0xffffffffu) : random.below(5);
            custom.id = random.below(200);
            custom.number = static_cast<std::int32_t>(random.below(400)) - 200;
            if (random.once(9)) custom.number = std::numeric_limits<std::int32_t>::min();
            custom.vector = place ? world.motions()[*place].position : random.point(-30.0, 30.0);
            if (random.once(9)) custom.vector.x = std::numeric_limits<float>::quiet_NaN();
            if (random.once(9)) custom.vector.y = std::numeric_limits<float>::max();
            commands.push_back({author, ++sequence, custom});
        }
        return commands;
    };
}

TEST(Games, RejectWhatIsWrongTheSameInEveryConfiguration) {
    std::array<std::size_t, 32> reasons{};
    for (const char* scene : {"ball:goals=1,seconds=3", "building:budget=4,pause=0.05"}) {
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            SCOPED_TRACE(std::string(scene) + ", seed " + std::to_string(seed));
            const auto look = [&](const World& world) {
                for (const CommandOutcome& outcome : world.events().commands) {
                    ++reasons[static_cast<std::size_t>(outcome.reason)];
                }
            };
            runTogether(worldOf(scene), 150, noiseFrom(seed), seed, look,
                        {{.name = "no executor", .withoutExecutor = true}, everythingAtOnce()});
            if (HasFatalFailure()) return;
        }
    }
    for (const Rejection reason :
         {Rejection::None, Rejection::NotFinite, Rejection::UnknownAction, Rejection::AgainstRules,
          Rejection::TooFar, Rejection::BadDefinition}) {
        EXPECT_GT(reasons[static_cast<std::size_t>(reason)], 0u) << describe(reason);
    }
}

TEST(Games, GoBackToACheckpointAndForwardAgainToTheSameHashes) {
    const std::pair<const char*, CommandsOf> games[] = {
        {"ball:goals=2,length=12,width=8", ballScript}, {"building:budget=5", buildingScript}};
    for (const auto& [scene, commandsOf] : games) {
        World world = worldOf(scene);
        World ahead = worldOf(scene);
        Checkpoint checkpoint;
        std::set<std::string> scores;
        for (int round = 0; round < 60; ++round) {
            // Eight ticks that were guessed wrong: nobody does anything in them.
            ahead.checkpoint(checkpoint);
            for (int i = 0; i < 8; ++i) ahead.step({});
            ahead.restore(checkpoint);
            for (int i = 0; i < 8; ++i) {
                const std::vector<Command> commands = commandsOf(world);
                world.step(commands);
                ahead.step(commands);
                ASSERT_EQ(differentEvents(world.events(), ahead.events()), "") << world.tick();
                ASSERT_EQ(world.fullRoot(), ahead.fullRoot())
                    << scene << ", tick " << world.tick() << ": " << differenceOf(world, ahead);
                ASSERT_EQ(world.motionRoot(), ahead.motionRoot());
            }
            scores.insert(world.score().substr(0, world.score().find(',')));
        }
        EXPECT_GT(scores.size(), 1u) << scene << ": something was at stake";
    }
}

}  // namespace
}  // namespace huestep::test
