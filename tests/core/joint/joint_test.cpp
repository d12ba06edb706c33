// Joints in a world: each kind holds what it promises.

#include <algorithm>
#include <cmath>

#include "core/math/trig.h"
#include "tests/core/joint/jointed.h"

namespace huestep::test {
namespace {

/// An anchor without shape at the origin and a disc of 1 kg beside it, without gravity.
Scene anchored(const JointDef& joint, Vec2 disc) {
    BodyDef body = discAt(disc, 0.5f);
    body.shapes[0].density = static_cast<float>(1.0 / (0.25 * pi));
    Scene scene = sceneOf({BodyDef{}, body}, {joint});
    scene.gravity = {};
    scene.sleep = false;
    return scene;
}

TEST(Joint, ARevoluteHoldsItsPointWhileTheBodySwings) {
    Scene scene = sceneOf({BodyDef{}, boxAt({2.0f, 0.0f})}, {hinge(0, {}, 1, {-2.0f, 0.0f})});
    World world = worldOf(scene);
    for (int tick = 0; tick < 300; ++tick) {
        world.step({});
        ASSERT_LT(errorOf(world), 5e-3) << tick;
    }
    EXPECT_LT(motionOf(world, 2).position.x, 1.99f) << "it swings";
}

TEST(Joint, ARevoluteMotorReachesItsSpeedNoFasterThanItsTorqueAllows) {
    JointDef axle = hinge(0, {}, 1, {});
    axle.motor = {true, 4.0f, 0.25f};
    World world = worldOf(anchored(axle, {}));
    const double inertia = wide(world.bodies()[1].inertia);
    EXPECT_NEAR(inertia, 0.125, 1e-6);
    // 0.25 N·m on 0.125 kg·m²: 2 rad/s², so 4 rad/s after 2 s.
    for (int tick = 1; tick <= 240; ++tick) {
        world.step({});
        const double w = wide(motionOf(world, 2).angularVelocity);
        ASSERT_NEAR(w, std::min(4.0, 2.0 * tick / 60.0), 1e-3) << tick;
    }
}

TEST(Joint, ARevoluteMotorTurnsBothBodiesAgainstEachOther) {
    JointDef axle = hinge(0, {}, 1, {});
    axle.motor = {true, 3.0f, 100.0f};
    Scene scene = sceneOf({discAt({}), discAt({})}, {axle});
    scene.gravity = {};
    World world = worldOf(scene);
    run(world, 30);
    EXPECT_NEAR(wide(motionOf(world, 2).angularVelocity), 1.5, 1e-3);
    EXPECT_NEAR(wide(motionOf(world, 1).angularVelocity), -1.5, 1e-3);
}

TEST(Joint, RevoluteLimitsHoldFromBothSides) {
    for (const double push : {3.0, -3.0}) {
        JointDef axle = hinge(0, {}, 1, {});
        axle.limit = {true, -0.4f, 0.7f};
        Scene scene = anchored(axle, {});
        scene.bodies[1].angularVelocity = static_cast<float>(push);
        World world = worldOf(scene);
        double least = 0.0, most = 0.0;
        for (int tick = 0; tick < 240; ++tick) {
            world.step({});
            least = std::min(least, angleOfBody(world, 2));
            most = std::max(most, angleOfBody(world, 2));
        }
        EXPECT_GT(least, -0.4 - 0.005);
        EXPECT_LT(most, 0.7 + 0.005);
        EXPECT_NEAR(push > 0.0 ? most : least, push > 0.0 ? 0.7 : -0.4, 0.005) << "it got there";
    }
}

TEST(Joint, LimitsCountFromTheReferenceAngle) {
    JointDef axle = hinge(0, {}, 1, {});
    axle.limit = {true, -0.1f, 0.1f};
    axle.reference = rotationOf(1.0f);
    Scene scene = anchored(axle, {});
    scene.bodies[1].rotation = rotationOf(1.0f);
    scene.bodies[1].angularVelocity = 2.0f;
    World world = worldOf(scene);
    run(world, 120);
    EXPECT_NEAR(angleOfBody(world, 2), 1.1, 0.02);
}

/// Period of an oscillation from its passages through zero.
template <class Coordinate>
double periodOf(World& world, int ticks, const Coordinate& coordinate) {
    std::vector<double> passages;
    double last = coordinate(world);
    for (int tick = 1; tick <= ticks; ++tick) {
        world.step({});
        const double now = coordinate(world);
        if ((now < 0.0) != (last < 0.0)) passages.push_back((tick - now / (now - last)) / 60.0);
        last = now;
    }
    if (passages.size() < 3) return 0.0;
    return 2.0 * (passages.back() - passages.front()) / static_cast<double>(passages.size() - 1);
}

TEST(Joint, SpringsSwingAtTheirFrequency) {
    JointDef torsion = hinge(0, {}, 1, {});
    torsion.spring = {true, 1.0f, 0.0f};
    Scene turned = anchored(torsion, {});
    turned.bodies[1].rotation = rotationOf(0.3f);
    turned.substeps = 16;
    World turning = worldOf(turned);
    EXPECT_NEAR(periodOf(turning, 150, [](const World& w) { return angleOfBody(w, 2); }), 1.0,
                0.02);

    JointDef coil = hinge(0, {}, 1, {});
    coil.kind = JointKind::Distance;
    coil.length = 2.0f;
    coil.spring = {true, 1.0f, 0.0f};
    Scene pulled = anchored(coil, {2.2f, 0.0f});
    pulled.substeps = 16;
    World bouncing = worldOf(pulled);
    EXPECT_NEAR(periodOf(bouncing, 150,
                         [](const World& w) { return wide(motionOf(w, 2).position.x) - 2.0; }),
                1.0, 0.02);
}

TEST(Joint, ACriticallyDampedSpringComesBackWithoutSwinging) {
    JointDef torsion = hinge(0, {}, 1, {});
    torsion.spring = {true, 2.0f, 1.0f};
    Scene scene = anchored(torsion, {});
    scene.bodies[1].rotation = rotationOf(0.5f);
    World world = worldOf(scene);
    double least = 1.0;
    for (int tick = 0; tick < 120; ++tick) {
        world.step({});
        least = std::min(least, angleOfBody(world, 2));
    }
    EXPECT_GT(least, -0.01);
    EXPECT_NEAR(angleOfBody(world, 2), 0.0, 0.01);
}

TEST(Joint, ARodKeepsItsLength) {
    JointDef rod = hinge(0, {}, 1, {});
    rod.kind = JointKind::Distance;
    rod.length = 2.0f;
    Scene scene = anchored(rod, {2.0f, 0.0f});
    scene.gravity = {0.0f, -10.0f};
    World world = worldOf(scene);
    for (int tick = 0; tick < 300; ++tick) {
        world.step({});
        ASSERT_NEAR(wide(length(motionOf(world, 2).position)), 2.0, 2e-3) << tick;
    }
}

TEST(Joint, ARopeIsSlackWithinItsRangeAndHoldsAtItsEnds) {
    JointDef rope = hinge(0, {}, 1, {});
    rope.kind = JointKind::Distance;
    rope.limit = {true, 1.0f, 3.0f};
    for (const float speed : {4.0f, -4.0f}) {
        Scene scene = anchored(rope, {2.0f, 0.0f});
        scene.bodies[1].velocity = {speed, 0.0f};
        World world = worldOf(scene);
        world.step({});
        EXPECT_NEAR(wide(motionOf(world, 2).velocity.x), wide(speed), 1e-5) << "free within";
        for (int tick = 0; tick < 240; ++tick) {
            world.step({});
            const double l = wide(length(motionOf(world, 2).position));
            ASSERT_GT(l, 1.0 - 0.02) << tick;
            ASSERT_LT(l, 3.0 + 0.02) << tick;
        }
    }
}

TEST(Joint, ADistanceMotorDrivesItsLengthWithinItsForce) {
    JointDef piston = hinge(0, {}, 1, {});
    piston.kind = JointKind::Distance;
    piston.limit = {true, 0.5f, 3.0f};
    piston.motor = {true, 1.0f, 2.0f};  // 2 N on 1 kg: at 1 m/s after half a second
    World world = worldOf(anchored(piston, {1.0f, 0.0f}));
    run(world, 15);
    EXPECT_NEAR(wide(motionOf(world, 2).velocity.x), 0.5, 0.01);
    run(world, 45);
    EXPECT_NEAR(wide(motionOf(world, 2).velocity.x), 1.0, 0.01);
    run(world, 240);
    EXPECT_NEAR(wide(motionOf(world, 2).position.x), 3.0, 0.01) << "stops at its end";
}

TEST(Joint, AMouseJointDrawsItsPointToTheTargetWithNoMoreThanItsForce) {
    JointDef hand;
    hand.kind = JointKind::Mouse;
    hand.bodyA = hand.bodyB = 1;
    hand.anchorB = {0.5f, 0.0f};
    hand.target = {4.0f, 3.0f};
    hand.maxForce = 5.0f;
    hand.spring = {true, 5.0f, 1.0f};
    World world = worldOf(anchored(hand, {}));
    Vec2 last{};
    for (int tick = 0; tick < 600; ++tick) {
        world.step({});
        const Vec2 v = motionOf(world, 2).velocity;
        ASSERT_LE(length(v - last), 5.0f / 60.0f * 1.01f) << "5 N on 1 kg";
        last = v;
    }
    const BodyMotion m = motionOf(world, 2);
    EXPECT_LT(length(transform(m.pose(), Vec2{0.5f, 0.0f}) - hand.target), 0.01f);
}

TEST(Joint, JoinedBodiesPassThroughEachOtherUnlessTheyAreToldToTouch) {
    for (const bool touch : {false, true}) {
        Scene scene = sceneOf({boxAt({}), boxAt({0.5f, 0.0f})}, {hinge(0, {}, 1, {-0.5f, 0.0f})});
        scene.gravity = {};
        scene.joints[0].collideConnected = touch;
        World world = worldOf(scene);
        run(world, 5);
        EXPECT_EQ(world.contacts().size(), touch ? 1u : 0u);
    }
}

TEST(Joint, BetweenTwoBodiesThatNothingCanPushDoesNothing) {
    Scene scene =
        sceneOf({BodyDef{}, ground(), discAt({0.0f, 5.0f})}, {hinge(0, {5.0f, 5.0f}, 1, {})});
    World world = worldOf(scene);
    run(world, 30);
    EXPECT_EQ(world.jointImpulses()[0].point, Vec2{});
    EXPECT_LT(motionOf(world, 3).position.y, 4.0f);
}

TEST(Joint, InternalForcesConserveMomentumInFreeSpace) {
    Random random(108);
    SCOPED_TRACE(random.trace());
    Scene scene;
    scene.gravity = {};
    scene.sleep = false;
    for (int i = 0; i < 12; ++i) {
        BodyDef body = discAt({1.1f * static_cast<float>(i), random.betweenF(-0.2, 0.2)},
                              random.betweenF(0.2, 0.4));
        body.velocity = random.point(-2.0, 2.0);
        scene.bodies.push_back(body);
        if (i == 0) continue;
        const auto place = static_cast<std::uint32_t>(i);
        JointDef joint = hinge(place - 1, {0.55f, 0.0f}, place, {-0.55f, 0.0f});
        if (i % 3 == 0) {
            joint.kind = JointKind::Distance;
            joint.spring = {true, 2.0f, 0.1f};
        }
        scene.joints.push_back(joint);
    }
    World world = worldOf(scene);
    const auto momentum = [&] {
        Vec2T<double> p;
        for (std::size_t i = 0; i < world.bodies().size(); ++i) {
            p += wide(world.bodies()[i].mass) * wide(world.motions()[i].velocity);
        }
        return p;
    };
    const Vec2T<double> before = momentum();
    run(world, 300);
    EXPECT_LT(length(momentum() - before), 1e-4);
}

}  // namespace
}  // namespace huestep::test
