// The one door: every action applied once, every reason for a rejection reached.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

constexpr BodyId groundId = 1, boxId = 2, discId = 3, fanId = 4;
constexpr JointId motorId = 1, plainId = 2;

/// A ground, a box on a motor, a disc on a plain hinge, a kinematic fan; players have a body.
Scene playground() {
    BodyDef fan = bodyAt(BodyType::Kinematic, {20.0f, 5.0f}, ShapeDef::box(1.0f, 0.1f));
    Scene scene = sceneOf({ground(), boxAt({0.0f, 3.0f}), discAt({4.0f, 3.0f}), fan},
                          {hinge(0, {0.0f, 4.0f}, 1, {}), hinge(0, {4.0f, 4.0f}, 2, {})});
    scene.joints[0].motor = {true, 1.0f, 50.0f};
    PlayerDef players;
    players.body = discAt({}, 0.4f);
    players.spawnPoints = {{-10.0f, 5.0f}, {-12.0f, 6.0f}};
    players.maxSpawned = 3;
    players.maxImpulse = 10.0f;
    players.maxForce = 100.0f;
    scene.players = players;
    scene.limits.players = 3;
    scene.limits.bodies = 12;
    scene.limits.joints = 4;
    scene.limits.commandsPerTick = 6;
    return scene;
}

/// Feeds commands with rising sequences and gives back what became of them.
class Desk {
 public:
    explicit Desk(const Scene& scene) : world(worldOf(scene)) {}

    CommandOutcome say(PlayerId author, Action action) {
        world.step(std::vector<Command>{{author, ++m_sequence, std::move(action)}});
        EXPECT_EQ(world.events().commands.size(), 1u);
        return world.events().commands.front();
    }
    Rejection ask(PlayerId author, Action action) { return say(author, std::move(action)).reason; }
    BodyId join(PlayerId player) {
        const CommandOutcome outcome = say(0, AddPlayer{player});
        EXPECT_EQ(outcome.reason, Rejection::None);
        return outcome.firstBody;
    }
    [[nodiscard]] std::uint64_t sequence() const { return m_sequence; }
    [[nodiscard]] const PlayerRecord* player(PlayerId id) const {
        for (const PlayerRecord& p : world.players()) {
            if (p.id == id) return &p;
        }
        return nullptr;
    }

    World world;

 private:
    std::uint64_t m_sequence = 0;
};

TEST(Commands, APlayerWhoJoinsGetsARecordAndABodyAtTheNextSpawnPoint) {
    Desk desk(playground());
    const BodyId first = desk.join(7);
    ASSERT_NE(first, 0u);
    EXPECT_NEAR(wide(motionOf(desk.world, first).position.x), -10.0, 1e-6);
    const BodyId second = desk.join(2);
    EXPECT_NEAR(wide(motionOf(desk.world, second).position.x), -12.0, 1e-6);
    const BodyId third = desk.join(5);
    EXPECT_NEAR(wide(motionOf(desk.world, third).position.x), -10.0, 1e-6) << "round and round";
    ASSERT_EQ(desk.world.players().size(), 4u);
    const std::array<PlayerId, 4> ids{0, 2, 5, 7};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(desk.world.players()[i].id, ids[i]);
    EXPECT_EQ(desk.player(7)->body, first);
    EXPECT_EQ(desk.world.bodies()[*desk.world.find(first)].owner, 7u);
}

TEST(Commands, APlayerWhoLeavesTakesItsBodiesAndItsGrabAlong) {
    Desk desk(playground());
    const BodyId own = desk.join(1);
    const BodyId thrown = desk.say(1, Spawn{{boxAt({-10.0f, 9.0f})}, {}}).firstBody;
    ASSERT_TRUE(desk.world.find(thrown));
    ASSERT_EQ(desk.ask(1, Grab{boxId, {0.0f, 3.0f}, {1.0f, 4.0f}}), Rejection::None);
    ASSERT_EQ(desk.world.joints().size(), 3u);
    EXPECT_EQ(desk.ask(0, RemovePlayer{1}), Rejection::None);
    EXPECT_FALSE(desk.world.find(own));
    EXPECT_FALSE(desk.world.find(thrown));
    EXPECT_EQ(desk.world.joints().size(), 2u);
    EXPECT_EQ(desk.world.players().size(), 1u);
    EXPECT_EQ(desk.world.bodies().size(), 4u);
}

TEST(Commands, AnImpulseChangesMomentumByItselfAndSpinByItsMoment) {
    Scene scene = sceneOf({boxAt({2.0f, 1.0f})});
    scene.gravity = {};
    Desk desk(scene);
    const BodyInfo info = desk.world.bodies()[0];
    ASSERT_EQ(desk.ask(0, ApplyImpulse{1, {3.0f, 4.0f}, {2.0f, 1.5f}}), Rejection::None);
    const BodyMotion& m = desk.world.motions()[0];
    EXPECT_NEAR(wide(m.velocity.x), 3.0 / wide(info.mass), 1e-6);
    EXPECT_NEAR(wide(m.velocity.y), 4.0 / wide(info.mass), 1e-6);
    EXPECT_NEAR(wide(m.angularVelocity), (0.0 * 4.0 - 0.5 * 3.0) / wide(info.inertia), 1e-5);
}

TEST(Commands, AGrabDrawsTheBodyToItsTargetAndAReleaseLetsItFall) {
    Desk desk(playground());
    desk.join(1);
    const BodyId mine = desk.say(1, Spawn{{discAt({-20.0f, 1.0f}, 0.3f)}, {}}).firstBody;
    const Vec2 at = motionOf(desk.world, mine).position;
    ASSERT_EQ(desk.ask(1, Grab{mine, at, {-18.0f, 4.0f}}), Rejection::None);
    EXPECT_NE(desk.player(1)->grab, 0u);
    run(desk.world, 180);
    EXPECT_LT(length(motionOf(desk.world, mine).position - Vec2{-18.0f, 4.0f}), 0.05f);
    ASSERT_EQ(desk.ask(1, MoveGrab{{-18.0f, 6.0f}}), Rejection::None);
    run(desk.world, 180);
    EXPECT_LT(length(motionOf(desk.world, mine).position - Vec2{-18.0f, 6.0f}), 0.05f);
    const JointId held = desk.player(1)->grab;
    ASSERT_EQ(desk.ask(1, Grab{mine, at, {-18.0f, 5.0f}}), Rejection::None);
    EXPECT_EQ(desk.player(1)->grab, held) << "a second grab of the same body moves the target";
    ASSERT_EQ(desk.ask(1, Grab{discId, {4.0f, 3.0f}, {4.0f, 5.0f}}), Rejection::None);
    EXPECT_NE(desk.player(1)->grab, held) << "a grab of another body lets the first go";
    EXPECT_EQ(desk.world.joints().size(), 3u);
    ASSERT_EQ(desk.ask(1, Release{}), Rejection::None);
    EXPECT_EQ(desk.player(1)->grab, 0u);
    EXPECT_EQ(desk.world.joints().size(), 2u);
}

TEST(Commands, AGrabOfARemovedBodyIsForgotten) {
    Desk desk(playground());
    desk.join(1);
    ASSERT_EQ(desk.ask(1, Grab{discId, {4.0f, 3.0f}, {4.0f, 5.0f}}), Rejection::None);
    ASSERT_EQ(desk.ask(0, RemoveBody{discId}), Rejection::None);
    EXPECT_EQ(desk.player(1)->grab, 0u);
    EXPECT_EQ(desk.ask(1, Release{}), Rejection::NothingGrabbed);
    ASSERT_TRUE(World::restore(desk.world.save()).ok());
}

TEST(Commands, AHostSpawnsBodiesWithJointsBetweenThemAndIdsCountOn) {
    Desk desk(playground());
    JointDef rod = hinge(0, {0.5f, 0.0f}, 1, {-0.5f, 0.0f});
    const CommandOutcome outcome =
        desk.say(0, Spawn{{boxAt({50.0f, 5.0f}), boxAt({51.0f, 5.0f})}, {rod}});
    ASSERT_EQ(outcome.reason, Rejection::None);
    EXPECT_EQ(outcome.firstBody, 5u);
    EXPECT_EQ(desk.world.joints().back().id, 3u);
    EXPECT_EQ(desk.world.joints().back().bodyA, 5u);
    EXPECT_EQ(desk.world.joints().back().bodyB, 6u);
    ASSERT_EQ(desk.ask(0, RemoveBody{6}), Rejection::None);
    EXPECT_EQ(desk.world.joints().size(), 2u) << "its joint went with it";
    EXPECT_EQ(desk.say(0, Spawn{{boxAt({60.0f, 5.0f})}, {}}).firstBody, 7u) << "ids never return";
}

TEST(Commands, AMotorIsSetAndSwitchedOff) {
    Desk desk(playground());
    ASSERT_EQ(desk.ask(0, SetMotor{motorId, true, -2.0f}), Rejection::None);
    EXPECT_EQ(desk.world.joints()[0].motorSpeed, -2.0f);
    EXPECT_TRUE(desk.world.joints()[0].has(JointInfo::motor));
    run(desk.world, 60);
    EXPECT_NEAR(wide(motionOf(desk.world, boxId).angularVelocity), -2.0, 1e-3);
    ASSERT_EQ(desk.ask(0, SetMotor{motorId, false, 0.0f}), Rejection::None);
    EXPECT_FALSE(desk.world.joints()[0].has(JointInfo::motor));
    EXPECT_TRUE(desk.world.joints()[0].has(JointInfo::hasMotor)) << "it may be switched on again";
    ASSERT_EQ(desk.ask(0, SetMotor{motorId, true, 1.0f}), Rejection::None);
}

TEST(Commands, AKinematicBodyMovesAsItIsTold) {
    Desk desk(playground());
    ASSERT_EQ(desk.ask(0, SetVelocity{fanId, {3.0f, 0.0f}, 2.0f}), Rejection::None);
    const BodyMotion start = motionOf(desk.world, fanId);
    EXPECT_EQ(start.velocity, (Vec2{3.0f, 0.0f}));
    run(desk.world, 60);
    EXPECT_NEAR(wide(motionOf(desk.world, fanId).position.x - start.position.x), 3.0, 1e-4);
}

TEST(Commands, AKinematicBodyIsWhereItsTargetIsAfterTheTick) {
    Random random(17);
    SCOPED_TRACE(random.trace());
    Desk desk(playground());
    for (int k = 0; k < 200; ++k) {
        const Vec2 to = random.point(-50.0, 50.0);
        const double angle = random.between(-3.14, 3.14);
        const Rotation q{static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
        const BodyMotion before = motionOf(desk.world, fanId);
        ASSERT_EQ(desk.ask(0, SetTarget{fanId, to, q}), Rejection::None);
        const BodyMotion after = motionOf(desk.world, fanId);
        const double reached = std::max(wide(length(to)), wide(length(before.position)));
        EXPECT_NEAR(wide(after.position.x), wide(to.x), 1e-6 * reached);
        EXPECT_NEAR(wide(after.position.y), wide(to.y), 1e-6 * reached);
        EXPECT_NEAR(wide(after.rotation.c), std::cos(angle), 1e-6);
        EXPECT_NEAR(wide(after.rotation.s), std::sin(angle), 1e-6);
        // The shorter way round: never more than half a turn in a tick of 1/60 s.
        const double turned =
            std::remainder(angle - std::atan2(wide(before.rotation.s), wide(before.rotation.c)),
                           2.0 * std::numbers::pi);
        EXPECT_NEAR(wide(after.angularVelocity) / 60.0, turned, 1e-5);
    }
}

TEST(Commands, ABodyThatReachedItsTargetGoesOnUntilItIsToldToStay) {
    Desk desk(playground());
    const Vec2 start = motionOf(desk.world, fanId).position;
    const Vec2 to = start + Vec2{0.25f, 0.5f};
    ASSERT_EQ(desk.ask(0, SetTarget{fanId, to, {}}), Rejection::None);
    run(desk.world, 1);
    const Vec2 on = motionOf(desk.world, fanId).position;
    EXPECT_NEAR(wide(on.x - start.x), 0.5, 1e-5);
    EXPECT_NEAR(wide(on.y - start.y), 1.0, 1e-5);
    ASSERT_EQ(desk.ask(0, SetTarget{fanId, on, {}}), Rejection::None);
    EXPECT_EQ(motionOf(desk.world, fanId).velocity, Vec2{});
    EXPECT_EQ(motionOf(desk.world, fanId).position, on);
}

TEST(Commands, ARemovedJointLetsItsBodiesGo) {
    Desk desk(playground());
    const Vec2 before = motionOf(desk.world, discId).position;
    ASSERT_EQ(desk.ask(0, RemoveJoint{plainId}), Rejection::None);
    EXPECT_EQ(desk.world.joints().size(), 1u);
    run(desk.world, 20);
    EXPECT_LT(motionOf(desk.world, discId).position.y, before.y - 0.3f);
}

TEST(Commands, AreRejectedForEveryReasonThereIs) {
    Desk desk(playground());
    const BodyId own = desk.join(1);
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto expect = [&](Rejection reason, PlayerId author, Action action) {
        const std::string before = std::string(describe(reason));
        const std::uint64_t bodies = desk.world.bodies().size();
        EXPECT_EQ(describe(desk.ask(author, std::move(action))), before);
        EXPECT_EQ(desk.world.bodies().size(), bodies);
    };
    expect(Rejection::UnknownAuthor, 9, Release{});
    expect(Rejection::UnknownAuthor, 0, RemovePlayer{9});

    expect(Rejection::NotAllowed, 1, AddPlayer{2});
    expect(Rejection::NotAllowed, 0, AddPlayer{0});
    expect(Rejection::NotAllowed, 1, RemovePlayer{1});
    expect(Rejection::NotAllowed, 0, RemovePlayer{0});
    expect(Rejection::NotAllowed, 1, RemoveBody{boxId});
    expect(Rejection::NotAllowed, 1, RemoveBody{own});
    expect(Rejection::NotAllowed, 1, RemoveJoint{plainId});
    expect(Rejection::NotAllowed, 1, SetVelocity{fanId, {}, 0.0f});
    expect(Rejection::NotAllowed, 1, SetTarget{fanId, {}, {}});
    expect(Rejection::NotAllowed, 1, Spawn{{ground()}, {}});
    expect(Rejection::NotAllowed, 1,
           Spawn{{boxAt({}), boxAt({2.0f, 0.0f})}, {hinge(0, {}, 1, {})}});
    expect(Rejection::NotAllowed, 1, Spawn{std::vector<BodyDef>(9, boxAt({})), {}});

    expect(Rejection::UnknownBody, 1, ApplyImpulse{99, {}, {}});
    expect(Rejection::UnknownBody, 1, ApplyForce{99, {}, {}});
    expect(Rejection::UnknownBody, 1, Grab{99, {}, {}});
    expect(Rejection::UnknownBody, 0, RemoveBody{99});
    expect(Rejection::UnknownBody, 0, SetVelocity{99, {}, 0.0f});
    expect(Rejection::UnknownBody, 0, SetTarget{99, {}, {}});
    expect(Rejection::UnknownJoint, 0, RemoveJoint{99});
    expect(Rejection::UnknownJoint, 1, SetMotor{99, true, 0.0f});

    expect(Rejection::WrongBodyType, 1, ApplyImpulse{groundId, {}, {}});
    expect(Rejection::WrongBodyType, 1, ApplyForce{fanId, {}, {}});
    expect(Rejection::WrongBodyType, 1, Grab{groundId, {}, {}});
    expect(Rejection::WrongBodyType, 0, SetVelocity{boxId, {}, 0.0f});
    expect(Rejection::WrongBodyType, 0, SetTarget{boxId, {}, {}});

    expect(Rejection::NotFinite, 1, ApplyImpulse{boxId, {nan, 0.0f}, {}});
    expect(Rejection::NotFinite, 1, ApplyImpulse{boxId, {}, {inf, 0.0f}});
    expect(Rejection::NotFinite, 1, ApplyImpulse{boxId, {}, {2.0e6f, 0.0f}});
    expect(Rejection::NotFinite, 1, ApplyForce{boxId, {0.0f, inf}, {}});
    expect(Rejection::NotFinite, 1, Grab{boxId, {nan, 0.0f}, {}});
    expect(Rejection::NotFinite, 1, Grab{boxId, {}, {0.0f, nan}});
    expect(Rejection::NotFinite, 1, MoveGrab{{inf, inf}});
    expect(Rejection::NotFinite, 1, SetMotor{motorId, true, nan});
    expect(Rejection::NotFinite, 0, SetVelocity{fanId, {nan, 0.0f}, 0.0f});
    expect(Rejection::NotFinite, 0, SetVelocity{fanId, {}, 2.0e5f});
    expect(Rejection::NotFinite, 0, SetTarget{fanId, {2.0e6f, 0.0f}, {}});
    expect(Rejection::NotFinite, 0, SetTarget{fanId, {0.0f, nan}, {}});
    expect(Rejection::NotFinite, 0, SetTarget{fanId, {}, {nan, 0.0f}});
    expect(Rejection::NotFinite, 0, SetTarget{fanId, {}, {0.5f, 0.5f}});

    expect(Rejection::TooStrong, 1, ApplyImpulse{boxId, {8.0f, 8.0f}, {}});
    expect(Rejection::TooStrong, 1, ApplyForce{boxId, {100.1f, 0.0f}, {}});
    expect(Rejection::TooStrong, 0, ApplyImpulse{boxId, {3.0e38f, 3.0e38f}, {0.0f, 1.0e6f}});

    BodyDef bad = boxAt({});
    bad.shapes[0].density = 0.0f;
    expect(Rejection::BadDefinition, 1, Spawn{});
    expect(Rejection::BadDefinition, 1, Spawn{{bad}, {}});
    bad = boxAt({});
    bad.id = 77;
    expect(Rejection::BadDefinition, 0, Spawn{{bad}, {}});
    expect(Rejection::BadDefinition, 0, Spawn{{boxAt({})}, {hinge(0, {}, 1, {})}});

    expect(Rejection::NothingGrabbed, 1, MoveGrab{{}});
    expect(Rejection::NothingGrabbed, 1, Release{});
    expect(Rejection::NoMotor, 1, SetMotor{plainId, true, 1.0f});
    expect(Rejection::PlayerExists, 0, AddPlayer{1});

    expect(Rejection::TooFar, 1, ApplyImpulse{boxId, {1.0f, 0.0f}, {0.0f, 5.0f}});
    expect(Rejection::TooFar, 1, ApplyForce{boxId, {1.0f, 0.0f}, {2.0f, 3.0f}});
    expect(Rejection::TooFar, 1, Grab{boxId, {0.0f, 1.0f}, {}});
    expect(Rejection::TooFar, 0, SetTarget{fanId, {2000.0f, 5.0f}, {}});
    BodyDef large = boxAt({}, 20.0f);
    expect(Rejection::NotAllowed, 1, Spawn{{large}, {}});
    large.shapes.assign(9, ShapeDef::circle({}, 0.5f));
    expect(Rejection::NotAllowed, 1, Spawn{{large}, {}});
    BodyDef crowd = bodyAt(BodyType::Static, {60.0f, 60.0f}, ShapeDef::circle({}, 0.5f));
    crowd.shapes.assign(65, crowd.shapes[0]);
    ASSERT_EQ(desk.ask(0, Spawn{{crowd}, {}}), Rejection::None);
    expect(Rejection::TooCrowded, 1, Spawn{{boxAt({60.0f, 60.0f})}, {}});
}

TEST(Commands, KeepEveryCapOfTheWorld) {
    Desk desk(playground());
    desk.join(1);
    desk.join(2);
    desk.join(3);
    EXPECT_EQ(desk.ask(0, AddPlayer{4}), Rejection::OverLimit) << "players";
    ASSERT_EQ(desk.ask(1, Grab{boxId, {0.0f, 3.0f}, {}}), Rejection::None);
    ASSERT_EQ(desk.ask(2, Grab{boxId, {0.0f, 3.0f}, {}}), Rejection::None);
    EXPECT_EQ(desk.ask(3, Grab{boxId, {0.0f, 3.0f}, {}}), Rejection::OverLimit) << "joints";
    // 7 bodies are there; 12 are allowed.
    EXPECT_EQ(desk.ask(0, Spawn{std::vector<BodyDef>(6, boxAt({30.0f, 3.0f})), {}}),
              Rejection::OverLimit)
        << "bodies";
    EXPECT_EQ(desk.ask(0, Spawn{std::vector<BodyDef>(5, boxAt({30.0f, 3.0f})), {}}),
              Rejection::None);
}

TEST(Commands, OfPlayersBeyondATicksCapAreRejectedThoseOfTheHostAreNot) {
    Desk desk(playground());
    desk.join(1);
    std::vector<Command> commands;
    for (std::uint64_t k = 0; k < 8; ++k) {
        commands.push_back({0, 100 + k, SetVelocity{fanId, {}, 0.0f}});
        commands.push_back({1, 100 + k, ApplyForce{boxId, {}, {0.0f, 3.0f}}});
    }
    const Events& events = desk.world.step(commands);
    ASSERT_EQ(events.commands.size(), 16u);
    for (std::size_t i = 0; i < 16; ++i) {
        const CommandOutcome& outcome = events.commands[i];
        EXPECT_EQ(outcome.author, i < 8 ? 0u : 1u) << "in key order";
        EXPECT_EQ(outcome.sequence, 100 + i % 8);
        EXPECT_EQ(outcome.reason, i < 14 ? Rejection::None : Rejection::OverLimit) << i;
    }
}

TEST(Commands, OfAPlayerSpawnNoMoreThanItsBudgetAtATime) {
    Desk desk(playground());
    desk.join(1);
    const BodyId first =
        desk.say(1, Spawn{{boxAt({-30.0f, 1.0f}), boxAt({-32.0f, 1.0f})}, {}}).firstBody;
    EXPECT_EQ(desk.ask(1, Spawn{{boxAt({-34.0f, 1.0f}), boxAt({-36.0f, 1.0f})}, {}}),
              Rejection::OverBudget);
    EXPECT_EQ(desk.ask(1, Spawn{{boxAt({-34.0f, 1.0f})}, {}}), Rejection::None);
    EXPECT_EQ(desk.ask(1, Spawn{{boxAt({-36.0f, 1.0f})}, {}}), Rejection::OverBudget);
    EXPECT_EQ(desk.ask(1, RemoveBody{first}), Rejection::None);
    EXPECT_EQ(desk.ask(1, Spawn{{boxAt({-36.0f, 1.0f})}, {}}), Rejection::None);
}

TEST(Commands, CountOnceHoweverOftenTheyAreSent) {
    Scene scene = sceneOf({discAt({})});
    scene.gravity = {};
    World world = worldOf(scene);
    const Command push{0, 5, ApplyImpulse{1, {1.0f, 0.0f}, {}}};
    const auto reason = [&](const Command& command) {
        return world.step(std::vector<Command>{command}).commands.front().reason;
    };
    EXPECT_EQ(reason(push), Rejection::None);
    const Vec2 once = world.motions()[0].velocity;
    EXPECT_EQ(reason(push), Rejection::OldSequence);
    Command earlier = push;
    earlier.sequence = 4;
    EXPECT_EQ(reason(earlier), Rejection::OldSequence);
    EXPECT_EQ(world.motions()[0].velocity, once);
    const Command twice[] = {{0, 9, ApplyImpulse{1, {1.0f, 0.0f}, {}}},
                             {0, 9, ApplyImpulse{1, {1.0f, 0.0f}, {}}}};
    world.step(twice);
    EXPECT_EQ(world.events().commands[0].reason, Rejection::None);
    EXPECT_EQ(world.events().commands[1].reason, Rejection::OldSequence);
    EXPECT_EQ(world.players()[0].lastSequence, 9u);
}

TEST(Commands, ThatAreRejectedUseUpTheirSequenceToo) {
    World world = worldOf(sceneOf({discAt({})}));
    world.step(std::vector<Command>{{0, 7, RemoveBody{55}}});
    EXPECT_EQ(world.events().commands.front().reason, Rejection::UnknownBody);
    EXPECT_EQ(world.players()[0].lastSequence, 7u);
}

TEST(Commands, AreAppliedInKeyOrderWhateverTheOrderOfTheCall) {
    Desk one(playground()), other(playground());
    for (Desk* desk : {&one, &other}) {
        desk->join(1);
        desk->join(2);
    }
    std::vector<Command> commands{{2, 50, Spawn{{boxAt({-40.0f, 1.0f})}, {}}},
                                  {1, 51, ApplyForce{boxId, {50.0f, 0.0f}, {0.0f, 3.2f}}},
                                  {1, 50, Spawn{{discAt({-44.0f, 1.0f})}, {}}},
                                  {0, 50, ApplyImpulse{discId, {5.0f, 0.0f}, {4.0f, 3.1f}}},
                                  {2, 49, Grab{boxId, {0.0f, 3.0f}, {1.0f, 4.0f}}}};
    one.world.step(commands);
    std::reverse(commands.begin(), commands.end());
    other.world.step(commands);
    EXPECT_EQ(one.world.events(), other.world.events());
    EXPECT_EQ(differenceOf(one.world, other.world), "");
    std::vector<std::pair<PlayerId, std::uint64_t>> order;
    for (const CommandOutcome& o : one.world.events().commands) {
        order.emplace_back(o.author, o.sequence);
    }
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(Commands, InAWorldWithoutPlayersNobodyJoins) {
    Desk desk(sceneOf({discAt({})}));
    EXPECT_EQ(desk.ask(0, AddPlayer{1}), Rejection::NotAllowed);
}

TEST(Commands, OnABodyRemovedInTheSameTickFindNone) {
    Desk desk(playground());
    desk.join(1);
    desk.world.step(std::vector<Command>{{0, 100, RemoveBody{discId}},
                                         {0, 101, RemoveBody{discId}},
                                         {1, 100, ApplyImpulse{discId, {}, {}}},
                                         {1, 101, Grab{discId, {}, {}}}});
    const auto& outcomes = desk.world.events().commands;
    EXPECT_EQ(outcomes[0].reason, Rejection::None);
    for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(outcomes[i].reason, Rejection::UnknownBody) << i;
}

TEST(Commands, HaveAReasonInWordsForEveryNumber) {
    std::vector<std::string_view> seen;
    for (std::uint16_t i = 0; i <= static_cast<std::uint16_t>(Rejection::AgainstRules); ++i) {
        const std::string_view words = describe(static_cast<Rejection>(i));
        EXPECT_NE(words, "unknown reason");
        EXPECT_EQ(std::count(seen.begin(), seen.end(), words), 0) << words;
        seen.push_back(words);
    }
}

}  // namespace
}  // namespace huestep::test
