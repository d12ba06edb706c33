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
World pressedHub(BodyType type) {
    const auto density = [](double mass, float radius) {
        return static_cast<float>(mass / (M_PI * wide(radius) * wide(radius)));
    };
    std::vector<BodyDef> bodies{discAt({}, hubRadius)};
    bodies[0].type = type;
    bodies[0].shapes[0].density = density(50.0, hubRadius);
    for (std::uint32_t i = 0; i < rimCount; ++i) {
        const double angle = 2.0 * M_PI * i / rimCount;
        const double far = wide(hubRadius) + wide(rimRadius);
        bodies.push_back(discAt(
            {static_cast<float>(far * std::cos(angle)), static_cast<float>(far * std::sin(angle))},
            rimRadius));
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
            const float force = i % 1000 < 333 ? 15.0f : 5.0f;
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

class PressedHub : public testing::TestWithParam<BodyType> {};

TEST_P(PressedHub, LeavesAResidualOfAtMost12TimesThatOfKeyOrder) {
    World buckets = pressedHub(GetParam()), inKeyOrder = pressedHub(GetParam());
    WorldSpoiler::limitPlans(inKeyOrder, {standardBatchSize, ~0u});
    double worst = 0.0, worstInKeyOrder = 0.0;
    for (int second = 0; second < 4; ++second) {
        press(buckets, 30);
        press(inKeyOrder, 30);
        worst = std::max(worst, residualOf(buckets));
        worstInKeyOrder = std::max(worstInKeyOrder, residualOf(inKeyOrder));
    }
    EXPECT_GT(worstInKeyOrder, 0.0);
    EXPECT_LE(worst, 1.2 * worstInKeyOrder);
    std::cout << "residual " << worst << " m, in key order " << worstInKeyOrder << " m\n";
}

INSTANTIATE_TEST_SUITE_P(Kinds, PressedHub, testing::Values(BodyType::Dynamic, BodyType::Kinematic),
                         [](const auto& param) {
                             return param.param == BodyType::Dynamic ? "Dynamic" : "Kinematic";
                         });

TEST(Hub, IsTheSameOnEveryTeamInAnyBatchAndAfterARestore) {
    World plain = pressedHub(BodyType::Dynamic);
    World small = pressedHub(BodyType::Dynamic), wide8 = pressedHub(BodyType::Dynamic);
    WorldSpoiler::limitPlans(small, {16, standardHubDegree});
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
