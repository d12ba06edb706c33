#include "core/scene/catalog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace huestep {
namespace {

Scene sceneOf(const std::string& text) {
    Result<Scene> scene = sceneFromCatalog(text);
    EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
    return scene.ok() ? *scene : Scene{};
}

std::size_t countOf(const Scene& scene, BodyType type) {
    return static_cast<std::size_t>(
        std::count_if(scene.bodies.begin(), scene.bodies.end(),
                      [&](const BodyDef& body) { return body.type == type; }));
}

std::string sentenceFor(const std::string& text) {
    const Result<Scene> scene = sceneFromCatalog(text);
    return scene.ok() ? "no error" : scene.error().message;
}

TEST(Catalog, EverySceneIsValidAtItsStandardLowestAndHighestValues) {
    for (const CatalogEntry& entry : sceneCatalog()) {
        std::vector<double> standard, low, high;
        for (const SceneParameter& parameter : entry.parameters) {
            standard.push_back(parameter.standard);
            low.push_back(parameter.low);
            high.push_back(parameter.high);
        }
        for (const auto& values : {standard, low, high}) {
            const Status status = check(entry.build(values));
            EXPECT_TRUE(status.ok())
                << entry.name << ": " << (status.ok() ? "" : status.error().message);
        }
    }
}

TEST(Catalog, IsSortedByNameAndEveryEntrySaysWhatItIsFor) {
    const auto catalog = sceneCatalog();
    EXPECT_TRUE(std::is_sorted(catalog.begin(), catalog.end(),
                               [](const auto& a, const auto& b) { return a.name < b.name; }));
    for (const CatalogEntry& entry : catalog) {
        EXPECT_FALSE(entry.purpose.empty()) << entry.name;
        EXPECT_GT(entry.ticks, 0u) << entry.name;
        for (const SceneParameter& parameter : entry.parameters) {
            EXPECT_LE(parameter.low, parameter.standard) << entry.name;
            EXPECT_LE(parameter.standard, parameter.high) << entry.name;
            EXPECT_FALSE(parameter.meaning.empty()) << entry.name;
        }
    }
}

// The counts below are those of the table of the performance page.
TEST(Catalog, PyramidHas5050BoxesOnAGroundAndNeverSleeps) {
    const Scene scene = sceneOf("pyramid");
    EXPECT_EQ(countOf(scene, BodyType::Dynamic), 5050u);
    EXPECT_EQ(countOf(scene, BodyType::Static), 1u);
    EXPECT_TRUE(scene.joints.empty());
    EXPECT_FALSE(scene.sleep);
    const BodyDef& last = scene.bodies.back();
    EXPECT_EQ(last.position, (Vec2{0.0f, 99.5f})) << "the top box stands on the axis";
    EXPECT_EQ(sceneOf("pyramid:base=100"), [&] {
        Scene same = scene;
        same.name = "pyramid:base=100";
        return same;
    }());
}

TEST(Catalog, ManyPyramidsHas22000BoxesAndASegmentARow) {
    const Scene scene = sceneOf("many_pyramids");
    EXPECT_EQ(countOf(scene, BodyType::Dynamic), 22'000u);
    ASSERT_EQ(countOf(scene, BodyType::Static), 1u);
    ASSERT_EQ(scene.bodies[0].shapes.size(), 20u);
    const ShapeDef& second = scene.bodies[0].shapes[1];
    EXPECT_EQ(second.kind, ShapeKind::Segment);
    EXPECT_EQ(second.vertices[0], (Vec2{-110.0f, 11.0f}));
    EXPECT_EQ(second.vertices[1], (Vec2{110.0f, 11.0f}));
    EXPECT_FALSE(scene.sleep);
    EXPECT_EQ(sceneOf("many_pyramids:base=3,rows=2,columns=5").bodies.size(), 2u * 5u * 6u + 1u);
}

TEST(Catalog, JointGridHas10000DiscsOfWhichSevenAreHeldAnd19800Revolutes) {
    const Scene scene = sceneOf("joint_grid");
    EXPECT_EQ(scene.bodies.size(), 10'000u);
    EXPECT_EQ(countOf(scene, BodyType::Static), 7u);
    EXPECT_EQ(scene.joints.size(), 19'800u);
    const Filter& filter = scene.bodies[0].shapes[0].filter;
    EXPECT_FALSE(mayTouch(filter, filter));
    for (const JointDef& joint : scene.joints) {
        EXPECT_EQ(scene.bodies[joint.bodyA].position + joint.anchorA,
                  scene.bodies[joint.bodyB].position + joint.anchorB);
    }
}

TEST(Catalog, TumblerHas2025BoxesInsideADrivenDrum) {
    const Scene scene = sceneOf("tumbler");
    EXPECT_EQ(countOf(scene, BodyType::Dynamic), 2026u);
    EXPECT_EQ(countOf(scene, BodyType::Static), 1u);
    ASSERT_EQ(scene.joints.size(), 1u);
    const MotorDef& motor = scene.joints[0].motor;
    EXPECT_TRUE(motor.enabled);
    EXPECT_FLOAT_EQ(motor.speed, 0.43633231f);
    EXPECT_FLOAT_EQ(motor.maxEffort, 1e8f);
    EXPECT_EQ(scene.bodies[1].shapes.size(), 4u);
    for (std::size_t i = 2; i < scene.bodies.size(); ++i) {
        const Vec2 p = scene.bodies[i].position - scene.bodies[1].position;
        EXPECT_LT(std::max(std::abs(p.x), std::abs(p.y)), 9.5f - 0.125f) << i;
    }
}

TEST(Catalog, SmashHas9600SleepingBoxesThatTouchAndABoxThatFliesAtThem) {
    const Scene scene = sceneOf("smash");
    EXPECT_EQ(scene.gravity, Vec2{});
    ASSERT_EQ(countOf(scene, BodyType::Dynamic), 9'601u);
    EXPECT_EQ(scene.bodies.size(), 9'601u);
    const BodyDef& ram = scene.bodies[0];
    EXPECT_EQ(ram.position, (Vec2{-20.0f, 0.0f}));
    EXPECT_EQ(ram.velocity, (Vec2{40.0f, 0.0f}));
    EXPECT_EQ(ram.shapes[0].vertices[2], (Vec2{4.0f, 4.0f}));
    EXPECT_EQ(ram.shapes[0].density, 8.0f);
    for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
        const auto column = static_cast<double>((i - 1) / 80);
        const auto row = static_cast<double>((i - 1) % 80);
        EXPECT_TRUE(scene.bodies[i].asleep);
        EXPECT_NEAR(static_cast<double>(scene.bodies[i].position.x), 30.0 + 0.4 * column, 1e-5);
        EXPECT_NEAR(static_cast<double>(scene.bodies[i].position.y), 0.4 * row - 16.0, 1e-5);
    }
}

TEST(Catalog, CompoundsHas3000BodiesOfTwoTrianglesAboveATrough) {
    const Scene scene = sceneOf("compounds");
    EXPECT_EQ(countOf(scene, BodyType::Dynamic), 3'000u);
    std::size_t ground = 0;
    for (const BodyDef& body : scene.bodies) {
        if (body.type == BodyType::Static) {
            ground += body.shapes.size();
            continue;
        }
        ASSERT_EQ(body.shapes.size(), 2u);
        EXPECT_LT(std::abs(body.position.x), 20.0f) << "well between the walls";
        for (const ShapeDef& triangle : body.shapes) {
            EXPECT_EQ(triangle.vertexCount, 3);
            EXPECT_EQ(triangle.material.friction, 0.5f);
        }
    }
    EXPECT_EQ(ground, 81u + 2u * 100u + 1u) << "floor, walls, and a segment far below";
    const BodyDef& last = scene.bodies.back();
    EXPECT_NEAR(last.position.x, 18.75f, 1e-5f);
    EXPECT_NEAR(last.position.y, 149 * 2.25f + 5.575f, 1e-4f);
}

TEST(Catalog, WasherHas8100BoxesInsideARingOf36PiecesWithFourPaddles) {
    const Scene scene = sceneOf("washer");
    EXPECT_EQ(countOf(scene, BodyType::Dynamic), 8'100u);
    ASSERT_EQ(countOf(scene, BodyType::Kinematic), 1u);
    const BodyDef& ring = scene.bodies[0];
    EXPECT_EQ(ring.velocity, (Vec2{0.001f, -0.002f}));
    EXPECT_FLOAT_EQ(ring.angularVelocity, 0.43633231f);
    ASSERT_EQ(ring.shapes.size(), 40u);
    std::size_t paddles = 0;
    for (const ShapeDef& piece : ring.shapes) {
        float least = 1e9f;
        for (std::size_t v = 0; v < 4; ++v) least = std::min(least, length(piece.vertices[v]));
        if (least < 15.0f) ++paddles;
        EXPECT_NEAR(least, least < 15.0f ? 14.0f : 16.0f, 1e-5f);
        EXPECT_NEAR(length(piece.vertices[1]), least + 2.0f, 1e-5f);
    }
    EXPECT_EQ(paddles, 4u);
    for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
        EXPECT_LT(length(scene.bodies[i].position - ring.position), 14.0f + 0.1f) << i;
    }
}

TEST(Catalog, SpinnerHas6076BodiesOfThreeKindsAndABarInARoundRoom) {
    const Scene scene = sceneOf("spinner");
    ASSERT_EQ(scene.bodies.size(), 6'078u);
    const BodyDef& room = scene.bodies[0];
    ASSERT_EQ(room.shapes.size(), 360u);
    const Vec2 middle{0.0f, 32.0f};
    for (const ShapeDef& side : room.shapes) {
        ASSERT_EQ(side.kind, ShapeKind::ChainSegment);
        EXPECT_EQ(side.material.friction, 0.1f);
        EXPECT_NEAR(length(side.vertices[1] - middle), 40.0f, 1e-5f);
        EXPECT_LT(cross(side.vertices[1] - middle, side.vertices[2] - middle), 0.0f)
            << "clockwise: it touches what is inside";
    }
    const BodyDef& bar = scene.bodies[1];
    EXPECT_EQ(bar.position, (Vec2{0.0f, 12.0f}));
    EXPECT_EQ(bar.shapes[0].vertices[2], (Vec2{0.4f, 20.0f}));
    EXPECT_EQ(bar.shapes[0].radius, 0.2f);
    ASSERT_EQ(scene.joints.size(), 1u);
    EXPECT_EQ(scene.joints[0].motor, (MotorDef{true, 5.0f, 1e12f}));
    EXPECT_FALSE(scene.joints[0].collideConnected) << "the bar reaches through the room's floor";
    const std::array<std::uint8_t, 3> vertices{2, 1, 4};
    for (std::size_t i = 2; i < scene.bodies.size(); ++i) {
        const BodyDef& body = scene.bodies[i];
        EXPECT_EQ(body.shapes[0].vertexCount, vertices[(i - 2) % 3]) << i;
        EXPECT_EQ(body.shapes[0].density, 0.25f);
        EXPECT_EQ(body.shapes[0].material, (Material{0.1f, 0.1f}));
        EXPECT_LT(length(body.position - middle), 39.0f);
    }
    EXPECT_EQ(scene.bodies[2].position, (Vec2{-23.0f, 2.0f}));
    EXPECT_EQ(scene.bodies[2 + 91].position, (Vec2{22.5f, 2.0f}));
    EXPECT_EQ(scene.bodies.back().position, (Vec2{-21.5f, 35.0f}));
    const Scene largest = sceneOf("spinner:bodies=11000");
    for (std::size_t i = 1; i < largest.bodies.size(); ++i) {
        EXPECT_LT(length(largest.bodies[i].position - middle), 39.0f) << i;
    }
}

TEST(Catalog, JunkyardHas8000PiecesOfFiveCornersInATroughWithAPusher) {
    const Scene scene = sceneOf("junkyard");
    EXPECT_EQ(countOf(scene, BodyType::Dynamic), 8'000u);
    ASSERT_EQ(countOf(scene, BodyType::Kinematic), 1u);
    ASSERT_EQ(scene.bodies[0].type, BodyType::Kinematic);
    EXPECT_EQ(scene.bodies[0].shapes[0].vertices[0], (Vec2{-2.0f, 0.0f}));
    EXPECT_EQ(scene.bodies[0].shapes[0].vertices[2], (Vec2{2.0f, 8.0f}));
    std::size_t ground = 0;
    for (const BodyDef& body : scene.bodies) {
        if (body.type == BodyType::Static) ground += body.shapes.size();
        if (body.type != BodyType::Dynamic) continue;
        const ShapeDef& piece = body.shapes[0];
        ASSERT_EQ(piece.vertexCount, 5);
        for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(length(piece.vertices[i]), 0.25f, 1e-6f);
        EXPECT_LT(std::abs(body.position.x), 79.0f) << "between the walls";
    }
    EXPECT_EQ(ground, 161u + 2u * 50u);
    EXPECT_NEAR(scene.bodies.back().position.x, 0.75f * 99.0f + 0.1f, 1e-4f);
    EXPECT_NEAR(scene.bodies.back().position.y, 15.0f + 39.0f, 1e-4f);
}

TEST(Catalog, RainHasFiveFloorsOf501BoxesAndNobodyYet) {
    const Scene scene = sceneOf("rain");
    EXPECT_EQ(countOf(scene, BodyType::Dynamic), 0u);
    std::size_t boxes = 0;
    float highest = 0.0f;
    for (const BodyDef& body : scene.bodies) {
        boxes += body.shapes.size();
        for (const ShapeDef& box : body.shapes) {
            highest = std::max(highest, box.vertices[2].y);
            EXPECT_LE(std::abs(box.vertices[2].x), 125.25f);
        }
    }
    EXPECT_EQ(boxes, 5u * 501u);
    EXPECT_EQ(highest, 4.0f * 45.0f + 0.25f);
}

TEST(Catalog, SmallHasThreeColumnsOf40BoxesAndADisc) {
    const Scene scene = sceneOf("small");
    EXPECT_EQ(countOf(scene, BodyType::Dynamic), 41u);
    EXPECT_EQ(scene.bodies.back().shapes[0].kind, ShapeKind::Circle);
    EXPECT_TRUE(scene.sleep);
    EXPECT_FALSE(sceneOf("small:sleep=0").sleep);
}

TEST(Catalog, ChainHasTenLinksOfOneKilogramAndABallOfTheRatio) {
    const Scene scene = sceneOf("chain:ratio=1000,angle=90");
    ASSERT_EQ(scene.bodies.size(), 12u);
    ASSERT_EQ(scene.joints.size(), 11u);
    for (std::size_t i = 1; i <= 10; ++i) {
        const ShapeDef& bar = scene.bodies[i].shapes[0];
        const Vec2 size = bar.vertices[2] - bar.vertices[0];
        EXPECT_NEAR(size.x * size.y * bar.density, 1.0f, 1e-6f);
    }
    const ShapeDef& ball = scene.bodies[11].shapes[0];
    EXPECT_NEAR(ball.density * 3.14159265f * ball.radius * ball.radius, 1000.0f, 1e-2f);
    EXPECT_NEAR(scene.bodies[11].position.x, 5.6f, 1e-4f) << "5 m of links and the ball's radius";
    EXPECT_NEAR(scene.bodies[11].position.y, 0.0f, 1e-4f);
}

TEST(Catalog, SandboxGivesPlayersABodyAndRoomToAppear) {
    const Scene scene = sceneOf("sandbox");
    ASSERT_TRUE(scene.players.has_value());
    ASSERT_TRUE(scene.players->body.has_value());
    EXPECT_GE(scene.players->spawnPoints.size(), 5u);
    for (const Vec2 point : scene.players->spawnPoints) {
        for (const BodyDef& body : scene.bodies) {
            if (body.type != BodyType::Dynamic) continue;
            EXPECT_GT(length(body.position - point), 1.0f);
        }
        EXPECT_LT(std::abs(point.x), 19.0f);
        EXPECT_GT(point.y, 1.0f);
        EXPECT_LT(point.y, 23.0f);
    }
    EXPECT_NEAR(static_cast<double>(scene.bodies.size()), 150.0, 20.0);
}

TEST(Catalog, MixedTouchesEveryFeature) {
    const Scene scene = sceneOf("mixed");
    std::array<bool, 4> shapes{};
    std::array<bool, 3> joints{}, types{};
    bool spring = false, limit = false, motor = false, connected = false, asleep = false;
    bool damped = false, scaled = false, fixed = false, restless = false, compound = false;
    bool rolling = false, belt = false, grouped = false, masked = false, givenId = false;
    for (const BodyDef& body : scene.bodies) {
        types[static_cast<std::size_t>(body.type)] = true;
        asleep |= body.asleep;
        damped |= body.linearDamping > 0.0f && body.angularDamping > 0.0f;
        scaled |= body.gravityScale != 1.0f;
        fixed |= body.fixedRotation;
        restless |= !body.maySleep;
        compound |= body.type == BodyType::Dynamic && body.shapes.size() > 1;
        givenId |= body.id != 0;
        for (const ShapeDef& shape : body.shapes) {
            shapes[static_cast<std::size_t>(shape.kind)] = true;
            rolling |= shape.material.rollingResistance > 0.0f;
            belt |= shape.material.tangentSpeed != 0.0f;
            grouped |= shape.filter.group != 0;
            masked |= shape.filter.mask != ~0u;
        }
    }
    for (const JointDef& joint : scene.joints) {
        joints[static_cast<std::size_t>(joint.kind)] = true;
        spring |= joint.spring.enabled;
        limit |= joint.limit.enabled;
        motor |= joint.motor.enabled;
        connected |= joint.collideConnected;
    }
    for (const bool has : shapes) EXPECT_TRUE(has);
    for (const bool has : joints) EXPECT_TRUE(has);
    for (const bool has : types) EXPECT_TRUE(has);
    EXPECT_TRUE(spring && limit && motor && connected);
    EXPECT_TRUE(asleep && damped && scaled && fixed && restless && compound && givenId);
    EXPECT_TRUE(rolling && belt && grouped && masked);
    EXPECT_TRUE(scene.players.has_value());
}

TEST(Catalog, ReadsParametersInAnyOrderAndFractionsWhereTheyMakeSense) {
    EXPECT_EQ(sceneOf("pendulum:angle=22.5").bodies.size(), 2u);
    const Scene a = sceneOf("hinges:rows=3,columns=2");
    const Scene b = sceneOf("hinges:columns=2,rows=3");
    EXPECT_EQ(a.bodies, b.bodies);
    EXPECT_EQ(a.joints, b.joints);
    EXPECT_EQ(a.name, "hinges:rows=3,columns=2");
}

TEST(Catalog, NamesWhatIsWrongAndWhatThereIsInstead) {
    std::string names;
    for (const CatalogEntry& entry : sceneCatalog()) {
        names += (names.empty() ? "" : ", ") + std::string(entry.name);
    }
    EXPECT_EQ(sentenceFor("pyrmaid"), "there is no scene 'pyrmaid'; there are " + names);
    EXPECT_NE(names.find("pendulum, pyramid, "), std::string::npos);
    EXPECT_EQ(sentenceFor("many_pyramids:bse=1"),
              "many_pyramids has no parameter 'bse'; it has rows, columns, base, and as every "
              "scene has seed, turn, far, hz");
    EXPECT_EQ(sentenceFor("mixed:base=1"),
              "mixed has no parameter 'base'; it has those of every scene: seed, turn, far, hz");
    EXPECT_EQ(sentenceFor("pyramid:base"), "pyramid: base needs a value, as in base=100");
    EXPECT_EQ(sentenceFor("pyramid:base=0"),
              "pyramid: base must be a whole number from 1 to 450, is 0");
    EXPECT_EQ(sentenceFor("pyramid:base=2.5"),
              "pyramid: base must be a whole number from 1 to 450, is 2.5");
    EXPECT_EQ(sentenceFor("chain:ratio=nan"),
              "chain: ratio must be a number from 1 to 1e+06, is nan");
    EXPECT_EQ(sentenceFor("pyramid:base=1e999"), "pyramid: base: '1e999' is not a number");
    EXPECT_EQ(sentenceFor("pyramid:base=12x"), "pyramid: base: '12x' is not a number");
    EXPECT_EQ(sentenceFor("pyramid:base="), "pyramid: base: '' is not a number");
    EXPECT_EQ(sentenceFor("pyramid:base=3,base=4"), "pyramid: base is given twice");
    EXPECT_EQ(sentenceFor("pyramid:"),
              "pyramid: nothing stands after the colon; it has base, and as every scene has seed, "
              "turn, far, hz");
    EXPECT_EQ(sentenceFor("pyramid:base=3,"), "pyramid: nothing stands after the last comma");
    EXPECT_EQ(sentenceFor(std::string(100, 'q')).substr(0, 65),
              "there is no scene '" + std::string(40, 'q') + "...'; ");
    EXPECT_EQ(sentenceFor("pyramid:base=" + std::string(300, '0') + "3"),
              "a scene's name and parameters take at most 256 characters");
}

TEST(Catalog, FindsTheEntryThatATextNamesParametersAside) {
    ASSERT_NE(findInCatalog("pyramid:base=7"), nullptr);
    EXPECT_EQ(findInCatalog("pyramid:base=7")->name, "pyramid");
    EXPECT_EQ(findInCatalog("pyramid:base=7")->ticks, 500u);
    EXPECT_EQ(findInCatalog("pyramids"), nullptr);
    EXPECT_EQ(findInCatalog(""), nullptr);
}

}  // namespace
}  // namespace huestep
