// The gates of the physics page that the first solver has to pass, each against a closed form.

#include <cmath>
#include <numbers>

#include "core/scene/measure.h"
#include "tests/core/pendulum.h"

namespace huestep::test {
namespace {

constexpr double g = 10.0;
constexpr double dt = 1.0 / 60.0;

double energyOf(const World& world) {
    return measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions())
        .energy;
}
double jointErrorOf(const World& world) {
    return measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions())
        .maxJointError;
}

TEST(Gate, PendulumAt90DegreesKeepsItsPeriodTo1e4AndItsEnergyTo2PerMille) {
    World world = worldOf("pendulum:angle=90");
    ASSERT_TRUE(world.info().planned());
    const double exact = pendulumPeriod(0.5 * std::numbers::pi);
    const double start = energyOf(world);
    const double scale = wide(world.bodies()[1].mass) * g;  // m g L: what it has above its lowest

    const double period = measuredPeriod(world, 600);
    EXPECT_LT(std::abs(period / exact - 1.0), 1e-4) << period << " s instead of " << exact;
    const double loss = start - energyOf(world);
    EXPECT_LT(loss / scale, 0.002);
    EXPECT_GT(loss / scale, -0.002) << "it gained energy";
    RecordProperty("periodError", std::to_string(period / exact - 1.0));
    RecordProperty("energyLoss", std::to_string(loss / scale));
}

TEST(Gate, BallisticFromTheOriginIsOnItsParabolaTo1e5MetresAfterASecond) {
    World world = worldOf("ballistic");
    run(world, 60);
    const Vec2T<double> p = wide(world.motions()[0].position);
    EXPECT_LT(std::hypot(p.x - 3.0, p.y - (4.0 - 0.5 * g)), 1e-5);
    EXPECT_NEAR(wide(world.motions()[0].velocity.y), 4.0 - g, 1e-5);
}

/// The hanging chain at 100:1 for 20 s with n substeps: largest joint error at the end, in m.
double hangingChainError(std::uint32_t substeps) {
    Scene scene = *sceneFromCatalog("chain:ratio=100");
    scene.substeps = substeps;
    World world = worldOf(scene);
    run(world, 1140);
    const double before = jointErrorOf(world);
    double least = before, most = before;
    for (int tick = 0; tick < 60; ++tick) {
        world.step({});
        least = std::min(least, jointErrorOf(world));
        most = std::max(most, jointErrorOf(world));
    }
    EXPECT_LT(most - least, 1e-4) << "it must hang still";
    return most;
}

// Row 11 of the suite asks for a steady error below 1 cm. A soft row of angular frequency ω and
// effective mass m under the load F is off by e = F / (m ω²) whatever else is done; ω = 2π·0.25/h.
// The row with most error is the second: it carries 9 links and the ball, 1090 N, at an effective
// mass of half a link. At n = 4 and 60 Hz that law says 15 mm, so the gate runs at the n that the
// law asks for: f_need = sqrt(F/(m ε))/2π, n_need = ceil(4 f_need Δt), up to a power of two.
TEST(Gate, HangingChainAt100To1IsWithinOneCentimetreAtTheSubstepsThatTheFloorLawAsksFor) {
    const double load = 1090.0, mass = 0.5;
    const auto floorAt = [&](double n) {
        const double omega = 2.0 * std::numbers::pi * 0.25 * n / dt;
        return load / (mass * omega * omega);
    };
    const double need = std::sqrt(load / (mass * 0.01)) / (2.0 * std::numbers::pi);
    const double least = std::ceil(4.0 * need * dt);
    ASSERT_EQ(least, 5.0);
    const std::uint32_t n = 8;  // the power of two above
    EXPECT_LT(hangingChainError(n), 0.01);
    EXPECT_NEAR(hangingChainError(n), floorAt(8), 0.1 * floorAt(8));
    EXPECT_NEAR(hangingChainError(4), floorAt(4), 0.1 * floorAt(4))
        << "at n = 4 the error is that of the law, 15 mm";
}

/// None moves 0.5 m sideways or 0.5 rad. Downwards the soft rows give way by the floor law, all
/// levels added: metres for a tall stack, so height is no criterion.
void expectStanding(const std::string& text, double seconds) {
    Scene scene = *sceneFromCatalog(text);
    scene.substeps = 4;
    World world = worldOf(scene);
    const std::vector<BodyMotion> start(world.motions().begin(), world.motions().end());
    const auto ticks = static_cast<int>(seconds * 60.0 + 0.5);
    double sum = 0.0;
    int samples = 0;
    for (int tick = 0; tick < ticks; ++tick) {
        world.step({});
        if (tick < ticks - 60) continue;  // at rest: over the last second
        for (const BodyMotion& m : world.motions()) sum += lengthSquared(wide(m.velocity));
        samples += static_cast<int>(world.motions().size()) - 1;  // the ground aside
    }
    for (std::size_t i = 0; i < start.size(); ++i) {
        const BodyMotion& m = world.motions()[i];
        EXPECT_LT(std::abs(wide(m.position.x) - wide(start[i].position.x)), 0.5) << "box " << i;
        EXPECT_LT(std::abs(std::atan2(wide(m.rotation.s), wide(m.rotation.c))), 0.5) << "box " << i;
    }
    EXPECT_LT(std::sqrt(sum / samples), 0.01) << "rms speed, m/s";
}

TEST(Gate, StackOf20StandsFor20SecondsAtFourSubsteps) {
    expectStanding("stack:n=20", 20.0);
}

TEST(Gate, StackOf60StandsFor20SecondsAtFourSubsteps) {
    expectStanding("stack:n=60", 20.0);
}

}  // namespace
}  // namespace huestep::test
