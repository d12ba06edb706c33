// Methods: what all of them share, whatever they do with the rows.
#include "core/solver/method.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/scene/catalog.h"
#include "core/world/world.h"
#include "tests/core/spoil.h"
#include "tests/core/support.h"

namespace huestep {
namespace {

/// A pyramid, and three boxes that hang on each other beside it.
Scene pyramid(Method method) {
    Scene scene = *sceneFromCatalog("pyramid:base=12");
    scene.method = method;
    for (std::uint32_t i = 0; i < 3; ++i) {
        const auto above = i == 0 ? 0u : static_cast<std::uint32_t>(scene.bodies.size() - 1);
        const Vec2 hook = i == 0 ? Vec2{30.0f, 20.0f} : Vec2{1.0f, 0.0f};
        scene.bodies.push_back(test::boxAt(scene.bodies[0].position +
                                           Vec2{31.0f + 2.0f * static_cast<float>(i), 20.0f}));
        const auto box = static_cast<std::uint32_t>(scene.bodies.size() - 1);
        scene.joints.push_back(test::hinge(above, hook, box, {-1.0f, 0.0f}));
    }
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
        Scene grid = *sceneFromCatalog("joint_grid:n=12");
        grid.method = method.method;
        for (const Scene& scene : {pyramid(method.method), grid}) {
            const std::uint64_t alone = after(scene, 60, {}, nullptr).fullRoot();
            for (const int threads : {2, 3}) {
                Executor executor(threads);
                const PlanLimits limits{.batchSize = 30, .sharedFrom = 1, .parallelFrom = 0};
                EXPECT_EQ(after(scene, 60, limits, &executor).fullRoot(), alone)
                    << method.name << ", " << scene.name << ", " << threads << " threads";
            }
        }
    }
}

TEST(Method, EachLetsABoxRestOnTheFloor) {
    for (const MethodTraits& method : allMethods()) {
        Scene scene = test::sceneOf({test::ground(), test::boxAt({0.0f, 0.5f})});
        scene.method = method.method;
        scene.sleep = false;
        World world = test::worldOf(scene);
        test::run(world, 240);
        const BodyMotion box = test::motionOf(world, 2);
        EXPECT_NEAR(box.position.x, 0.0f, 1e-3f) << method.name;
        EXPECT_NEAR(box.position.y, 0.5f, 0.006f) << method.name << ": with the slop of some";
        EXPECT_LT(std::abs(box.velocity.y), 1e-3f) << method.name;
        EXPECT_LT(std::abs(box.rotation.s), 1e-3f) << method.name;
    }
}

/// Velocities of two bodies after the rigid impulse that lets their anchors, in one place, move
/// alike: p = −K⁻¹ Ċ.
struct Joined {
    Vec2T<double> v[2];
    double w[2];
};
Joined joinedAtAPoint(const World& start, Vec2T<double> point) {
    Joined after;
    double k11 = 0.0, k12 = 0.0, k22 = 0.0;
    Vec2T<double> arm[2], rate{};
    for (std::size_t i = 0; i < 2; ++i) {
        const BodyMotion& m = start.motions()[i];
        after.v[i] = test::wide(m.velocity);
        after.w[i] = test::wide(m.angularVelocity);
        arm[i] = point - test::wide(m.position);
        const double mass = test::wide(start.bodies()[i].inverseMass);
        const double inertia = test::wide(start.bodies()[i].inverseInertia);
        k11 += mass + inertia * arm[i].y * arm[i].y;
        k12 -= inertia * arm[i].x * arm[i].y;
        k22 += mass + inertia * arm[i].x * arm[i].x;
        const double sign = i == 0 ? -1.0 : 1.0;
        rate += sign * (after.v[i] + crossScalar(after.w[i], arm[i]));
    }
    const double determinant = k11 * k22 - k12 * k12;
    const Vec2T<double> p{-(k22 * rate.x - k12 * rate.y) / determinant,
                          -(k11 * rate.y - k12 * rate.x) / determinant};
    for (std::size_t i = 0; i < 2; ++i) {
        const double sign = i == 0 ? -1.0 : 1.0;
        after.v[i] += (sign * test::wide(start.bodies()[i].inverseMass)) * p;
        after.w[i] += sign * test::wide(start.bodies()[i].inverseInertia) * cross(arm[i], p);
    }
    return after;
}

TEST(Method, EachStopsTwoBodiesOfOnePinAgainstEachOtherAsTheRigidImpulseDoes) {
    for (const MethodTraits& method : allMethods()) {
        Scene scene = test::sceneOf({test::boxAt({}), test::boxAt({1.3f, 0.4f}, 0.3f)},
                                    {test::hinge(0, {0.5f, 0.3f}, 1, {-0.8f, -0.1f})});
        scene.gravity = {};
        scene.sleep = false;
        scene.method = method.method;
        // What is exact in one sweep of pins takes the descent many: it has multipliers to find.
        scene.substeps = method.method == Method::Avbd ? 64 : 1;
        // Slow, so that nobody goes anywhere within the step.
        scene.bodies[0].velocity = {0.01f, -0.004f};
        scene.bodies[1].angularVelocity = 0.02f;
        World world = test::worldOf(scene);
        const Joined expected = joinedAtAPoint(world, {0.5, 0.3});
        world.step({});
        for (std::size_t i = 0; i < 2; ++i) {
            const BodyMotion& m = world.motions()[i];
            EXPECT_NEAR(test::wide(m.velocity.x), expected.v[i].x, 2e-5) << method.name;
            EXPECT_NEAR(test::wide(m.velocity.y), expected.v[i].y, 2e-5) << method.name;
            EXPECT_NEAR(test::wide(m.angularVelocity), expected.w[i], 4e-5) << method.name;
        }
    }
}

TEST(Method, SequentialTakesConstraintsInKeyOrderAlone) {
    const World world = after(pyramid(Method::Sequential), 5, {}, nullptr);
    EXPECT_EQ(world.report().overflow, world.report().contacts + world.report().joints);
}

}  // namespace
}  // namespace huestep
