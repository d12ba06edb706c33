#include "core/scene/measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace huestep {
namespace {

/// Definitions and motions put together by hand, in the form a world shows them in.
struct HandMade {
    WorldInfo world{};
    std::vector<BodyInfo> bodies;
    std::vector<ShapeInfo> shapes;
    std::vector<JointInfo> joints;
    std::vector<BodyMotion> motions;

    BodyId addBody(BodyType type, Vec2 position, float mass = 0.0f, float inertia = 0.0f) {
        BodyInfo info{};
        info.id = static_cast<BodyId>(bodies.size() * 2 + 3);  // gaps, as after removals
        info.flags = static_cast<std::uint32_t>(type);
        info.mass = mass;
        info.inertia = inertia;
        info.gravityScale = 1.0f;
        bodies.push_back(info);
        motions.push_back({position, {1.0f, 0.0f}, {}, 0.0f, 0, 0, 0});
        return info.id;
    }

    ShapeInfo& addShape(BodyId body, const ShapeDef& def) {
        ShapeInfo info{};
        info.id = static_cast<ShapeId>(shapes.size() + 1);
        info.body = body;
        info.kind =
            static_cast<std::uint32_t>(def.kind) | static_cast<std::uint32_t>(def.vertexCount) << 8;
        info.radius = def.radius;
        info.vertices = def.vertices;
        info.category = 1;
        info.mask = ~0u;
        shapes.push_back(info);
        return shapes.back();
    }

    JointInfo& addJoint(JointKind kind, BodyId a, Vec2 anchorA, BodyId b, Vec2 anchorB) {
        JointInfo info{};
        info.id = static_cast<JointId>(joints.size() + 1);
        info.flags = static_cast<std::uint32_t>(kind);
        info.bodyA = a;
        info.bodyB = b;
        info.anchorA = anchorA;
        info.anchorB = anchorB;
        joints.push_back(info);
        return joints.back();
    }

    [[nodiscard]] Measures take() const { return measure(world, bodies, shapes, joints, motions); }
};

TEST(Measure, AddsKineticEnergyAndThatOfHeightForDynamicBodiesAlone) {
    HandMade setup;
    setup.world.gravity = {0.0f, -10.0f};
    setup.addBody(BodyType::Dynamic, {1.0f, 4.0f}, 2.0f, 0.5f);
    setup.motions[0].velocity = {3.0f, 4.0f};
    setup.motions[0].angularVelocity = 6.0f;
    setup.addBody(BodyType::Kinematic, {0.0f, 100.0f}, 0.0f, 0.0f);
    setup.motions[1].velocity = {50.0f, 0.0f};
    // 2·25/2 + 0.5·36/2 + 2·10·4
    EXPECT_DOUBLE_EQ(setup.take().energy, 25.0 + 9.0 + 80.0);
    setup.bodies[0].gravityScale = 0.5f;
    EXPECT_DOUBLE_EQ(setup.take().energy, 25.0 + 9.0 + 40.0);
}

TEST(Measure, FindsTheDepthOfOverlappingDiscsAndTheMeanOverPairs) {
    HandMade setup;
    for (const float x : {0.0f, 0.875f, 1.75f, 5.0f}) {
        setup.addShape(setup.addBody(BodyType::Dynamic, {x, 0.0f}, 1.0f),
                       ShapeDef::circle({}, 0.5f));
    }
    setup.motions[2].position.x = 1.625f;
    // Pairs: 1 − 0.875 = 0.125 and 1 − 0.75 = 0.25; the fourth disc is alone.
    const Measures measures = setup.take();
    EXPECT_DOUBLE_EQ(measures.maxPenetration, 0.25);
    EXPECT_DOUBLE_EQ(measures.meanPenetration, 0.1875);
}

TEST(Measure, FindsTheDepthOfATurnedBoxInTheGround) {
    HandMade setup;
    setup.addShape(setup.addBody(BodyType::Static, {0.0f, -1.0f}), ShapeDef::box(10.0f, 1.0f));
    setup.addShape(setup.addBody(BodyType::Dynamic, {3.0f, 0.7f}, 1.0f), ShapeDef::box(0.5f, 0.5f));
    const float r = std::sqrt(0.5f);
    setup.motions[1].rotation = {r, r};
    EXPECT_NEAR(setup.take().maxPenetration, std::sqrt(0.5) - 0.7, 1e-6);
    setup.motions[1].position.y = 0.71f;
    EXPECT_EQ(setup.take().maxPenetration, 0.0);
    EXPECT_EQ(setup.take().meanPenetration, 0.0);
}

TEST(Measure, TakesWhatIsNotANumberForInfinitelyFarOff) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinite = std::numeric_limits<float>::infinity();
    // Whichever of three bodies it is, in a row with two joints: a maximum over the others is not
    // what is asked for.
    for (std::size_t broken = 0; broken < 3; ++broken) {
        for (const float value : {nan, infinite, -infinite}) {
            for (const int part : {0, 1, 2, 3}) {
                HandMade setup;
                std::vector<BodyId> ids;
                for (const float x : {0.0f, 1.0f, 2.0f}) {
                    ids.push_back(setup.addBody(BodyType::Dynamic, {x, 0.0f}, 1.0f, 1.0f));
                    setup.addShape(ids.back(), ShapeDef::circle({}, 0.25f));
                }
                setup.addJoint(JointKind::Revolute, ids[0], {0.5f, 0.0f}, ids[1], {-0.5f, 0.0f});
                setup.addJoint(JointKind::Prismatic, ids[1], {0.5f, 0.0f}, ids[2], {-0.5f, 0.0f})
                    .target = {1.0f, 0.0f};
                EXPECT_EQ(setup.take().maxJointError, 0.0);
                EXPECT_EQ(setup.take().maxPenetration, 0.0);
                setup.motions[broken].angularVelocity = value;
                EXPECT_FALSE(std::isfinite(setup.take().energy));
                EXPECT_EQ(setup.take().maxPenetration, 0.0) << "where it is is known";
                BodyMotion& motion = setup.motions[broken];
                (part == 0   ? motion.position.x
                 : part == 1 ? motion.position.y
                 : part == 2 ? motion.rotation.c
                             : motion.rotation.s) = value;
                const Measures measures = setup.take();
                const double far = std::numeric_limits<double>::infinity();
                EXPECT_EQ(measures.maxPenetration, far) << broken << part << value;
                EXPECT_EQ(measures.meanPenetration, far) << broken << part << value;
                EXPECT_EQ(measures.maxJointError, far) << broken << part << value;
            }
        }
    }
}

TEST(Measure, CountsTheRadiusOfRoundedShapes) {
    HandMade setup;
    setup.addShape(setup.addBody(BodyType::Dynamic, {0.0f, 0.0f}, 1.0f),
                   ShapeDef::capsule({-1.0f, 0.0f}, {1.0f, 0.0f}, 0.25f));
    setup.addShape(setup.addBody(BodyType::Dynamic, {0.5f, 1.0f}, 1.0f),
                   ShapeDef::box(0.5f, 0.5f, {}, {}, 0.3125f));
    // Distance of the cores 0.5, radii 0.5625 together.
    EXPECT_DOUBLE_EQ(setup.take().maxPenetration, 0.0625);
}

TEST(Measure, LeavesOutPairsThatMayNotTouch) {
    const auto overlapping = [](HandMade& setup) {
        for (int i = 0; i < 2; ++i) {
            setup.addShape(setup.addBody(BodyType::Dynamic, {}, 1.0f), ShapeDef::circle({}, 0.5f));
        }
    };
    HandMade filtered;
    overlapping(filtered);
    EXPECT_GT(filtered.take().maxPenetration, 0.9);
    for (ShapeInfo& shape : filtered.shapes) shape.group = -1;
    EXPECT_EQ(filtered.take().maxPenetration, 0.0) << "one negative group";

    HandMade joined;
    overlapping(joined);
    JointInfo& joint = joined.addJoint(JointKind::Revolute, 5, {}, 3, {});
    EXPECT_EQ(joined.take().maxPenetration, 0.0) << "linked by a joint";
    joint.flags |= JointInfo::collideConnected;
    EXPECT_GT(joined.take().maxPenetration, 0.9) << "linked, but may touch";

    HandMade still;
    overlapping(still);
    for (BodyInfo& body : still.bodies) body.flags = static_cast<std::uint32_t>(BodyType::Static);
    EXPECT_EQ(still.take().maxPenetration, 0.0) << "nothing can push them apart";

    HandMade compound;
    const BodyId body = compound.addBody(BodyType::Dynamic, {}, 1.0f);
    compound.addShape(body, ShapeDef::circle({}, 0.5f));
    compound.addShape(body, ShapeDef::circle({}, 0.5f));
    EXPECT_EQ(compound.take().maxPenetration, 0.0) << "one body";
}

TEST(Measure, TakesTheLargestGapOfRevoluteJoints) {
    HandMade setup;
    setup.addBody(BodyType::Static, {1.0f, 1.0f});
    setup.addBody(BodyType::Dynamic, {3.0f, 1.0f}, 1.0f);
    setup.motions[1].rotation = {0.0f, 1.0f};
    // Anchor B: (3, 1) + (0, 1) turned by 90° = (2, 1); anchor A: (1, 1) + (1.5, 0) = (2.5, 1).
    setup.addJoint(JointKind::Revolute, 3, {1.5f, 0.0f}, 5, {0.0f, 1.0f});
    EXPECT_DOUBLE_EQ(setup.take().maxJointError, 0.5);
    setup.addJoint(JointKind::Revolute, 3, {1.0f, 0.0f}, 5, {0.0f, 1.0f});
    EXPECT_DOUBLE_EQ(setup.take().maxJointError, 0.5);
}

TEST(Measure, ComparesADistanceJointWithItsLengthOrItsRange) {
    HandMade setup;
    setup.addBody(BodyType::Static, {});
    setup.addBody(BodyType::Dynamic, {3.0f, 4.0f}, 1.0f);
    JointInfo& joint = setup.addJoint(JointKind::Distance, 3, {}, 5, {});
    joint.length = 4.5f;
    EXPECT_DOUBLE_EQ(setup.take().maxJointError, 0.5) << "rigid";
    joint.flags |= JointInfo::spring;
    EXPECT_EQ(setup.take().maxJointError, 0.0) << "a spring may have any length";
    joint.flags |= JointInfo::limit;
    joint.lower = 1.0f;
    joint.upper = 4.0f;
    EXPECT_DOUBLE_EQ(setup.take().maxJointError, 1.0) << "above the range";
    joint.lower = 7.0f;
    joint.upper = 8.0f;
    EXPECT_DOUBLE_EQ(setup.take().maxJointError, 2.0) << "below the range";
    joint.flags = static_cast<std::uint32_t>(JointKind::Mouse);
    EXPECT_EQ(setup.take().maxJointError, 0.0) << "a target may be anywhere";
}

TEST(Measure, CountsTheAngleOfAWeldAsTheWayItSwingsTheCentre) {
    HandMade setup;
    setup.addBody(BodyType::Static, {1.0f, 1.0f});
    setup.addBody(BodyType::Dynamic, {1.0f, 3.0f}, 1.0f);
    JointInfo& joint = setup.addJoint(JointKind::Weld, 3, {}, 5, {-2.0f, 0.0f});
    joint.reference = {0.0f, 1.0f};
    setup.motions[1].rotation = {0.0f, 1.0f};
    EXPECT_NEAR(setup.take().maxJointError, 0.0, 1e-12) << "as it should be, turned by 90 degrees";
    setup.motions[1].position.y = 3.25f;
    EXPECT_NEAR(setup.take().maxJointError, 0.25, 1e-12) << "the anchors are apart";
    // Turned back by 90 degrees about the anchor: the centre is off by the diagonal of 2 m.
    setup.motions[1] = {{3.0f, 1.0f}, {1.0f, 0.0f}, {}, 0.0f, 0, 0, 0};
    EXPECT_NEAR(setup.take().maxJointError, std::sqrt(8.0), 1e-12);
    joint.flags |= JointInfo::spring;
    EXPECT_NEAR(setup.take().maxJointError, 0.0, 1e-12) << "a spring may have any angle";
}

TEST(Measure, OfAPrismaticJointIsHowFarItIsOffItsAxisOrOutsideItsLimit) {
    HandMade setup;
    setup.addBody(BodyType::Static, {});
    setup.motions[0].rotation = {0.0f, 1.0f};  // its axis x points up in the world
    setup.addBody(BodyType::Dynamic, {0.25f, 3.0f}, 1.0f);
    setup.motions[1].rotation = {0.0f, 1.0f};
    JointInfo& joint = setup.addJoint(JointKind::Prismatic, 3, {}, 5, {});
    joint.reference = {1.0f, 0.0f};
    joint.target = {1.0f, 0.0f};
    EXPECT_NEAR(setup.take().maxJointError, 0.25, 1e-12);
    joint.flags |= JointInfo::limit;
    joint.lower = -1.0f;
    joint.upper = 2.5f;
    EXPECT_NEAR(setup.take().maxJointError, 0.5, 1e-12);
    joint.upper = 4.0f;
    joint.target = {0.0f, 1.0f};  // now along −x in the world: 3 m off, at −0.25
    EXPECT_NEAR(setup.take().maxJointError, 3.0, 1e-12);
}

TEST(Measure, AgreesWithAllPairsOnAScatterOfDiscs) {
    HandMade setup;
    std::uint64_t state = 99;
    const auto next = [&] {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<float>(state >> 40) / 16777216.0f;
    };
    for (int i = 0; i < 300; ++i) {
        setup.addShape(setup.addBody(BodyType::Dynamic, {20.0f * next(), 20.0f * next()}, 1.0f),
                       ShapeDef::circle({}, 0.2f + next()));
    }
    double deepest = 0.0, sum = 0.0;
    int pairs = 0;
    for (std::size_t i = 0; i < 300; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const Vec2 a = setup.motions[i].position;
            const Vec2 b = setup.motions[j].position;
            const double distance = std::hypot(static_cast<double>(a.x) - static_cast<double>(b.x),
                                               static_cast<double>(a.y) - static_cast<double>(b.y));
            const double depth = static_cast<double>(setup.shapes[i].radius) +
                                 static_cast<double>(setup.shapes[j].radius) - distance;
            if (depth <= 0.0) continue;
            deepest = std::max(deepest, depth);
            sum += depth;
            ++pairs;
        }
    }
    ASSERT_GT(pairs, 100);
    const Measures measures = setup.take();
    EXPECT_NEAR(measures.maxPenetration, deepest, 1e-12);
    EXPECT_NEAR(measures.meanPenetration, sum / pairs, 1e-12);
}

}  // namespace
}  // namespace huestep
