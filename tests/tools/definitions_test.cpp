#include "tools/definitions.h"

#include <gtest/gtest.h>

#include "core/scene/catalog.h"

namespace huestep::tools {
namespace {

template <class Record>
std::vector<std::uint32_t> idsOf(std::span<const Record> records) {
    std::vector<std::uint32_t> ids;
    for (const Record& record : records) ids.push_back(record.id);
    return ids;
}

// The oracle is a world that takes the same commands.
TEST(Definitions, AreThoseOfAWorldThatTakesTheSameCommands) {
    const std::string text = "rain:floors=1,columns=2,group=2,period=4";
    const Result<Scene> scene = sceneFromCatalog(text);
    const Result<Script> script = scriptFromCatalog(text);
    ASSERT_TRUE(scene.ok() && script.ok());
    Result<World> world = World::create(*scene);
    ASSERT_TRUE(world.ok());
    Definitions definitions(*world);
    EXPECT_FALSE(definitions.changed());
    for (std::uint64_t tick = 0; tick < 30; ++tick) {
        std::vector<Command> commands = script->commands(tick);
        if (tick == 9) {
            const JointId joint = world->joints()[5].id;
            commands.push_back({0, hostSequence(tick, caps::maxCommands), RemoveJoint{joint}});
        }
        world->step(commands);
        definitions.apply(commands);
        ASSERT_TRUE(definitions.changed());
        ASSERT_EQ(idsOf(definitions.bodies()), idsOf(world->bodies())) << "tick " << tick;
        ASSERT_EQ(idsOf(definitions.shapes()), idsOf(world->shapes())) << "tick " << tick;
        ASSERT_EQ(idsOf(definitions.joints()), idsOf(world->joints())) << "tick " << tick;
        for (std::size_t i = 0; i < world->bodies().size(); ++i) {
            EXPECT_EQ(definitions.bodies()[i].mass, world->bodies()[i].mass);
            EXPECT_EQ(definitions.bodies()[i].flags, world->bodies()[i].flags);
        }
        for (std::size_t i = 0; i < world->shapes().size(); ++i) {
            EXPECT_EQ(definitions.shapes()[i].body, world->shapes()[i].body);
        }
        for (std::size_t i = 0; i < world->joints().size(); ++i) {
            EXPECT_EQ(definitions.joints()[i].bodyA, world->joints()[i].bodyA);
            EXPECT_EQ(definitions.joints()[i].bodyB, world->joints()[i].bodyB);
            EXPECT_EQ(definitions.joints()[i].anchorB, world->joints()[i].anchorB);
        }
    }
}

}  // namespace
}  // namespace huestep::tools
