// The reference solver against closed forms. Beside other methods: see second_method_test.cpp.
#include "tools/reference/reference_world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/scene/catalog.h"
#include "tools/metrics/scenes.h"
#include "tools/metrics/soft_model.h"
#include "tools/reference/linkage.h"

namespace huestep::reference {
namespace {

constexpr double g = 10.0;
constexpr double slope = 20.0 * std::numbers::pi / 180.0;

World worldOf(const Scene& scene) {
    return *World::create(scene);
}
Scene sceneOf(const char* text) {
    return *sceneFromCatalog(text);
}

/// Where the scene is after so many ticks, its own uncertainty and residual checked beside.
std::vector<Body> after(const Scene& scene, std::uint64_t ticks, double uncertainty = 1e-6) {
    const Result<Trajectory> trajectory = follow(worldOf(scene), ticks, {});
    EXPECT_TRUE(trajectory.ok());
    EXPECT_LE(trajectory->uncertainty, uncertainty);
    EXPECT_LE(trajectory->residual, 1e-10);
    return trajectory->ticks.back();
}

double downhill(Vec2d way) {
    return way.x * std::cos(slope) - way.y * std::sin(slope);
}

TEST(ReferenceWorld, ABoxSlidesDownASlopeByCoulombsLaw) {
    const Scene scene = sceneOf("ramp:angle=20,friction=0.3");
    const Vec2d start = {0.5 * std::sin(slope), 0.5 * std::cos(slope)};
    const Body box = after(scene, 120)[1];
    const double acceleration = g * (std::sin(slope) - 0.3 * std::cos(slope));
    EXPECT_NEAR(downhill(box.position - start), 0.5 * acceleration * 4.0, 2e-6);
    EXPECT_NEAR(downhill(box.velocity), acceleration * 2.0, 2e-6);
}

TEST(ReferenceWorld, ABoxSticksToASlopeOfLessThanItsFriction) {
    const Scene scene = sceneOf("ramp:angle=20,friction=0.5");
    const Vec2d start = {0.5 * std::sin(slope), 0.5 * std::cos(slope)};
    EXPECT_LT(length(after(scene, 60)[1].position - start), 1e-6);
}

TEST(ReferenceWorld, ABoxStopsWhereItsEnergyIsUsedUp) {
    EXPECT_NEAR(after(sceneOf("slide:speed=5,friction=0.4"), 120)[1].position.x, 3.125, 1e-6);
}

TEST(ReferenceWorld, ADiscThatSlidesRollsWithTwoThirdsOfItsSpeed) {
    const Body disc = after(sceneOf("slide:speed=5,friction=0.3,disc=1"), 60)[1];
    const double rolls = 5.0 / (3.0 * 0.3 * g);
    const double way = 5.0 * rolls - 0.5 * 0.3 * g * rolls * rolls + 10.0 / 3.0 * (1.0 - rolls);
    EXPECT_NEAR(disc.position.x, way, 1e-6);
    EXPECT_NEAR(disc.velocity.x, 10.0 / 3.0, 1e-6);
    EXPECT_NEAR(disc.spin, -10.0 / 3.0 / 0.5, 1e-5);
}

TEST(ReferenceWorld, ADiscRollsDownASlopeWithTwoThirdsOfItsFall) {
    const Body disc = after(sceneOf("ramp:angle=20,friction=0.6,disc=1"), 120)[1];
    const Vec2d start = {0.5 * std::sin(slope), 0.5 * std::cos(slope)};
    EXPECT_NEAR(downhill(disc.position - start), 4.56027, 5e-6);
}

TEST(ReferenceWorld, AStackOfRigidBoxesStaysWhereItIs) {
    const std::vector<Body> stack = after(tools::straightStack(5), 30, 1e-8);
    for (std::size_t i = 1; i <= 5; ++i) {
        EXPECT_NEAR(stack[i].position.y, static_cast<double>(i) - 0.5, 1e-8);
        EXPECT_LT(length(stack[i].velocity), 1e-7);
    }
}

TEST(ReferenceWorld, DiscsThatMeetHeadOnExchangeMomentumByNewtonsLaw) {
    const std::vector<Body> discs = after(tools::headOn(0.5f), 60, 2e-3);
    // 1 : 3 at 4 and −2 m/s: the middle moves with −0.5; −e of 6 m/s is left between them.
    EXPECT_NEAR(discs[0].velocity.x, -0.5 - 0.5 * 6.0 * 0.75, 1e-6);
    EXPECT_NEAR(discs[1].velocity.x, -0.5 + 0.5 * 6.0 * 0.25, 1e-6);
}

TEST(ReferenceWorld, AnImpactIsLateByLessThanASubstep) {
    // Down 2 m in 0.6325 s, up with half the speed: the parabola after it, at 1 s.
    const double falls = std::sqrt(2.0 * 2.0 / g);
    const double rest = 1.0 - falls;
    const double height = 0.5 + 0.5 * g * falls * rest - 0.5 * g * rest * rest;
    const double h = 1.0 / 60.0 / 128.0;
    const Body disc = after(sceneOf("bounce:restitution=0.5,height=2"), 60, 2e-3)[1];
    EXPECT_NEAR(disc.position.y, height, 1.5 * g * falls * h);
}

TEST(ReferenceWorld, HingesMoveAsTheEquationsInMinimalCoordinates) {
    const World start = worldOf(sceneOf("double_pendulum"));
    const Vec2d exact = solveLinkage(*Linkage::find(start), 1.0).linkage.position(2);
    Accuracy accuracy;
    double last = 0.0;
    for (const int substeps : {8, 16, 32}) {
        accuracy.substeps = substeps;
        Result<ReferenceWorld> world = ReferenceWorld::create(start, accuracy);
        ASSERT_TRUE(world.ok());
        for (int tick = 0; tick < 60; ++tick) world->step();
        const double off = length(world->bodies()[2].position - exact);
        if (last > 0.0) {
            EXPECT_NEAR(std::log2(last / off), 2.0, 0.2) << "of second order";
        }
        last = off;
    }
    EXPECT_LT(last, 3e-6);
}

TEST(ReferenceWorld, SoftRowsGiveWayByTheFloorLaw) {
    Scene scene = tools::straightStack(3);
    scene.substeps = 4;
    const World start = worldOf(scene);
    Accuracy accuracy;
    accuracy.substeps = 4;
    accuracy.soft = SoftRows{};
    accuracy.soft->contactHertz = 30.0;
    accuracy.soft->groundHertz = 60.0;
    const Result<Trajectory> rests = follow(start, 300, accuracy);
    ASSERT_TRUE(rests.ok());
    const double omega = 2.0 * std::numbers::pi * 30.0;
    // A level of k boxes of 1 kg and what is upon it, on two points of effective mass 1/5 and, on
    // the ground, 2/5 kg and twice the frequency.
    const double ground = 3.0 * g / 2.0 / (0.4 * 4.0 * omega * omega);
    const double second = 2.0 * g / 2.0 / (0.2 * omega * omega);
    const std::vector<Body>& stack = rests->ticks.back();
    EXPECT_NEAR(0.5 - stack[1].position.y, ground, 1e-6);
    EXPECT_NEAR(1.0 - (stack[2].position.y - stack[1].position.y), second, 1e-6);
}

// The frequencies as the physics page has them, in numbers: metrics and reference take them from
// the product, so a wrong constant there would move the truth with it.
TEST(SoftRows, HaveAnEighthOfTheSubstepRateForContactsAndAQuarterForJoints) {
    for (const std::uint32_t substeps : {1u, 4u, 32u}) {
        Scene scene = sceneOf("stack:n=2");
        scene.substeps = substeps;
        const WorldInfo info = worldOf(scene).info();
        const double rate = 60.0 * substeps;  // Hz: 240 at n = 4, so contacts have 30 and joints 60
        const SoftRows rows = SoftRows::ofProduct(info);
        EXPECT_NEAR(rows.contactHertz, rate / 8.0, 1e-5 * rate);
        EXPECT_NEAR(rows.groundHertz, rate / 4.0, 1e-5 * rate) << "what does not move: twice that";
        EXPECT_NEAR(rows.jointHertz, rate / 4.0, 1e-5 * rate);
        const tools::SoftOmegas omegas = tools::softOmegas(info);
        const double round = 2.0 * std::numbers::pi * rate;
        EXPECT_NEAR(omegas.contact, round / 8.0, 1e-5 * round);
        EXPECT_NEAR(omegas.ground, round / 4.0, 1e-5 * round);
        EXPECT_NEAR(omegas.joint, round / 4.0, 1e-5 * round);
    }
}

TEST(ReferenceWorld, RefusesWhatItDoesNotKnow) {
    const auto sentence = [](const Scene& scene) {
        const Result<ReferenceWorld> world = ReferenceWorld::create(worldOf(scene), {});
        return world.ok() ? std::string("no error") : world.error().message;
    };
    EXPECT_EQ(sentence(sceneOf("terrain")), "the reference solver knows no kinematic bodies");
    Scene driven = sceneOf("pendulum");
    driven.joints[0].motor = {true, 1.0f, 1.0f};
    EXPECT_EQ(sentence(driven), "the reference solver knows no joints other than plain hinges");
    EXPECT_EQ(sentence(sceneOf("stack")), "no error");
}

}  // namespace
}  // namespace huestep::reference
