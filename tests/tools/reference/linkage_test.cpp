// The equations in minimal coordinates against closed forms and conserved quantities.
#include "tools/reference/linkage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/scene/catalog.h"
#include "tests/core/pendulum.h"

namespace huestep::reference {
namespace {

World worldOf(const std::string& text) {
    return *World::create(*sceneFromCatalog(text));
}
Linkage linkageOf(const std::string& text) {
    return Linkage::find(worldOf(text)).value();
}

TEST(Linkage, APendulumIsStraightBelowItsPivotAfterAQuarterOfThePeriodOfTheClosedForm) {
    for (const int degrees : {30, 90, 150}) {
        const double start = degrees * std::numbers::pi / 180.0;
        const double period = test::pendulumPeriod(start);
        const LinkageSolution quarter =
            solveLinkage(linkageOf("pendulum:angle=" + std::to_string(degrees)), 0.25 * period);
        EXPECT_LT(quarter.change, 1e-12);
        // Mass, moment and gravity are floats in the scene: 1e-7 of the period at most.
        EXPECT_NEAR(quarter.linkage.position(1).x, 0.0, 1e-6) << degrees;
        EXPECT_NEAR(quarter.linkage.position(1).y, -1.0, 1e-9) << degrees;
    }
}

// The value stands in the physics page (A6), found there by another program.
TEST(Linkage, ADoublePendulumIsWhereThePhysicsPageHasItAfterASecond) {
    const LinkageSolution second = solveLinkage(linkageOf("double_pendulum"), 1.0);
    EXPECT_LT(second.change, 1e-12);
    EXPECT_NEAR(second.linkage.position(2).x, -1.4771364, 1e-6);
    EXPECT_NEAR(second.linkage.position(2).y, -1.2884217, 1e-6);
}

TEST(Linkage, AChainOfElevenBodiesKeepsItsEnergy) {
    Linkage chain = linkageOf("chain:ratio=1000,angle=90");
    const double before = chain.energy();
    chain.advance(2.0, 40'000);
    EXPECT_NEAR(chain.energy(), before, 1e-6) << "of the 55 kJ that its fall is worth";
}

TEST(Linkage, IsNoneWhereAMotorDrivesOrABodyIsFree) {
    EXPECT_FALSE(Linkage::find(worldOf("ballistic")).has_value());
    Scene driven = *sceneFromCatalog("pendulum");
    driven.joints[0].motor = {true, 1.0f, 1.0f};
    EXPECT_FALSE(Linkage::find(*World::create(driven)).has_value());
}

}  // namespace
}  // namespace huestep::reference
