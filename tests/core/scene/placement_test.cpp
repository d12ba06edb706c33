#include "core/scene/placement.h"

#include <cmath>

#include "core/math/trig.h"
#include "core/scene/measure.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

TEST(Placement, ThatSaysNothingLeavesASceneAsItIs) {
    for (const char* text : {"mixed", "sandbox", "rain:floors=1"}) {
        const Scene scene = *sceneFromCatalog(text);
        Scene placed = scene;
        place(placed, {});
        EXPECT_EQ(placed, scene) << text;
    }
}

TEST(Placement, TurnsEveryPointAndDirectionAboutTheOriginAndMovesThePoints) {
    Scene scene = sceneOf({ground(), boxAt({3.0f, 4.0f})});
    scene.bodies[1].velocity = {1.0f, 0.0f};
    scene.bodies[1].angularVelocity = 2.0f;
    PlayerDef players;
    players.spawnPoints = {{1.0f, 2.0f}};
    scene.players = players;
    Placement placement;
    placement.turn = 90.0;
    place(scene, placement);
    const auto near = [](Vec2 a, Vec2 b) { return length(a - b) < 1e-5f; };
    EXPECT_TRUE(near(scene.gravity, {10.0f, 0.0f}));
    EXPECT_TRUE(near(scene.bodies[0].position, {1.0f, 0.0f}));
    EXPECT_TRUE(near(scene.bodies[1].position, {-4.0f, 3.0f}));
    EXPECT_TRUE(near(scene.bodies[1].velocity, {0.0f, 1.0f}));
    EXPECT_EQ(scene.bodies[1].angularVelocity, 2.0f);
    EXPECT_NEAR(angleOf(scene.bodies[1].rotation), 0.5 * pi, 1e-6);
    EXPECT_TRUE(near(scene.players->spawnPoints[0], {-2.0f, 1.0f}));
    placement = {};
    placement.far = 20.0;
    place(scene, placement);
    EXPECT_TRUE(near(scene.bodies[1].position - Vec2{16'000.0f, -12'000.0f}, {-4.0f, 3.0f}) ||
                length(scene.bodies[1].position - Vec2{15'996.0f, -11'997.0f}) < 0.002f);
    EXPECT_TRUE(near(scene.bodies[1].velocity, {0.0f, 1.0f}));
}

TEST(Placement, KeepsJointsClosedAndShapesApartOfEveryScene) {
    for (const CatalogEntry& entry : sceneCatalog()) {
        const std::string name(entry.name);
        const World plain = worldOf(name);
        if (plain.bodies().size() > 3'000) continue;  // the same as smaller ones, but slow
        const World turned = worldOf(name + ":turn=-127.5");
        const auto measured = [](const World& world) {
            return measure(world.info(), world.bodies(), world.shapes(), world.joints(),
                           world.motions());
        };
        const Measures a = measured(plain), b = measured(turned);
        EXPECT_NEAR(a.maxPenetration, b.maxPenetration, 2e-4) << name;
        EXPECT_NEAR(a.maxJointError, b.maxJointError, 2e-4) << name;
        const double scale = energyScale(plain.info(), plain.bodies(), plain.motions());
        EXPECT_NEAR(a.energy / scale, b.energy / scale, 1e-5) << name;
    }
}

TEST(Placement, DisturbsEveryBodyALittleAndEverySeedOtherwise) {
    const Scene plain = *sceneFromCatalog("stack:n=30");
    const Scene one = *sceneFromCatalog("stack:n=30,seed=1");
    const Scene two = *sceneFromCatalog("stack:n=30,seed=2");
    EXPECT_EQ(one.bodies[0], plain.bodies[0]) << "the ground stays";
    double sum = 0.0;
    for (std::size_t i = 1; i < plain.bodies.size(); ++i) {
        const Vec2T<double> moved = wide(one.bodies[i].position) - wide(plain.bodies[i].position);
        EXPECT_LE(std::abs(moved.x), 1.001e-3);
        EXPECT_LE(std::abs(moved.y), 1.001e-3);
        EXPECT_GT(length(moved), 0.0);
        const double turned =
            wide(angleOf(relative(plain.bodies[i].rotation, one.bodies[i].rotation)));
        EXPECT_LE(std::abs(turned), 1.001e-3);
        EXPECT_NE(turned, 0.0);
        EXPECT_EQ(one.bodies[i].velocity, Vec2{});
        EXPECT_NE(one.bodies[i].position, two.bodies[i].position);
        sum += length(moved);
    }
    // The mean distance of a uniform point of a square of half side 1 from its middle is 0.765.
    EXPECT_NEAR(sum / 30.0, 0.765e-3, 0.2e-3);
}

TEST(Placement, MovesAThinBodyByNoMoreThanATenthOfItsThickness) {
    const Scene plain = *sceneFromCatalog("card_house");
    const Scene disturbed = *sceneFromCatalog("card_house:seed=1");
    float most = 0.0f;
    for (std::size_t i = 1; i < plain.bodies.size(); ++i) {
        const Vec2 moved = disturbed.bodies[i].position - plain.bodies[i].position;
        most = std::max({most, std::abs(moved.x), std::abs(moved.y)});
    }
    EXPECT_LE(most, 0.2001e-3f);  // cards of 2 mm
    EXPECT_GT(most, 0.1e-3f);
}

TEST(Placement, PushesABodyOnAJointAndDoesNotTearIt) {
    const Scene plain = *sceneFromCatalog("chain");
    const Scene disturbed = *sceneFromCatalog("chain:seed=7");
    EXPECT_EQ(disturbed.bodies[0], plain.bodies[0]);
    for (std::size_t i = 1; i < plain.bodies.size(); ++i) {
        EXPECT_EQ(disturbed.bodies[i].position, plain.bodies[i].position);
        EXPECT_EQ(disturbed.bodies[i].rotation, plain.bodies[i].rotation);
        const Vec2 pushed = disturbed.bodies[i].velocity;
        EXPECT_NE(pushed, Vec2{});
        EXPECT_LE(std::max(std::abs(pushed.x), std::abs(pushed.y)), 1.001e-3f);
        EXPECT_LE(std::abs(disturbed.bodies[i].angularVelocity), 1.001e-3f);
    }
}

TEST(Placement, PlacesWhatTheHostDoesWithTheScene) {
    const std::string text = "junkyard:columns=2,rows=1";
    const Script plain = *scriptFromCatalog(text);
    const Script turned = *scriptFromCatalog(text + ",turn=90");
    const auto target = [](const Script& script) {
        return std::get<SetTarget>(script.actions(100).at(0));
    };
    const SetTarget a = target(plain), b = target(turned);
    EXPECT_NEAR(b.position.x, 0.0f, 1e-4f);
    EXPECT_NEAR(b.position.y, a.position.x, 1e-4f);
    EXPECT_NEAR(angleOf(b.rotation), 0.5 * pi, 1e-6);

    const Spawn rained = std::get<Spawn>(scriptFromCatalog("rain:turn=90")->actions(0).at(0));
    const Spawn upright = std::get<Spawn>(scriptFromCatalog("rain")->actions(0).at(0));
    EXPECT_NEAR(rained.bodies[0].position.y, upright.bodies[0].position.x, 1e-3f);

    const auto push =
        std::get<ApplyImpulse>(scriptFromCatalog("dominoes:turn=180")->actions(0).at(0));
    EXPECT_NEAR(push.impulse.x, -0.2f, 1e-6f);
    EXPECT_NEAR(push.point.y, -1.0f, 1e-6f);
}

TEST(Placement, SetsTheRateOfTicks) {
    EXPECT_EQ(sceneFromCatalog("stack:hz=120")->stepSeconds, 1.0f / 120.0f);
    EXPECT_EQ(sceneFromCatalog("stack:hz=60")->stepSeconds, Scene{}.stepSeconds);
    EXPECT_FALSE(sceneFromCatalog("stack:hz=5").ok());
    EXPECT_EQ(*placementFromCatalog("stack:n=3,far=2,turn=-7.5,seed=9"), (Placement{9, -7.5, 2.0}));
    EXPECT_FALSE(placementFromCatalog("stack:turn=200").ok());
}

}  // namespace
}  // namespace huestep::test
