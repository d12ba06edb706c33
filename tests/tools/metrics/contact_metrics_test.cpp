// Friction, impact, rest, frames and orders: metrics of made-up motions whose error is known.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/scene/catalog.h"
#include "tests/tools/metrics/shown.h"
#include "tools/reference/reference_world.h"

namespace huestep::tools {
namespace {

constexpr double g = 10.0;
constexpr double slope = 20.0 * std::numbers::pi / 180.0;

/// Body 1 at this way down the slope, with this speed and spin.
void slideTo(Motions& m, double way, double speed = 0.0, double spin = 0.0) {
    m[1].position = {m[1].position.x + f(way * std::cos(slope)),
                     m[1].position.y - f(way * std::sin(slope))};
    m[1].velocity = {f(speed * std::cos(slope)), f(-speed * std::sin(slope))};
    m[1].angularVelocity = f(spin);
}

TEST(MetricRamp, SlideIsTheShareByWhichTheWayIsOff) {
    const auto slides = [](double pace) {
        const double a = g * (std::sin(slope) - 0.3 * std::cos(slope));
        return [=](double t, Motions& m) { slideTo(m, pace * 0.5 * a * t * t); };
    };
    EXPECT_NEAR(Shown("ramp-slide").error(slides(1.0)), 0.0, 1e-6);
    EXPECT_NEAR(Shown("ramp-slide").error(slides(1.005)), 0.005, 1e-6);
}

TEST(MetricRamp, StickIsHowFarItCrept) {
    const auto creeps = [](double t, Motions& m) { slideTo(m, 1e-4 * t); };
    EXPECT_NEAR(Shown("ramp-stick").error(creeps), 1e-3, 1e-7);
    EXPECT_NEAR(Shown("ramp-stick-barely").error(creeps), 1e-3, 1e-7);
    EXPECT_NEAR(Shown("ramp-stick-later").error(creeps), 9e-4, 1e-7) << "from the first second on";
}

TEST(MetricRamp, ThresholdIsWhereBisectionFindsThatItHolds) {
    // A world in which 0.4 is needed.
    const double error = errorOfPlayers("ramp-threshold", 4, [](const Scene& scene) {
        const auto friction = static_cast<double>(scene.bodies[1].shapes[0].material.friction);
        return [friction](double t, Motions& m) { slideTo(m, friction < 0.4 ? 0.1 * t : 0.0); };
    });
    EXPECT_NEAR(error, 0.4 / std::tan(slope) - 1.0, 1e-4);
}

TEST(MetricStop, IsTheShareOfTheDistance) {
    const auto at = [](double x) { return [x](double, Motions& m) { m[1].position.x = f(x); }; };
    EXPECT_NEAR(Shown("stop-distance").error(at(3.125)), 0.0, 1e-6);
    EXPECT_NEAR(Shown("stop-distance").error(at(3.15625)), 0.01, 1e-6);
}

TEST(MetricRolling, WayAndSlipAreThoseOfADiscThatSlipsALittle) {
    const auto rolls = [](double pace) {
        const double a = pace * g * std::sin(slope) * 2.0 / 3.0;
        const double turn = g * std::sin(slope) * 2.0 / 3.0 / 0.5;
        return [=](double t, Motions& m) { slideTo(m, 0.5 * a * t * t, a * t, -turn * t); };
    };
    EXPECT_NEAR(Shown("rolling-way").error(rolls(1.0)), 0.0, 1e-6);
    EXPECT_NEAR(Shown("rolling-way").error(rolls(1.002)), 0.002, 1e-6);
    EXPECT_NEAR(Shown("rolling-slip").error(rolls(1.0)), 0.0, 1e-5);
    const double speed = g * std::sin(slope) * 2.0 / 3.0 * 2.0;
    EXPECT_NEAR(Shown("rolling-slip").error(rolls(1.002)), 0.002 * speed, 1e-5);
}

/// A disc at 5 m/s without spin on this friction.
void slideToRoll(double friction, double t, Motions& m) {
    const double rolls = 5.0 / (3.0 * friction * g);
    const double until = std::min(t, rolls);
    m[1].velocity = {f(5.0 - friction * g * until), 0.0f};
    m[1].angularVelocity = f(-2.0 * friction * g * until / 0.5);
}

TEST(MetricSlideToRoll, SpeedAndTimeAreThoseOfCoulombsLaw) {
    const auto with = [](double friction) {
        return [friction](double t, Motions& m) { slideToRoll(friction, t, m); };
    };
    EXPECT_NEAR(Shown("slide-to-roll-speed").error(with(0.3)), 0.0, 1e-6);
    EXPECT_NEAR(Shown("slide-to-roll-time").error(with(0.3)), 0.0, 1e-5);
    EXPECT_NEAR(Shown("slide-to-roll-time").error(with(0.306)), 1.0 - 1.0 / 1.02, 1e-5);
    EXPECT_NEAR(Shown("slide-to-roll-speed").error([](double t, Motions& m) {
        slideToRoll(0.3, t, m);
        m[1].velocity.x *= 0.99f;
    }),
                0.01, 1e-6);
    EXPECT_TRUE(std::isinf(Shown("slide-to-roll-time").error([](double, Motions&) {})))
        << "it never rolls";
}

/// A disc that falls 2 m and bounces once with restitution e, at height above its place of rest.
double bounced(double e, double t) {
    const double falls = std::sqrt(2.0 * 2.0 / g);
    if (t < falls) return 2.0 - 0.5 * g * t * t;
    const double after = t - falls;
    return std::max(0.0, e * g * falls * after - 0.5 * g * after * after);
}

TEST(MetricBounce, IsTheApexOfTheSquareOfRestitution) {
    const auto with = [](double e) {
        return [e](double t, Motions& m) { m[1].position.y = f(0.5 + bounced(e, t)); };
    };
    EXPECT_NEAR(Shown("bounce-0.5").error(with(0.5)), 0.0, 1e-5);
    EXPECT_NEAR(Shown("bounce-0.8").error(with(0.8)), 0.0, 1e-5);
    EXPECT_NEAR(Shown("bounce-1").error(with(1.0)), 0.0, 1e-5);
    EXPECT_NEAR(Shown("bounce-0.8").error(with(0.7)), 0.64 - 0.49, 1e-5);
    EXPECT_TRUE(std::isinf(Shown("bounce-0.5").error(with(0.0)))) << "it never rises";
}

TEST(MetricBounce, EnergyIsTheShareThatIsLost) {
    const auto high = [](double height) {
        return [height](double, Motions& m) { m[1].position.y = f(0.5 + height); };
    };
    EXPECT_NEAR(Shown("bounce-energy").error(high(0.5)), 0.0, 1e-6);
    EXPECT_NEAR(Shown("bounce-energy").error(high(0.4)), 0.2, 1e-6);
}

TEST(MetricHeadOn, IsTheSpeedByWhichOneOfTheTwoIsOff) {
    // 1 : 3 at 4 and −2 m/s, e = 0.5: −2.75 and 0.25 m/s.
    const auto part = [](double left, double right) {
        return [=](double, Motions& m) {
            m[0].velocity.x = f(left);
            m[1].velocity.x = f(right);
        };
    };
    EXPECT_NEAR(Shown("head-on").error(part(-2.75, 0.25)), 0.0, 1e-6);
    EXPECT_NEAR(Shown("head-on").error(part(-2.75, 0.35)), 0.1, 1e-6);
}

TEST(MetricPyramid, PenetrationIsThatOfTheBoxThatIsPushedDown) {
    const auto down = [](double t, Motions& m) {
        m.back().position.y -= t < 1.0 ? 0.005f : 0.002f;
    };
    EXPECT_NEAR(Shown("pyramid-peak").error(down), 0.005, 2e-6);
    EXPECT_NEAR(Shown("pyramid-mean").error(down), 0.002, 2e-6) << "of the pairs that overlap";
}

TEST(MetricPyramid, JitterIsTheSpeedAndSleepTheTimeOfTheLast) {
    const auto hums = [](double, Motions& m) {
        for (std::size_t i = 1; i < m.size(); ++i) m[i].velocity = {0.006f, 0.008f};
    };
    EXPECT_NEAR(Shown("pyramid-jitter").error(hums), 0.01, 1e-7);
    const auto tires = [](double t, Motions& m) {
        for (std::size_t i = 1; i < m.size(); ++i) {
            const bool last = i + 1 == m.size();
            if (t > (last ? 1.49 : 0.5)) m[i].rest = BodyMotion::asleepBit;
        }
    };
    EXPECT_NEAR(Shown("pyramid-sleep").error(tires), 1.5, 1e-6);
}

TEST(MetricStack, IsTheLevelThatIsSqueezedMostAndNoneAgainstTheFloorLaw) {
    // Levels of 1 kg on two points: with ω of 30 Hz, on the ground 60 Hz, at 4 substeps. A row
    // weighs 1/5 kg between boxes and 2/5 kg on the ground.
    const auto level = [](std::size_t k) {
        const double omega = 2.0 * std::numbers::pi * (k == 0 ? 60.0 : 30.0);
        const double load = 0.5 * g * (10.0 - static_cast<double>(k));
        return load / ((k == 0 ? 0.4 : 0.2) * omega * omega);
    };
    const auto gives = [&](double, Motions& m) {
        double sunk = 0.0;
        for (std::size_t k = 0; k < 10; ++k) m[k + 1].position.y -= f(sunk += level(k));
    };
    EXPECT_NEAR(Shown("stack-10-sink").error(gives), level(1), 1e-6);
    EXPECT_LT(Shown("stack-10-floor").error(gives), 2e-6);
    EXPECT_NEAR(Shown("stack-10-floor").error([](double, Motions&) {}), level(1), 1e-6);
}

TEST(MetricFrame, IsHowFarARunElsewhereIsFromThatAtTheOrigin) {
    // Whoever is more than 500 m away, or turned, is 0.1 m to the right of where he should be.
    const auto play = [](const Scene& scene) {
        const bool moved = scene.bodies[0].position.x > 500.0f || scene.gravity.x != 0.0f;
        return [moved](double, Motions& m) { m[1].position.x += moved ? 0.1f : 0.0f; };
    };
    const auto still = [](const Scene&) { return [](double, Motions&) {}; };
    for (const char* name : {"ramp-slide-1km", "ramp-slide-20km", "ramp-slide-turned",
                             "double-pendulum-turned", "stack-1km"}) {
        SCOPED_TRACE(name);
        EXPECT_NEAR(errorOfPlayers(name, 4, play), 0.1, 2e-3);
        EXPECT_LT(errorOfPlayers(name, 4, still), 2e-3) << "0 but for what a float can say there";
    }
}

TEST(MetricOrder, IsTwoForAnErrorThatIsQuartered) {
    const double a = g * (std::sin(slope) - 0.3 * std::cos(slope));
    for (const double order : {1.0, 2.0}) {
        const double found = errorOfPlayers("ramp-slide-order", 2, [&](const Scene& scene) {
            const double off = 0.1 * std::pow(static_cast<double>(scene.substeps), -order);
            return [=](double t, Motions& m) { slideTo(m, (1.0 + off) * 0.5 * a * t * t); };
        });
        EXPECT_NEAR(found, order, 1e-3);
    }
}

TEST(MetricTrajectory, IsZeroForTheReferenceItselfAndWhatAllOfItIsShiftedBy) {
    const MetricCase& metric = *findMetricCase("tipping-box");
    reference::Accuracy accuracy;
    accuracy.substeps = 512;
    const Result<reference::Trajectory> truth =
        reference::follow(*World::create(metric.scene()), metric.ticks, accuracy);
    ASSERT_TRUE(truth.ok());
    const auto shifted = [&](double by) {
        return [&truth, by](double t, Motions& m) {
            const auto tick = static_cast<std::size_t>(60.0 * t + 0.5);
            const auto& at = truth->ticks[tick][1].position;
            m[1].position = {f(at.x), f(at.y + by)};
        };
    };
    EXPECT_LT(Shown("tipping-box").error(shifted(0.0)), 1e-6);
    EXPECT_NEAR(Shown("tipping-box").error(shifted(1e-3)), 1e-3, 1e-6);
}

/// Accepted only where halving its step moves the reference by less than a tenth of the smallest
/// error that it is to show.
TEST(MetricTrajectory, TheReferenceIsTenTimesMoreCertainThanTheSmallestErrorOfTheProduct) {
    for (const MetricCase& metric : metricCases()) {
        if (!metric.uncertainty) continue;
        SCOPED_TRACE(metric.name);
        const double uncertainty = metric.uncertainty();
        RecordProperty(metric.name + "-uncertainty", std::to_string(uncertainty));
        for (const std::uint32_t substeps : {1u, 4u, 16u}) {
            Setting setting;
            setting.method = Method::SoftStep;
            setting.substeps = substeps;
            setting.make = [](const Scene& scene) -> Result<std::unique_ptr<Engine>> {
                Result<World> world = World::create(scene);
                if (!world) return world.error();
                return std::unique_ptr<Engine>(std::make_unique<Stepper>(std::move(*world)));
            };
            const Result<double> error = errorOf(metric, setting);
            ASSERT_TRUE(error.ok());
            EXPECT_LT(uncertainty, 0.1 * *error) << "n = " << substeps;
        }
    }
}

}  // namespace
}  // namespace huestep::tools
