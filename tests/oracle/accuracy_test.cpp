// The first accuracy gates of the physics page: right answers in closed form or as the solution of
// a differential equation, limits as the page states them.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/catalog.h"
#include "core/scene/measure.h"
#include "core/world/world.h"

namespace huestep::oracle {
namespace {

World worldOf(const char* text) {
    Result<Scene> scene = sceneFromCatalog(text);
    EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
    Result<World> world = World::create(*scene);
    EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().message);
    return std::move(world.value());
}

Measures measured(const World& world) {
    return measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions());
}

double arithmeticGeometricMean(double a, double b) {
    for (int i = 0; i < 60 && std::abs(a - b) > 1e-16 * a; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return a;
}

TEST(Accuracy, ADiscInFreeFlightIsOnItsParabolaAfterASecond) {
    World world = worldOf("ballistic");
    for (int tick = 0; tick < 60; ++tick) world.step({});
    EXPECT_NEAR(world.motions()[0].position.x, 3.0f, 1e-5f);
    EXPECT_NEAR(world.motions()[0].position.y, -1.0f, 1e-5f);
}

/// Times at which the pendulum passes its lowest point, refined linearly in its angle.
std::vector<double> passages(World& world, int ticks) {
    std::vector<double> times;
    const double dt = static_cast<double>(world.info().stepSeconds);
    const auto angle = [&] {
        const Vec2 bob = world.motions()[1].position;
        return std::atan2(static_cast<double>(bob.x), static_cast<double>(-bob.y));
    };
    double last = angle();
    for (int tick = 1; tick <= ticks; ++tick) {
        world.step({});
        const double now = angle();
        if (last * now < 0.0 && std::abs(now) < 1.5) {
            times.push_back(dt * (tick - now / (now - last)));
        }
        last = now;
    }
    return times;
}

TEST(Accuracy, APendulumAt90DegreesKeepsItsPeriodAndItsEnergy) {
    World world = worldOf("pendulum:angle=90");
    const double before = measured(world).energy;
    const std::vector<double> times = passages(world, 600);
    ASSERT_GE(times.size(), 7u);
    // From the first passage to the last one of the same direction, in whole swings.
    const std::size_t swings = (times.size() - 1) / 2;
    const double period = (times[2 * swings] - times[0]) / static_cast<double>(swings);
    const double equivalentLength = 1.0 + 0.5 * 0.1 * 0.1;
    const double exact = 2.0 * M_PI * std::sqrt(equivalentLength / 10.0) /
                         arithmeticGeometricMean(1.0, std::cos(M_PI / 4.0));
    ASSERT_NEAR(exact, 2.3510953, 1e-6) << "the reference of the physics page";
    EXPECT_NEAR(period / exact, 1.0, 1e-4);
    // In units of the energy that it has above hanging at rest: m g L.
    const double scale = static_cast<double>(world.bodies()[1].mass) * 10.0;
    EXPECT_LT(std::abs(measured(world).energy - before) / scale, 2e-3);
}

TEST(Accuracy, ADoublePendulumIsWhereItsEquationsSayAfterASecond) {
    World world = worldOf("double_pendulum");
    for (int tick = 0; tick < 60; ++tick) world.step({});
    const Vec2 tip = world.motions()[2].position;
    const double off =
        std::hypot(static_cast<double>(tip.x) + 1.4771364, static_cast<double>(tip.y) + 1.2884217);
    EXPECT_LT(off, 6e-3);
}

TEST(Accuracy, AHangingChainAtAHundredToOneIsOffByTheFloorOfItsSoftRows) {
    World world = worldOf("chain:ratio=100");
    double steady = 0.0;
    for (int tick = 0; tick < 900; ++tick) {
        world.step({});
        if (tick >= 600) steady = std::max(steady, measured(world).maxJointError);
    }
    // e = F/(m ω²): the second joint carries 109 links at 60 Hz with an effective mass of 0.5 kg,
    // so 15.34 mm; at twice that the solver itself would be at fault.
    const double omega = 2.0 * M_PI * 60.0;
    const double floor = 1090.0 / (0.5 * omega * omega);
    EXPECT_LT(steady, 1.25 * floor);
}

TEST(Accuracy, AStackOfTwentyBoxesStandsForTwentySeconds) {
    World world = worldOf("stack:n=20");
    const std::vector<BodyMotion> start(world.motions().begin(), world.motions().end());
    double speed = 0.0;
    for (int tick = 0; tick < 1200; ++tick) {
        world.step({});
        if (tick < 1140) continue;
        double sum = 0.0;
        for (const BodyMotion& motion : world.motions()) {
            sum += static_cast<double>(lengthSquared(motion.velocity));
        }
        speed = std::max(speed, std::sqrt(sum / static_cast<double>(world.motions().size())));
    }
    for (std::size_t i = 1; i < start.size(); ++i) {
        EXPECT_LT(length(world.motions()[i].position - start[i].position), 0.5f) << "box " << i;
        EXPECT_LT(std::abs(world.motions()[i].rotation.s), 0.45f) << "box " << i;
    }
    EXPECT_LT(speed, 0.01);
    EXPECT_LT(measured(world).maxPenetration, 0.02);
}

TEST(Accuracy, TheHingeSceneComesToRestAndSleeps) {
    World world = worldOf("hinges");
    for (int tick = 0; tick < 600; ++tick) world.step({});
    for (std::size_t i = 1; i < world.motions().size(); ++i) {
        EXPECT_TRUE(world.motions()[i].asleep()) << "body " << world.bodies()[i].id;
    }
    EXPECT_LT(measured(world).maxJointError, 5e-3);
    EXPECT_LT(measured(world).maxPenetration, 5e-3);
}

}  // namespace
}  // namespace huestep::oracle
