// Methods: what all of them share, whatever they do with the rows.
#include "core/solver/method.h"

#include <gtest/gtest.h>

#include <string>

#include "core/scene/catalog.h"
#include "core/world/world.h"
#include "tests/core/spoil.h"

namespace huestep {
namespace {

Scene pyramid(Method method) {
    Scene scene = *sceneFromCatalog("pyramid:base=12");
    scene.method = method;
    return scene;
}

World after(const Scene& scene, int ticks, const PlanLimits& limits, Executor* executor) {
    World world = *World::create(scene);
    WorldSpoiler::limitPlans(world, limits);
    for (int i = 0; i < ticks; ++i) world.step({}, {executor});
    return world;
}

TEST(Method, EachIsFoundByItsName) {
    for (const MethodTraits& method : allMethods()) {
        EXPECT_EQ(methodNamed(method.name), method.method);
        EXPECT_EQ(traitsOf(method.method).name, method.name);
    }
    EXPECT_EQ(allMethods().size(), static_cast<std::size_t>(lastMethod) + 1);
    EXPECT_FALSE(methodNamed("gauss").has_value());
}

TEST(Method, EachGivesAFutureOfItsOwn) {
    const World product = after(pyramid(Method::SoftStep), 30, {}, nullptr);
    for (const MethodTraits& method : allMethods()) {
        if (method.method == Method::SoftStep) continue;
        EXPECT_NE(after(pyramid(method.method), 30, {}, nullptr).motionRoot(), product.motionRoot())
            << method.name;
    }
}

TEST(Method, EachGivesTheSameBitsOnEveryTeamIfItSaysSo) {
    for (const MethodTraits& method : allMethods()) {
        if (!method.deterministic) continue;
        const Scene scene = pyramid(method.method);
        const std::uint64_t alone = after(scene, 60, {}, nullptr).fullRoot();
        for (const int threads : {2, 3}) {
            Executor executor(threads);
            const PlanLimits limits{.batchSize = 30, .sharedFrom = 1, .parallelFrom = 0};
            EXPECT_EQ(after(scene, 60, limits, &executor).fullRoot(), alone)
                << method.name << ", " << threads << " threads";
        }
    }
}

TEST(Method, SequentialTakesConstraintsInKeyOrderAlone) {
    const World world = after(pyramid(Method::Sequential), 5, {}, nullptr);
    EXPECT_EQ(world.report().overflow, world.report().contacts);
}

}  // namespace
}  // namespace huestep
