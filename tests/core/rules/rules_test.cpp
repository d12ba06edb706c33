// Rules of a game: asked at their places, their state part of everything that a state is part of.

#include "core/rules/rules.h"

#include <cstring>

#include "core/state/roots.h"
#include "core/state/snapshot.h"
#include "tests/core/rules/tally.h"

namespace huestep::test {
namespace {

std::string refusal(const Result<World>& world) {
    return world.ok() ? std::string() : world.error().message;
}

World playedTally(int ticks) {
    World world = tallyWorld();
    for (int i = 0; i < ticks; ++i) world.step(tallyCommands(world));
    return world;
}

TEST(Rules, AreAskedOfEveryCommandAndOnceBeforeAndAfterAStep) {
    World world = tallyWorld();
    EXPECT_EQ(world.rules()->name(), "tally");
    for (int i = 0; i < 30; ++i) world.step({});
    EXPECT_EQ(tallyOf(world).before, 30u);
    EXPECT_EQ(tallyOf(world).after, 30u);
    EXPECT_EQ(tallyOf(world).commands, 0u);
    EXPECT_NEAR(wide(tallyOf(world).reached), 4.0, 0.01) << "where the higher box began";
    world.step(std::vector<Command>{{0, 1, AddPlayer{1}}});
    EXPECT_EQ(tallyOf(world).commands, 0u) << "the host's own are not theirs";
    const BodyId body = world.players()[1].body;
    world.step(std::vector<Command>{{1, 1, ApplyForce{body, {}, {-10.0f, 5.0f}}},
                                    {1, 2, Custom{tallyRoll, 0, 1, {}}},
                                    {0, 2, Custom{tallyRoll, 0, 1, {}}}});
    EXPECT_EQ(tallyOf(world).commands, 3u);
    EXPECT_EQ(world.score(), "3 commands");
    for (int i = 0; i < 120; ++i) world.step({});
    EXPECT_EQ(tallyOf(world).begins, 3u) << "two boxes and a player on the ground";
}

TEST(Rules, RefuseACommandByTheirReasonAndTheWorldRefusesIt) {
    Scene scene = tallyScene();
    scene.rules->parameters = {{"most", 2.0f}};
    World world = tallyWorld(scene);
    world.step(std::vector<Command>{{0, 1, AddPlayer{1}}});
    const BodyId body = world.players()[1].body;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    world.step(std::vector<Command>{{1, 1, Custom{99, 0, 0, {}}},
                                    {1, 2, Custom{tallyRoll, 0, 1, {nan, 0.0f}}},
                                    {1, 3, ApplyImpulse{body, {nan, 0.0f}, {}}},
                                    {1, 4, Spawn{}},
                                    {1, 5, Custom{tallyRoll, 0, 1, {}}},
                                    {1, 6, ApplyImpulse{body, {1.0f, 0.0f}, {-10.0f, 5.0f}}}});
    const std::vector<Rejection> wanted{Rejection::UnknownAction, Rejection::NotFinite,
                                        Rejection::NotFinite,     Rejection::BadDefinition,
                                        Rejection::None,          Rejection::AgainstRules};
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_EQ(world.events().commands[i].reason, wanted[i]) << i;
    }
    EXPECT_EQ(motionOf(world, body).velocity.x, 0.0f);
    EXPECT_EQ(tallyOf(world).commands, 2u) << "what has no finite numbers never comes to them";
}

TEST(Rules, AWorldWithoutThemKnowsNoActionOfTheirs) {
    Scene scene = tallyScene();
    scene.rules.reset();
    World world = worldOf(scene);
    const std::uint64_t root = world.fullRoot();
    world.step(std::vector<Command>{{0, 1, AddPlayer{1}}, {0, 2, Custom{1, 0, 0, {}}}});
    world.step(std::vector<Command>{{1, 1, Custom{1, 0, 0, {}}}});
    EXPECT_EQ(world.events().commands[0].reason, Rejection::UnknownAction);
    EXPECT_EQ(world.rules(), nullptr);
    EXPECT_TRUE(world.rulesState().empty());
    EXPECT_EQ(world.score(), "");
    std::uint32_t version = 0;
    std::memcpy(&version, world.save().data() + 8, sizeof version);
    EXPECT_EQ(version, snapshotVersion) << "snapshots are what they were";
    EXPECT_NE(root, tallyWorld().fullRoot());
}

TEST(Rules, ActWithTheRightsTheySayAndWhatIsSpawnedBelongsToWhomTheySay) {
    World world = playedTally(4);  // player 1 is there
    auto say = [&, sequence = std::uint64_t{1000}](PlayerId author, Custom custom) mutable {
        world.step(std::vector<Command>{{author, ++sequence, custom}});
        return world.events().commands[0].reason;
    };
    ASSERT_EQ(say(1, {tallySpawn, 0, 0, {20.0f, 5.0f}}), Rejection::None);
    const BodyId mine = tallyOf(world).last;
    EXPECT_EQ(world.bodies()[*world.find(mine)].owner, 1u);
    ASSERT_EQ(say(0, {tallySpawn, 0, 0, {24.0f, 5.0f}}), Rejection::None);
    const BodyId hosts = tallyOf(world).last;
    EXPECT_EQ(world.bodies()[*world.find(hosts)].owner, 0u);
    EXPECT_EQ(say(1, {tallyRemove, hosts, 0, {}}), Rejection::NotAllowed);
    EXPECT_EQ(say(1, {tallyRemove, mine, 0, {}}), Rejection::None);
    EXPECT_FALSE(world.find(mine).has_value());
    for (int i = 0; i < 3; ++i) static_cast<void>(say(1, {tallySpawn, 0, 0, {28.0f, 5.0f}}));
    EXPECT_EQ(say(1, {tallySpawn, 0, 0, {32.0f, 5.0f}}), Rejection::OverBudget);
    EXPECT_EQ(say(0, {tallyRespawn, 0, 0, {}}), Rejection::UnknownAuthor) << "the host is nowhere";
}

TEST(Rules, GiveAPlayerANewBodyWhereTheySay) {
    World world = playedTally(3);
    const BodyId before = world.players()[1].body;
    world.step(std::vector<Command>{{1, 1000, Grab{2, motionOf(world, 2).position, {0, 5}}},
                                    {1, 1001, Custom{tallyRespawn, 0, 0, {7.0f, 9.0f}}}});
    const BodyId after = world.players()[1].body;
    EXPECT_NE(after, before);
    EXPECT_FALSE(world.find(before).has_value());
    EXPECT_NEAR(wide(motionOf(world, after).position.x), 7.0, 1e-6);
    EXPECT_EQ(world.bodies()[*world.find(after)].owner, 1u);
    EXPECT_NE(world.players()[1].grab, 0u) << "what it held it still holds";
    world.step(std::vector<Command>{
        {1, 1002, Custom{tallyRespawn, 0, 0, {std::numeric_limits<float>::max(), 0.0f}}}});
    EXPECT_EQ(world.events().commands[0].reason, Rejection::NotFinite);
    EXPECT_EQ(world.players()[1].body, after);
    ASSERT_TRUE(World::restore(world.save(), tallyAlone()).ok());
}

TEST(Rules, TheirStateIsInBothRootsAndADifferenceNamesTheirField) {
    const World world = playedTally(20);
    const WorldState good = *readSnapshot(world.save());
    RootCache fresh;
    const std::uint64_t full = fullRoot(good, fresh);
    EXPECT_EQ(full, world.fullRoot());
    EXPECT_EQ(motionRoot(good), world.motionRoot());
    for (std::size_t word = 0; word < good.rulesWords.size(); ++word) {
        for (std::uint32_t bit = 0; bit < 32; ++bit) {
            WorldState bad = good;
            bad.rulesWords[word].value ^= 1u << bit;
            RootCache cache;
            EXPECT_NE(fullRoot(bad, cache), full) << word;
            EXPECT_NE(motionRoot(bad), motionRoot(good)) << word;
        }
    }
    WorldState otherDice = good;
    otherDice.rules[0].dice ^= 1u;
    EXPECT_NE(motionRoot(otherDice), motionRoot(good));

    WorldState counted = good;
    counted.rulesWords[3].value += 5;
    const Result<World> left = World::restore(writeSnapshot(good), tallyAlone());
    const Result<World> right = World::restore(writeSnapshot(counted), tallyAlone());
    ASSERT_TRUE(left.ok() && right.ok());
    const auto difference = firstDifference(*left, *right);
    ASSERT_TRUE(difference.has_value());
    const std::string begins = std::to_string(good.rulesWords[3].value);
    const std::string more = std::to_string(good.rulesWords[3].value + 5);
    EXPECT_EQ(difference->sentence(), "rules begins: " + begins + " here, " + more + " there");
}

TEST(Rules, GoOnFromSnapshotsDeltasCopiesAndCheckpointsAsIfNothingHadBeen) {
    World world = playedTally(17);
    World start = tallyWorld();
    Scene plain = tallyScene();
    plain.rules.reset();
    const Result<World> without = World::create(plain, tallyAlone());
    ASSERT_TRUE(without.ok());
    std::vector<World> others;
    others.push_back(world);
    others.push_back(*World::restore(world.save(), tallyAlone()));
    others.push_back(*World::restore(start, world.saveDelta(start)));
    others.push_back(*World::restore(*without, world.saveDelta(*without)));
    Checkpoint checkpoint;
    world.checkpoint(checkpoint);
    others.push_back(tallyWorld());
    others.back().restore(checkpoint);
    World back = world;
    back.checkpoint(checkpoint);
    for (int i = 0; i < 25; ++i) back.step(tallyCommands(back));
    back.restore(checkpoint);
    others.push_back(std::move(back));
    for (int i = 0; i < 60; ++i) {
        const std::vector<Command> commands = tallyCommands(world);
        world.step(commands);
        for (std::size_t k = 0; k < others.size(); ++k) {
            others[k].step(commands);
            ASSERT_EQ(others[k].fullRoot(), world.fullRoot())
                << "copy " << k << ", tick " << world.tick();
        }
    }
    EXPECT_GT(tallyOf(world).rolled, 0u);
    const Result<World> base = World::restore(world.save(), tallyAlone());
    EXPECT_EQ(refusal(World::restore(*base, without->saveDelta(*base))), "") << "and back again";
}

TEST(Rules, WhatIsNotFiniteInTheirStateBecomesZeroSoThatASnapshotOfItIsTaken) {
    World world = playedTally(6);
    world.step(std::vector<Command>{{1, 1000, Custom{tallySpoil, 0, 0, {}}}});
    EXPECT_EQ(tallyOf(world).reached, 0.0f);
    EXPECT_EQ(refusal(World::restore(world.save(), tallyAlone())), "");
}

TEST(Rules, ThatABuildLacksOrAStateThatCannotBeTheirsAreRefusedWithASentence) {
    const World world = playedTally(6);
    const std::vector<std::byte> snapshot = world.save();
    EXPECT_EQ(refusal(World::restore(snapshot))
                  .rfind("snapshot: this build does not have the rules tally 2; it has ball 1", 0),
              0u)
        << refusal(World::restore(snapshot));
    EXPECT_EQ(refusal(World::restore(snapshot, {})),
              "snapshot: this build does not have the rules tally 2; it has none");
    const WorldState good = *readSnapshot(snapshot);
    const auto saying = [&](auto&& spoil) {
        WorldState bad = good;
        spoil(bad);
        return refusal(World::restore(writeSnapshot(bad), tallyAlone()));
    };
    EXPECT_EQ(saying([](WorldState& s) { s.rulesWords.pop_back(); }),
              "snapshot: rules tally: 28 bytes instead of their 32");
    EXPECT_EQ(saying([](WorldState& s) { s.rulesWords[0].value = 5000; }),
              "snapshot: rules tally: commands: more than the most");
    EXPECT_EQ(saying([](WorldState& s) { s.rulesWords[6].value = 0x7fc00000u; }),
              "snapshot: rules tally: reached: not finite, or a zero with a sign");
    EXPECT_EQ(saying([](WorldState& s) { s.rulesWords[6].value = 0x80000000u; }),
              "snapshot: rules tally: reached: not finite, or a zero with a sign");
    EXPECT_EQ(saying([](WorldState& s) { s.rules[0].name[0] = 'T'; }),
              "snapshot: rules name: not 1 to 32 of [a-z0-9_-]");
    EXPECT_EQ(saying([](WorldState& s) { s.rules[0].name[9] = 'x'; }),
              "snapshot: rules name: more than zeros behind it");
    EXPECT_EQ(saying([](WorldState& s) { s.rules.push_back(s.rules[0]); }),
              "snapshot: rules: more than one");
    EXPECT_EQ(saying([](WorldState& s) { s.rulesWords.resize(20'000); }),
              "snapshot: rulesWord: too many");
    EXPECT_EQ(saying([](WorldState& s) { s.rules[0].version = 3; }),
              "snapshot: this build does not have the rules tally 3; it has tally 2");
}

TEST(Rules, SnapshotsOfThemWithAnyByteFlippedOrCutOffAreRefused) {
    const std::vector<std::byte> good = playedTally(3).save();
    Random random(5);
    SCOPED_TRACE(random.trace());
    for (std::size_t at = 0; at < good.size(); ++at) {
        std::vector<std::byte> bad = good;
        bad[at] ^= static_cast<std::byte>(1u << random.below(8));
        ASSERT_NE(refusal(World::restore(bad, tallyAlone())), "") << at;
        ASSERT_NE(refusal(World::restore(std::span(good).first(at), tallyAlone())), "") << at;
    }
}

TEST(Rules, AreStartedWithTheParametersThatTheyKnowInTheirRange) {
    const auto saying = [](std::vector<RulesParameter> parameters) {
        Scene scene = tallyScene();
        scene.rules->parameters = std::move(parameters);
        return refusal(World::create(scene, tallyAlone()));
    };
    EXPECT_EQ(saying({{"most", 7.0f}}), "");
    EXPECT_EQ(saying({{"least", 7.0f}}),
              "rules tally: there is no parameter least; there are most");
    EXPECT_NE(saying({{"most", 0.0f}}).find("rules tally: parameter most: must be from 1"),
              std::string::npos);
    EXPECT_NE(saying({{"most", 1.5f}}).find("rules tally: parameter most: must be a whole number"),
              std::string::npos);
    EXPECT_EQ(saying({{"most", 2.0f}, {"most", 3.0f}}),
              "rules.parameters[1].name: must come after the one before it, letter by letter");
    EXPECT_EQ(saying({{"most", std::numeric_limits<float>::infinity()}}),
              "rules.parameters[0].value: not a finite number");
    Scene empty = tallyScene();
    empty.bodies.clear();
    EXPECT_EQ(refusal(World::create(empty, tallyAlone())), "rules tally: a tally wants a body");
    empty.rules->version = 9;
    EXPECT_EQ(refusal(World::create(empty, tallyAlone())),
              "rules: this build does not have the rules tally 9; it has tally 2");
}

TEST(Rules, RollTheDiceOfSplitMix64FromTheScenesSeed) {
    // Its first numbers from the seed 0, as published: e220a8397b1dcdaf, 6e789e6aa1b965f4,
    // 06c45d188009454f. In thousandths of 2⁶⁴ that is 883, 431 and 26.
    Scene scene = tallyScene();
    scene.rules->seed = 0;
    World world = tallyWorld(scene);
    world.step(std::vector<Command>{{0, 1, Custom{tallyRoll, 0, 1, {}}}});
    EXPECT_EQ(tallyOf(world).rolled, 883u);
    world.step(std::vector<Command>{{0, 2, Custom{tallyRoll, 0, 1, {}}}});
    EXPECT_EQ(tallyOf(world).rolled, 431u);
    world.step(std::vector<Command>{{0, 3, Custom{tallyRoll, 0, 1, {}}}});
    EXPECT_EQ(tallyOf(world).rolled, 26u);
    EXPECT_NE(tallyOf(playedTally(2)).rolled, 883u) << "another seed, other numbers";
}

}  // namespace
}  // namespace huestep::test
