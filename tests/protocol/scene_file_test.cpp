#include "protocol/scene_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <regex>
#include <set>

#include "core/math/trig.h"
#include "core/scene/catalog.h"
#include "protocol/json_document.h"
#include "tests/protocol/samples.h"

namespace huestep::protocol {
namespace {

using samples::Draw;

std::span<const std::byte> bytesOf(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

std::string refusalOf(const std::string& document) {
    const auto scene = readScene(bytesOf(document));
    return scene ? "accepted" : scene.error().message;
}

/// A scene with a value that is not the default in every field, and that `check` accepts.
Scene fullScene() {
    Scene scene;
    scene.name = "all \"fields\" \xe2\x82\xac";
    scene.gravity = {0.5f, -9.81f};
    scene.stepSeconds = 0.01f;
    scene.substeps = 7;
    scene.method = Method::Sequential;
    scene.need = {0.002f, 0.003f};
    scene.rules = {.name = "ball", .version = 3, .seed = 9, .parameters = {{"goals", 7.5f}}};
    scene.sleep = false;
    BodyDef ground;
    ground.id = 3;
    ground.shapes.emplace_back();
    ground.shapes[0].kind = ShapeKind::Segment;
    ground.shapes[0].vertexCount = 2;
    ground.shapes[0].vertices = {Vec2{-10.0f, 0.0f}, {10.0f, 0.1f}};
    ground.shapes[0].radius = 0.0f;
    ground.shapes[0].material.tangentSpeed = -1.5f;
    ground.shapes[0].filter = {2, 0xfffffff0u, 0};
    BodyDef box;
    box.id = 5;
    box.firstShape = 40;
    box.type = BodyType::Dynamic;
    box.fixedRotation = true;
    box.position = {1.0f / 3.0f, 2.0f};
    box.rotation = {0.6f, 0.8f};
    box.velocity = {1.0e-40f, -3.0f};
    box.angularVelocity = 0.1f;
    box.linearDamping = 0.2f;
    box.angularDamping = 0.3f;
    box.gravityScale = -1.0f;
    box.shapes.emplace_back();
    box.shapes[0].kind = ShapeKind::Polygon;
    box.shapes[0].vertexCount = 3;
    box.shapes[0].vertices = {Vec2{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.0f, 0.7f}};
    box.shapes[0].radius = 0.05f;
    box.shapes[0].density = 2.5f;
    box.shapes[0].material = {0.1f, 0.2f, 0.3f, 0.4f};
    box.shapes[0].filter = {4, 8, -3};
    BodyDef capsule;
    capsule.type = BodyType::Kinematic;
    capsule.maySleep = false;
    capsule.shapes.emplace_back();
    capsule.shapes[0].kind = ShapeKind::Capsule;
    capsule.shapes[0].vertexCount = 2;
    capsule.shapes[0].vertices = {Vec2{0.0f, 0.0f}, {1.0f, 0.0f}};
    BodyDef sleeper;
    sleeper.type = BodyType::Dynamic;
    sleeper.asleep = true;
    sleeper.position = {4.0f, 4.0f};
    sleeper.shapes.emplace_back();
    scene.bodies = {ground, box, capsule, sleeper};
    JointDef hinge;
    hinge.id = 9;
    hinge.collideConnected = true;
    hinge.bodyA = 1;
    hinge.bodyB = 2;
    hinge.anchorA = {0.1f, 0.2f};
    hinge.anchorB = {0.3f, 0.4f};
    hinge.reference = {0.8f, -0.6f};
    hinge.limit = {true, -0.5f, 0.75f};
    hinge.motor = {true, 2.0f, 30.0f};
    JointDef rod;
    rod.kind = JointKind::Distance;
    rod.bodyB = 1;
    rod.length = 3.25f;
    rod.spring = {true, 2.0f, 0.5f};
    JointDef mouse;
    mouse.kind = JointKind::Mouse;
    mouse.bodyA = 0;
    mouse.bodyB = 3;
    mouse.target = {5.0f, 6.0f};
    mouse.maxForce = 100.0f;
    mouse.spring = {true, 5.0f, 0.7f};
    JointDef weld;
    weld.kind = JointKind::Weld;
    weld.bodyB = 3;
    weld.spring = {true, 3.0f, 0.25f};
    JointDef slide;
    slide.kind = JointKind::Prismatic;
    slide.bodyB = 3;
    slide.axis = {-0.6f, 0.8f};
    slide.limit = {true, -2.5f, 0.5f};
    scene.joints = {hinge, rod, mouse, weld, slide};
    scene.players.emplace();
    scene.players->body = sleeper;
    scene.players->body->asleep = false;
    scene.players->spawnPoints = {{1.0f, 2.0f}, {-3.0f, 4.5f}};
    scene.players->maxSpawned = 3;
    scene.players->maxImpulse = 12.5f;
    scene.players->maxForce = 99.0f;
    scene.limits = {1'000, 2'000, 3'000, 40, 50};
    scene.counters = {100, 200, 300};
    return scene;
}

/// A document of one body with `fields` in it, for the table below.
std::string withBody(const std::string& fields) {
    return R"({"version": 1, "bodies": [{)" + fields + "}]}";
}
std::string withShape(const std::string& fields) {
    return withBody(R"("shapes": [{)" + fields + "}]");
}
std::string withTwoAndJoint(const std::string& fields) {
    const std::string ball = R"({"type": "dynamic", "shapes": [{"kind": "circle",)"
                             R"( "vertices": [{"x": 0, "y": 0}]}]})";
    return R"({"version": 1, "bodies": [)" + ball + "," + ball + R"(], "joints": [{)" + fields +
           "}]}";
}
const std::string circle = R"("kind": "circle", "vertices": [{"x": 0, "y": 0}])";

TEST(SceneFile, AFullSceneReadsBackEqualFromBothForms) {
    const Scene scene = fullScene();
    const Status status = check(scene);
    ASSERT_TRUE(status.ok()) << status.error().message;
    const std::string json = writeSceneJson(scene);
    const auto fromJson = readScene(bytesOf(json));
    ASSERT_TRUE(fromJson.ok()) << fromJson.error().message << "\n" << json;
    EXPECT_EQ(*fromJson, scene);
    const auto fromBinary = readScene(writeSceneBinary(scene));
    ASSERT_TRUE(fromBinary.ok()) << fromBinary.error().message;
    EXPECT_EQ(*fromBinary, scene);
}

TEST(SceneFile, EveryFieldOfTheFullSceneDiffersFromItsDefaultSoNoneCanBeForgotten) {
    // What the text form of the full scene does not mention, the round trip above does not test.
    const std::string json = writeSceneJson(fullScene());
    std::ifstream file(std::string(HUESTEP_SOURCE_DIR) + "/protocol/scene.capnp");
    std::string line;
    std::set<std::string> names;
    const std::regex field(R"(^\s+(\w+) (?:@\d+ :(?!Void)|:group).*)");
    for (bool inEnum = false; std::getline(file, line);) {
        if (line.rfind("enum", 0) == 0) inEnum = true;
        if (line.rfind("}", 0) == 0) inEnum = false;
        std::smatch match;
        if (!inEnum && std::regex_match(line, match, field)) names.insert(match[1]);
    }
    ASSERT_GT(names.size(), 60u);
    for (const std::string& name : names) {
        EXPECT_NE(json.find('"' + name + "\": "), std::string::npos) << name;
    }
}

TEST(SceneFile, WritingIsStable) {
    const Scene scene = fullScene();
    const std::string json = writeSceneJson(scene);
    EXPECT_EQ(json, writeSceneJson(*readScene(bytesOf(json))));
    EXPECT_EQ(writeSceneBinary(scene), writeSceneBinary(*readScene(writeSceneBinary(scene))));
}

TEST(SceneFile, TextIsForPeople) {
    Scene scene;
    scene.name = "one ball";
    BodyDef ball;
    ball.type = BodyType::Dynamic;
    ball.position = {0.0f, 0.1f};
    ball.shapes.emplace_back();
    ball.shapes[0].material.friction = 0.3f;
    scene.bodies = {ball};
    EXPECT_EQ(writeSceneJson(scene), R"({
  "version": 1,
  "name": "one ball",
  "bodies": [
    {
      "type": "dynamic",
      "position": {"x": 0, "y": 0.1},
      "shapes": [
        {
          "kind": "circle",
          "vertices": [{"x": 0, "y": 0}],
          "material": {"friction": 0.3}
        }
      ]
    }
  ]
}
)");
}

TEST(SceneFile, RandomBodiesAndJointsKeepEveryBit) {
    constexpr std::uint64_t seed = 31;
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    Draw draw(seed);
    for (int round = 0; round < 300; ++round) {
        Scene scene;
        BodyDef body;
        body.type = BodyType::Dynamic;
        const auto within = [&](float most) {
            const float value = draw.real();
            return std::abs(value) <= most ? value : most / 3.0f;
        };
        body.position = {within(1.0e6f), within(1.0e6f)};
        body.velocity = {within(1.0e5f), within(1.0e5f)};
        body.angularVelocity = within(1.0e5f);
        body.gravityScale = within(1.0e3f);
        body.rotation = rotationOf(within(100.0f));
        body.shapes.emplace_back();
        body.shapes[0].vertices[0] = {within(1.0e4f), within(1.0e4f)};
        body.shapes[0].filter = {draw.word(), draw.word(), static_cast<std::int32_t>(draw.word())};
        scene.bodies = {body};
        const std::string json = writeSceneJson(scene);
        const auto back = readScene(bytesOf(json));
        ASSERT_TRUE(back.ok()) << back.error().message << "\n" << json;
        ASSERT_EQ(*back, scene) << json;
        const BodyDef& read = back->bodies[0];
        ASSERT_EQ(0, std::memcmp(&read.position, &body.position, sizeof body.position)) << json;
        ASSERT_EQ(*readScene(writeSceneBinary(scene)), scene);
    }
}

TEST(SceneFile, BuiltInScenesReadBackEqual) {
    for (const CatalogEntry& entry : sceneCatalog()) {
        const auto scene = sceneFromCatalog(entry.name);
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        const auto json = readScene(bytesOf(writeSceneJson(*scene)));
        ASSERT_TRUE(json.ok()) << entry.name << ": " << json.error().message;
        EXPECT_TRUE(*json == *scene) << entry.name;
        const auto binary = readScene(writeSceneBinary(*scene));
        ASSERT_TRUE(binary.ok()) << entry.name << ": " << binary.error().message;
        EXPECT_TRUE(*binary == *scene) << entry.name;
    }
}

TEST(SceneFile, AnAngleStandsForItsCosineAndSine) {
    const auto scene = readScene(bytesOf(withBody(R"("rotation": {"angle": 0.5})")));
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_EQ(scene->bodies[0].rotation, rotationOf(0.5f));
    EXPECT_NEAR(static_cast<double>(scene->bodies[0].rotation.c), std::cos(0.5), 1e-7);
    EXPECT_NEAR(static_cast<double>(scene->bodies[0].rotation.s), std::sin(0.5), 1e-7);
}

TEST(SceneFile, NumbersAreReadAsTheNearestFloat) {
    const auto friction = [](const std::string& text) {
        const auto scene =
            readScene(bytesOf(withShape(circle + R"(, "material": {"friction": )" + text + "}")));
        return scene ? scene->bodies[0].shapes[0].material.friction : -1.0f;
    };
    EXPECT_EQ(friction("0.1"), 0.1f);
    EXPECT_EQ(friction("1"), 1.0f);
    EXPECT_EQ(friction("1e1"), 10.0f);
    EXPECT_EQ(friction("2.5E-3"), 2.5e-3f);
    EXPECT_EQ(friction("1e-45"), 1.0e-45f);
    EXPECT_EQ(friction("1e-60"), 0.0f);
    // 1 + 2^-24, the midpoint of two floats, and a shade above it that a double cannot hold.
    EXPECT_EQ(friction("1.000000059604644775390625"), 1.0f);
    EXPECT_EQ(friction("1.0000000596046447753906250001"), std::nextafter(1.0f, 2.0f));
}

struct BadDocument {
    std::string document;
    std::string sentence;
};

TEST(SceneFile, BadDocumentsAreRefusedWithTheirPath) {
    const std::vector<BadDocument> table{
        {"[]", "a scene must be an object, this is a list"},
        {"3", "a scene must be an object, this is a number"},
        {"{}", "version: is missing; this program reads version 1"},
        {R"({"version": 2})", "version: is 2, this program reads version 1"},
        {R"({"version": "1"})", "version: must be a number, is a text"},
        {R"({"version": 1.5})", "version: must be a whole number from 0 to 4294967295, is 1.5"},
        {R"({"version": 1, "substeps": -4})",
         "substeps: must be a whole number from 0 to 4294967295, is -4"},
        {R"({"version": 1, "substeps": 4294967296})",
         "substeps: must be a whole number from 0 to 4294967295, is 4294967296"},
        {R"({"version": 1, "version": 1})", "version: stands here twice"},
        {withBody(R"("position": {"x": 1, "y": 2, "x": 3})"),
         "bodies[0].position.x: stands here twice"},
        {R"({"version": 1, "colour": "red"})",
         "colour: no such field; there are version, name, gravity, stepSeconds, substeps, sleep, "
         "bodies, joints, players, limits, counters, method, need, rules"},
        {R"({"version": 1, "rules": {"name": "Ball"}})",
         "rules.name: must be 1 to 32 of a-z, 0-9, _, -"},
        {R"({"version": 1, "rules": {"version": 1}})", "rules.name: is missing"},
        {R"({"version": 1, "rules": {"name": "a", "parameters": [{"name": "b", "value": 1},
             {"name": "a", "value": 1}]}})",
         "rules.parameters[1].name: must come after the one before it, letter by letter"},
        {R"({"version": 1, "rules": {"name": "a", "parameters": [{"name": "", "value": 1}]}})",
         "rules.parameters[0].name: must be 1 to 32 of a-z, A-Z, 0-9, _, -"},
        {withBody(R"("position": {"x": 1, "y": 2, "z": 3})"),
         "bodies[0].position.z: no such field; there are x, y"},
        {withBody(R"("position": {"x": 1})"), "bodies[0].position.y: is missing"},
        {withBody(R"("position": [1, 2])"), "bodies[0].position: must be an object, is a list"},
        {withBody(R"("position": {"x": 1e999, "y": 2})"),
         "bodies[0].position.x: 1e999 is not a finite number"},
        {withBody(R"("position": {"x": 1e39, "y": 2})"),
         "bodies[0].position.x: 1e39 is beyond the range of 32-bit floats"},
        {withBody(R"("position": {"x": "NaN", "y": 2})"),
         "bodies[0].position.x: must be a number, is a text"},
        {withBody(R"("position": {"x": null, "y": 2})"),
         "bodies[0].position.x: must be a number, is null"},
        {withBody(R"("type": "soft")"),
         "bodies[0].type: \"soft\" is none of static, kinematic, dynamic"},
        {withBody(R"("asleep": 1)"), "bodies[0].asleep: must be true or false, is a number"},
        {withBody(R"("rotation": {"angle": 1, "c": 1})"),
         "bodies[0].rotation: has both an angle and c or s"},
        {withBody(R"("rotation": {"angle": 1e7})"),
         "bodies[0].rotation.angle: must be within 1000000 of 0"},
        {withBody(R"("rotation": {"c": 1})"), "bodies[0].rotation.s: is missing"},
        {withBody(R"("rotation": {"c": 1, "s": 0, "t": 0})"),
         "bodies[0].rotation.t: no such field; there are c, s, angle"},
        {withShape(R"("kind": "circle")"), "bodies[0].shapes[0].vertices: is missing"},
        {withShape(R"("vertices": [])"), "bodies[0].shapes[0].kind: is missing"},
        {withShape(R"("kind": "blob", "vertices": [])"),
         "bodies[0].shapes[0].kind: \"blob\" is none of circle, capsule, polygon, segment, "
         "chainSegment"},
        {withShape(R"("kind": "polygon", "vertices": [0,0,0,0,0,0,0,0,0])"),
         "bodies[0].shapes[0].vertices: 9 are more than 8"},
        {withShape(R"("kind": "polygon", "vertices": [{"x": 0, "y": 0}, 7])"),
         "bodies[0].shapes[0].vertices[1]: must be an object, is a number"},
        {withShape(
             R"("kind": "polygon", "vertices": [{"x":0,"y":0},{"x":1,"y":0},{"x":false,"y":1}])"),
         "bodies[0].shapes[0].vertices[2].x: must be a number, is true or false"},
        {withShape(circle + R"(, "filter": {"group": 2147483648})"),
         "bodies[0].shapes[0].filter.group: must be a whole number from -2147483648 to "
         "2147483647, is 2147483648"},
        {withTwoAndJoint(R"("bodyA": 0, "bodyB": 1)"), "joints[0].kind: is missing"},
        {withTwoAndJoint(R"("kind": "revolute", "bodyA": 0)"), "joints[0].bodyB: is missing"},
        {withTwoAndJoint(R"("kind": "revolute", "bodyA": 0, "bodyB": 1, "motor": {"torque": 1})"),
         "joints[0].motor.torque: no such field; there are enabled, speed, maxEffort"},
        {R"({"version": 1, "players": {"body": 3}})",
         "players.body: must be an object, is a number"},
        {R"({"version": 1, "players": {"spawnPoints": [{"x": 0, "y": 0}, {"x": 0}]}})",
         "players.spawnPoints[1].y: is missing"},
        {R"({"version": 1, "name": "a\u0000b"})", "name: must be text without control characters"},
        {"", "the file is empty"},
    };
    for (const BadDocument& bad : table) EXPECT_EQ(refusalOf(bad.document), bad.sentence);
}

TEST(SceneFile, WhatCoreRefusesIsRefusedWithItsPath) {
    // The sentences are core's own; here it counts that the path is the document's.
    const std::vector<BadDocument> table{
        {withShape(
             R"("kind": "polygon", "vertices": [{"x":0,"y":0},{"x":2,"y":0},{"x":0.5,"y":0.5},{"x":0,"y":2}])"),
         "bodies[0].shapes[0].vertices"},
        {withShape(circle + R"(, "radius": -1)"), "bodies[0].shapes[0].radius: "},
        {withShape(circle + R"(, "material": {"restitution": 1.5})"),
         "bodies[0].shapes[0].material.restitution: "},
        {withTwoAndJoint(R"("kind": "revolute", "bodyA": 0, "bodyB": 2)"), "joints[0].bodyB: "},
        {withBody(R"("rotation": {"c": 1, "s": 1})"), "bodies[0].rotation: "},
        {R"({"version": 1, "stepSeconds": 0})", "stepSeconds: "},
        {R"({"version": 1, "substeps": 65})", "substeps: "},
    };
    for (const BadDocument& bad : table) {
        const std::string refusal = refusalOf(bad.document);
        EXPECT_EQ(refusal.rfind(bad.sentence, 0), 0u) << bad.document << "\n" << refusal;
    }
}

TEST(SceneFile, WhatIsNotJsonIsRefusedWithLineAndColumn) {
    const auto startsWith = [](const std::string& document, const std::string& start) {
        const std::string refusal = refusalOf(document);
        EXPECT_EQ(refusal.rfind(start, 0), 0u) << refusal;
        EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
    };
    startsWith("{\n  \"version\": 1,\n  \"name\": oops\n}", "line 3, column 11: syntax error");
    startsWith("{\"version\": 1", "line 1, column 14: syntax error");
    startsWith("{\"version\": 1} x", "line 1, column 16: syntax error");
    startsWith("{\"version\": 01}", "line 1, column 14: syntax error");
    startsWith("{\"version\": NaN}", "line 1, column 13: syntax error");
    startsWith("// comment\n{\"version\": 1}", "line 1, column 1: syntax error");
    startsWith("{\"version\": 1, \"name\": \"\xff\"}", "line 1, column 25: syntax error");
    startsWith("\xff", "line 1, column 1: ");
}

TEST(SceneFile, CapsOfADocumentAreKept) {
    std::string deep = R"({"version": 1, "bodies": )";
    deep += std::string(15, '[') + std::string(15, ']') + "}";
    EXPECT_EQ(refusalOf(deep), "bodies[0]: must be an object, is a list");
    deep = R"({"version": 1, "bodies": )" + std::string(16, '[') + std::string(16, ']') + "}";
    EXPECT_EQ(refusalOf(deep),
              "bodies[0][0][0][0][0][0][0][0][0][0][0][0][0][0][0]: nested deeper "
              "than 16 levels");
    deep = std::string(1'000'000, '[');
    EXPECT_NE(refusalOf(deep).find("nested deeper than 16 levels"), std::string::npos);
    std::string wide = R"({"version": 1)";
    for (int i = 0; i < 64; ++i) wide += ", \"f" + std::to_string(i) + "\": 0";
    EXPECT_EQ(refusalOf(wide + "}"), "the object has more than 64 fields");
    std::string many = R"({"version": 1, "bodies": [0)";
    for (std::size_t i = 0; i < maxJsonValues; ++i) many += ",0";
    const std::string refusal = refusalOf(many + "]}");
    EXPECT_NE(refusal.find("the document has more than 4194304 values"), std::string::npos)
        << refusal;
    const std::string large(maxSceneFileBytes + 1, ' ');
    EXPECT_EQ(refusalOf(large), "the file has 67108865 bytes, at most 67108864 are read");
}

TEST(SceneFile, EveryFlippedBitOfABinaryFileIsRefused) {
    auto file = writeSceneBinary(fullScene());
    for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
        file[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
        ASSERT_FALSE(readScene(file).ok()) << "bit " << bit;
        file[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    }
    for (std::size_t size = 0; size < file.size(); ++size) {
        ASSERT_FALSE(readScene(std::span(file).first(size)).ok()) << size;
    }
}

TEST(SceneFile, ABinaryFileMeetsTheSameCheckAsText) {
    Scene scene = fullScene();
    scene.bodies[1].shapes[0].vertices[2].x = std::nanf("");
    EXPECT_EQ(readScene(writeSceneBinary(scene)).error().message,
              "bodies[1].shapes[0].vertices[2].x: not a finite number");
    scene = fullScene();
    scene.joints[0].bodyB = 17;
    EXPECT_EQ(readScene(writeSceneBinary(scene)).error().message.rfind("joints[0].bodyB: ", 0), 0u);
    auto file = writeSceneBinary(fullScene());
    file[8] = std::byte{2};
    EXPECT_EQ(readScene(file).error().message, "version: is 2, this program reads version 1");
}

}  // namespace
}  // namespace huestep::protocol
