// Joints, flight and conserved quantities: metrics of made-up motions whose error is known.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "core/scene/catalog.h"
#include "tests/tools/metrics/shown.h"

namespace huestep::tools {
namespace {

constexpr double dt = 1.0 / 60.0;
constexpr double g = 10.0;

TEST(MetricBallistic, IsZeroOnTheParabolaAndWhatTheBodyIsOffIt) {
    const auto parabola = [](double lift) {
        return [lift](double t, Motions& m) {
            m[0].position = {f(3.0 * t), f(4.0 * t - 0.5 * g * t * t + lift)};
        };
    };
    EXPECT_NEAR(Shown("ballistic").error(parabola(0.0)), 0.0, 1e-6);
    EXPECT_NEAR(Shown("ballistic").error(parabola(1e-3)), 1e-3, 1e-6);
}

/// A pendulum by its equation, a step of the classical Runge-Kutta method at a time.
struct Swing {
    double angle, rate = 0.0;
    void advance(double h, double over) {
        const auto turn = [over](double a) { return -over * std::sin(a); };
        const double k1 = rate, l1 = turn(angle);
        const double k2 = rate + 0.5 * h * l1, l2 = turn(angle + 0.5 * h * k1);
        const double k3 = rate + 0.5 * h * l2, l3 = turn(angle + 0.5 * h * k2);
        const double k4 = rate + h * l3, l4 = turn(angle + h * k3);
        angle += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
        rate += h / 6.0 * (l1 + 2.0 * (l2 + l3) + l4);
    }
};

/// Shows the pendulum from `degrees` with its clock running at `pace`.
double swingError(const char* name, double degrees, double pace) {
    Swing swing{degrees * std::numbers::pi / 180.0};
    return Shown(name).error([&](double, Motions& m) {
        for (int i = 0; i < 100; ++i) swing.advance(0.01 * pace * dt, g / 1.005);
        const double c = std::cos(swing.angle), s = std::sin(swing.angle);
        m[1].position = {f(s), f(-c)};
        m[1].rotation = {f(c), f(s)};
        m[1].velocity = {f(pace * swing.rate * c), f(pace * swing.rate * s)};
        m[1].angularVelocity = f(pace * swing.rate);
    });
}

TEST(MetricPendulum, IsZeroForTheEquationAndTheShareByWhichAClockRunsFast) {
    for (const double degrees : {30.0, 90.0, 150.0}) {
        const std::string name = "pendulum-" + std::to_string(std::lround(degrees)) + "-period";
        SCOPED_TRACE(name);
        EXPECT_LT(swingError(name.c_str(), degrees, 1.0), 1e-6);
        EXPECT_NEAR(swingError(name.c_str(), degrees, 1.001), 1.0 - 1.0 / 1.001, 1e-6);
    }
}

TEST(MetricPendulum, PhaseIsWhatAFastClockGains) {
    EXPECT_LT(swingError("pendulum-90-phase", 90.0, 1.0), 3e-5);
    // The last passage of 10 s is that after a quarter and eight halves: 4.25 periods of 2.351 s.
    const double due = 4.25 * 2.0 * std::numbers::pi;
    EXPECT_NEAR(swingError("pendulum-90-phase", 90.0, 1.001), due * (1.0 - 1.0 / 1.001), 3e-5);
}

TEST(MetricPendulum, EnergyIsTheShareOfItsHeightThatItHasLost) {
    const auto at = [](double x, double y) {
        return [x, y](double, Motions& m) { m[1].position = {f(x), f(y)}; };
    };
    EXPECT_NEAR(Shown("pendulum-90-energy").error(at(1.0, 0.0)), 0.0, 1e-6);
    EXPECT_NEAR(Shown("pendulum-90-energy").error(at(0.0, -1.0)), 1.0, 1e-6);
    EXPECT_NEAR(Shown("pendulum-90-energy").error(at(0.8, -0.6)), 0.6, 1e-6);
}

TEST(MetricDoublePendulum, IsHowFarTheTipIsFromItsEquation) {
    // Where the physics page has it (A6).
    const auto tip = [](double off) {
        return [off](double, Motions& m) { m[2].position = {f(-1.4771364 + off), -1.2884217f}; };
    };
    EXPECT_LT(Shown("double-pendulum-1s").error(tip(0.0)), 1e-6);
    EXPECT_NEAR(Shown("double-pendulum-1s").error(tip(1e-3)), 1e-3, 1e-6);
    EXPECT_NEAR(Shown("double-pendulum-energy").error([](double, Motions& m) {
        m[1].position = {0.0f, -1.0f};
        m[2].position = {0.0f, -2.0f};
    }),
                1.0, 1e-6)
        << "hanging still";
}

TEST(MetricMomentum, IsZeroWhereNothingChangesAndWhatIsAddedAsAShare) {
    const auto keep = [](double, Motions&) {};
    EXPECT_LT(Shown("kicked-momentum").error(keep), 1e-12);
    EXPECT_LT(Shown("kicked-angular-momentum").error(keep), 1e-12);
    const auto faster = [](double, Motions& m) {
        for (BodyMotion& body : m) body.velocity = 1.5f * body.velocity;
    };
    EXPECT_NEAR(Shown("kicked-angular-momentum").error(faster), 0.5, 1e-6);
    // A drift of 1 m/s of everything: the mass over the sum of m |v|.
    Shown drift("kicked-momentum");
    const Result<World> world = World::create(findMetricCase("kicked-momentum")->scene());
    double mass = 0.0, size = 0.0;
    for (std::size_t i = 0; i < world->bodies().size(); ++i) {
        const BodyMotion& body = world->motions()[i];
        mass += static_cast<double>(world->bodies()[i].mass);
        size +=
            static_cast<double>(world->bodies()[i].mass) *
            std::hypot(static_cast<double>(body.velocity.x), static_cast<double>(body.velocity.y));
    }
    EXPECT_NEAR(drift.error([](double, Motions& m) {
        for (BodyMotion& body : m) body.velocity.y += 1.0f;
    }),
                mass / size, 1e-5);
}

TEST(MetricBridge, PeakRemembersWhatSteadyForgets) {
    const auto shaken = [](double t, Motions& m) {
        if (t < 1.0) m[5].position.y += 0.01f;
    };
    EXPECT_NEAR(Shown("bridge-peak").error(shaken), 0.01, 1e-6);
    EXPECT_LT(Shown("bridge-steady").error(shaken), 1e-6);
}

TEST(MetricChain, IsTheStretchAgainstRigidJointsAndNoneAgainstTheFloorLaw) {
    // A row of effective mass m under F gives way by F / (m ω²), ω = 2π · 60 Hz at 4 substeps.
    const double omega = 2.0 * std::numbers::pi * 60.0;
    const auto stretched = [omega](double, Motions& m) {
        double sunk = 0.0;
        for (std::size_t joint = 0; joint < 11; ++joint) {
            const double load = g * (100.0 + 10.0 - static_cast<double>(joint));
            const double effective = joint == 0 ? 1.0 : (joint == 10 ? 100.0 / 101.0 : 0.5);
            sunk += load / (effective * omega * omega);
            m[joint + 1].position.y -= f(sunk);
        }
    };
    const double worst = 1090.0 / (0.5 * omega * omega);
    EXPECT_NEAR(Shown("chain-100-hang").error(stretched), worst, 2e-6);
    EXPECT_LT(Shown("chain-100-floor").error(stretched), 2e-6);
    const auto straight = [](double, Motions&) {};
    EXPECT_NEAR(Shown("chain-100-floor").error(straight), worst, 2e-6);
}

TEST(MetricChain, GainIsTheEnergyWonOfThatOfTheFall) {
    // 100 kg at 5.6 m and links of 1 kg at 0.25 m, 0.75 m … 4.75 m: 25 kg·m.
    const double fall = g * (100.0 * 5.6 + 25.0);
    const auto lifted = [](double t, Motions& m) { m[11].position.y += t < 1.0 ? 0.1f : -0.1f; };
    EXPECT_NEAR(Shown("chain-100-swing-gain").error(lifted), 100.0 * g * 0.1 / fall, 1e-6);
}

TEST(MetricArm, IsTheShareByWhichRadiusAndEnergyChange) {
    const auto longer = [](double, Motions& m) { m[1].position = {0.0f, 5.05f}; };
    EXPECT_NEAR(Shown("arm-10-radius").error(longer), 0.01, 1e-6);
    const auto slower = [](double, Motions& m) {
        m[1].velocity = 0.9f * m[1].velocity;
        m[1].angularVelocity *= 0.9f;
    };
    EXPECT_NEAR(Shown("arm-30-energy").error(slower), 1.0 - 0.81, 1e-6);
}

TEST(Metrics, AMotionThatIsNoNumberIsAFailureAndNoError) {
    for (const MetricCase& metric : metricCases()) {
        if (!metric.judge) continue;
        SCOPED_TRACE(metric.name);
        const double error = Shown(metric.name.c_str()).error([](double, Motions& m) {
            for (BodyMotion& body : m) {
                body.position.x = body.position.y = std::nanf("");
                body.velocity.x = body.velocity.y = body.angularVelocity = std::nanf("");
            }
        });
        EXPECT_TRUE(std::isinf(error)) << error;
    }
}

TEST(Metrics, NamesAreUniqueAndEveryCaseSaysWhatItIs) {
    std::set<std::string> names;
    std::set<std::string_view> metrics;
    for (const MetricCase& metric : metricCases()) {
        EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
        metrics.insert(metric.metric);
        EXPECT_FALSE(metric.what.empty() || metric.unit.empty() || metric.reference.empty());
        EXPECT_TRUE(check(metric.scene()).ok()) << metric.name;
        EXPECT_NE(metric.judge == nullptr, metric.series == nullptr) << metric.name;
        EXPECT_FALSE(metric.charted && metric.series) << metric.name;
    }
    for (int id = 1; id <= 20; ++id) {
        EXPECT_TRUE(metrics.contains("A" + std::to_string(id))) << "A" << id;
    }
}

TEST(Metrics, ASceneFindsItsOwnCasesWhateverItsEffort) {
    Scene scene = *sceneFromCatalog("pendulum:angle=90");
    scene.substeps = 7;
    scene.name = "mine";
    Setting setting;
    setting.method = Method::SoftStep;
    setting.substeps = 7;
    std::set<std::string> names;
    for (const RunningJudge& judge : judgesOf(scene, *World::create(scene), setting))
        names.insert(judge.metric->name);
    EXPECT_EQ(names, (std::set<std::string>{"pendulum-90-energy", "pendulum-90-period",
                                            "pendulum-90-phase"}));
    scene.bodies[1].linearDamping = 0.1f;
    EXPECT_TRUE(judgesOf(scene, *World::create(scene), setting).empty());
}

}  // namespace
}  // namespace huestep::tools
