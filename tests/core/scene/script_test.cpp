#include "core/scene/script.h"

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

}  // namespace
}  // namespace huestep::test
