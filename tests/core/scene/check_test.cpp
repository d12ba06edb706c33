#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/scene/scene.h"

namespace huestep {
namespace {

const float notANumber = std::numeric_limits<float>::quiet_NaN();
const float infinity = std::numeric_limits<float>::infinity();

/// Four bodies, one of them with two shapes, two joints and players: all valid.
Scene validScene() {
    Scene scene;
    BodyDef ground;
    ground.shapes.push_back(ShapeDef::segment({-10.0f, 0.0f}, {10.0f, 0.0f}));
    scene.bodies.push_back(ground);
    for (int i = 0; i < 3; ++i) {
        BodyDef body;
        body.type = BodyType::Dynamic;
        body.position = {2.0f * static_cast<float>(i), 1.0f};
        body.shapes.push_back(ShapeDef::box(0.5f, 0.25f));
        scene.bodies.push_back(body);
    }
    scene.bodies[3].shapes.push_back(ShapeDef::capsule({0.0f, 0.0f}, {1.0f, 0.0f}, 0.2f));
    JointDef joint;
    joint.bodyA = 1;
    joint.bodyB = 2;
    scene.joints.push_back(joint);
    joint.kind = JointKind::Distance;
    joint.length = 2.0f;
    scene.joints.push_back(joint);
    PlayerDef players;
    players.body = scene.bodies[1];
    players.spawnPoints = {{0.0f, 5.0f}};
    scene.players = players;
    return scene;
}

struct Case {
    const char* sentence;  ///< all of it
    std::function<void(Scene&)> spoil;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.sentence;
}

class SpoiledScene : public testing::TestWithParam<Case> {};

TEST_P(SpoiledScene, IsRefusedWithASentenceThatNamesThePath) {
    Scene scene = validScene();
    ASSERT_TRUE(check(scene).ok());
    GetParam().spoil(scene);
    const Status status = check(scene);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().message, GetParam().sentence);
}

ShapeDef triangle(Vec2 a, Vec2 b, Vec2 c) {
    const std::array<Vec2, 3> points{a, b, c};
    return ShapeDef::polygon(points);
}

const Case sceneCases[] = {
    {"name: is longer than 256 bytes", [](Scene& s) { s.name.assign(257, 'x'); }},
    {"gravity.y: not a finite number", [](Scene& s) { s.gravity.y = infinity; }},
    {"gravity.x: must be from -10000 to 10000, is 20000", [](Scene& s) { s.gravity.x = 2e4f; }},
    {"stepSeconds: must be from 1e-04 to 0.1, is 0.25", [](Scene& s) { s.stepSeconds = 0.25f; }},
    {"stepSeconds: must be from 1e-04 to 0.1, is 0", [](Scene& s) { s.stepSeconds = 0.0f; }},
    {"substeps: must be from 0 to 64, is 65", [](Scene& s) { s.substeps = 65; }},
    {"need.penetration: must be from 1e-06 to 1, is 2", [](Scene& s) { s.need.penetration = 2; }},
    {"need.joint: must be from 1e-06 to 1, is -1", [](Scene& s) { s.need.joint = -1; }},
    {"method: is no method", [](Scene& s) { s.method = static_cast<Method>(200); }},
    {"limits.bodies: must be from 0 to 1000000, is 1000001",
     [](Scene& s) { s.limits.bodies = 1'000'001; }},
    {"limits.commandsPerTick: must be from 1 to 65536, is 0",
     [](Scene& s) { s.limits.commandsPerTick = 0; }},
    {"counters.nextBody: must be from 1 to 2147483647, is 0",
     [](Scene& s) { s.counters.nextBody = 0; }},
    {"bodies: 4 are more than the 3 of limits.bodies", [](Scene& s) { s.limits.bodies = 3; }},
    {"joints: 2 are more than the 1 of limits.joints", [](Scene& s) { s.limits.joints = 1; }},
    {"bodies[3].shapes: with these the scene has more than the 4 of limits.shapes",
     [](Scene& s) { s.limits.shapes = 4; }},
    {"bodies[2].id: 9 is also the id of bodies[0]",
     [](Scene& s) { s.bodies[0].id = s.bodies[2].id = 9; }},
    {"joints[1].id: 4 is also the id of joints[0]",
     [](Scene& s) { s.joints[0].id = s.joints[1].id = 4; }},
};
INSTANTIATE_TEST_SUITE_P(Scene, SpoiledScene, testing::ValuesIn(sceneCases));

const Case bodyCases[] = {
    {"bodies[1].type: is not static, kinematic or dynamic",
     [](Scene& s) { s.bodies[1].type = static_cast<BodyType>(3); }},
    {"bodies[1].id: must be from 0 to 2147483647, is 2147483648",
     [](Scene& s) { s.bodies[1].id = 0x80000000u; }},
    {"bodies[1].firstShape: must be from 0 to 2147483647, is 4294967295",
     [](Scene& s) { s.bodies[1].firstShape = ~0u; }},
    {"bodies[1].firstShape: needs an id of the body as well",
     [](Scene& s) { s.bodies[1].firstShape = 4; }},
    {"bodies[1].position.y: not a finite number",
     [](Scene& s) { s.bodies[1].position.y = notANumber; }},
    {"bodies[1].position.x: must be from -1e+06 to 1e+06, is 2e+06",
     [](Scene& s) { s.bodies[1].position.x = 2e6f; }},
    {"bodies[1].rotation.s: not a finite number",
     [](Scene& s) { s.bodies[1].rotation.s = notANumber; }},
    {"bodies[1].rotation: (c, s) must be (cos, sin) of an angle, but c*c + s*s is 2",
     [](Scene& s) {
         s.bodies[1].rotation = {1.0f, 1.0f};
     }},
    {"bodies[1].velocity.x: must be from -1e+05 to 1e+05, is 1e+06",
     [](Scene& s) { s.bodies[1].velocity.x = 1e6f; }},
    {"bodies[0].velocity: a static body has none",
     [](Scene& s) { s.bodies[0].angularVelocity = 1.0f; }},
    {"bodies[1].angularVelocity: not a finite number",
     [](Scene& s) { s.bodies[1].angularVelocity = -infinity; }},
    {"bodies[1].linearDamping: must be from 0 to 1000, is -1",
     [](Scene& s) { s.bodies[1].linearDamping = -1.0f; }},
    {"bodies[1].angularDamping: must be from 0 to 1000, is 2000",
     [](Scene& s) { s.bodies[1].angularDamping = 2000.0f; }},
    {"bodies[1].gravityScale: must be from -1000 to 1000, is 1001",
     [](Scene& s) { s.bodies[1].gravityScale = 1001.0f; }},
    {"bodies[0].asleep: only a dynamic body can sleep",
     [](Scene& s) { s.bodies[0].asleep = true; }},
    {"bodies[1].asleep: contradicts maySleep",
     [](Scene& s) {
         s.bodies[1].asleep = true;
         s.bodies[1].maySleep = false;
     }},
    {"bodies[1].asleep: a sleeping body has no velocity",
     [](Scene& s) {
         s.bodies[1].asleep = true;
         s.bodies[1].velocity.y = 1.0f;
     }},
    {"bodies[1].shapes: 1025 are more than the 1024 a body may have",
     [](Scene& s) { s.bodies[1].shapes.assign(1025, ShapeDef::circle({}, 1.0f)); }},
    {"bodies[2]: a dynamic body needs mass: give it a circle, capsule or polygon with a density "
     "above 0",
     [](Scene& s) { s.bodies[2].shapes.clear(); }},
    {"bodies[2]: a dynamic body needs mass: give it a circle, capsule or polygon with a density "
     "above 0",
     [](Scene& s) { s.bodies[2].shapes[0].density = 0.0f; }},
    {"bodies[2]: a dynamic body needs mass: give it a circle, capsule or polygon with a density "
     "above 0",
     [](Scene& s) {
         s.bodies[2].shapes[0] = ShapeDef::segment({}, {1.0f, 0.0f});
     }},
    {"bodies[2]: a dynamic body needs mass: give it a circle, capsule or polygon with a density "
     "above 0",
     [](Scene& s) {
         s.bodies[2].shapes =
             ShapeDef::chain(std::array{Vec2{}, Vec2{1.0f, 0.0f}, Vec2{0.0f, 1.0f}}, true);
     }},
};
INSTANTIATE_TEST_SUITE_P(Body, SpoiledScene, testing::ValuesIn(bodyCases));

const Case shapeCases[] = {
    {"bodies[3].shapes[0].vertices[2].x: not a finite number",
     [](Scene& s) { s.bodies[3].shapes[0].vertices[2].x = notANumber; }},
    {"bodies[3].shapes[1].vertices[1].y: must be from -10000 to 10000, is 20000",
     [](Scene& s) { s.bodies[3].shapes[1].vertices[1].y = 2e4f; }},
    {"bodies[3].shapes[0].kind: is not circle, capsule, polygon, segment or chain segment",
     [](Scene& s) { s.bodies[3].shapes[0].kind = static_cast<ShapeKind>(5); }},
    {"bodies[0].shapes[0].vertices: a chain segment has 4 vertices, not 2",
     [](Scene& s) { s.bodies[0].shapes[0].kind = ShapeKind::ChainSegment; }},
    {"bodies[0].shapes[0].vertices[3]: less than 0.001 m from vertex 2",
     [](Scene& s) {
         s.bodies[0].shapes[0] =
             ShapeDef::chainSegment({}, {1.0f, 0.0f}, {2.0f, 0.0f}, {2.0f, 0.0f});
     }},
    {"bodies[0].shapes[0].radius: must be from 0 to 0, is 0.25",
     [](Scene& s) {
         s.bodies[0].shapes[0] =
             ShapeDef::chainSegment({}, {1.0f, 0.0f}, {2.0f, 0.0f}, {3.0f, 0.0f});
         s.bodies[0].shapes[0].radius = 0.25f;
     }},
    {"bodies[3].shapes[0].vertices: a polygon has 3 to 8 vertices, not 2",
     [](Scene& s) { s.bodies[3].shapes[0].vertexCount = 2; }},
    {"bodies[3].shapes[0].vertices: a polygon has 3 to 8 vertices, not 9",
     [](Scene& s) {
         const std::vector<Vec2> points(9);
         s.bodies[3].shapes[0] = ShapeDef::polygon(points);
     }},
    {"bodies[3].shapes[1].vertices: a capsule has 2 vertices, not 1",
     [](Scene& s) { s.bodies[3].shapes[1].vertexCount = 1; }},
    {"bodies[0].shapes[0].vertices: a segment has 2 vertices, not 3",
     [](Scene& s) { s.bodies[0].shapes[0].vertexCount = 3; }},
    {"bodies[3].shapes[1].vertices[1]: less than 0.001 m from vertex 0",
     [](Scene& s) { s.bodies[3].shapes[1].vertices[1] = s.bodies[3].shapes[1].vertices[0]; }},
    {"bodies[3].shapes[0].vertices[2]: less than 0.001 m from vertex 1",
     [](Scene& s) { s.bodies[3].shapes[0].vertices[2] = s.bodies[3].shapes[0].vertices[1]; }},
    {"bodies[3].shapes[0].vertices: run clockwise, must run counter-clockwise",
     [](Scene& s) {
         s.bodies[3].shapes[0] = triangle({0.0f, 0.0f}, {0.0f, 1.0f}, {1.0f, 0.0f});
     }},
    {"bodies[3].shapes[0].vertices[3]: the polygon is not convex: outside of the edge from "
     "vertex 1 to 2",
     [](Scene& s) {
         const std::array<Vec2, 5> arrow{Vec2{0.0f, 0.0f}, Vec2{2.0f, 0.0f}, Vec2{1.0f, 0.5f},
                                         Vec2{2.0f, 1.0f}, Vec2{0.0f, 1.0f}};
         s.bodies[3].shapes[0] = ShapeDef::polygon(arrow);
     }},
    {"bodies[3].shapes[0].vertices[2]: the polygon is flat here: less than 1e-04 m inside of the "
     "edge from vertex 0 to 1",
     [](Scene& s) {
         s.bodies[3].shapes[0] = triangle({0.0f, 0.0f}, {1.0f, 0.0f}, {2.0f, 0.00001f});
     }},
    {"bodies[3].shapes[1].radius: must be from 0.001 to 10000, is 0",
     [](Scene& s) { s.bodies[3].shapes[1].radius = 0.0f; }},
    {"bodies[3].shapes[0].radius: must be from 0 to 10000, is -1",
     [](Scene& s) { s.bodies[3].shapes[0].radius = -1.0f; }},
    {"bodies[0].shapes[0].radius: must be from 0 to 0, is 0.5",
     [](Scene& s) { s.bodies[0].shapes[0].radius = 0.5f; }},
    {"bodies[3].shapes[0].density: must be from 0 to 1e+06, is -2",
     [](Scene& s) { s.bodies[3].shapes[0].density = -2.0f; }},
    {"bodies[3].shapes[0].density: must be 0 or at least 1e-06, is 1e-07",
     [](Scene& s) { s.bodies[3].shapes[0].density = 1e-7f; }},
    {"bodies[3].shapes[0].material.friction: must be from 0 to 100, is -0.5",
     [](Scene& s) { s.bodies[3].shapes[0].material.friction = -0.5f; }},
    {"bodies[3].shapes[0].material.restitution: must be from 0 to 1, is 1.5",
     [](Scene& s) { s.bodies[3].shapes[0].material.restitution = 1.5f; }},
    {"bodies[3].shapes[0].material.rollingResistance: not a finite number",
     [](Scene& s) { s.bodies[3].shapes[0].material.rollingResistance = notANumber; }},
    {"bodies[3].shapes[0].material.tangentSpeed: must be from -10000 to 10000, is 10001",
     [](Scene& s) { s.bodies[3].shapes[0].material.tangentSpeed = 10001.0f; }},
};
INSTANTIATE_TEST_SUITE_P(Shape, SpoiledScene, testing::ValuesIn(shapeCases));

const Case jointCases[] = {
    {"joints[0].kind: is not revolute, distance, mouse, weld or prismatic",
     [](Scene& s) { s.joints[0].kind = static_cast<JointKind>(7); }},
    {"joints[0].bodyA: there is no body 4 among 4", [](Scene& s) { s.joints[0].bodyA = 4; }},
    {"joints[0].bodyB: there is no body 99 among 4", [](Scene& s) { s.joints[0].bodyB = 99; }},
    {"joints[0].bodyB: is body A: a joint needs two bodies",
     [](Scene& s) { s.joints[0].bodyB = 1; }},
    {"joints[0].anchorA.x: not a finite number",
     [](Scene& s) { s.joints[0].anchorA.x = notANumber; }},
    {"joints[0].anchorB.y: must be from -1e+06 to 1e+06, is -1e+07",
     [](Scene& s) { s.joints[0].anchorB.y = -1e7f; }},
    {"joints[0].reference: (c, s) must be (cos, sin) of an angle, but c*c + s*s is 0",
     [](Scene& s) {
         s.joints[0].reference = {0.0f, 0.0f};
     }},
    {"joints[0].axis: (c, s) must be (cos, sin) of an angle, but c*c + s*s is 2",
     [](Scene& s) {
         s.joints[0].axis = {1.0f, 1.0f};
     }},
    {"joints[1].length: must be at least 0.001 m, is 0",
     [](Scene& s) { s.joints[1].length = 0.0f; }},
    {"joints[1].length: must be from 0 to 1e+05, is 1e+06",
     [](Scene& s) { s.joints[1].length = 1e6f; }},
    {"joints[0].target.x: not a finite number", [](Scene& s) { s.joints[0].target.x = infinity; }},
    {"joints[0].maxForce: must be from 0 to 1e+12, is -1",
     [](Scene& s) { s.joints[0].maxForce = -1.0f; }},
    {"joints[0].spring.hertz: must be from 0 to 1000, is 1001",
     [](Scene& s) { s.joints[0].spring.hertz = 1001.0f; }},
    {"joints[0].spring.hertz: must be above 0 where the spring is enabled",
     [](Scene& s) { s.joints[0].spring.enabled = true; }},
    {"joints[0].spring.dampingRatio: not a finite number",
     [](Scene& s) { s.joints[0].spring.dampingRatio = notANumber; }},
    {"joints[0].limit: lower 1 is above upper -1",
     [](Scene& s) {
         s.joints[0].limit = {true, 1.0f, -1.0f};
     }},
    {"joints[0].limit.lower: must be above -pi",
     [](Scene& s) {
         s.joints[0].limit = {true, -4.0f, 1.0f};
     }},
    {"joints[0].limit.upper: must be below pi",
     [](Scene& s) {
         s.joints[0].limit = {true, 0.0f, 3.2f};
     }},
    {"joints[0].limit.upper: not a finite number",
     [](Scene& s) { s.joints[0].limit.upper = notANumber; }},
    {"joints[1].limit.lower: must be from 0 to 1e+05, is -1",
     [](Scene& s) {
         s.joints[1].limit = {true, -1.0f, 1.0f};
     }},
    {"joints[1].limit.lower: must be from -1e+05 to 1e+05, is -2e+05",
     [](Scene& s) {
         s.joints[1].kind = JointKind::Prismatic;
         s.joints[1].limit = {true, -2e5f, 1.0f};
     }},
    {"joints[1].limit: lower 1 is above upper -1",
     [](Scene& s) {
         s.joints[1].kind = JointKind::Prismatic;
         s.joints[1].limit = {true, 1.0f, -1.0f};
     }},
    {"joints[0].limit: a weld joint has no limit",
     [](Scene& s) {
         s.joints[0].kind = JointKind::Weld;
         s.joints[0].limit.enabled = true;
     }},
    {"joints[0].motor: a weld joint has none",
     [](Scene& s) {
         s.joints[0].kind = JointKind::Weld;
         s.joints[0].motor.enabled = true;
     }},
    {"joints[0].motor.speed: must be from -1e+05 to 1e+05, is 1e+06",
     [](Scene& s) { s.joints[0].motor.speed = 1e6f; }},
    {"joints[0].motor.maxEffort: must be from 0 to 1e+12, is -1",
     [](Scene& s) { s.joints[0].motor.maxEffort = -1.0f; }},
    {"joints[0].spring: a mouse joint needs one",
     [](Scene& s) { s.joints[0].kind = JointKind::Mouse; }},
    {"joints[0].motor: a mouse joint has none",
     [](Scene& s) {
         s.joints[0].kind = JointKind::Mouse;
         s.joints[0].motor.enabled = true;
     }},
    {"joints[0].limit: a mouse joint has no limit",
     [](Scene& s) {
         s.joints[0].kind = JointKind::Mouse;
         s.joints[0].spring = {true, 5.0f, 0.7f};
         s.joints[0].limit.enabled = true;
     }},
};
INSTANTIATE_TEST_SUITE_P(Joint, SpoiledScene, testing::ValuesIn(jointCases));

const Case playerCases[] = {
    {"players.maxSpawned: must be from 0 to 1024, is 1025",
     [](Scene& s) { s.players->maxSpawned = 1025; }},
    {"players.maxImpulse: not a finite number",
     [](Scene& s) { s.players->maxImpulse = notANumber; }},
    {"players.maxForce: must be from 0 to 1e+09, is -1",
     [](Scene& s) { s.players->maxForce = -1.0f; }},
    {"players.spawnPoints[0].y: not a finite number",
     [](Scene& s) { s.players->spawnPoints[0].y = notANumber; }},
    {"players.spawnPoints: players have a body, so there must be at least one",
     [](Scene& s) { s.players->spawnPoints.clear(); }},
    {"players.spawnPoints: 4097 are more than 4096",
     [](Scene& s) { s.players->spawnPoints.assign(4097, Vec2{}); }},
    {"players.body.id: must be 0: every player's body gets an id of its own",
     [](Scene& s) { s.players->body->id = 3; }},
    {"players.body.shapes[0].radius: not a finite number",
     [](Scene& s) { s.players->body->shapes[0].radius = notANumber; }},
};
INSTANTIATE_TEST_SUITE_P(Player, SpoiledScene, testing::ValuesIn(playerCases));

TEST(Check, PutsThePathOfABodyInFrontOfItsSentence) {
    BodyDef body;
    body.position.x = notANumber;
    EXPECT_EQ(check(body, "spawn.bodies[2]").error().message,
              "spawn.bodies[2].position.x: not a finite number");
    EXPECT_EQ(check(body, "").error().message, "position.x: not a finite number");
}

TEST(Check, PutsThePathOfAJointInFrontOfItsSentence) {
    JointDef joint;
    joint.bodyB = 1;
    EXPECT_TRUE(check(joint, 2, "spawn.joints[0]").ok());
    EXPECT_EQ(check(joint, 1, "spawn.joints[0]").error().message,
              "spawn.joints[0].bodyB: there is no body 1 among 1");
}

TEST(Check, AcceptsThePolygonsThatItsRuleSaysItShould) {
    const std::array<Vec2, 3> sliver{Vec2{0.0f, 0.0f}, Vec2{1.0f, 0.0f}, Vec2{1.0f, 0.002f}};
    const ShapeDef card = ShapeDef::box(0.2f, 0.001f);
    for (const ShapeDef& shape : {card, ShapeDef::polygon(sliver)}) {
        BodyDef body;
        body.type = BodyType::Dynamic;
        body.shapes = {shape};
        const Status status = check(body, "body");
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
    }
}

TEST(Check, RefusesAStarWhoseEveryTurnIsToTheLeft) {
    std::array<Vec2, 5> star;
    for (std::size_t i = 0; i < star.size(); ++i) {
        const double angle = 2.0 * 6.28318530717958647692 * static_cast<double>(i) / 5.0;
        star[i] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
    }
    BodyDef body;
    body.shapes = {ShapeDef::polygon(star)};
    const Status status = check(body, "body");
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("not convex"), std::string::npos);
}

TEST(Check, AllowsAJointBetweenTwoBodiesThatNothingCanPush) {
    Scene scene = validScene();
    scene.bodies.push_back(BodyDef{});
    scene.joints[0].bodyA = 0;
    scene.joints[0].bodyB = 4;
    EXPECT_TRUE(check(scene).ok());
}

TEST(Ids, GivenOnesStandAndTheOthersAreCountedUpPastThem) {
    Scene scene = validScene();
    EXPECT_EQ(bodyIdsOf(scene), (std::vector<BodyId>{1, 2, 3, 4}));
    scene.bodies[1].id = 17;
    scene.bodies[3].id = 5;
    EXPECT_EQ(bodyIdsOf(scene), (std::vector<BodyId>{18, 17, 19, 5}));
    scene.counters.nextBody = 100;
    EXPECT_EQ(bodyIdsOf(scene), (std::vector<BodyId>{100, 17, 101, 5}));
    scene.counters.nextJoint = 7;
    EXPECT_EQ(jointIdsOf(scene), (std::vector<JointId>{7, 8}));
}

}  // namespace
}  // namespace huestep
