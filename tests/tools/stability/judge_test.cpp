// Judges on made-up trajectories whose verdicts are known, worked out by hand.
#include "tools/stability/judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/math/trig.h"
#include "tests/core/support.h"
#include "tools/stability/measures.h"

namespace huestep::tools::stability {
namespace {

using test::boxAt;
using test::discAt;
using test::ground;
using test::sceneOf;
using test::worldOf;

/// A run whose motions the test makes up.
struct Told {
    explicit Told(const Scene& scene, std::vector<Criterion> own, std::vector<Criterion> rules = {},
                  const Placement& placement = {})
        : world(worldOf(scene)),
          motions(world.motions().begin(), world.motions().end()),
          judge(world, placement, std::move(own), std::move(rules)) {}

    /// The bodies as they stand in `motions` after so many more ticks.
    void hold(int ticks = 1, std::span<const Command> commands = {}) {
        for (int i = 0; i < ticks; ++i) judge.watch(++tick, commands, motions);
    }

    World world;
    std::vector<BodyMotion> motions;
    Judge judge;
    std::uint64_t tick = 0;
};

/// A floor whose centre is at (0, −1) and a unit box of 1 kg at (0, 0.5).
Scene boxOnFloor() {
    return sceneOf({ground(), boxAt({0.0f, 0.5f})});
}

const Criterion moved{"moved", "m", 0.5, farthestMoved};
const Criterion turned{"turned", "rad", 0.5, furthestTurned};

TEST(Judge, PassesABoxThatMovedBy49CentimetresAndFailsOneThatMovedBy51) {
    for (const auto& [metres, passes] : {std::pair{0.49f, true}, {0.51f, false}}) {
        Told told(boxOnFloor(), {moved});
        told.hold(5);
        told.motions[1].position += Vec2{0.6f * metres, 0.8f * metres};
        told.hold();
        told.motions[1].position = {0.0f, 0.5f};  // it went back: the farthest counts
        told.hold(5);
        const Judgement judgement = told.judge.judgement();
        EXPECT_EQ(judgement.pass, passes);
        EXPECT_NEAR(judgement.value, static_cast<double>(metres), 1e-6);
        EXPECT_EQ(judgement.limit, 0.5);
        EXPECT_EQ(judgement.unit, "m");
        EXPECT_EQ(judgement.brokenAt.has_value(), !passes);
        EXPECT_EQ(judgement.brokenAt.value_or(6), 6u);
        EXPECT_EQ(judgement.why.empty(), passes);
    }
}

TEST(Judge, SaysWhenTheCriterionThatItNamesWasFirstBroken) {
    // Turned too far after tick 2 by a little, moved too far after tick 4 by ten times as much.
    Told told(boxOnFloor(), {moved, turned});
    told.hold();
    told.motions[1].rotation = rotationOf(0.6f);
    told.hold(2);
    told.motions[1].position.x += 5.0f;
    told.hold(2);
    const Judgement judgement = told.judge.judgement();
    EXPECT_EQ(judgement.what, "moved");
    EXPECT_EQ(judgement.brokenAt.value_or(0), 4u);
}

TEST(Judge, MeasuresATurnTheShorterWayRound) {
    for (const auto& [angle, passes] : {std::pair{0.49f, true}, {-0.51f, false}, {6.2f, true}}) {
        Told told(boxOnFloor(), {turned});
        told.motions[1].rotation = rotationOf(angle);
        told.hold();
        EXPECT_EQ(told.judge.judgement().pass, passes) << angle;
    }
}

TEST(Judge, AllowsEnergyToRiseByOnePercentOfWeightTimesExtent) {
    // 1 kg · 10 m/s² · 1.5 m from floor to box are 15 J; lifting the box by h brings 10 h J.
    for (const auto& [share, passes] : {std::pair{0.009, true}, {0.011, false}}) {
        Told told(boxOnFloor(), {}, {energyRule()});
        told.motions[1].position.y += static_cast<float>(1.5 * share);
        told.hold();
        EXPECT_EQ(told.judge.judgement().pass, passes) << share;
        EXPECT_NEAR(told.judge.judgement().value, share, 1e-6);
    }
    // … and ½ · 1 kg · v² of speed.
    Told told(boxOnFloor(), {}, {energyRule()});
    told.motions[1].velocity.x = static_cast<float>(std::sqrt(2.0 * 15.0 * 0.011));
    told.hold();
    EXPECT_FALSE(told.judge.judgement().pass);
}

TEST(Judge, AllowsNoBodyToBeFasterThan100MetresASecond) {
    for (const auto& [speed, passes] : {std::pair{99.0f, true}, {101.0f, false}}) {
        Told told(boxOnFloor(), {moved}, {speedRule()});
        told.motions[1].velocity = {0.6f * speed, -0.8f * speed};
        told.hold();
        EXPECT_EQ(told.judge.judgement().pass, passes) << speed;
        const std::string unit = passes ? "m" : "m/s";
        EXPECT_EQ(told.judge.judgement().unit, unit) << "the row's own, or the rule that broke";
    }
}

TEST(Judge, FailsWhatIsNotANumberAndSaysWhichBodyAndWhen) {
    Told told(boxOnFloor(), {moved}, {speedRule()});
    told.hold(59);
    told.motions[1].velocity.y = std::numeric_limits<float>::quiet_NaN();
    told.hold();
    const Judgement judgement = told.judge.judgement();
    EXPECT_FALSE(judgement.pass);
    EXPECT_TRUE(told.judge.hopeless());
    EXPECT_TRUE(std::isinf(judgement.value));
    EXPECT_EQ(judgement.why, "body 2 is not finite after 1 s");
    EXPECT_EQ(judgement.brokenAt, std::uint64_t{60});
}

TEST(Judge, FailsARunWhoseEngineTookABodyOut) {
    Told told(boxOnFloor(), {moved});
    told.hold(3);
    told.judge.lost(3, 2);
    EXPECT_FALSE(told.judge.judgement().pass);
    EXPECT_NE(told.judge.judgement().why.find("body 2"), std::string::npos);
}

TEST(Judge, LooksOnlyWithinTheWindowOfACriterion) {
    Criterion late = moved;
    late.from = 1.0;
    late.to = 2.0;
    Told told(boxOnFloor(), {late});
    told.motions[1].position.x = 3.0f;
    told.hold(59);  // until just before 1 s
    told.motions[1].position.x = 0.2f;
    told.hold(61);  // until 2 s
    told.motions[1].position.x = 3.0f;
    told.hold(60);
    EXPECT_TRUE(told.judge.judgement().pass);
    EXPECT_NEAR(told.judge.judgement().value, 0.2, 1e-6);
}

TEST(Judge, FailsACriterionWhoseWindowNeverCame) {
    Criterion late = moved;
    late.from = 10.0;
    Told told(boxOnFloor(), {late});
    told.hold(60);
    EXPECT_FALSE(told.judge.judgement().pass);
    EXPECT_TRUE(std::isinf(told.judge.judgement().value));
}

TEST(Judge, NamesWhatBrokeOfARunThatWasGivenUpAndNotWhatNeverCame) {
    Criterion late{"late", "m/s", 0.01, rmsSpeed, Fold::Rms, 10.0};
    Told told(boxOnFloor(), {late, moved});
    told.motions[1].position.x = 40.0f;
    told.hold();
    EXPECT_TRUE(told.judge.hopeless());
    EXPECT_EQ(told.judge.judgement().what, "moved");
    EXPECT_NEAR(told.judge.judgement().value, 40.0, 1e-4);
}

TEST(Judge, NamesTheCriterionThatIsFurthestBeyondItsLimitElseTheNearest) {
    Told told(boxOnFloor(), {moved, turned});
    told.motions[1].position.x = 0.1f;  // a fifth of the limit
    told.motions[1].rotation = rotationOf(0.2f);
    told.hold();
    EXPECT_EQ(told.judge.judgement().what, "turned");
    told.motions[1].position.x = 2.0f;
    told.motions[1].rotation = rotationOf(0.6f);
    told.hold();
    EXPECT_EQ(told.judge.judgement().what, "moved");
}

TEST(Judge, FoldsSpeedsToTheRootOfTheirMeanSquare) {
    Scene scene = sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({3.0f, 0.5f})});
    const Criterion quiet{"rms speed", "m/s", 5.0, rmsSpeed, Fold::Rms};
    Told told(scene, {quiet});
    told.motions[1].velocity = {3.0f, 0.0f};  // (9 + 25) / 2 = 17
    told.motions[2].velocity = {3.0f, 4.0f};
    told.hold();
    told.motions[1].velocity = told.motions[2].velocity = {0.0f, 1.0f};  // 1
    told.hold();
    EXPECT_NEAR(told.judge.judgement().value, 3.0, 1e-6);  // √((17 + 1) / 2)
}

TEST(Judge, SeesTheSameInAScenePlacedElsewhere) {
    Placement placement;
    placement.turn = 90.0;
    placement.far = 1.0;
    Scene scene = boxOnFloor();
    place(scene, placement);
    Told told(scene, {{"aside", "m", 0.3, farthestAside}}, {}, placement);
    // The scene's own up is now the world's left: falling on is no shift aside, …
    told.motions[1].position += Vec2{-2.0f, 0.0f};
    told.hold();
    EXPECT_NEAR(told.judge.judgement().value, 0.0, 1e-4);
    // … and its own right is up.
    told.motions[1].position += Vec2{0.0f, 0.25f};
    told.hold();
    EXPECT_NEAR(told.judge.judgement().value, 0.25, 1e-3);
}

TEST(Judge, FollowsTheBodiesThatStayWhenOneGoesAndAsksNoEnergyOfThem) {
    const Scene scene = sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({3.0f, 0.5f})});
    Told told(scene, {moved}, {energyRule()});
    told.hold(2);
    const std::vector<Command> commands{{0, 1, RemoveBody{2}}};
    told.motions.erase(told.motions.begin() + 1);
    told.motions[1].position = {3.1f, 40.0f};  // 395 J above the start
    told.hold(1, commands);
    EXPECT_NEAR(told.judge.judgement().value, 39.5, 0.01);
    told.motions[1].position = {3.1f, 0.6f};
    Told calm(scene, {moved}, {energyRule()});
    calm.motions = told.motions;
    calm.hold(1, commands);
    EXPECT_TRUE(calm.judge.judgement().pass);
}

TEST(Judge, LetsACountReachItsLimit) {
    std::vector<BodyDef> bodies{ground()};
    for (int i = 0; i < 4; ++i) bodies.push_back(boxAt({3.0f * static_cast<float>(i), 0.5f}));
    Criterion few{"fallen", "bodies", 2.0, fallen(0.1, 0.5)};
    few.mayReach = true;
    Told told(sceneOf(std::move(bodies)), {few});
    told.motions[1].position.x += 0.2f;
    told.motions[2].rotation = rotationOf(0.7f);
    told.motions[3].position.x += 0.05f;
    told.hold();
    EXPECT_TRUE(told.judge.judgement().pass);
    EXPECT_EQ(told.judge.judgement().value, 2.0);
    told.motions[3].position.x += 0.1f;
    told.hold();
    EXPECT_FALSE(told.judge.judgement().pass);
}

/// The value of a criterion made of one measure, of the start as it stands.
double valueOf(Told& told) {
    told.hold();
    return told.judge.judgement().value;
}

Criterion measured(Measure measure) {
    return {"value", "", 1e9, std::move(measure)};
}

TEST(Measures, OfAnArmAreItsRadiusAndItsKineticEnergy) {
    Scene scene = sceneOf({discAt({5.0f, 0.0f}, 0.1f)});
    scene.gravity = {};
    scene.bodies[0].velocity = {0.0f, 50.0f};
    Told radius(scene, {measured(armError)});
    radius.motions[0].position = {3.0f, 4.05f};  // 5.0401 m
    EXPECT_NEAR(valueOf(radius), std::sqrt(9.0 + 4.05 * 4.05) / 5.0 - 1.0, 1e-6);
    Told loss(scene, {measured(kineticLoss)});
    loss.motions[0].velocity = {0.0f, 49.0f};
    EXPECT_NEAR(valueOf(loss), 1.0 - 49.0 * 49.0 / 2500.0, 1e-6);
}

TEST(Measures, OfAHubAddOverlapAndApproach) {
    Scene scene = sceneOf({discAt({0.0f, 0.0f}, 1.0f), discAt({1.2f, 0.0f}, 0.2f),
                           discAt({0.0f, 1.2f}, 0.2f), discAt({0.0f, -1.9f}, 0.2f)});
    scene.gravity = {};
    Told told(scene, {measured(hubResidual)});
    told.motions[1].position.x -= 0.003f;       // 3 mm inside …
    told.motions[1].velocity = {-0.24f, 9.0f};  // … and 1 mm further within a substep
    told.motions[2].velocity = {0.0f, 5.0f};    // leaves
    told.motions[3].velocity = {0.0f, 5.0f};    // comes, but is far
    EXPECT_NEAR(valueOf(told), 0.004 / std::sqrt(3.0), 1e-6);
}

TEST(Measures, OfAWallSeeTheForemostPointOfWhatWhirls) {
    const ShapeDef rod = ShapeDef::capsule({0.0f, -1.0f}, {0.0f, 1.0f}, 0.05f);
    Scene scene = sceneOf({test::bodyAt(BodyType::Dynamic, {-0.6f, 0.0f}, rod)});
    Told told(scene, {measured(beyond(-0.01))});
    told.motions[0].rotation = rotationOf(0.5235988f);  // its tips are 0.5 m aside
    EXPECT_NEAR(valueOf(told), -0.6 + 0.5 + 0.05 + 0.01, 1e-5);
}

TEST(Measures, OfADrumAreTakenInItsOwnFrame) {
    Scene scene = sceneOf({test::boxAt({0.0f, 0.0f}, 10.0f), boxAt({9.0f, 0.0f})});
    Told told(scene, {measured(outsideDrum(1, 9.5))});
    told.motions[0].rotation = rotationOf(0.78539816f);
    EXPECT_NEAR(valueOf(told), 9.0 * std::sqrt(0.5) - 9.5, 1e-5) << "it lies towards a corner";
}

TEST(Measures, KnowWhereAFallingTopComesToRest) {
    const Scene scene = sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({0.0f, 3.5f}, 1.0f)});
    const auto drop = [](const Tracked& body) { return body.mass > 2.0 ? 2.0 : 0.0; };
    Told told(scene, {measured(movedFromRest(drop))});
    told.motions[2].position = {0.03f, 1.54f};  // 4 cm above its rest and 3 aside
    EXPECT_NEAR(valueOf(told), 0.05, 1e-5);
}

TEST(Measures, SeeOverlapAndJointErrorOfTheMotionsThatTheyAreGiven) {
    Scene scene = sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({5.0f, 3.0f})},
                          {test::hinge(0, {5.0f, 4.5f}, 2, {0.0f, 0.5f})});
    Told told(scene, {measured(penetration)});
    told.motions[1].position.y = 0.47f;
    EXPECT_NEAR(valueOf(told), 0.03, 1e-6);
    Told torn(scene, {measured(jointError)});
    torn.motions[2].position = {5.3f, 3.4f};
    EXPECT_NEAR(valueOf(torn), 0.5, 1e-6);
}

}  // namespace
}  // namespace huestep::tools::stability
