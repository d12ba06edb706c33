// A body with a thousand contacts: as exact as one by one in key order, and the same on any team.

#include <cmath>
#include <iostream>

#include "core/state/roots.h"
#include "tests/core/spoil.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

constexpr std::uint32_t rimCount = 1000;
constexpr float hubRadius = 10.0f;
constexpr float rimRadius = 0.03f;

/// A disc of 50 kg with a thousand of 0.05 kg around it. The hub is body 1.
World pressedHub(BodyType rim = BodyType::Dynamic) {
    const auto density = [](double mass, float radius) {
        return static_cast<float>(mass / (M_PI * wide(radius) * wide(radius)));
    };
    std::vector<BodyDef> bodies{discAt({}, hubRadius)};
    bodies[0].shapes[0].density = density(50.0, hubRadius);
    for (std::uint32_t i = 0; i < rimCount; ++i) {
        const double angle = 2.0 * M_PI * i / rimCount;
        const double far = wide(hubRadius) + wide(rimRadius);
        bodies.push_back(discAt(
            {static_cast<float>(far * std::cos(angle)), static_cast<float>(far * std::sin(angle))},
            rimRadius));
        bodies.back().type = rim;
        bodies.back().shapes[0].density = density(0.05, rimRadius);
    }
    Scene scene = sceneOf(std::move(bodies));
    scene.gravity = {};
    return worldOf(scene);
}

/// Every disc is pressed on the hub by ten times its weight on Earth, a third of them by thirty
/// times, so that the hub is pushed about.
void press(World& world, int ticks, const StepResources& with = {}) {
    for (int tick = 0; tick < ticks; ++tick) {
        std::vector<Command> commands;
        const Vec2 hub = motionOf(world, 1).position;
        for (std::uint32_t i = 0; i < rimCount; ++i) {
            const Vec2 inward = normalized(hub - motionOf(world, i + 2).position);
            const float force = i < rimCount / 3 ? 15.0f : 5.0f;
            commands.push_back({0, i + 1, ApplyForce{i + 2, force * inward, {}}});
        }
        world.step(commands, with);
    }
}

/// What is left wrong at the hub's contacts: overlap (m) and approach over a substep (m), their
/// root mean square.
double residualOf(const World& world) {
    const BodyMotion hub = motionOf(world, 1);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < rimCount; ++i) {
        const BodyMotion disc = motionOf(world, i + 2);
        const Vec2T<double> d = wide(disc.position) - wide(hub.position);
        const double distance = length(d);
        const double gap = distance - wide(hubRadius) - wide(rimRadius);
        const double speed = dot(wide(disc.velocity) - wide(hub.velocity), (1.0 / distance) * d);
        const double wrong =
            std::max(-gap, 0.0) + std::max(-speed, 0.0) / 240.0 * (gap < 0.005 ? 1.0 : 0.0);
        sum += wrong * wrong;
    }
    return std::sqrt(sum / rimCount);
}

TEST(Hub, LeavesAResidualOfAtMostOneFifthMoreThanKeyOrderDoes) {
    World buckets = pressedHub(), inKeyOrder = pressedHub();
    WorldSpoiler::limitPlans(inKeyOrder, {.hubDegree = ~0u});
    double worst = 0.0, worstInKeyOrder = 0.0;
    for (int second = 0; second < 4; ++second) {
        press(buckets, 30);
        press(inKeyOrder, 30);
        ASSERT_GT(buckets.report().inBuckets, 300u);
        ASSERT_GT(inKeyOrder.report().overflow, 200u);
        worst = std::max(worst, residualOf(buckets));
        worstInKeyOrder = std::max(worstInKeyOrder, residualOf(inKeyOrder));
    }
    EXPECT_GT(worstInKeyOrder, 0.0);
    EXPECT_LE(worst, 1.2 * worstInKeyOrder);
    std::cout << "residual " << worst << " m, in key order " << worstInKeyOrder << " m\n";
}

TEST(Hub, AmongDiscsThatDoNotMoveIsHeldAsInKeyOrder) {
    World buckets = pressedHub(BodyType::Static), inKeyOrder = pressedHub(BodyType::Static);
    WorldSpoiler::limitPlans(inKeyOrder, {.hubDegree = ~0u});
    const std::vector<Command> pull{{0, 1, ApplyForce{1, {4000.0f, 1000.0f}, {}}}};
    for (World* world : {&buckets, &inKeyOrder}) {
        world->step(pull);
        EXPECT_EQ(world->report().inBuckets > 900u, world == &buckets);
        for (int tick = 0; tick < 120; ++tick) world->step(pull);
    }
    const double moved = length(wide(motionOf(buckets, 1).position));
    const double movedInKeyOrder = length(wide(motionOf(inKeyOrder, 1).position));
    std::cout << "moved " << moved << " m, in key order " << movedInKeyOrder << " m\n";
    EXPECT_LE(moved, 1.2 * movedInKeyOrder + 1e-5);
}

TEST(Hub, OfWhichOnlyOneContactPushesBouncesAsHighAsInKeyOrder) {
    // A plank over 90 pieces of ground, of which one stands out.
    std::vector<BodyDef> bodies;
    for (int i = 0; i < 90; ++i) {
        const float x = 0.5f * (static_cast<float>(i) - 44.5f);
        const float top = i == 45 ? 0.017f : 0.0f;
        bodies.push_back(bodyAt(BodyType::Static, {x, top - 0.5f}, ShapeDef::box(0.25f, 0.5f)));
    }
    bodies.push_back(
        bodyAt(BodyType::Dynamic, {0.0f, 0.018f + 0.25f}, ShapeDef::box(25.0f, 0.25f)));
    bodies.back().velocity = {0.0f, -1.2f};
    for (BodyDef& body : bodies) body.shapes[0].material.restitution = 0.8f;
    Scene scene = sceneOf(std::move(bodies));
    scene.gravity = {};
    World buckets = worldOf(scene), inKeyOrder = worldOf(scene);
    WorldSpoiler::limitPlans(inKeyOrder, {.hubDegree = ~0u});
    run(buckets, 1);
    run(inKeyOrder, 1);
    EXPECT_GT(buckets.report().inBuckets, 80u);
    const double up = wide(motionOf(buckets, 91).velocity.y);
    const double upInKeyOrder = wide(motionOf(inKeyOrder, 91).velocity.y);
    EXPECT_GT(upInKeyOrder, 0.7);
    EXPECT_NEAR(up, upInKeyOrder, 0.05);
}

TEST(Hub, IsTheSameOnEveryTeamInAnyBatchAndAfterARestore) {
    World plain = pressedHub();
    World small = pressedHub(), wide8 = pressedHub();
    WorldSpoiler::limitPlans(small, {.batchSize = 16});
    Executor team(3, 7);
    for (int part = 0; part < 5; ++part) {
        press(plain, 8, {nullptr, Simd::Scalar});
        press(small, 8, {&team, Simd::Auto});
        press(wide8, 8);
        wide8 = restored(wide8);
        ASSERT_EQ(differenceOf(plain, small), "") << "part " << part;
        ASSERT_EQ(differenceOf(plain, wide8), "") << "part " << part;
    }
    EXPECT_EQ(plain.report().overflow, 0u) << "nobody is solved one by one";
}

}  // namespace
}  // namespace huestep::test
