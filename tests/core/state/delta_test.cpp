// Deltas: exact against any base, small where little has changed, refused wherever a byte is wrong.

#include "core/state/delta.h"

#include <cstring>

#include "core/state/hash.h"
#include "tests/determinism/random_scene.h"
#include "tests/determinism/script.h"

namespace huestep::test {
namespace {

std::string refusal(const World& base, std::span<const std::byte> delta) {
    const Result<World> world = World::restore(base, delta);
    return world.ok() ? std::string() : world.error().message;
}

/// A world of the sandbox whose players have done something.
World playedWorld(int ticks) {
    World world = worldOf("sandbox");
    for (int tick = 0; tick < ticks; ++tick) world.step(playersScript(world));
    return world;
}

/// With the checksum that fits, so that it is not the checksum that refuses it.
std::vector<std::byte> sealed(std::vector<std::byte> delta) {
    const std::size_t end = delta.size() - 8;
    const std::uint64_t sum = hash64(std::span(delta).first(end));
    std::memcpy(&delta[end], &sum, sizeof sum);
    return delta;
}

TEST(Delta, HoldsTheStateExactlyAgainstAnyBase) {
    for (std::uint64_t seed = 41'000; seed < 41'010; ++seed) {
        Random random(seed);
        SCOPED_TRACE(random.trace());
        World world = worldOf(randomScene(random));
        std::vector<World> bases{world, worldOf("mixed")};
        std::uint64_t sequence = 0;
        for (int tick = 0; tick < 60; ++tick) {
            std::vector<Command> commands;
            for (std::uint32_t i = random.below(4); i > 0; --i) {
                commands.push_back({random.once(2) ? 0 : random.below(5), ++sequence,
                                    randomAction(random, world)});
            }
            world.step(commands);
            if (random.once(10)) bases.push_back(world);
        }
        for (const World& base : bases) {
            const std::vector<std::byte> delta = world.saveDelta(base);
            const Result<World> copy = World::restore(base, delta);
            ASSERT_TRUE(copy.ok()) << copy.error().message;
            EXPECT_EQ(differenceOf(world, *copy), "");
            EXPECT_EQ(copy->save(), world.save()) << "byte by byte";
        }
    }
}

TEST(Delta, DoesNotRepeatWhatIsTheSame) {
    World world = worldOf("pyramid:base=20");
    run(world, 60);
    EXPECT_LT(world.saveDelta(world).size(), 200u) << "nothing has changed";
    const World base = world;
    run(world, 8);
    const std::size_t moved =
        world.bodies().size() * sizeof(BodyMotion) + world.contacts().size() * sizeof(ContactState);
    EXPECT_LT(world.saveDelta(base).size(), moved) << "definitions are not among it";
    world.step(std::vector<Command>{{0, 1, RemoveBody{world.bodies().back().id}}});
    EXPECT_LT(world.saveDelta(base).size(), moved) << "nor after a removal";
}

TEST(Delta, OfAWrongBaseIsRefused) {
    const World base = playedWorld(30);
    const World world = playedWorld(40);
    const std::string sentence = refusal(playedWorld(31), world.saveDelta(base));
    EXPECT_NE(sentence.find("offset 16"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("another base"), std::string::npos) << sentence;
}

TEST(Delta, IsRefusedWhereverItIsCut) {
    const World base = playedWorld(30);
    const std::vector<std::byte> delta = playedWorld(34).saveDelta(base);
    for (std::size_t size = 0; size < delta.size(); size += 1 + size / 40) {
        const std::span<const std::byte> part = std::span(delta).first(size);
        EXPECT_NE(refusal(base, part), "") << size;
        if (size < 41) continue;
        EXPECT_NE(refusal(base, sealed({part.begin(), part.end()})), "") << size;
    }
}

TEST(Delta, WithAnyByteFlippedIsRefusedEvenUnderAChecksumThatFits) {
    Random random(42'000);
    SCOPED_TRACE(random.trace());
    const World base = playedWorld(30);
    const std::vector<std::byte> delta = playedWorld(34).saveDelta(base);
    for (int round = 0; round < 2000; ++round) {
        std::vector<std::byte> spoilt = delta;
        const std::size_t at = random.below(delta.size());
        spoilt[at] ^= std::byte{1} << random.below(8);
        EXPECT_NE(refusal(base, spoilt), "") << "byte " << at;
        if (at >= delta.size() - 8) continue;
        const std::string sentence = refusal(base, sealed(spoilt));
        EXPECT_EQ(sentence.substr(0, 6), "delta:") << "byte " << at << ": " << sentence;
    }
}

TEST(Delta, SaysWhichArrayARunLeaves) {
    const World base = worldOf("pyramid:base=4");
    std::vector<std::byte> delta = base.saveDelta(base);
    // After the head and the count of the first array stands the run of the one world record.
    delta[36] = std::byte{0};
    EXPECT_EQ(refusal(base, sealed(delta)),
              "delta: offset 40 follows an empty run of array \"world\"");
    delta[36] = std::byte{3 << 2};
    EXPECT_EQ(refusal(base, sealed(delta)),
              "delta: offset 40 follows a run past the base's records of array \"world\"");
}

}  // namespace
}  // namespace huestep::test
