// The protocol with one client: who is let in, and how it ends for those who break its rules.
#include "server/connection.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/scene/catalog.h"
#include "desk.h"
#include "protocol/codec.h"
#include "protocol/fingerprint.h"

namespace huestep::server {
namespace {

using protocol::ByeReason;
using test::Desk;
using test::deskScene;
using test::Peer;

TEST(Connection, APlayerIsWelcomedOnceItsFrameIsOnDisk) {
    Desk desk;
    desk.committing = false;
    Peer peer(desk);
    peer.say(peer.hello());
    desk.tick(5);
    peer.read();
    EXPECT_EQ(peer.count<protocol::Welcome>(), 0u);
    desk.committing = true;
    desk.tick(2);
    peer.read();
    ASSERT_EQ(peer.count<protocol::Welcome>(), 1u);
    EXPECT_EQ(peer.last<protocol::Welcome>()->player, 1u);
    EXPECT_EQ(desk.session->world().players().size(), 2u);
}

TEST(Connection, AfterWelcomeComeASnapshotAndThenEveryFrameFromItsTick) {
    Desk desk;
    desk.tick(50);
    Peer peer(desk);
    peer.join();
    desk.tick(10);
    peer.read();
    ASSERT_GE(peer.heard.size(), 5u);
    EXPECT_TRUE(std::holds_alternative<protocol::Welcome>(peer.heard[0]));
    const auto& begin = std::get<protocol::SnapshotBegin>(peer.heard[1]);
    std::vector<std::byte> bytes;
    std::uint64_t next = 0;
    for (const protocol::Message& message : peer.heard) {
        if (const auto* chunk = std::get_if<protocol::SnapshotChunk>(&message)) {
            EXPECT_EQ(chunk->offset, bytes.size());
            bytes.insert(bytes.end(), chunk->data.begin(), chunk->data.end());
        } else if (std::get_if<protocol::SnapshotEnd>(&message)) {
            next = begin.tick;
        } else if (const auto* frame = std::get_if<protocol::Frame>(&message)) {
            EXPECT_EQ(frame->tick, next++);
        }
    }
    EXPECT_EQ(bytes.size(), begin.bytes);
    EXPECT_EQ(next, desk.session->tick());
    const Result<World> world = World::restore(bytes);
    ASSERT_TRUE(world.ok());
    EXPECT_EQ(world->tick(), begin.tick);
}

TEST(Connection, WrongVersionFingerprintOrSessionIsRefusedWithItsReason) {
    const auto refusal = [](auto change) {
        Desk desk;
        Peer peer(desk);
        protocol::Hello hello = peer.hello();
        change(hello);
        peer.say(hello);
        return peer.bye();
    };
    EXPECT_EQ(refusal([](auto& hello) { hello.version = 2; }), ByeReason::VersionMismatch);
    EXPECT_EQ(refusal([](auto& hello) { hello.fingerprint.selfTest = 1; }),
              ByeReason::FingerprintMismatch);
    EXPECT_EQ(refusal([](auto& hello) { hello.session = "nowhere"; }), ByeReason::UnknownSession);
}

TEST(Connection, ABuildWithoutTheRulesOfTheSessionIsRefusedAndToldWhichItLacks) {
    const auto answer = [](const std::vector<std::uint64_t>& rules) {
        Desk desk({}, *sceneFromCatalog("ball"));
        Peer peer(desk);
        protocol::Hello hello = peer.hello();
        hello.rules = rules;
        peer.say(hello);
        desk.tick(3);
        peer.read();
        const auto* bye = peer.last<protocol::Bye>();
        return bye == nullptr ? std::string("welcome") : bye->text;
    };
    const std::uint64_t building = protocol::rulesMark("building", 1);
    const std::uint64_t older = protocol::rulesMark("ball", 0);
    const std::vector<std::vector<std::uint64_t>> lacking{{}, {building}, {building, older}};
    for (const std::vector<std::uint64_t>& rules : lacking) {
        const std::string text = answer(rules);
        EXPECT_NE(text.find("by the rules ball 1"), std::string::npos) << text;
        EXPECT_NE(text.find("--web"), std::string::npos) << text;
    }
    EXPECT_EQ(answer({building, protocol::rulesMark("ball", 1)}), "welcome");
    EXPECT_EQ(answer(protocol::builtInRulesMarks()), "welcome");
}

TEST(Connection, ASpectatorOfAnotherBuildIsSentToThePage) {
    Desk desk;
    Peer peer(desk);
    protocol::Hello hello = peer.hello();
    hello.fingerprint.selfTest = 1;
    hello.role = protocol::Role::Spectator;
    peer.say(hello);
    EXPECT_EQ(peer.bye(), ByeReason::FingerprintMismatch);
    EXPECT_EQ(peer.count<protocol::Welcome>(), 0u);
    EXPECT_NE(peer.last<protocol::Bye>()->text.find("--web"), std::string::npos);
}

TEST(Connection, WhatAByeSaysIsCutBetweenCharacters) {
    ConnectionContext context;
    Connection connection(1, "test", context, 0);
    connection.end(ByeReason::BadMessage, std::string(255, 'x') + "\u00e9 and more", false, 0);
    const SharedBytes bytes = connection.next(0, 0);
    ASSERT_NE(bytes, nullptr);
    protocol::FrameSplitter splitter;
    std::vector<protocol::Message> heard;
    const Status fed = splitter.feed(*bytes, heard);
    ASSERT_TRUE(fed.ok()) << fed.error().message;
    EXPECT_EQ(std::get<protocol::Bye>(heard.at(0)).text, std::string(255, 'x'));
}

TEST(Connection, TheLargestSpawnThatAWorldTakesOfAPlayerIsTaken) {
    Desk desk;
    Peer peer(desk);
    peer.join();
    ShapeDef shape;
    shape.kind = ShapeKind::Polygon;
    shape.vertexCount = maxPolygonVertices;
    BodyDef body;
    body.shapes.assign(8, shape);
    peer.say(protocol::Intent{{{1, 1, Spawn{std::vector<BodyDef>(8, body), {}}}}, std::nullopt});
    EXPECT_EQ(peer.bye(), std::nullopt);
    EXPECT_EQ(desk.hub.counters().commandsQueued, 1u);
}

TEST(Connection, NothingLargerThanAHelloIsReadBeforeOne) {
    Limits limits;
    limits.helloBytes = 64;
    Desk desk(limits);
    Peer peer(desk);
    peer.say(peer.hello());
    EXPECT_EQ(peer.bye(), ByeReason::BadMessage);
}

TEST(Connection, AnIntentAboveTheCapIsRefusedFromItsHeader) {
    Limits limits;
    limits.messageBytes = 512;
    Desk desk(limits);
    Peer peer(desk);
    const PlayerId player = peer.join().player;
    protocol::Intent intent;
    for (std::uint64_t s = 1; s <= 16; ++s) intent.commands.push_back({player, s, Release{}});
    peer.say(intent);
    EXPECT_EQ(peer.bye(), ByeReason::BadMessage);
    EXPECT_EQ(desk.session->queued(), 0u);
}

TEST(Connection, CorruptBytesEndItWithABye) {
    Desk desk;
    Peer peer(desk);
    std::vector<std::byte> bytes = protocol::encode(peer.hello());
    bytes[40] ^= std::byte{4};
    peer.bytes(bytes);
    EXPECT_EQ(peer.bye(), ByeReason::BadMessage);
    EXPECT_EQ(desk.hub.counters().badMessages, 1u);
}

TEST(Connection, AMessageOutOfPlaceEndsIt) {
    Desk desk;
    Peer early(desk);
    early.say(protocol::Intent{});
    EXPECT_EQ(early.bye(), ByeReason::UnexpectedMessage);
    Peer twice(desk);
    twice.join();
    twice.say(twice.hello());
    EXPECT_EQ(twice.bye(), ByeReason::UnexpectedMessage);
    Peer server(desk);
    server.join();
    server.say(protocol::Frame{});
    EXPECT_EQ(server.bye(), ByeReason::UnexpectedMessage);
}

TEST(Connection, WithoutAHelloInFiveSecondsItEnds) {
    Desk desk;
    Peer peer(desk);
    desk.wait(5 * second);
    EXPECT_EQ(peer.bye(), std::nullopt);
    desk.wait(1);
    EXPECT_EQ(peer.bye(), ByeReason::Timeout);
}

TEST(Connection, AMessageBegunMustBeFinishedInTime) {
    Desk desk;
    Peer peer(desk);
    peer.join();
    const std::vector<std::byte> bytes = protocol::encode(protocol::Ping{});
    peer.bytes(std::span(bytes).first(20));
    // A byte now and then does not help.
    desk.wait(3 * second);
    peer.bytes(std::span(bytes).subspan(20, 1));
    EXPECT_EQ(peer.bye(), std::nullopt);
    desk.wait(2 * second + 1);
    EXPECT_EQ(peer.bye(), ByeReason::Timeout);
}

TEST(Connection, SilenceIsAnsweredByPingsAndThenTheEnd) {
    Desk desk;
    Peer peer(desk);
    peer.watch();
    for (int i = 0; i < 14; ++i) desk.wait(second);
    peer.read();
    EXPECT_GE(peer.count<protocol::Ping>(), 3u);
    EXPECT_EQ(peer.bye(), std::nullopt);
    for (int i = 0; i < 2; ++i) desk.wait(second);
    EXPECT_EQ(peer.bye(), ByeReason::Timeout);
}

TEST(Connection, APingIsAnswered) {
    Desk desk;
    Peer peer(desk);
    peer.watch();
    peer.say(protocol::Ping{77, false});
    peer.read();
    EXPECT_EQ(*peer.last<protocol::Ping>(), (protocol::Ping{77, true, desk.session->tick(), 0}));
}

TEST(Connection, APingsAnswerSaysHowFarTheSessionIsIntoItsTick) {
    Desk desk;
    Peer peer(desk);
    peer.join();
    desk.tick(5);
    desk.now += 7 * millisecond;
    peer.say(protocol::Ping{78, false});
    desk.now += 3 * millisecond;  // it waits to be written: that does not count
    peer.read();
    EXPECT_EQ(*peer.last<protocol::Ping>(),
              (protocol::Ping{78, true, desk.session->tick(), 7'000}));
}

TEST(Connection, CommandsGoIntoTheFrameThatTheirIntentAsksFor) {
    Desk desk;
    Peer peer(desk);
    const protocol::Welcome welcome = peer.join();
    const std::uint64_t asked = desk.session->tick() + 4;
    peer.say(protocol::Intent{{{0, welcome.lastSequence + 1, Release{}}}, std::nullopt, asked});
    desk.tick(8);
    for (std::uint64_t tick = asked - 4; tick < asked + 4; ++tick) {
        EXPECT_EQ(desk.session->frames().find(tick)->commands.size(), tick == asked ? 1u : 0u);
    }
}

TEST(Connection, MoreMessagesThanTheRateEndIt) {
    Limits limits;
    limits.messageBurst = 10;
    Desk desk(limits);
    Peer peer(desk);
    peer.watch();
    for (int i = 0; i < 9; ++i) peer.say(protocol::Ping{1, true});
    EXPECT_EQ(peer.bye(), std::nullopt);
    peer.say(protocol::Ping{1, true});
    EXPECT_EQ(peer.bye(), ByeReason::TooFast);
}

TEST(Connection, MoreRequestsThatCostWorkThanTheRateEndIt) {
    Desk desk;
    Peer peer(desk);
    peer.watch();
    for (int i = 0; i < 6; ++i) peer.say(protocol::SnapshotRequest{0});
    EXPECT_EQ(peer.bye(), std::nullopt);
    peer.say(protocol::SnapshotRequest{0});
    EXPECT_EQ(peer.bye(), ByeReason::TooFast);
}

TEST(Connection, HashQueriesThatWaitAreBounded) {
    Limits limits;
    limits.heavyBurst = 100;
    Desk desk(limits);
    desk.tick(70);
    Peer peer(desk);
    peer.watch();
    for (std::uint64_t i = 0; i < 4; ++i) peer.say(protocol::HashQuery{65 + i});
    EXPECT_EQ(peer.bye(), std::nullopt);
    peer.say(protocol::HashQuery{64});
    EXPECT_EQ(peer.bye(), ByeReason::TooFast);
}

TEST(Connection, AsManyCommandsAsWelcomeSaysMayWaitAndOneMoreEndsIt) {
    Limits limits;
    limits.queuedPerPlayer = 8;
    Desk desk(limits);
    Peer peer(desk);
    const protocol::Welcome welcome = peer.join();
    ASSERT_EQ(welcome.maxQueuedCommands, 8u);
    EXPECT_EQ(welcome.maxQueuedBytes, limits.queuedBytesPerPlayer);
    protocol::Intent intent;
    for (std::uint64_t s = 1; s <= 8; ++s) intent.commands.push_back({1, s, Release{}});
    peer.say(intent);
    EXPECT_EQ(peer.bye(), std::nullopt);
    peer.say(protocol::Intent{{{1, 9, Release{}}}, std::nullopt});
    EXPECT_EQ(peer.bye(), ByeReason::TooFast);
}

TEST(Connection, TheShortestStepOfASceneHasAWelcomeThatAClientTakes) {
    Scene scene = deskScene();
    scene.stepSeconds = caps::minStepSeconds;
    Desk desk({}, scene);
    Peer peer(desk);
    EXPECT_EQ(peer.join().ticksPerSecond, 10'000.0f);
}

TEST(Connection, AFullSessionQueueDropsCommandsAndCountsThem) {
    Limits limits;
    limits.queuedInTotal = 4;
    Desk desk(limits);
    Peer peer(desk);
    const PlayerId player = peer.join().player;
    protocol::Intent intent;
    for (std::uint64_t s = 1; s <= 6; ++s) intent.commands.push_back({player, s, Release{}});
    peer.say(intent);
    EXPECT_EQ(peer.bye(), std::nullopt);
    EXPECT_EQ(desk.hub.counters().commandsQueued, 4u);
    EXPECT_EQ(desk.hub.counters().commandsDropped, 2u);
}

TEST(Connection, MoreCommandsInAnIntentThanWelcomeSaysEndIt) {
    Desk desk;
    Peer peer(desk);
    const protocol::Welcome welcome = peer.join();
    protocol::Intent intent;
    for (std::uint64_t s = 1; s <= welcome.maxCommandsPerIntent + 1; ++s) {
        intent.commands.push_back({welcome.player, s, Release{}});
    }
    peer.say(intent);
    EXPECT_EQ(peer.bye(), ByeReason::BadMessage);
}

TEST(Connection, ASpectatorHasNoCommands) {
    Desk desk;
    Peer peer(desk);
    peer.watch();
    peer.say(protocol::Intent{{}, protocol::Checkpoint{0, 0}});
    EXPECT_EQ(peer.bye(), std::nullopt);
    peer.say(protocol::Intent{{{0, 1, Release{}}}, std::nullopt});
    EXPECT_EQ(peer.bye(), ByeReason::UnexpectedMessage);
}

TEST(Connection, TheServerOverwritesTheAuthorOfACommand) {
    Desk desk;
    Peer first(desk), second(desk);
    first.join();
    const PlayerId player = second.join().player;
    second.say(protocol::Intent{{{1, 1, Release{}}}, std::nullopt});
    desk.tick();
    second.read();
    const auto* frame = second.last<protocol::Frame>();
    ASSERT_EQ(frame->commands.size(), 1u);
    EXPECT_EQ(frame->commands[0].author, player);
    EXPECT_NE(frame->commands[0].author, 1u);
}

TEST(Connection, AClientsCheckpointIsCompared) {
    Desk desk;
    Peer peer(desk);
    peer.join();
    const std::uint64_t tick = desk.session->tick();
    peer.say(protocol::Intent{{}, protocol::Checkpoint{tick, desk.session->world().motionRoot()}});
    peer.say(protocol::Intent{{}, protocol::Checkpoint{tick - 1, 12345}});
    peer.say(protocol::Intent{{}, protocol::Checkpoint{tick + 9, 12345}});
    EXPECT_EQ(desk.hub.counters().checkpointsChecked, 2u);
    EXPECT_EQ(desk.hub.counters().checkpointMismatches, 1u);
    EXPECT_TRUE(desk.logged("event=checkpoint_mismatch"));
}

TEST(Connection, ASpectatorCannotFloodTheLogWithCheckpoints) {
    Desk desk;
    Peer peer(desk);
    peer.watch();
    desk.tick(5);
    for (int i = 0; i < 200; ++i) {
        peer.say(protocol::Intent{{}, protocol::Checkpoint{desk.session->tick(), 12345}});
    }
    EXPECT_EQ(peer.bye(), std::nullopt);
    EXPECT_EQ(desk.hub.counters().checkpointMismatches, 200u);
    const auto lines = std::count_if(desk.log.begin(), desk.log.end(), [](const auto& line) {
        return line.find("event=checkpoint_mismatch") != std::string::npos;
    });
    EXPECT_GE(lines, 1);
    EXPECT_LE(lines, 5);
}

TEST(Connection, ADesyncReportIsLoggedWithTickBodyAndField) {
    Desk desk;
    Peer peer(desk);
    peer.join();
    peer.say(protocol::DesyncReport{12, 1, 2, 5, "velocity.x", "1", "2"});
    EXPECT_TRUE(desk.logged("event=desync"));
    EXPECT_TRUE(desk.logged("tick=12 body=5 field=velocity.x client_value=1 server_value=2"));
}

// Slow consumers -------------------------------------------------------------------------------

TEST(SlowConsumer, NoMoreThanLowWaterAndOneMessageLiesUnsent) {
    Limits limits;
    limits.lowWater = 4'096;
    Desk desk(limits);
    Peer peer(desk);
    peer.join();
    std::size_t most = 0;
    for (int i = 0; i < 110; ++i) {
        desk.tick();
        most = std::max(most, peer.stall());
    }
    EXPECT_GE(most, limits.lowWater) << "it was put to the test";
    EXPECT_LT(most, limits.lowWater + 512);
}

TEST(SlowConsumer, TwoSecondsBehindItGetsASnapshotInPlaceOfTheFramesItMissed) {
    Desk desk;
    Peer peer(desk);
    peer.join();
    desk.tick(30);
    peer.read();
    peer.heard.clear();
    desk.tick(150);  // 2.5 s without asking for anything
    peer.read();
    EXPECT_EQ(desk.hub.counters().resyncs, 1u);
    ASSERT_EQ(peer.count<protocol::SnapshotEnd>(), 1u);
    EXPECT_LT(peer.count<protocol::Frame>(), 60u);
    EXPECT_EQ(peer.last<protocol::Frame>()->tick + 1, desk.session->tick());
}

TEST(SlowConsumer, OneThatTakesNothingForTenSecondsIsDroppedWithTheRightToResume) {
    Desk desk;
    Peer peer(desk);
    peer.join();
    for (int i = 0; i < 60 * 14; ++i) {
        desk.tick();
        peer.say(protocol::Ping{1, true});  // it writes, but does not read
        peer.stall();
    }
    peer.unstall();
    EXPECT_EQ(peer.bye(), ByeReason::TooSlow);
    EXPECT_TRUE(peer.last<protocol::Bye>()->mayResume);
    EXPECT_EQ(desk.hub.counters().tooSlow, 1u);
    EXPECT_TRUE(desk.session->seats().has(1)) << "its seat is kept";
}

TEST(SlowConsumer, AnswersThatPileUpUnreadEndIt) {
    Limits limits;
    limits.clientBytes = 4'096;
    limits.lowWater = 1'024;
    Desk desk(limits);
    Peer peer(desk);
    peer.watch();
    peer.stall();
    for (int i = 0; i < 200; ++i) {
        peer.say(protocol::Ping{1, false});
        peer.stall();
    }
    EXPECT_EQ(desk.hub.counters().tooSlow, 1u);
}

TEST(SlowConsumer, AJoinersSnapshotDoesNotHoldUpTheOthers) {
    Desk desk;
    Peer quick(desk);
    quick.join();
    Peer slow(desk);
    slow.say(slow.hello());
    for (int i = 0; i < 120; ++i) {
        desk.tick();
        slow.stall();
        quick.read();
        EXPECT_EQ(quick.last<protocol::Frame>()->tick + 1, desk.session->tick());
    }
}

/// Lets a joiner take one byte of its snapshot a tick, for so many seconds; how many were too slow.
std::uint64_t trickled(double leastBytesPerSecond, int seconds) {
    Limits limits;
    limits.lowWater = 1'000;
    limits.snapshotBytesPerSecond = leastBytesPerSecond;
    Desk desk(limits);
    Peer peer(desk);
    protocol::Hello hello = peer.hello();
    hello.role = protocol::Role::Spectator;
    peer.say(hello);
    std::vector<protocol::Message> heard;
    protocol::FrameSplitter splitter;
    std::size_t unsent = 0;
    for (int i = 0; i < 60 * seconds; ++i) {
        desk.tick();
        peer.say(protocol::Ping{1, true});
        while (const SharedBytes bytes = desk.hub.next(peer.id(), unsent, desk.now)) {
            unsent += bytes->size();
            EXPECT_TRUE(splitter.feed(*bytes, heard).ok());
        }
        --unsent;
    }
    EXPECT_GT(unsent, 1'000u) << "the snapshot is not through";
    return desk.hub.counters().tooSlow;
}

TEST(SlowConsumer, OneThatStaysTooFarBehindIsDropped) {
    Desk desk;
    Peer first(desk);
    protocol::Hello hello = first.hello();
    hello.resume = first.join().resume;
    hello.haveTick = desk.session->tick();
    hello.haveHash = desk.session->world().motionRoot();
    desk.hub.closed(first.id(), desk.now);
    desk.tick(200);
    Peer again(desk);
    again.say(hello);
    for (int i = 0; i < 60 * 12; ++i) {
        desk.tick();
        again.say(protocol::Ping{1, true});
        // One message a tick keeps it as far behind as it came.
        static_cast<void>(desk.hub.next(again.id(), 0, desk.now));
        if (i == 60 * 9) {
            EXPECT_EQ(desk.hub.counters().tooSlow, 0u);
        }
    }
    EXPECT_EQ(desk.hub.counters().tooSlow, 1u);
    EXPECT_EQ(desk.hub.counters().resyncs, 0u);
    EXPECT_TRUE(desk.logged("too far behind for too long"));
}

TEST(SlowConsumer, OneThatTakesABitOfItsSnapshotNowAndThenIsDropped) {
    EXPECT_EQ(trickled(16.0 * 1024.0, 12), 1u);
}

TEST(SlowConsumer, OneThatKeepsThePaceOfASnapshotIsNot) {
    EXPECT_EQ(trickled(30.0, 12), 0u);
}

TEST(SlowConsumer, ThoseWhoReadSnapshotsSlowlyHoldFewAndOthersShareTheNewestOfThem) {
    Limits limits;
    limits.lentSnapshots = 1;
    Desk desk(limits);
    desk.tick(100);
    Peer slow(desk);
    protocol::Hello hello = slow.hello();
    hello.role = protocol::Role::Spectator;
    slow.say(hello);  // and reads nothing
    desk.tick(50);
    Peer quick(desk);
    quick.watch();
    ASSERT_EQ(quick.count<protocol::SnapshotBegin>(), 1u);
    EXPECT_LE(quick.last<protocol::SnapshotBegin>()->tick, 100u) << "the one that is held";
    EXPECT_EQ(quick.last<protocol::Frame>()->tick + 1, desk.session->tick()) << "and the tail";

    quick.heard.clear();
    const std::uint64_t tick = desk.session->tick();
    quick.say(protocol::SnapshotRequest{tick});
    desk.tick(60);  // its world is rebuilt by then
    quick.read();
    EXPECT_EQ(quick.count<protocol::SnapshotBegin>(), 0u) << "no second one is made";
    slow.read();
    desk.tick();
    quick.read();
    ASSERT_EQ(quick.count<protocol::SnapshotBegin>(), 1u);
    EXPECT_GE(quick.last<protocol::SnapshotBegin>()->tick, tick);
    desk.tick();
    quick.read();
    ASSERT_NE(quick.last<protocol::Frame>(), nullptr);
    EXPECT_EQ(quick.last<protocol::Frame>()->tick + 1, desk.session->tick());
}

}  // namespace
}  // namespace huestep::server
