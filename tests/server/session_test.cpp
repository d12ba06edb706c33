#include "server/session.h"

#include <gtest/gtest.h>

#include <map>

#include "desk.h"
#include "protocol/codec.h"

namespace huestep::server {
namespace {

using test::Desk;
using test::deskScene;
using test::Peer;
using test::startOf;

const protocol::Frame& frameOf(const ClosedTick& closed) {
    return std::get<protocol::Frame>(closed.entries.at(0).content);
}

struct Bench {
    explicit Bench(Limits given = {}, const Scene& scene = deskScene())
        : limits(given), session(startOf(scene), given, second) {}
    ClosedTick close() {
        now += second / 60;
        ClosedTick closed = session.closeTick(now, {});
        session.committed(closed.commits);
        return closed;
    }
    PlayerId seat() {
        const std::optional<JoinId> join = session.seats().join();
        EXPECT_TRUE(join.has_value());
        close();
        const Seats::Outcome outcome = session.seats().outcome(*join, now);
        EXPECT_EQ(outcome.kind, Seats::Outcome::Kind::Seated);
        return outcome.player;
    }
    Limits limits;
    Instant now = second;
    Session session;
};

TEST(Session, AViewShowsAHandFromItsTargetToTheBodyItHolds) {
    Bench bench;
    const PlayerId player = bench.seat();
    const BodyId held = 2;
    const Vec2 at = bench.session.world().motions()[*bench.session.world().find(held)].position;
    bench.session.queue(player, {0, 1, Grab{held, at, {1.5f, 4.0f}}});
    bench.close();
    const protocol::View view = bench.session.view(false);
    ASSERT_EQ(view.joints.size(), 1u);
    EXPECT_EQ(view.joints[0].a, (Vec2{1.5f, 4.0f}));
    const Vec2 now = bench.session.world().motions()[*bench.session.world().find(held)].position;
    EXPECT_NEAR(view.joints[0].b.x, now.x, 0.05f);
    EXPECT_NEAR(view.joints[0].b.y, now.y, 0.05f);
}

/// A kinematic body, and a host who moves it to x = tick and spawns a disc every tenth tick.
Scene drivenScene() {
    Scene scene;
    scene.name = "driven";
    scene.bodies.push_back({});
    scene.bodies[0].type = BodyType::Kinematic;
    scene.bodies[0].shapes = {ShapeDef::box(0.5f, 0.5f)};
    return scene;
}
void drive(std::span<const double>, std::uint64_t tick, std::vector<Action>& actions) {
    actions.emplace_back(SetTarget{1, {static_cast<float>(tick), 0.0f}, {}});
    if (tick % 10 != 0) return;
    BodyDef disc;
    disc.type = BodyType::Dynamic;
    disc.position = {static_cast<float>(tick), 20.0f};
    disc.shapes = {ShapeDef::circle({}, 0.5f)};
    actions.emplace_back(Spawn{{disc}, {}});
    if (tick >= 30) actions.emplace_back(RemoveBody{static_cast<BodyId>(2 + tick / 10 - 3)});
}

TEST(Session, AddsTheCommandsOfItsScenesScriptToEveryFrame) {
    SessionStart start = startOf(drivenScene());
    World replay = start.world;
    start.script = Script(drive, {});
    Session session(std::move(start), Limits{}, second);
    Instant now = second;
    for (std::uint64_t tick = 0; tick < 65; ++tick) {
        const ClosedTick closed = session.closeTick(now += second / 60, {});
        session.committed(closed.commits);
        const std::vector<Command>& commands = frameOf(closed).commands;
        std::vector<Action> actions;
        drive({}, tick, actions);
        ASSERT_EQ(commands.size(), actions.size());
        for (std::size_t i = 0; i < actions.size(); ++i) EXPECT_EQ(commands[i].action, actions[i]);
        // Who has the journal needs no script.
        for (const CommandOutcome& outcome : replay.step(commands).commands) {
            EXPECT_EQ(outcome.reason, Rejection::None) << describe(outcome.reason);
        }
        ASSERT_EQ(replay.fullRoot(), session.world().fullRoot()) << "tick " << tick;
    }
    EXPECT_EQ(session.world().bodies().size(), 1u + 3u) << "seven spawned, four removed";
    EXPECT_NEAR(session.world().motions()[0].position.x, 64.0f, 1e-3f);
}

TEST(Session, ThatIsRecoveredGoesOnWithItsScriptFromItsTick) {
    SessionStart start = startOf(drivenScene());
    start.script = Script(drive, {});
    SessionStart later = startOf(drivenScene());
    later.script = start.script;
    Session whole(std::move(start), Limits{}, second);
    for (int tick = 0; tick < 60; ++tick) {
        whole.committed(whole.closeTick(second, {}).commits);
        if (tick == 36) later.world = whole.world();
    }
    Session session(std::move(later), Limits{}, second);
    while (session.tick() < whole.tick()) session.committed(session.closeTick(second, {}).commits);
    EXPECT_EQ(session.world().fullRoot(), whole.world().fullRoot());
}

TEST(Session, AViewShowsAChainWithoutItsGhosts) {
    Scene scene = deskScene();
    scene.bodies[0].shapes = {
        ShapeDef::chainSegment({9.0f, 1.0f}, {8.0f, 0.0f}, {-8.0f, 0.0f}, {-9.0f, 1.0f})};
    Bench bench({}, scene);
    bench.close();
    const protocol::View view = bench.session.view(true);
    ASSERT_FALSE(view.shapes.empty());
    EXPECT_EQ(view.shapes[0].kind, ShapeKind::ChainSegment);
    EXPECT_EQ(view.shapes[0].vertices, (std::vector<Vec2>{{8.0f, 0.0f}, {-8.0f, 0.0f}}));
}

TEST(Session, AFrameHasItsCommandsInKeyOrderAndTheRootItIsAppliedTo) {
    Bench bench;
    const PlayerId one = bench.seat(), two = bench.seat();
    bench.session.queue(two, {99, 1, Release{}});
    bench.session.queue(one, {99, 1, Release{}});
    bench.session.queue(two, {99, 2, Release{}});
    const std::uint64_t root = bench.session.world().motionRoot();
    const std::uint64_t tick = bench.session.tick();
    const ClosedTick closed = bench.close();
    const protocol::Frame& frame = frameOf(closed);
    EXPECT_EQ(frame.tick, tick);
    EXPECT_EQ(frame.previousRoot, root);
    EXPECT_EQ(frame.commands, (std::vector<Command>{
                                  {one, 1, Release{}}, {two, 1, Release{}}, {two, 2, Release{}}}));
}

TEST(Session, CommittedFollowsTheDiskAndNeverTheWorld) {
    Bench bench;
    bench.now += second / 60;
    bench.session.closeTick(bench.now, {});
    bench.session.closeTick(bench.now, {});
    EXPECT_EQ(bench.session.committedTick(), 0u);
    bench.session.committed(1);
    EXPECT_EQ(frameOf(bench.session.closeTick(bench.now, {})).committed, 1u);
    bench.session.committed(99);  // no more than was closed
    EXPECT_EQ(bench.session.committedTick(), bench.session.tick());
}

TEST(Session, StandsStillWhileTooMuchWaitsForTheDisk) {
    Limits limits;
    limits.uncommittedTicks = 5;
    Bench bench(limits);
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(bench.session.mayClose());
        bench.session.closeTick(bench.now, {});
    }
    EXPECT_FALSE(bench.session.mayClose());
    bench.session.committed(1);
    EXPECT_TRUE(bench.session.mayClose());
    bench.session.fail("disk full");
    EXPECT_FALSE(bench.session.mayClose());
}

TEST(Session, FramesReplayedAnywhereGiveTheSameRoots) {
    Bench bench;
    const PlayerId player = bench.seat();
    World replica = *World::create(deskScene());
    replica.step(bench.session.frames().find(0)->commands);
    for (std::uint64_t s = 1; s < 100; ++s) {
        const Vec2 at = bench.session.world().motions()[2].position;
        bench.session.queue(player, {0, s, ApplyImpulse{3, {0.3f, 1.0f}, at}});
        const ClosedTick closed = bench.close();
        ASSERT_EQ(frameOf(closed).previousRoot, replica.motionRoot()) << s;
        replica.step(frameOf(closed).commands);
    }
    EXPECT_EQ(replica.fullRoot(), bench.session.world().fullRoot());
}

TEST(Session, ASnapshotAndTheFullRootGoToTheJournalAtIntervals) {
    Limits limits;
    limits.journalSnapshotTicks = 10;
    limits.segmentTicks = 20;
    Bench bench(limits);
    for (std::uint64_t tick = 1; tick <= 40; ++tick) {
        const ClosedTick closed = bench.close();
        EXPECT_EQ(closed.commits, tick);
        EXPECT_EQ(closed.newSegment, tick % 20 == 0);
        ASSERT_EQ(closed.snapshot != nullptr, tick % 10 == 0);
        if (!closed.snapshot) continue;
        const auto& check = std::get<protocol::FullRoot>(closed.entries.at(1).content);
        EXPECT_EQ(check.tick, tick);
        EXPECT_EQ(World::restore(closed.snapshot->bytes)->fullRoot(), check.root);
    }
}

TEST(Session, ASilentPlayerIsNamedAsSubstitutedUntilItIsHeardAgain) {
    Limits limits;
    limits.lateTicks = 10;
    Bench bench(limits);
    const PlayerId player = bench.seat();
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(frameOf(bench.close()).substituted.empty()) << i;
    bench.close();
    EXPECT_EQ(frameOf(bench.close()).substituted, (std::vector<PlayerId>{player}));
    bench.session.seats().heard(player, bench.session.tick());
    EXPECT_TRUE(frameOf(bench.close()).substituted.empty());
}

TEST(Session, InputDelayHoldsCommandsBack) {
    Limits limits;
    limits.inputDelay = 3;
    Bench bench(limits);
    const PlayerId player = bench.seat();
    const std::uint64_t tick = bench.session.tick();
    bench.session.queue(player, {0, 1, Release{}});
    while (frameOf(bench.close()).commands.empty()) ASSERT_LT(bench.session.tick(), tick + 9);
    EXPECT_EQ(bench.session.tick(), tick + 4);
}

TEST(Session, ACommandIsInTheFrameThatItAsksFor) {
    Limits limits;
    limits.inputDelay = 3;  // of those that ask for none
    limits.askedAhead = 20;
    Bench bench(limits);
    const PlayerId player = bench.seat();
    const std::uint64_t now = bench.session.tick();
    bench.session.queue(player, {0, 1, Release{}}, now);
    bench.session.queue(player, {0, 2, Release{}}, now + 5);
    bench.session.queue(player, {0, 3, Release{}}, now + 2);      // after the one before it
    bench.session.queue(player, {0, 4, Release{}}, now + 1'000);  // too far ahead
    std::map<std::uint64_t, std::uint64_t> tickOf;
    for (int i = 0; i < 30; ++i) {
        const protocol::Frame frame = frameOf(bench.close());
        EXPECT_TRUE(frame.substituted.empty()) << i;
        for (const Command& command : frame.commands) tickOf[command.sequence] = frame.tick - now;
    }
    EXPECT_EQ(tickOf, (std::map<std::uint64_t, std::uint64_t>{{1, 0}, {2, 5}, {3, 5}, {4, 20}}));
}

TEST(Session, ACommandForAClosedFrameIsInTheNextWhichSaysSo) {
    Bench bench;
    const PlayerId player = bench.seat();
    bench.close();
    const std::uint64_t tick = bench.session.tick();
    bench.session.queue(player, {0, 1, Release{}}, tick - 1);
    bench.session.queue(player, {0, 2, Release{}}, tick + 1);
    const protocol::Frame late = frameOf(bench.close());
    ASSERT_EQ(late.commands.size(), 1u);
    EXPECT_EQ(late.substituted, (std::vector<PlayerId>{player}));
    const protocol::Frame early = frameOf(bench.close());
    EXPECT_EQ(early.commands.size(), 1u);
    EXPECT_TRUE(early.substituted.empty());
}

TEST(Session, AFrameTakesNoMoreOfPlayersThanItsLimits) {
    Limits byNumber;
    byNumber.commandsPerFrame = 3;
    Limits byBytes;
    byBytes.frameCommandBytes = 3 * protocol::commandBytes({1, 1, Release{}}) + 1;
    for (const Limits& limits : {byNumber, byBytes}) {
        Bench bench(limits);
        const PlayerId one = bench.seat(), two = bench.seat();
        for (std::uint64_t s = 1; s <= 4; ++s) {
            bench.session.queue(one, {0, s, Release{}});
            bench.session.queue(two, {0, s, Release{}});
        }
        for (const std::size_t expected : {3u, 3u, 2u, 0u}) {
            EXPECT_EQ(frameOf(bench.close()).commands.size(), expected);
        }
    }
}

TEST(Session, TheHostsOwnCommandsTakeNoRoomOfThePlayersInAFrame) {
    // The world's cap is of players' commands: see core/world/commands.cpp.
    Scene scene = deskScene();
    scene.limits.commandsPerTick = 2;
    Bench bench({}, scene);
    const PlayerId one = bench.seat();
    bench.session.queue(one, {0, 1, Release{}});
    bench.session.queue(one, {0, 2, Release{}});
    ASSERT_TRUE(bench.session.seats().join().has_value());
    EXPECT_EQ(frameOf(bench.close()).commands.size(), 3u);
    for (const CommandOutcome& outcome : bench.session.world().events().commands) {
        EXPECT_NE(outcome.reason, Rejection::OverLimit);
    }
}

TEST(Session, AViewHoldsNoMoreOfEachKindThanItsLimit) {
    Limits limits;
    limits.drawn = 3;
    Bench bench(limits);
    for (int i = 0; i < 120; ++i) bench.close();
    const protocol::View view = bench.session.view(true);
    EXPECT_EQ(view.poses.size(), 3u);
    EXPECT_EQ(view.bodies.size(), 3u);
    EXPECT_EQ(view.shapes.size(), 3u);
    EXPECT_LE(view.contacts.size(), 3u);
    Bench whole;
    EXPECT_GT(whole.session.view(true).poses.size(), 3u) << "or this shows nothing";
}

TEST(Session, FramesAreKeptWithinTheirBytes) {
    Limits limits;
    limits.recentBytes = 2'000;
    Bench bench(limits);
    for (int i = 0; i < 100; ++i) bench.close();
    EXPECT_LE(bench.session.frames().bytes(), 2'000u);
    EXPECT_GT(bench.session.frames().size(), 10u);
    EXPECT_LT(bench.session.frames().size(), 100u);
}

TEST(Session, FewDifferentSnapshotsAreLentAtATime) {
    Limits limits;
    limits.lentSnapshots = 2;
    limits.freshTicks = 1;
    Bench bench(limits);
    const auto later = [&] {
        for (int i = 0; i < 5; ++i) bench.close();
    };
    later();
    SharedSnapshot first = bench.session.snapshotForJoin();
    later();
    const SharedSnapshot second = bench.session.snapshotForJoin();
    later();
    ASSERT_NE(second, first);
    EXPECT_EQ(bench.session.snapshotForJoin(), second) << "the newest of those that are held";
    EXPECT_EQ(bench.session.snapshotForJoin(bench.session.tick()), nullptr);
    EXPECT_EQ(bench.session.snapshotOf(bench.session.world()), nullptr);
    first.reset();
    const SharedSnapshot third = bench.session.snapshotForJoin(bench.session.tick());
    ASSERT_NE(third, nullptr);
    EXPECT_EQ(third->tick, bench.session.tick());
}

TEST(Session, ManyJoinersShareOneSnapshot) {
    Bench bench;
    for (int i = 0; i < 7; ++i) bench.close();
    const SharedSnapshot first = bench.session.snapshotForJoin();
    for (int i = 0; i < 20; ++i) bench.close();
    EXPECT_EQ(bench.session.snapshotForJoin(), first);
    for (int i = 0; i < 20; ++i) bench.close();
    EXPECT_NE(bench.session.snapshotForJoin(), first);
    EXPECT_EQ(bench.session.snapshotForJoin(bench.session.tick())->tick, bench.session.tick());
}

TEST(Session, AViewHasAPlaceForEachBodyAndShapesOnlyWhenAsked) {
    Bench bench;
    bench.seat();
    for (int i = 0; i < 45; ++i) bench.close();
    const protocol::View full = bench.session.view(true), lean = bench.session.view(false);
    EXPECT_EQ(full.tick, bench.session.tick());
    EXPECT_EQ(full.root, bench.session.world().motionRoot());
    EXPECT_EQ(full.players, 1u);
    ASSERT_EQ(full.bodies.size(), 7u);
    EXPECT_EQ(full.poses.size(), 7u);
    EXPECT_EQ(full.shapes.size(), 7u);
    EXPECT_EQ(full.flags.front() & 6, 0) << "the ground is static";
    EXPECT_EQ(full.flags.back() & 8, 8) << "the player's body";
    EXPECT_GT(full.contacts.size(), 0u);
    EXPECT_TRUE(lean.shapes.empty());
    EXPECT_TRUE(lean.bodies.empty());
    EXPECT_EQ(lean.poses, full.poses);
}

TEST(Session, DefinitionsRiseWhenABodyComesOrGoes) {
    Bench bench;
    const std::uint32_t before = bench.session.definitions();
    bench.close();
    EXPECT_EQ(bench.session.definitions(), before);
    const PlayerId player = bench.seat();
    const std::uint32_t joined = bench.session.definitions();
    EXPECT_GT(joined, before);
    bench.session.seats().vacate(player, true, bench.now);
    bench.close();
    EXPECT_GT(bench.session.definitions(), joined);
}

// Seats ----------------------------------------------------------------------------------------

TEST(Seats, PlayersAreNumberedInTheOrderTheyJoinedAndNumbersAreNotReused) {
    Bench bench;
    EXPECT_EQ(bench.seat(), 1u);
    EXPECT_EQ(bench.seat(), 2u);
    bench.session.seats().vacate(2, true, bench.now);
    bench.close();
    EXPECT_EQ(bench.seat(), 3u);
    EXPECT_FALSE(bench.session.seats().has(2));
}

TEST(Seats, AreBounded) {
    Limits limits;
    limits.seats = 2;
    Bench bench(limits);
    bench.seat();
    EXPECT_TRUE(bench.session.seats().join().has_value());
    EXPECT_FALSE(bench.session.seats().join().has_value());
}

TEST(Seats, AWorldWithoutRoomForABodyRefusesInWords) {
    Scene scene = deskScene();
    scene.limits.bodies = 6;
    Bench bench({}, scene);
    const std::optional<JoinId> join = bench.session.seats().join();
    bench.close();
    const Seats::Outcome outcome = bench.session.seats().outcome(*join, bench.now);
    EXPECT_EQ(outcome.kind, Seats::Outcome::Kind::Refused);
    EXPECT_EQ(outcome.reason, describe(Rejection::OverLimit));
}

TEST(Seats, NoMoreThanSoManyJoinInOneFrame) {
    Limits limits;
    limits.joinsPerFrame = 3;
    Bench bench(limits);
    for (int i = 0; i < 5; ++i) bench.session.seats().join();
    EXPECT_EQ(frameOf(bench.close()).commands.size(), 3u);
    EXPECT_EQ(frameOf(bench.close()).commands.size(), 2u);
}

TEST(Seats, ABrokenConnectionKeepsItsSeatForAWhile) {
    Bench bench;
    const PlayerId player = bench.seat();
    bench.session.seats().vacate(player, false, bench.now);
    bench.now += bench.limits.seatKept - second;
    bench.close();
    EXPECT_TRUE(bench.session.seats().has(player));
    bench.now += 2 * second;
    bench.close();
    EXPECT_FALSE(bench.session.seats().has(player));
    EXPECT_EQ(bench.session.world().players().size(), 1u);
}

TEST(Seats, AnAbandonedJoinLeavesNobodyBehind) {
    Bench bench;
    const std::optional<JoinId> before = bench.session.seats().join();
    bench.session.seats().abandon(*before);
    EXPECT_TRUE(frameOf(bench.close()).commands.empty());
    const std::optional<JoinId> after = bench.session.seats().join();
    bench.close();
    bench.session.seats().abandon(*after);
    bench.close();
    EXPECT_EQ(bench.session.world().players().size(), 1u);
    EXPECT_EQ(bench.session.seats().taken(), 0u);
}

TEST(Seats, ATokenIsOfNoUseOnceItsSuccessorWasUsed) {
    Bench bench;
    Seats& seats = bench.session.seats();
    const PlayerId player = bench.seat();
    const protocol::ResumeToken first = seats.issue(player);
    ASSERT_TRUE(seats.resume(first, bench.now).ok());
    const protocol::ResumeToken second = seats.issue(player);
    EXPECT_NE(second, first);
    EXPECT_TRUE(seats.resume(second, bench.now).ok());
    const protocol::ResumeToken third = seats.issue(player);
    EXPECT_NE(third, second);
    EXPECT_FALSE(seats.resume(first, bench.now).ok());
    EXPECT_TRUE(seats.resume(third, bench.now).ok());
}

TEST(Seats, AnyNumberOfAnswersThatAreLostCostNoSeat) {
    Bench bench;
    Seats& seats = bench.session.seats();
    const PlayerId player = bench.seat();
    const protocol::ResumeToken first = seats.issue(player);
    ASSERT_TRUE(seats.resume(first, bench.now).ok());
    const protocol::ResumeToken lost = seats.issue(player);
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(seats.resume(first, bench.now).ok()) << i;
        EXPECT_EQ(seats.issue(player), lost) << "the same goes out until it is shown";
    }
    EXPECT_TRUE(seats.resume(lost, bench.now).ok());
    EXPECT_NE(seats.issue(player), lost);
    EXPECT_FALSE(seats.resume(first, bench.now).ok());
}

TEST(Seats, AnyNumberOfAnswersThatAreLostAfterARestartCostNoSeat) {
    Bench bench;
    const PlayerId player = bench.seat();
    const protocol::ResumeToken old = bench.session.seats().issue(player);
    SessionStart again{"play", 2, ResumeKey{5, 6, 7}, nullptr, {}, bench.session.world()};
    Session next(std::move(again), bench.limits, bench.now);
    protocol::ResumeToken fresh{};
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(next.seats().resume(old, bench.now).ok()) << i;
        fresh = next.seats().issue(player);
    }
    ASSERT_TRUE(next.seats().resume(fresh, bench.now).ok());
    EXPECT_NE(next.seats().issue(player), fresh);
    EXPECT_FALSE(next.seats().resume(old, bench.now).ok());
}

TEST(Seats, ATokenOutlivesTheServerButNotTheSeat) {
    Bench bench;
    const PlayerId player = bench.seat();
    const protocol::ResumeToken token = bench.session.seats().issue(player);
    SessionStart again{"play", 2, ResumeKey{5, 6, 7}, nullptr, {}, bench.session.world()};
    Session next(std::move(again), bench.limits, bench.now);
    const Result<Seats::Resumed> resumed = next.seats().resume(token, bench.now);
    ASSERT_TRUE(resumed.ok());
    EXPECT_EQ(resumed->player, player);
    EXPECT_FALSE(resumed->sameEpoch);
    next.seats().vacate(player, true, bench.now);
    EXPECT_FALSE(next.seats().resume(token, bench.now).ok());

    SessionStart other{"play", 2, ResumeKey{1}, nullptr, {}, bench.session.world()};
    Session stranger(std::move(other), bench.limits, bench.now);
    EXPECT_FALSE(stranger.seats().resume(token, bench.now).ok());
}

// The hub --------------------------------------------------------------------------------------

TEST(Hub, ConnectionsAndHalfOpenOnesAreBounded) {
    Limits limits;
    limits.connections = 4;
    limits.halfOpen = 2;
    Desk desk(limits);
    Peer a(desk), b(desk);
    Peer c(desk);
    EXPECT_TRUE(c.accepted());
    EXPECT_EQ(desk.hub.displaced(), std::vector<ConnectionId>{a.id()})
        << "two have not said hello: the older makes room";
    EXPECT_TRUE(desk.hub.overdue(a.id(), desk.now)) << "and is to be closed";
    desk.hub.closed(a.id(), desk.now);
    b.watch();
    c.watch();
    Peer d(desk), e(desk);
    d.watch();
    e.watch();
    EXPECT_FALSE(Peer(desk).accepted()) << "four are here";
    EXPECT_EQ(desk.hub.counters().refused, 1u);
    EXPECT_EQ(desk.hub.counters().displaced, 1u);
}

TEST(Hub, SessionsAreBoundedAndTheirNamesChecked) {
    Limits limits;
    limits.sessions = 2;
    Desk desk(limits);
    EXPECT_FALSE(desk.hub.add(startOf(deskScene(), "play"), desk.now).ok()) << "twice";
    EXPECT_FALSE(desk.hub.add(startOf(deskScene(), "../x"), desk.now).ok());
    EXPECT_TRUE(desk.hub.add(startOf(deskScene(), "two"), desk.now).ok());
    EXPECT_FALSE(desk.hub.add(startOf(deskScene(), "three"), desk.now).ok());
}

TEST(Hub, AResumedSeatGetsTheTailAloneIfTheServerStillHasIt) {
    Desk desk;
    Peer first(desk);
    const protocol::Welcome welcome = first.join();
    desk.tick(40);
    const std::uint64_t tick = desk.session->tick();
    const std::uint64_t root = desk.session->world().motionRoot();
    desk.hub.closed(first.id(), desk.now);
    desk.tick(20);

    Peer again(desk);
    protocol::Hello hello = again.hello();
    hello.resume = welcome.resume;
    hello.haveTick = tick;
    hello.haveHash = root;
    again.say(hello);
    again.read();
    EXPECT_EQ(again.last<protocol::Welcome>()->player, welcome.player);
    EXPECT_EQ(again.count<protocol::SnapshotBegin>(), 0u);
    EXPECT_EQ(again.count<protocol::Frame>(), 20u);

    Peer wrong(desk);
    hello.resume = again.last<protocol::Welcome>()->resume;
    hello.haveHash = root + 1;
    wrong.say(hello);
    wrong.read();
    EXPECT_EQ(wrong.count<protocol::SnapshotBegin>(), 1u) << "its world is not ours";
}

TEST(Hub, AfterARestartAnEqualMotionRootIsNotEnoughForTheTail) {
    // A command that moves nothing changes the world's state and not its motion root: a client that
    // stepped one in a frame that the restart lost must not go on from there.
    Desk before;
    Peer first(before);
    const protocol::Welcome welcome = first.join();
    Limits limits;
    SessionStart again{"play", 2, ResumeKey{5, 6, 7}, nullptr, {}, before.session->world()};
    test::DeskJournal journal;
    Hub hub({limits, test::deskPrint, nullptr, {}}, journal);
    ASSERT_TRUE(hub.add(std::move(again), before.now).ok());
    protocol::Hello hello = first.hello();
    hello.resume = welcome.resume;
    hello.haveTick = before.session->tick();
    hello.haveHash = before.session->world().motionRoot();
    const ConnectionId id = *hub.accept("test", before.now);
    hub.receive(id, protocol::encode(hello), before.now);
    protocol::FrameSplitter splitter;
    std::vector<protocol::Message> heard;
    while (const SharedBytes bytes = hub.next(id, 0, before.now)) {
        ASSERT_TRUE(splitter.feed(*bytes, heard).ok());
    }
    ASSERT_GE(heard.size(), 2u);
    EXPECT_EQ(std::get<protocol::Welcome>(heard[0]).player, welcome.player);
    EXPECT_TRUE(std::holds_alternative<protocol::SnapshotBegin>(heard[1]));
}

TEST(Hub, ASecondConnectionTakesTheSeatOverFromTheFirst) {
    Desk desk;
    Peer first(desk);
    const protocol::Welcome welcome = first.join();
    Peer second(desk);
    const protocol::Welcome again = second.join(welcome.resume);
    EXPECT_EQ(again.player, welcome.player);
    EXPECT_EQ(first.bye(), protocol::ByeReason::Done);
    desk.hub.closed(first.id(), desk.now);
    desk.wait(60 * huestep::server::second);
    EXPECT_TRUE(desk.session->seats().has(welcome.player));
}

TEST(Hub, AForgedTokenIsRefused) {
    Desk desk;
    Peer first(desk);
    protocol::Welcome welcome = first.join();
    welcome.resume[0] ^= 1;
    Peer thief(desk);
    protocol::Hello hello = thief.hello();
    hello.resume = welcome.resume;
    thief.say(hello);
    EXPECT_EQ(thief.bye(), protocol::ByeReason::ResumeRefused);
}

TEST(Hub, LeavingGivesTheSeatUp) {
    Desk desk;
    Peer peer(desk);
    const PlayerId player = peer.join().player;
    peer.say(protocol::Bye{protocol::ByeReason::Done, "leaves", false});
    desk.tick();
    EXPECT_FALSE(desk.session->seats().has(player));
}

TEST(Hub, AHashQueryIsAnsweredWithTheLeavesOfThatTickAndASnapshotOfIt) {
    Desk desk;
    desk.tick(100);
    Peer peer(desk);
    peer.join();
    desk.tick(1);
    const std::uint64_t tick = desk.session->tick();
    const std::vector<std::uint64_t> leaves = desk.session->world().motionLeaves();
    desk.tick(20);
    peer.read();
    peer.heard.clear();
    peer.say(protocol::HashQuery{tick});
    peer.say(protocol::SnapshotRequest{tick});
    desk.tick(100);
    peer.read();
    ASSERT_NE(peer.last<protocol::HashNodes>(), nullptr);
    EXPECT_EQ(peer.last<protocol::HashNodes>()->leaves, leaves);
    ASSERT_NE(peer.last<protocol::SnapshotBegin>(), nullptr);
    EXPECT_EQ(peer.last<protocol::SnapshotBegin>()->tick, tick);
    std::uint64_t next = tick;
    for (const protocol::Message& message : peer.heard) {
        const auto* frame = std::get_if<protocol::Frame>(&message);
        if (!frame) continue;
        EXPECT_EQ(frame->tick, next++);
    }
    EXPECT_EQ(next, desk.session->tick());
}

TEST(Hub, ATickThatIsGoneIsAnsweredWithEmptyLeavesAndTheNewestSnapshot) {
    Limits limits;
    limits.keyframeTicks = 10;
    limits.keyframes = 2;
    Desk desk(limits);
    Peer peer(desk);
    peer.join();
    desk.tick(100);
    peer.read();
    peer.heard.clear();
    peer.say(protocol::HashQuery{5});
    peer.say(protocol::SnapshotRequest{5});
    desk.tick(1);
    peer.read();
    EXPECT_TRUE(peer.last<protocol::HashNodes>()->leaves.empty());
    EXPECT_GE(peer.last<protocol::SnapshotBegin>()->tick, 70u);
}

TEST(Hub, TicksThatWaitToBeRebuiltAreBounded) {
    Limits limits;
    limits.rebuildsWaiting = 2;
    limits.heavyBurst = 100;
    Desk desk(limits);
    desk.tick(100);
    Rebuilder& rebuilder = desk.session->rebuilder();
    EXPECT_EQ(rebuilder.ask(90), Rebuilder::Answer::Coming);
    EXPECT_EQ(rebuilder.ask(90), Rebuilder::Answer::Coming) << "the same one";
    EXPECT_EQ(rebuilder.ask(91), Rebuilder::Answer::Coming);
    EXPECT_EQ(rebuilder.ask(92), Rebuilder::Answer::Gone);
    int steps = 0;
    while (rebuilder.work({})) ++steps;
    EXPECT_LE(steps, 2 * (60 + 1));
    EXPECT_EQ(rebuilder.find(91)->motionRoot(), *desk.session->rootAt(91));
}

TEST(Hub, AFailedJournalEndsItsSessionWithAWord) {
    Desk desk;
    Peer peer(desk);
    peer.join();
    desk.hub.failed("play", "disk full", desk.now);
    EXPECT_EQ(peer.bye(), protocol::ByeReason::ServerStops);
    EXPECT_FALSE(desk.hub.closeTick(*desk.session, desk.now));
    EXPECT_TRUE(desk.logged("event=journal_failed session=play text=\"disk full\""));
    Peer late(desk);
    late.say(late.hello());
    EXPECT_EQ(late.bye(), protocol::ByeReason::UnknownSession);
}

TEST(Hub, StoppingSaysByeToAllAndRecordsEachSession) {
    Desk desk;
    Peer peer(desk);
    peer.join();
    desk.hub.stop(desk.now);
    EXPECT_EQ(peer.bye(), protocol::ByeReason::ServerStops);
    EXPECT_TRUE(peer.last<protocol::Bye>()->mayResume);
    ASSERT_NE(desk.journal.closed.back().snapshot, nullptr);
    EXPECT_EQ(desk.journal.closed.back().snapshot->tick, desk.session->tick());
    EXPECT_FALSE(Peer(desk).accepted());
}

TEST(FrameRing, IsBoundedByNumberAndByBytes) {
    FrameRing few(3, 1u << 20), small(100, 1'000);
    for (std::uint64_t tick = 5; tick < 50; ++tick) {
        protocol::Frame frame;
        frame.tick = tick;
        few.push(frame);
        small.push(frame);
        EXPECT_LE(small.bytes(), 1'000u);
    }
    EXPECT_EQ(few.oldest(), 47u);
    EXPECT_EQ(few.find(46), nullptr);
    EXPECT_EQ(few.find(49)->tick, 49u);
    EXPECT_EQ(few.find(50), nullptr);
    EXPECT_GT(small.size(), 1u);
}

}  // namespace
}  // namespace huestep::server
