// Box2D 3 as an engine: joints, chains, bodies and commands mean there what they mean here. Both
// solve softly with the same step, so within seconds they part by centimetres; a joint that was
// carried over with a wrong sign, axis or frame parts them by its length. Built only where CMake
// was given a Box2D 3.
#include "core/box2d/engine3.h"

#include <functional>
#include <memory>

#include "core/math/trig.h"
#include "core/scene/catalog.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

std::unique_ptr<Engine> engineOf(const Scene& scene, int threads = 1) {
    Result<std::unique_ptr<Engine>> engine = makeBox2d3Engine(scene, threads);
    if (!engine.ok()) {
        ADD_FAILURE() << engine.error().message;
        std::abort();
    }
    return std::move(engine.value());
}

/// Steps both with the same commands and expects all bodies to be near each other all the time.
void expectSideBySide(const Scene& scene, int ticks, float within,
                      const std::function<std::vector<Command>(int tick)>& commandsOf = {}) {
    World world = worldOf(scene);
    const auto engine = engineOf(scene);
    for (int tick = 0; tick < ticks; ++tick) {
        const std::vector<Command> commands =
            commandsOf ? commandsOf(tick) : std::vector<Command>();
        world.step(commands);
        for (const CommandOutcome& outcome : world.events().commands)
            ASSERT_EQ(outcome.reason, Rejection::None);
        ASSERT_TRUE(engine->step(commands).ok());
        const std::vector<BodyMotion> motions = engine->motions();
        ASSERT_EQ(motions.size(), world.motions().size());
        for (std::size_t i = 0; i < motions.size(); ++i) {
            const BodyMotion &here = world.motions()[i], &there = motions[i];
            ASSERT_LT(length(here.position - there.position), within)
                << "tick " << tick << ", body " << world.bodies()[i].id << ": here "
                << here.position.x << " " << here.position.y << ", there " << there.position.x
                << " " << there.position.y;
            const Vec2 turned{here.rotation.c - there.rotation.c,
                              here.rotation.s - there.rotation.s};
            ASSERT_LT(length(turned), 2.0f * within) << "tick " << tick << ", body " << i + 1;
        }
    }
}

/// A joint between a body that is turned and one that hangs from it at the joint's reference.
struct Linked {
    std::string name;
    JointDef joint;
};
void PrintTo(const Linked& linked, std::ostream* out) {
    *out << linked.name;
}

class Box2D3Joint : public testing::TestWithParam<Linked> {
 protected:
    /// Body A in the type given, and body B so that anchors and reference fit.
    static Scene sceneWith(BodyType typeOfA, JointDef joint, Vec2 gravity) {
        Scene scene;
        scene.gravity = gravity;
        scene.sleep = false;
        BodyDef a = bodyAt(typeOfA, {1.0f, 2.0f}, ShapeDef::box(0.6f, 0.4f));
        a.rotation = rotationOf(0.7f);
        if (typeOfA == BodyType::Kinematic) {
            a.velocity = {0.5f, -0.25f};
            a.angularVelocity = 0.8f;
        }
        BodyDef b = boxAt({}, 0.3f);
        b.rotation = compose(a.rotation, joint.reference);
        const float along = joint.kind == JointKind::Distance ? joint.length : 0.0f;
        const Vec2 anchor = a.position + rotate(a.rotation, joint.anchorA + Vec2{along, 0.0f});
        b.position = anchor - rotate(b.rotation, joint.anchorB);
        joint.bodyA = 0;
        joint.bodyB = 1;
        scene.bodies = {a, b};
        scene.joints = {joint};
        return scene;
    }
};

std::vector<Linked> everyJoint() {
    std::vector<Linked> all;
    const auto add = [&all](const std::string& name, JointKind kind, auto&& change) {
        JointDef joint;
        joint.kind = kind;
        joint.anchorA = {1.5f, 0.2f};
        joint.anchorB = {-0.4f, 0.1f};
        joint.reference = rotationOf(-0.9f);
        change(joint);
        all.push_back({name, joint});
    };
    const auto plain = [](JointDef&) {};
    const auto motor = [](float speed) {
        return [speed](JointDef& j) { j.motor = {true, speed, 500.0f}; };
    };
    add("Revolute", JointKind::Revolute, plain);
    add("RevoluteLimit", JointKind::Revolute, [](JointDef& j) { j.limit = {true, -0.3f, 0.1f}; });
    add("RevoluteMotor", JointKind::Revolute, motor(2.0f));
    add("RevoluteSpring", JointKind::Revolute, [](JointDef& j) { j.spring = {true, 2.0f, 0.5f}; });
    const auto rod = [](JointDef& j) {
        j.reference = {};
        j.length = 1.2f;
    };
    add("Rod", JointKind::Distance, rod);
    add("Rope", JointKind::Distance, [&](JointDef& j) {
        rod(j);
        j.limit = {true, 0.7f, 1.6f};
    });
    add("DistanceSpring", JointKind::Distance, [&](JointDef& j) {
        rod(j);
        j.spring = {true, 2.0f, 0.4f};
    });
    add("DistanceMotor", JointKind::Distance, [&](JointDef& j) {
        rod(j);
        j.limit = {true, 0.5f, 2.5f};
        j.motor = {true, 0.5f, 500.0f};
    });
    add("Weld", JointKind::Weld, plain);
    add("WeldSpring", JointKind::Weld, [](JointDef& j) { j.spring = {true, 3.0f, 0.3f}; });
    const auto slide = [](JointDef& j) { j.axis = rotationOf(-1.9f); };
    add("PrismaticLimit", JointKind::Prismatic, [&](JointDef& j) {
        slide(j);
        j.limit = {true, -0.2f, 0.5f};
    });
    add("PrismaticLowerLimit", JointKind::Prismatic, [](JointDef& j) {
        j.axis = rotationOf(1.2f);
        j.limit = {true, -0.2f, 0.5f};
    });
    add("PrismaticMotor", JointKind::Prismatic, [&](JointDef& j) {
        slide(j);
        j.motor = {true, -0.6f, 500.0f};
    });
    add("PrismaticSpring", JointKind::Prismatic, [&](JointDef& j) {
        slide(j);
        j.spring = {true, 1.5f, 0.4f};
    });
    return all;
}

std::string nameOfLinked(const testing::TestParamInfo<Linked>& info) {
    return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(All, Box2D3Joint, testing::ValuesIn(everyJoint()), nameOfLinked);

TEST_P(Box2D3Joint, OnAFixedBodyMovesAsItDoesHere) {
    expectSideBySide(sceneWith(BodyType::Static, GetParam().joint, {0.0f, -10.0f}), 60, 0.04f);
}

TEST_P(Box2D3Joint, OnABodyThatIsDrivenMovesAsItDoesHere) {
    expectSideBySide(sceneWith(BodyType::Kinematic, GetParam().joint, {0.0f, -10.0f}), 60, 0.04f);
}

TEST_P(Box2D3Joint, BetweenTwoFreeBodiesMovesAsItDoesHere) {
    Scene scene = sceneWith(BodyType::Dynamic, GetParam().joint, {});
    scene.bodies[1].velocity = {0.4f, -0.7f};
    scene.bodies[1].angularVelocity = 0.5f;
    expectSideBySide(scene, 60, 0.04f);
}

TEST(Box2D3Engine, DrawsABodyToAHandWithNoMoreThanItsForce) {
    Scene scene = sceneOf({boxAt({0.0f, 3.0f}), boxAt({4.0f, 3.0f})});
    for (std::uint32_t body = 0; body < 2; ++body) {
        JointDef hand;
        hand.kind = JointKind::Mouse;
        hand.bodyA = hand.bodyB = body;
        hand.anchorB = {0.2f, 0.1f};
        hand.target = {4.0f * static_cast<float>(body) + 1.0f, 4.0f};
        hand.spring = {true, 3.0f, 1.0f};
        hand.maxForce = body == 0 ? 1000.0f : 4.0f;  // the second is too weak for its weight
        scene.joints.push_back(hand);
    }
    expectSideBySide(scene, 60, 0.1f);
}

TEST(Box2D3Engine, LetsBodiesLieOnAChainAndComeThroughFromBehind) {
    // From right to left: its front is above.
    BodyDef floor;
    std::vector<Vec2> points;
    for (int i = 0; i < 16; ++i) {
        const float x = 8.0f - static_cast<float>(i);
        points.push_back({x, 0.2f * rotationOf(1.3f * x).s});
    }
    floor.shapes = ShapeDef::chain(points, false);
    Scene scene = sceneOf({floor, discAt({-2.0f, 2.0f}), boxAt({1.5f, 2.0f}, 0.4f)});
    scene.bodies.push_back(discAt({4.0f, -2.0f}, 0.3f));
    scene.bodies.back().velocity = {0.0f, 9.0f};
    scene.bodies.push_back(discAt({-5.0f, 2.0f}, 0.3f));
    for (BodyDef& body : scene.bodies) {
        for (ShapeDef& shape : body.shapes) shape.material.rollingResistance = 0.3f;
    }
    for (ShapeDef& shape : scene.bodies[0].shapes) shape.filter.category = 4u;
    scene.bodies.back().shapes[0].filter.mask = ~4u;
    expectSideBySide(scene, 60, 0.15f);
    const auto engine = engineOf(scene);
    for (int tick = 0; tick < 25; ++tick) ASSERT_TRUE(engine->step({}).ok());
    EXPECT_GT(engine->motions()[3].position.y, 0.5f) << "it came through from below";
    for (int tick = 0; tick < 200; ++tick) ASSERT_TRUE(engine->step({}).ok());
    for (std::size_t i = 1; i < 4; ++i) EXPECT_GT(engine->motions()[i].position.y, 0.0f) << i;
    EXPECT_LT(engine->motions()[4].position.y, -10.0f) << "the filter lets it through";
}

TEST(Box2D3Engine, KeepsWhatIsInALoopInsideAndWhatIsOutsideOut) {
    const std::vector<Vec2> square{{-2.0f, 2.0f}, {2.0f, 2.0f}, {2.0f, -2.0f}, {-2.0f, -2.0f}};
    BodyDef room, block;
    room.shapes = ShapeDef::chain(square, true);  // clockwise: a room
    block.position = {10.0f, 0.0f};
    block.shapes = ShapeDef::chain(std::vector<Vec2>(square.rbegin(), square.rend()), true);
    Scene scene = sceneOf({room, block, discAt({0.0f, 0.5f}), discAt({10.3f, 3.0f})});
    scene.bodies[2].velocity = {3.0f, 4.0f};
    const auto engine = engineOf(scene);
    for (int tick = 0; tick < 300; ++tick) ASSERT_TRUE(engine->step({}).ok());
    EXPECT_NEAR(engine->motions()[2].position.y, -1.5f, 0.02f);
    EXPECT_NEAR(engine->motions()[3].position.y, 2.5f, 0.02f);
    EXPECT_EQ(engine->contactCount(), 2u);
}

TEST(Box2D3Engine, RunsBeltsTheSameWay) {
    BodyDef belt = ground();
    belt.shapes[0].material.tangentSpeed = 1.0f;
    BodyDef chain;
    chain.position = {0.0f, 5.0f};
    std::vector<Vec2> points;
    for (int i = 0; i < 10; ++i) points.push_back({9.0f - 2.0f * static_cast<float>(i), 0.0f});
    chain.shapes = ShapeDef::chain(points, false);
    for (ShapeDef& shape : chain.shapes) shape.material.tangentSpeed = -2.0f;
    const Scene scene = sceneOf({belt, chain, boxAt({0.0f, 0.5f}), boxAt({0.0f, 5.5f})});
    expectSideBySide(scene, 90, 0.1f);
    const auto engine = engineOf(scene);
    for (int tick = 0; tick < 90; ++tick) ASSERT_TRUE(engine->step({}).ok());
    EXPECT_LT(engine->motions()[2].position.x, -1.0f) << "counter-clockwise: to the left";
    EXPECT_GT(engine->motions()[3].position.x, 1.0f);
}

TEST(Box2D3Engine, CarriesOverWhatBodiesAreAndWhoMayTouchWhom) {
    Scene scene = sceneOf({ground()});
    const auto add = [&](auto&& change) {
        BodyDef body = boxAt({3.0f * static_cast<float>(scene.bodies.size()), 4.0f}, 0.4f);
        change(body);
        scene.bodies.push_back(body);
    };
    add([](BodyDef& b) { b.gravityScale = 0.3f; });
    add([](BodyDef& b) { b.gravityScale = -0.2f; });
    add([](BodyDef& b) { b.velocity = {2.0f, 1.0f}, b.linearDamping = 2.0f; });
    add([](BodyDef& b) { b.angularVelocity = 4.0f, b.angularDamping = 1.5f; });
    add([](BodyDef& b) { b.rotation = rotationOf(0.5f), b.fixedRotation = true; });
    add([](BodyDef& b) { b.asleep = true; });
    add([](BodyDef& b) { b.type = BodyType::Kinematic, b.velocity = {0.3f, 0.2f}; });
    add([](BodyDef& b) { b.shapes[0].filter.mask = 2u; });
    add([](BodyDef& b) { b.shapes[0].filter.group = -1; });
    add([](BodyDef& b) { b.shapes = {ShapeDef::capsule({-0.4f, 0.1f}, {0.5f, 0.0f}, 0.2f)}; });
    add([](BodyDef& b) {
        b.shapes = {ShapeDef::box(0.3f, 0.2f, {0.5f, 0.0f}, rotationOf(0.4f), 0.1f),
                    ShapeDef::circle({-0.5f, 0.1f}, 0.3f)};
        b.shapes[1].density = 7.0f;
    });
    scene.bodies[0].shapes[0].filter.group = -1;
    const auto motions = engineOf(scene)->motions();
    const World world = worldOf(scene);
    for (std::size_t i = 0; i < motions.size(); ++i) {
        // Box2D rounds the mass of rounded polygons.
        EXPECT_LT(length(motions[i].position - world.motions()[i].position), 5e-3f) << i;
        EXPECT_EQ(motions[i].velocity, world.motions()[i].velocity) << i;
        EXPECT_EQ(motions[i].asleep(), world.motions()[i].asleep()) << i;
    }
    expectSideBySide(scene, 50, 0.12f);  // Box2D falls 8 cm farther in a second
}

TEST(Box2D3Engine, DoesWhatTheHostSays) {
    Scene scene = sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({4.0f, 0.5f}),
                           bodyAt(BodyType::Kinematic, {8.0f, 3.0f}, ShapeDef::box(0.5f, 0.5f)),
                           boxAt({12.0f, 2.0f}), boxAt({16.0f, 2.0f})},
                          {hinge(0, {12.0f, 3.0f}, 4, {}), hinge(0, {16.0f, 3.0f}, 5, {})});
    scene.joints[1].motor = {true, 0.0f, 1000.0f};
    const auto told = [](int tick) -> std::vector<Command> {
        switch (tick) {
            case 1:
                return {{0, 1, ApplyImpulse{2, {1.0f, 3.0f}, {0.1f, 0.5f}}}};
            case 2:
                return {{0, 2, SetVelocity{4, {1.0f, 2.0f}, 1.5f}}};
            case 3:
                return {{0, 3, SetTarget{4, {8.1f, 3.05f}, rotationOf(0.2f)}}};
            case 4:
                return {{0, 4, SetVelocity{4, {}, 0.0f}}, {0, 5, RemoveJoint{1}}};
            case 5:
                return {{0, 6, SetMotor{2, true, 1.5f}}};
            case 6:
                return {{0, 7,
                         Spawn{{boxAt({-5.0f, 2.0f}), boxAt({-5.0f, 3.0f})},
                               {hinge(0, {0.0f, 0.5f}, 1, {0.0f, -0.5f})}}}};
            case 7:
                return {{0, 8, RemoveBody{3}}};
            case 8:
                return {{0, 9, ApplyForce{7, {200.0f, 0.0f}, {-5.0f, 2.0f}}}};
            case 20:
                return {{0, 10, RemoveJoint{3}}, {0, 11, RemoveBody{6}}};
            default:
                return {};
        }
    };
    expectSideBySide(scene, 40, 0.1f, told);
}

TEST(Box2D3Engine, WakesWhatAMotorIsToldToDrive) {
    Scene scene = sceneOf({ground(), boxAt({0.0f, 5.0f})}, {hinge(0, {0.0f, 6.0f}, 1, {})});
    scene.joints[0].motor = {true, 0.0f, 1000.0f};
    const auto engine = engineOf(scene);
    for (int tick = 0; tick < 120; ++tick) ASSERT_TRUE(engine->step({}).ok());
    ASSERT_TRUE(engine->motions()[1].asleep());
    ASSERT_TRUE(engine->step(std::vector<Command>{{0, 1, SetMotor{1, true, 2.0f}}}).ok());
    for (int tick = 0; tick < 10; ++tick) ASSERT_TRUE(engine->step({}).ok());
    EXPECT_FALSE(engine->motions()[1].asleep());
    EXPECT_NEAR(engine->motions()[1].angularVelocity, 2.0f, 0.05f);
}

TEST(Box2D3Engine, ForgetsTheJointsOfABodyThatIsRemoved) {
    Scene scene = sceneOf({ground(), boxAt({0.0f, 5.0f})}, {hinge(0, {0.0f, 6.0f}, 1, {})});
    const auto engine = engineOf(scene);
    const std::vector<Command> commands{
        {0, 1, RemoveBody{2}}, {0, 2, SetMotor{1, true, 2.0f}}, {0, 3, RemoveJoint{1}}};
    ASSERT_TRUE(engine->step(commands).ok());
    EXPECT_EQ(engine->motions().size(), 1u);
}

TEST(Box2D3Engine, BuildsAndStepsEveryBuiltInSceneOnAnyNumberOfThreadsAlike) {
    for (const CatalogEntry& entry : sceneCatalog()) {
        const Scene scene = *sceneFromCatalog(entry.name);
        if (scene.bodies.size() > 3'000) continue;  // the same as smaller ones, but slow
        const auto one = engineOf(scene), three = engineOf(scene, 3);
        ASSERT_EQ(one->motions().size(), scene.bodies.size()) << entry.name;
        for (int tick = 0; tick < 5; ++tick) {
            ASSERT_TRUE(one->step({}).ok());
            ASSERT_TRUE(three->step({}).ok());
            ASSERT_EQ(one->hash(), three->hash()) << entry.name << ", tick " << tick;
        }
        for (const BodyMotion& motion : one->motions())
            ASSERT_TRUE(std::isfinite(motion.position.x)) << entry.name;
    }
}

TEST(Box2D3Engine, ListsBodiesByIdWhateverTheirOrder) {
    const Scene scene = *sceneFromCatalog("mixed");  // its last body has the lowest id
    const auto motions = engineOf(scene)->motions();
    const World world = worldOf(scene);
    for (std::size_t i = 0; i < motions.size(); ++i)
        EXPECT_LT(length(motions[i].position - world.motions()[i].position), 1e-3f) << i;
}

TEST(Box2D3Engine, RefusesWithItsPathWhatItWouldWeldOrFlatten) {
    Scene scene = sceneOf({ground(), boxAt({0.0f, 3.0f})});
    scene.bodies[0].shapes.push_back(ShapeDef::segment({5.0f, 0.0f}, {5.004f, 0.0f}));
    EXPECT_EQ(makeBox2d3Engine(scene).error().message,
              "bodies[0].shapes[1]: Box2D 3 takes nothing shorter than 5 mm");
    scene.bodies[0].shapes.pop_back();
    scene.bodies[1].shapes = {ShapeDef::polygon(
        std::vector<Vec2>{{0.0f, 0.0f}, {1.0f, -0.0002f}, {2.0f, 0.0f}, {1.0f, 1.0f}})};
    ASSERT_TRUE(check(scene).ok());
    EXPECT_EQ(makeBox2d3Engine(scene).error().message,
              "bodies[1].shapes[0]: Box2D 3 welds vertices that are so near or nearly in line");
}

}  // namespace
}  // namespace huestep::test
