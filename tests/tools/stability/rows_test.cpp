// That the suite's scenes are set up as the physics page has them, before anything steps.
#include "tools/stability/rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/scene/measure.h"
#include "tests/core/support.h"
#include "tools/stability/suite.h"

namespace huestep::tools::stability {
namespace {

using test::wide;
using test::worldOf;

std::vector<double> massesOf(const World& world) {
    std::vector<double> masses;
    for (const BodyInfo& body : world.bodies())
        if (body.dynamic()) masses.push_back(wide(body.mass));
    return masses;
}

Measures startOf(const World& world) {
    return measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions());
}

const Row& rowOf(int number) {
    return *std::find_if(sceneRows().begin(), sceneRows().end(),
                         [number](const Row& row) { return row.number == number; });
}

TEST(Rows, AreThoseOfThePageInOrderWithNames) {
    ASSERT_EQ(sceneRows().size(), 26u);
    std::set<std::string> names;
    for (int number = 1; number <= stabilityRows; ++number) {
        const std::string name(stabilityRowName(number));
        EXPECT_FALSE(name.empty()) << number;
        EXPECT_TRUE(names.insert(name).second) << name;
    }
    for (std::size_t i = 0; i < 26; ++i) EXPECT_EQ(sceneRows()[i].number, static_cast<int>(i) + 1);
    EXPECT_TRUE(stabilityRowName(0).empty());
    EXPECT_TRUE(stabilityRowName(29).empty());
}

TEST(Rows, HaveScenesThatTheCatalogBuildsUprightTurnedFarAndAtOtherRates) {
    for (const Row& row : sceneRows()) {
        ASSERT_FALSE(row.trials.empty()) << row.number;
        for (const Trial& trial : row.trials) {
            EXPECT_EQ(trial.row, row.number);
            EXPECT_FALSE(trial.criteria.empty()) << trial.scene;
            for (const Placing& placing :
                 {Placing{}, Placing{turnedBy}, Placing{0.0, 100.0}, Placing{0.0, 0.0, 30.0}}) {
                const std::string text = textOf(trial, placing);
                const Result<Scene> scene = sceneFromCatalog(text);
                ASSERT_TRUE(scene.ok()) << scene.error().message;
                EXPECT_TRUE(check(*scene).ok()) << text;
                EXPECT_FLOAT_EQ(scene->stepSeconds, static_cast<float>(1.0 / placing.hz));
            }
        }
    }
}

TEST(Rows, AskForWhatThePageAsks) {
    const auto secondsOf = [](int row) { return rowOf(row).trials.front().seconds; };
    EXPECT_EQ(secondsOf(1), 60.0);
    EXPECT_EQ(rowOf(1).trials.back().scene, "stack:n=100");
    EXPECT_EQ(rowOf(1).trials.back().seconds, 20.0);
    EXPECT_EQ(secondsOf(3), 5.0);
    EXPECT_EQ(secondsOf(18), 5.0);
    EXPECT_EQ(secondsOf(22), 60.0);
    for (const int row :
         {2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 19, 20, 21, 23, 24, 25, 26})
        EXPECT_EQ(secondsOf(row), 20.0) << row;
    const std::map<int, std::size_t> trials = {{1, 6},  {4, 8},  {10, 2}, {11, 5}, {12, 5},
                                               {17, 7}, {18, 3}, {24, 2}, {26, 2}};
    std::set<std::string> reported;
    for (const Row& row : sceneRows()) {
        const auto known = trials.find(row.number);
        EXPECT_EQ(row.trials.size(), known == trials.end() ? 1u : known->second) << row.number;
        for (const Trial& trial : row.trials)
            if (!trial.judged) reported.insert(trial.scene);
    }
    EXPECT_EQ(reported, (std::set<std::string>{"chain:ratio=1000000",
                                               "chain:ratio=1000000,angle=90", "arm:speed=100"}));
}

TEST(Rows, StandWithoutOverlapUnlessTheyAreAboutIt) {
    for (const Row& row : sceneRows()) {
        if (row.number == 10 || row.number == 21) continue;
        for (const Trial& trial : row.trials) {
            const World plain = worldOf(trial.scene);
            EXPECT_LT(startOf(plain).maxPenetration, 2e-6) << trial.scene;
            // Two bodies moved by up to 1 mm along each axis and turned by 1 mrad over their size.
            const World disturbed = worldOf(textOf(trial, {}));
            double size = 0.0;
            for (const ShapeInfo& shape : disturbed.shapes())
                for (const Vec2 vertex : shape.vertices) {
                    const BodyInfo& body = disturbed.bodies()[*disturbed.find(shape.body)];
                    if (body.dynamic()) size = std::max(size, wide(length(vertex)));
                }
            EXPECT_LT(startOf(disturbed).maxPenetration, 2.9e-3 + 2e-3 * size) << trial.scene;
        }
    }
    EXPECT_NEAR(startOf(worldOf(rowOf(10).trials[0].scene)).maxPenetration, 0.25, 1e-5);
    EXPECT_NEAR(startOf(worldOf(rowOf(10).trials[1].scene)).maxPenetration, 0.9, 1e-5);
    EXPECT_NEAR(startOf(worldOf(rowOf(21).trials[0].scene)).maxPenetration, 1.0 - 0.72, 1e-5);
}

TEST(Rows, StartWithClosedJointsButForTheStretchedChain) {
    for (const Row& row : sceneRows())
        for (const Trial& trial : row.trials) {
            const double error = startOf(worldOf(textOf(trial, {turnedBy}))).maxJointError;
            const double torn = row.number == 16 ? 1.0 : 0.0;  // links of 1 m, 2 m apart
            EXPECT_NEAR(error, torn, 1e-4) << trial.scene;
        }
}

TEST(Rows, ChainsHaveTheMassesOfThePage) {
    const std::vector<double> chain = massesOf(worldOf("chain:ratio=1000"));
    ASSERT_EQ(chain.size(), 11u);
    EXPECT_NEAR(chain[0], 1.0, 1e-6);
    EXPECT_NEAR(chain[10], 1000.0, 1e-2);
    const std::vector<double> ball = massesOf(worldOf("ball_and_chain"));
    ASSERT_EQ(ball.size(), 41u);
    EXPECT_NEAR(ball[0], 6.0, 0.05);
    EXPECT_NEAR(ball[40], 4021.0, 1.0);
    const World bridge = worldOf("bridge");
    EXPECT_EQ(massesOf(bridge), std::vector<double>(160, 5.0));
    EXPECT_EQ(bridge.joints().size(), 161u);
    EXPECT_EQ(bridge.bodies()[1].linearDamping, 0.1f);
    EXPECT_EQ(bridge.bodies()[1].angularDamping, 0.1f);
    EXPECT_EQ(worldOf("stretched_chain").joints().size(), 40u);
    EXPECT_EQ(worldOf("joint_grid:n=100,gravity=2").info().gravity, (Vec2{0.0f, -20.0f}));
}

TEST(Rows, StacksHaveTheMassesOfThePage) {
    EXPECT_EQ(massesOf(worldOf("tower")), (std::vector<double>{1, 4, 16, 64, 256, 1024}));
    EXPECT_EQ(massesOf(worldOf("heavy_top:ratio=400,n=5")),
              (std::vector<double>{1, 1, 1, 1, 1, 400}));
    for (const char* ground : {"big_box:thick=0", "big_box:thick=1"}) {
        const World world = worldOf(ground);
        EXPECT_EQ(massesOf(world), (std::vector<double>{1, 1, 400})) << ground;
        EXPECT_EQ(world.motions()[3].position.y - 10.0f, 16.0f) << "its bottom is 16 m up";
        EXPECT_EQ(world.shapes()[0].shapeKind(), ground == std::string("big_box:thick=0")
                                                     ? ShapeKind::Segment
                                                     : ShapeKind::Polygon);
    }
    std::vector<double> pyramids = massesOf(worldOf("heavy_pyramids"));
    ASSERT_EQ(pyramids.size(), 165u);
    std::sort(pyramids.begin(), pyramids.end());
    EXPECT_EQ(pyramids[161], 4.0);
    EXPECT_EQ(std::vector<double>(pyramids.end() - 3, pyramids.end()),
              (std::vector<double>{400, 800, 1200}));
    const std::vector<double> discs = massesOf(worldOf("release"));
    ASSERT_EQ(discs.size(), 3u);
    EXPECT_NEAR(discs[2] / discs[0], 100.0, 1e-4);
    EXPECT_EQ(massesOf(worldOf("overlap:n=50,share=90")).size(), 50u);
    EXPECT_EQ(massesOf(worldOf("confined")).size(), 625u);
}

TEST(Rows, HubsAndBuildingsHaveTheirParts) {
    const std::vector<double> hub = massesOf(worldOf("hub"));
    ASSERT_EQ(hub.size(), 1001u);
    EXPECT_NEAR(hub[0], 50.0, 1e-3);
    EXPECT_NEAR(hub[1], 0.05, 1e-5);
    EXPECT_EQ(worldOf("hub:kinematic=1").bodies()[0].type(), BodyType::Kinematic);
    const std::vector<double> arch = massesOf(worldOf("arch"));
    ASSERT_EQ(arch.size(), 17u + 4u);
    EXPECT_EQ(std::vector<double>(arch.end() - 4, arch.end()), std::vector<double>(4, 4.0));
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_NEAR(arch[i], arch[16 - i], 1e-4) << "the arch is its own mirror image";
    const std::vector<double> cards = massesOf(worldOf("card_house"));
    ASSERT_EQ(cards.size(), 40u);
    for (const double card : cards) EXPECT_NEAR(card, 0.4 * 0.002, 1e-8);
    const std::vector<double> dominoes = massesOf(worldOf("dominoes"));
    EXPECT_EQ(dominoes, std::vector<double>(15, 0.25));
    EXPECT_EQ(massesOf(worldOf("tumbler:count=45")).size(), 2026u);
    EXPECT_EQ(worldOf("bullet").motions()[2].velocity, (Vec2{200.0f, 0.0f}));
    EXPECT_EQ(worldOf("whirling_rod").motions()[2].angularVelocity, 50.0f);
}

TEST(Rows, WriteTheTextsThatTheCatalogReads) {
    Trial trial;
    trial.scene = "release";
    trial.ticksParameter = "after";
    trial.ticksSeconds = 2.0;
    EXPECT_EQ(textOf(trial, {}), "release:after=120,seed=1");
    EXPECT_EQ(textOf(trial, {37.0, 20.0, 60.0}), "release:after=120,seed=1,turn=37,far=20");
    EXPECT_EQ(textOf(trial, {0.0, 0.0, 30.0}), "release:after=60,seed=1,hz=30");
    trial = {};
    trial.scene = "arch";
    EXPECT_EQ(textOf(trial, {}), "arch:seed=1");
}

}  // namespace
}  // namespace huestep::tools::stability
