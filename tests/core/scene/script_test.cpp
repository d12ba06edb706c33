#include "core/scene/script.h"

#include <cmath>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

void twoVelocities(std::span<const double> values, std::uint64_t tick,
                   std::vector<Action>& actions) {
    if (tick == 3) return;
    const auto speed = static_cast<float>(values[0]);
    actions.emplace_back(SetVelocity{1, {speed, 0.0f}, 0.0f});
    actions.emplace_back(SetVelocity{2, {0.0f, static_cast<float>(tick)}, 0.0f});
}

TEST(Script, NumbersTheHostsCommandsUpwardsFromTickToTick) {
    const Script script(twoVelocities, {2.5});
    EXPECT_TRUE(static_cast<bool>(script));
    std::uint64_t last = 0;
    for (std::uint64_t tick = 0; tick < 10; ++tick) {
        const std::vector<Command> commands = script.commands(tick);
        ASSERT_EQ(commands.size(), tick == 3 ? 0u : 2u);
        for (const Command& command : commands) {
            EXPECT_EQ(command.author, 0u);
            EXPECT_GT(command.sequence, last);
            last = command.sequence;
        }
        EXPECT_EQ(commands, script.commands(tick)) << "asked twice, the same";
        // Others may speak for the host in the same tick, and the next is still above them.
        EXPECT_GT(hostSequence(tick, caps::maxCommands), last);
        EXPECT_LT(hostSequence(tick, 2 * caps::maxCommands - 1), hostSequence(tick + 1, 0));
    }
    EXPECT_EQ(script.actions(7)[0], Action(SetVelocity{1, {2.5f, 0.0f}, 0.0f}));
    EXPECT_EQ(script.actions(7)[1], Action(SetVelocity{2, {0.0f, 7.0f}, 0.0f}));
}

TEST(Script, OfMostScenesSaysNothing) {
    EXPECT_FALSE(static_cast<bool>(Script()));
    EXPECT_TRUE(Script().commands(0).empty());
    const Result<Script> script = scriptFromCatalog("pyramid:base=5");
    ASSERT_TRUE(script.ok());
    EXPECT_FALSE(static_cast<bool>(*script));
    EXPECT_FALSE(scriptFromCatalog("pyramid:base=x").ok());
    EXPECT_FALSE(scriptFromCatalog("no such scene").ok());
}

Script scriptOf(const std::string& text) {
    const Result<Script> script = scriptFromCatalog(text);
    EXPECT_TRUE(script.ok());
    return script.ok() ? *script : Script();
}

TEST(Script, OfEveryScriptedSceneHasAllItsCommandsApplied) {
    for (const std::string text : {"dominoes:turn=30", "hub:n=9", "junkyard:columns=4,rows=3",
                                   "release:after=7", "rain:floors=2,columns=3,group=2,period=9",
                                   "rain:floors=1,columns=40,group=5,period=1"}) {
        World world = worldOf(text);
        const Script script = scriptOf(text);
        EXPECT_EQ(world.info().flags & WorldInfo::players, 0u)
            << "players' bodies would take the ids that the script counts on";
        for (int tick = 0; tick < 100; ++tick) {
            const std::vector<Command> commands = script.commands(world.tick());
            for (const CommandOutcome& outcome : world.step(commands).commands) {
                ASSERT_EQ(outcome.reason, Rejection::None)
                    << text << ", tick " << tick << ": " << describe(outcome.reason);
            }
        }
    }
    for (const CatalogEntry& entry : sceneCatalog()) {
        const bool tried = entry.name == "dominoes" || entry.name == "hub" ||
                           entry.name == "junkyard" || entry.name == "rain" ||
                           entry.name == "release";
        EXPECT_EQ(entry.script != nullptr, tried) << entry.name << " is missing above";
    }
}

TEST(Script, MovesTheJunkyardsPusherOnASineOfTime) {
    World world = worldOf("junkyard:columns=2,rows=2");
    const Script script = scriptOf("junkyard:columns=2,rows=2");
    for (int tick = 0; tick < 600; ++tick) {
        world.step(script.commands(world.tick()));
        const BodyMotion pusher = motionOf(world, 1);
        EXPECT_NEAR(wide(pusher.position.x), 60.0 * std::sin(0.2 * tick / 60.0), 1e-4);
        EXPECT_EQ(pusher.position.y, 0.0f);
        EXPECT_EQ(pusher.rotation, Rotation{});
    }
}

TEST(Script, RainsRagdollsUntilEveryColumnIsFullAndThenTakesTheOldest) {
    const std::string text = "rain:floors=2,columns=3,group=2,period=10";
    World world = worldOf(text);
    const Script script = scriptOf(text);
    const std::size_t ground = world.bodies().size();
    const std::size_t aTurn = 2 * 2 * 11;
    BodyId oldest = 0;
    for (std::size_t tick = 0; tick < 120; ++tick) {
        world.step(script.commands(world.tick()));
        const std::size_t turns = std::min<std::size_t>(3, tick / 10 + 1);
        ASSERT_EQ(world.bodies().size(), ground + turns * aTurn) << "tick " << tick;
        ASSERT_EQ(world.joints().size(), turns * 2 * 2 * 10) << "tick " << tick;
        const BodyId first = world.bodies()[ground].id;
        if (tick >= 30 && tick % 10 == 0) {
            EXPECT_EQ(first, oldest + aTurn) << "tick " << tick;
        }
        oldest = first;
    }
}

/// m, largest distance of a joint's two points.
double worstJointOf(const World& world) {
    double worst = 0.0;
    for (const JointInfo& joint : world.joints()) {
        const BodyMotion a = motionOf(world, joint.bodyA);
        const BodyMotion b = motionOf(world, joint.bodyB);
        const Vec2 gap = transform(a.pose(), joint.anchorA) - transform(b.pose(), joint.anchorB);
        worst = std::max(worst, wide(length(gap)));
    }
    return worst;
}

TEST(Script, RainsRagdollsThatHangTogether) {
    const std::string text = "rain:floors=1,columns=1,group=5,period=600";
    World world = worldOf(text);
    const Script script = scriptOf(text);
    for (int tick = 0; tick < 160; ++tick) {
        world.step(script.commands(world.tick()));
        ASSERT_LT(worstJointOf(world), 0.005) << "m, tick " << tick;
    }
}

TEST(Script, RainsRagdollsThatLieStillOnceTheyHaveFallen) {
    // From one metre: at the scene's 40 m they come in faster than their bones are thick.
    const std::string text = "rain:floors=1,columns=1,group=5,period=600";
    World world = worldOf(text);
    std::vector<Command> commands = scriptOf(text).commands(0);
    for (Command& command : commands) {
        for (BodyDef& body : std::get<Spawn>(command.action).bodies) body.position.y -= 39.0f;
    }
    world.step(commands);
    run(world, 600);
    for (std::size_t i = 0; i < world.bodies().size(); ++i) {
        if (!world.bodies()[i].dynamic()) continue;
        const BodyMotion& motion = world.motions()[i];
        EXPECT_GT(motion.position.y, 0.25f) << "in the floor";
        EXPECT_LT(motion.position.y, 2.0f);
        EXPECT_LT(length(motion.velocity), 0.2f);
    }
    EXPECT_LT(worstJointOf(world), 0.005) << "m";
}

}  // namespace
}  // namespace huestep::test
