// Locks and atomics: sequential on one thread, near it on more.

#include "core/solver/shared_bodies.h"

#include <cmath>

#include "tests/core/solver/line_of_discs.h"
#include "tests/core/spoil.h"

namespace huestep::test {
namespace {

constexpr PlanLimits smallBatches{.batchSize = 30, .sharedFrom = 1, .parallelFrom = 0};

World played(const Scene& scene, Method method, int ticks, int threads) {
    Scene as = scene;
    as.method = method;
    World world = worldOf(as);
    WorldSpoiler::limitPlans(world, smallBatches);
    Executor executor(threads);
    run(world, ticks, {&executor});
    return world;
}

TEST(SharedBodies, UnderLocksOnOneThreadHaveTheFutureOfKeyOrder) {
    for (const char* name : {"pyramid:base=12", "joint_grid:n=12"}) {
        const Scene scene = *sceneFromCatalog(name);
        EXPECT_EQ(played(scene, Method::Locks, 60, 1).motionRoot(),
                  played(scene, Method::Sequential, 60, 1).motionRoot())
            << name;
    }
}

TEST(SharedBodies, OnOneThreadRepeatTheirBits) {
    const Scene scene = *sceneFromCatalog("pyramid:base=12");
    for (const Method method : {Method::Locks, Method::Atomics}) {
        EXPECT_EQ(played(scene, method, 60, 1).fullRoot(), played(scene, method, 60, 1).fullRoot());
    }
}

TEST(SharedBodies, WithAtomicsOnOneThreadTakeAStepOfDiscsOnALineAsWorkedOutInDouble) {
    Random random(601);
    SCOPED_TRACE(random.trace());
    LineOfDiscs line = randomLine(random, 9);
    Scene scene = sceneOf(line);
    scene.method = Method::Atomics;
    World world = worldOf(scene);
    world.step({});
    softStepOf(line, 4, Order::OneByOne);
    EXPECT_LT(distanceOf(world, line), 1e-4);
}

/// The largest distance between bodies of two worlds, m.
double apart(const World& a, const World& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.motions().size(); ++i) {
        const Vec2 d = a.motions()[i].position - b.motions()[i].position;
        most = std::max(most, std::sqrt(lengthSquared(wide(d))));
    }
    return most;
}

TEST(SharedBodies, OnFourThreadsStayNearKeyOrder) {
    for (const char* name : {"pyramid:base=12", "joint_grid:n=12"}) {
        const Scene scene = *sceneFromCatalog(name);
        const World alone = played(scene, Method::Sequential, 60, 1);
        for (const Method method : {Method::Locks, Method::Atomics}) {
            for (int repeat = 0; repeat < 3; ++repeat) {
                EXPECT_LT(apart(played(scene, method, 60, 4), alone), 0.05)
                    << name << ", method " << static_cast<int>(method);
            }
        }
    }
}

/// A disc that a hundred others press on from all sides: every constraint wants it.
TEST(SharedBodies, OnFourThreadsLoseNoImpulseOfABodyThatAllTouch) {
    Scene scene;
    scene.gravity = {};
    scene.sleep = false;
    scene.bodies.push_back(discAt({}, 2.0f));
    constexpr int count = 100;
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * M_PI * i / count;
        const Vec2 out{static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
        scene.bodies.push_back(discAt(2.049f * out, 0.05f));
        scene.bodies.back().velocity = (i < 30 ? -2.0f : -1.0f) * out;
    }
    const auto momentumOf = [](const World& world) {
        Vec2T<double> sum{};
        for (std::size_t i = 0; i < world.bodies().size(); ++i) {
            sum += wide(world.bodies()[i].mass) * wide(world.motions()[i].velocity);
        }
        return sum;
    };
    const Vec2T<double> before = momentumOf(worldOf(scene));
    ASSERT_GT(length(before), 0.1);
    for (const Method method : {Method::Locks, Method::Atomics}) {
        for (int repeat = 0; repeat < 5; ++repeat) {
            const Vec2T<double> after = momentumOf(played(scene, method, 20, 4));
            EXPECT_LT(length(after - before), 1e-3) << "method " << static_cast<int>(method);
        }
    }
}

}  // namespace
}  // namespace huestep::test
