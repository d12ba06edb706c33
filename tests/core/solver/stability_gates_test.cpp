// Rows of the stability suite that came out of one change each, as gates of the product's default:
// at the level of the core, so that whoever breaks one sees it at once.

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/scene/measure.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

double overlapOf(const World& world) {
    return measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions())
        .maxPenetration;
}

double speedOf(const World& world) {
    double most = 0.0;
    for (const BodyMotion& m : world.motions()) most = std::max(most, length(wide(m.velocity)));
    return most;
}

std::vector<Vec2T<double>> placesOf(const World& world) {
    std::vector<Vec2T<double>> places;
    for (const BodyMotion& m : world.motions()) places.push_back(wide(m.position));
    return places;
}

double farthestFrom(const std::vector<Vec2T<double>>& places, const World& world) {
    double most = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        most = std::max(most, length(wide(world.motions()[i].position) - places[i]));
    }
    return most;
}

TEST(StabilityGate, PyramidOf5050BoxesKeepsItsShapeAtFourSubsteps) {
    World world = worldOf("pyramid:base=100,seed=2");
    const auto start = placesOf(world);
    double most = 0.0;
    for (int tick = 0; tick < 120; ++tick) {
        world.step({});
        most = std::max(most, farthestFrom(start, world));
    }
    EXPECT_LT(most, 0.5);
    EXPECT_EQ(world.stepLayout().islands.front().substeps, 4u);
}

TEST(StabilityGate, PyramidsStandUnderBoxesOf100To300TimesTheirMassThatFallTwoMetres) {
    World world = worldOf("heavy_pyramids:base=10,seed=2");
    std::vector<Vec2T<double>> rest = placesOf(world);
    for (std::size_t i = 0; i < rest.size(); ++i) {
        if (world.bodies()[i].mass > 100.0f) rest[i].y -= 2.0;
    }
    run(world, 60);
    for (int tick = 60; tick < 600; ++tick) {
        world.step({});
        ASSERT_LT(farthestFrom(rest, world), 0.5) << "tick " << tick;
    }
}

TEST(StabilityGate, BoxesDrawnTogetherComeApartAndNoFasterForIt) {
    for (const std::uint32_t substeps : {0u, 4u, 8u}) {
        Scene scene = *sceneFromCatalog("overlap:n=50,share=90,seed=2");
        scene.substeps = substeps;
        SCOPED_TRACE(std::to_string(substeps) + " substeps");
        World world = worldOf(scene);
        double fastest = 0.0;
        for (int tick = 0; tick < 240; ++tick) {
            world.step({});
            fastest = std::max(fastest, speedOf(world));
        }
        EXPECT_LT(fastest, 1.0) << "m/s, where pushing alone leaves 13";
        EXPECT_LT(overlapOf(world), substeps == 0 ? 0.005 : 0.011);
        // It is a pyramid again, of rows of 10, 9 … 4 and one box.
        double highest = 0.0;
        for (const BodyMotion& m : world.motions()) {
            highest = std::max(highest, wide(m.position.y));
        }
        EXPECT_NEAR(highest, 7.5, 0.05);
    }
}

TEST(StabilityGate, ABoxThatFallsDeepIntoAnotherWithinATickIsNoOverlapToRecoverFrom) {
    // At 60 m/s a box is a metre further each tick: what it then overlaps is its motion's.
    Scene scene = sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({0.0f, 20.0f})});
    scene.bodies[2].velocity = {0.0f, -60.0f};
    World world = worldOf(scene);
    constexpr std::uint8_t recovers = 0x20;
    for (int tick = 0; tick < 60; ++tick) {
        world.step({});
        for (const BodyMotion& m : world.motions()) ASSERT_EQ(m.effort & recovers, 0) << tick;
    }
}

TEST(StabilityGate, AnArmThatWhirlsFromItsFirstStepOnKeepsItsEnergy) {
    World world = worldOf("arm:speed=30,seed=2");
    const BodyMotion start = world.motions().back();
    run(world, 300);
    const BodyMotion end = world.motions().back();
    EXPECT_NEAR(length(wide(end.position)), 5.0, 1e-4);
    // I/(m L²) is 2e-4 here, so its speed is its energy.
    EXPECT_GT(lengthSquared(wide(end.velocity)), 0.95 * lengthSquared(wide(start.velocity)));
}

}  // namespace
}  // namespace huestep::test
