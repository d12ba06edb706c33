// Metrics against cases whose value is known: made-up trajectories, not runs.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/scene/catalog.h"
#include "tools/metrics/ballistic.h"
#include "tools/metrics/metric.h"

namespace huestep::tools {
namespace {

constexpr double dt = 1.0 / 60.0;
constexpr double g = 10.0;

/// The judge of a case, and the motions that it is shown.
class Shown {
 public:
    explicit Shown(const char* name) : m_metric(findMetricCase(name)) {
        EXPECT_NE(m_metric, nullptr) << name;
        Result<World> world = World::create(m_metric->scene());
        EXPECT_TRUE(world.ok());
        m_motions.assign(world->motions().begin(), world->motions().end());
        m_judge = m_metric->judge(*world);
    }
    /// Shows every tick of the case; `move` sets motions to where they are at `t` seconds.
    template <class Move>
    double error(Move move) {
        for (std::uint64_t tick = 1; tick <= m_metric->ticks; ++tick) {
            const std::vector<BodyMotion> start = m_motions;
            std::vector<BodyMotion> now = start;
            move(dt * static_cast<double>(tick), now);
            m_judge->watch(tick, {}, now, false);
        }
        return m_judge->error();
    }

 private:
    const MetricCase* m_metric;
    std::vector<BodyMotion> m_motions;
    std::unique_ptr<Judge> m_judge;
};

float f(double x) {
    return static_cast<float>(x);
}

TEST(MetricBallistic, IsZeroOnTheParabolaAndWhatTheBodyIsOffIt) {
    const auto parabola = [](double lift) {
        return [lift](double t, std::vector<BodyMotion>& m) {
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
    return Shown(name).error([&](double, std::vector<BodyMotion>& m) {
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
        const std::string name = "pendulum-" + std::to_string(int(degrees)) + "-period";
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

}  // namespace
}  // namespace huestep::tools
