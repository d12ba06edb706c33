// The client's state machine, fed by hand with what a server would say, and with what none should.
#include "client/replica.h"

#include <gtest/gtest.h>

#include <limits>

#include "protocol/codec.h"
#include "protocol/frame.h"
#include "table.h"
#include "tests/core/spoil.h"

namespace huestep::client {
namespace {

using namespace protocol;

TEST(Replica, SaysHelloWithItsFingerprintAndSession) {
    Table table;
    table.replica.connected(0);
    const std::vector<Message> out = table.take();
    const auto hello = Table::find<Hello>(out);
    ASSERT_TRUE(hello.has_value());
    EXPECT_EQ(hello->session, "play");
    EXPECT_EQ(hello->fingerprint, (Fingerprint{1, 2, 3}));
    EXPECT_EQ(hello->haveTick, 0u);
    EXPECT_FALSE(hello->resume.has_value());
}

TEST(Replica, FollowsFramesAndComparesEveryHash) {
    Table table;
    table.enter();
    for (int i = 0; i < 100; ++i) EXPECT_TRUE(table.say(table.frame()));
    EXPECT_EQ(table.replica.world()->fullRoot(), table.world.fullRoot());
    EXPECT_EQ(table.replica.counts().hashesCompared, 100u);
    EXPECT_EQ(table.replica.counts().ticks, 100u);
    EXPECT_EQ(table.replica.counts().mismatches, 0u);
}

TEST(Replica, SendsACheckpointNowAndThen) {
    Table table;
    table.enter();
    std::size_t checkpoints = 0;
    for (int i = 0; i < 90; ++i) {
        table.say(table.frame());
        const auto intent = Table::find<Intent>(table.take());
        if (!intent || !intent->checkpoint) continue;
        ++checkpoints;
        EXPECT_EQ(intent->checkpoint->tick, table.world.tick());
        EXPECT_EQ(intent->checkpoint->motionRoot, table.world.motionRoot());
    }
    EXPECT_EQ(checkpoints, 3u);
}

TEST(Replica, AMismatchFreezesItsTickAsksForItAndNamesBodyAndField) {
    Table table;
    table.enter();
    for (int i = 0; i < 10; ++i) table.say(table.frame());
    WorldSpoiler::flip(*table.replica.world(), 2, 4, 12);
    const World frozen = table.world;
    const std::uint64_t tick = table.world.tick();
    EXPECT_TRUE(table.say(table.frame()));
    EXPECT_FALSE(table.replica.following());
    const std::vector<Message> asked = table.take();
    EXPECT_EQ(Table::find<HashQuery>(asked)->tick, tick);
    EXPECT_EQ(Table::find<SnapshotRequest>(asked)->tick, tick);
    EXPECT_TRUE(table.say(table.frame())) << "frames are let go meanwhile";
    EXPECT_EQ(table.replica.world()->tick(), tick);

    EXPECT_TRUE(table.say(HashNodes{tick, frozen.motionLeaves(), 0}));
    table.world = frozen;
    table.snapshot();
    const auto report = Table::find<DesyncReport>(table.take());
    ASSERT_TRUE(report.has_value());
    EXPECT_EQ(report->tick, tick);
    EXPECT_EQ(report->body, 2u);
    EXPECT_EQ(report->field, "velocity.x");
    EXPECT_NE(report->here, report->there);
    EXPECT_EQ(report->yours, frozen.motionRoot());
    EXPECT_TRUE(table.replica.following());
    EXPECT_TRUE(table.say(table.frame()));
    EXPECT_EQ(table.replica.world()->fullRoot(), table.world.fullRoot());
    EXPECT_EQ(table.replica.counts().corrections, 1u);
}

TEST(Replica, IfTheServerNoLongerHasTheTickTheBlockOfBodiesIsNamed) {
    Table table;
    table.enter();
    WorldSpoiler::flip(*table.replica.world(), 2, 4, 12);
    const std::uint64_t tick = table.world.tick();
    const std::vector<std::uint64_t> leaves = table.world.motionLeaves();
    table.say(table.frame());
    for (int i = 0; i < 50; ++i) table.frame();
    EXPECT_TRUE(table.say(HashNodes{tick, leaves, 0}));
    table.take();
    table.snapshot();
    const auto report = Table::find<DesyncReport>(table.take());
    ASSERT_TRUE(report.has_value());
    EXPECT_EQ(report->tick, tick);
    EXPECT_EQ(report->body, 1u) << "the block's first";
    EXPECT_EQ(report->field, "block 0 of 64 bodies");
    EXPECT_EQ(table.replica.world()->tick(), table.world.tick());
}

TEST(Replica, OwnCommandsHaveRisingSequencesAndAreFoundInFrames) {
    Table table;
    table.enter();
    EXPECT_TRUE(table.act(ApplyImpulse{3, {1, 0}, {0, 6}}));
    EXPECT_TRUE(table.act(Release{}));
    const auto intent = Table::find<Intent>(table.take());
    ASSERT_TRUE(intent.has_value());
    ASSERT_EQ(intent->commands.size(), 2u);
    EXPECT_EQ(intent->commands[0].sequence, 1u);
    EXPECT_EQ(intent->commands[1].sequence, 2u);
    table.now += 50'000'000;
    EXPECT_TRUE(table.say(table.frame(intent->commands)));
    EXPECT_EQ(table.replica.counts().commandsSeen, 2u);
    EXPECT_EQ(table.replica.counts().commandsRejected, 1u) << "nothing was grabbed";
    EXPECT_NEAR(table.replica.statistics().latencyMedian, 0.05, 1e-9);
}

TEST(Replica, NoMoreCommandsInAnIntentThanWelcomeAllows) {
    Table table;
    table.enter();
    for (int i = 0; i < 40; ++i) table.act(Release{});
    std::vector<std::size_t> sizes;
    for (const Message& message : table.take()) {
        sizes.push_back(std::get<Intent>(message).commands.size());
    }
    EXPECT_EQ(sizes, (std::vector<std::size_t>{16, 16, 8}));
}

TEST(Replica, CommandsThatWaitForTheirCommitAreBounded) {
    Table table;
    table.enter();
    for (std::size_t i = 0; i < maxPendingCommands; ++i) {
        EXPECT_TRUE(table.act(Release{}));
    }
    EXPECT_FALSE(table.act(Release{}));
    const auto intent = Table::find<Intent>(table.take());
    table.say(table.frame(intent->commands));
    EXPECT_FALSE(table.act(Release{})) << "seen is not committed";
    table.say(table.frame({}, table.world.tick()));
    EXPECT_TRUE(table.act(Release{}));
}

TEST(Replica, AfterAResumeWhatTheServerDoesNotHaveIsSentAgainAndNothingElse) {
    Table table;
    table.enter();
    for (int i = 0; i < 3; ++i) table.act(Release{});
    const auto intent = Table::find<Intent>(table.take());
    // The server ordered the first two, and committed the first.
    table.say(table.frame({intent->commands[0]}));
    table.say(table.frame({intent->commands[1]}, table.world.tick()));
    table.replica.disconnected();

    table.replica.connected(table.now);
    const auto hello = Table::find<Hello>(table.take());
    EXPECT_EQ(hello->resume, (ResumeToken{9, 9}));
    EXPECT_EQ(hello->haveTick, table.world.tick());
    EXPECT_EQ(hello->haveHash, table.world.motionRoot());
    Welcome welcome;
    welcome.player = 1;
    welcome.epoch = 1;
    welcome.tick = table.world.tick();
    welcome.lastSequence = 2;
    table.say(welcome);
    const auto again = Table::find<Intent>(table.take());
    ASSERT_TRUE(again.has_value());
    EXPECT_EQ(again->commands, (std::vector<Command>{intent->commands[2]}));
    EXPECT_TRUE(table.say(table.frame())) << "the tail goes on without a snapshot";
    EXPECT_EQ(table.replica.counts().resumes, 1u);
}

TEST(Replica, CommandsOfFramesThatASnapshotReplacedAreNotWaitedForForEver) {
    Table table;
    table.enter();
    for (int i = 0; i < 3; ++i) table.act(Release{});
    const auto intent = Table::find<Intent>(table.take());
    table.frame({intent->commands[0], intent->commands[1]});  // never gets here
    table.snapshot();
    EXPECT_EQ(table.replica.counts().commandsSeen, 2u);
    EXPECT_EQ(table.replica.pendingCommands(), 3u);
    table.say(table.frame({}, table.world.tick()));
    EXPECT_EQ(table.replica.pendingCommands(), 1u) << "the third is still on its way";
    table.say(table.frame({intent->commands[2]}));
    table.say(table.frame({}, table.world.tick()));
    EXPECT_EQ(table.replica.pendingCommands(), 0u);
    EXPECT_EQ(table.replica.counts().commandsSeen, 3u);
}

TEST(Replica, ACommandTheServerLetGoOfIsCountedAsLostOnceALaterOneIsOrdered) {
    Table table;
    table.enter();
    for (int i = 0; i < 2; ++i) table.act(Release{});
    const auto intent = Table::find<Intent>(table.take());
    table.say(table.frame({intent->commands[1]}));
    table.say(table.frame({}, table.world.tick()));
    EXPECT_EQ(table.replica.pendingCommands(), 0u);
    EXPECT_EQ(table.replica.counts().commandsLost, 1u);
    EXPECT_EQ(table.replica.counts().commandsSeen, 1u);
}

TEST(Replica, AServerThatLostUncommittedTicksGetsThemAgainOnce) {
    Table table;
    table.enter();
    table.act(Release{});
    const auto intent = Table::find<Intent>(table.take());
    const World saved = table.world;
    table.say(table.frame(intent->commands));
    table.replica.disconnected();
    table.world = saved;  // the frame was not on disk
    table.welcome(1, 0, 2);
    const auto again = Table::find<Intent>(table.take());
    ASSERT_TRUE(again.has_value());
    EXPECT_EQ(again->commands, intent->commands);
    table.snapshot();
    EXPECT_EQ(table.replica.counts().rolledBack, 1u);
    EXPECT_EQ(table.replica.counts().committedLost, 0u);
}

TEST(Replica, ACommittedTickThatIsLostIsCounted) {
    Table table;
    table.enter();
    const World saved = table.world;
    for (int i = 0; i < 5; ++i) table.say(table.frame({}, table.world.tick()));
    table.replica.disconnected();
    table.world = saved;
    table.welcome(1, 0, 2);
    EXPECT_EQ(table.replica.counts().committedLost, 4u);
}

TEST(Replica, WhatNoServerSaysEndsTheConnectionWithABye) {
    const auto refused = [](auto speak) {
        Table table;
        table.enter();
        const bool taken = speak(table);
        const auto bye = Table::find<Bye>(table.take());
        return !taken && bye.has_value();
    };
    EXPECT_TRUE(refused([](Table& t) { return t.say(Hello{}); }));
    EXPECT_TRUE(refused([](Table& t) { return t.say(Intent{}); }));
    EXPECT_TRUE(refused([](Table& t) {
        t.frame();
        return t.say(t.frame());  // a gap
    }));
    EXPECT_TRUE(refused([](Table& t) { return t.say(SnapshotChunk{0, {std::byte{1}}}); }));
    EXPECT_TRUE(refused([](Table& t) { return t.say(SnapshotEnd{1}); }));
    EXPECT_TRUE(refused([](Table& t) { return t.say(SnapshotBegin{1, 0, 0}); }));
    EXPECT_TRUE(refused([](Table& t) { return t.say(SnapshotBegin{1, maxSnapshotBytes + 1, 0}); }));
    EXPECT_TRUE(refused([](Table& t) {
        t.say(SnapshotBegin{1, 10, 0});
        return t.say(SnapshotChunk{0, std::vector<std::byte>(11)});
    }));
    EXPECT_TRUE(refused([](Table& t) {
        t.say(SnapshotBegin{1, 10, 0});
        return t.say(SnapshotChunk{4, std::vector<std::byte>(2)});
    }));
    EXPECT_TRUE(refused([](Table& t) {
        const std::vector<std::byte> bytes = t.world.save();
        t.say(SnapshotBegin{t.world.tick(), bytes.size(), hash64(bytes) + 1});
        t.say(SnapshotChunk{0, bytes});
        return t.say(SnapshotEnd{t.world.tick()});
    }));
    EXPECT_TRUE(refused([](Table& t) {
        std::vector<std::byte> bytes = t.world.save();
        bytes.resize(bytes.size() / 2);
        t.say(SnapshotBegin{t.world.tick(), bytes.size(), hash64(bytes)});
        t.say(SnapshotChunk{0, bytes});
        return t.say(SnapshotEnd{t.world.tick()});
    }));
}

TEST(Replica, TheFirstMessageMustBeAWelcome) {
    Table table;
    table.replica.connected(0);
    EXPECT_FALSE(table.say(table.frame()));
}

TEST(Replica, ABrokenSnapshotLeavesTheWorldAsItWas) {
    Table first;
    first.enter();
    const std::vector<std::byte> whole = first.world.save();
    ASSERT_GT(whole.size(), 500u);
    for (std::size_t at = 0; at < whole.size(); at += 7) {
        SCOPED_TRACE("byte " + std::to_string(at));
        Table table;
        table.enter();
        for (int i = 0; i < 5; ++i) table.say(table.frame());
        const std::uint64_t root = table.replica.world()->fullRoot();
        std::vector<std::byte> bytes = table.world.save();
        ASSERT_EQ(bytes.size(), whole.size());
        bytes[at] ^= std::byte{64};
        // The sender hashed what it sends; the image's own checksums are what refuses it.
        EXPECT_TRUE(table.say(SnapshotBegin{table.world.tick(), bytes.size(), hash64(bytes)}));
        EXPECT_TRUE(table.say(SnapshotChunk{0, bytes}));
        EXPECT_FALSE(table.say(SnapshotEnd{table.world.tick()}));
        EXPECT_TRUE(Table::find<Bye>(table.take()).has_value());
        EXPECT_FALSE(table.replica.following());
        ASSERT_NE(table.replica.world(), nullptr);
        EXPECT_EQ(table.replica.world()->fullRoot(), root);
    }
}

/// Commands of Intents among the messages, and what they take.
std::vector<Command> commandsOf(const std::vector<Message>& messages) {
    std::vector<Command> out;
    for (const Message& message : messages) {
        const auto* intent = std::get_if<Intent>(&message);
        if (intent) out.insert(out.end(), intent->commands.begin(), intent->commands.end());
    }
    return out;
}

/// A spawn of so many bodies, each of eight octagons.
Spawn octagons(std::size_t bodies) {
    ShapeDef octagon = ShapeDef::box(1.0f, 1.0f);
    octagon.vertexCount = 8;
    octagon.vertices.fill({1.0f, 2.0f});
    BodyDef body;
    body.type = BodyType::Dynamic;
    body.shapes.assign(8, octagon);
    return Spawn{std::vector<BodyDef>(bodies, body), {}};
}

TEST(Replica, WhatNoIntentMayHoldIsRefusedWithASentenceAndTakesNoSequence) {
    Table table;
    table.enter();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<std::pair<Action, std::string>> wrong{
        {octagons(500), "at most " + std::to_string(maxPayload(MessageType::Intent))},
        {ApplyImpulse{3, {nan, 0}, {0, 6}}, "not a finite number"},
    };
    for (const auto& [action, why] : wrong) {
        const Status asked = table.replica.act(action, table.now);
        ASSERT_FALSE(asked.ok()) << why;
        EXPECT_EQ(asked.error().message.rfind("a command that cannot be sent: Intent", 0), 0u)
            << asked.error().message;
        EXPECT_NE(asked.error().message.find(why), std::string::npos) << asked.error().message;
    }
    EXPECT_EQ(table.replica.pendingCommands(), 0u);
    EXPECT_EQ(table.replica.counts().commandsSent, 0u);
    EXPECT_TRUE(table.act(Release{}));
    const std::vector<Command> sent = commandsOf(table.take());
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_EQ(sent[0].sequence, 1u);
}

TEST(Replica, EveryIntentItSendsIsOneThatAServerTakes) {
    Table table;
    table.enter();
    std::size_t asked = 0;
    for (std::size_t bodies = 1; bodies <= 64; ++bodies) {
        asked += table.act(octagons(bodies));
        asked += table.act(Release{});
    }
    EXPECT_GT(asked, 64u);
    EXPECT_LT(asked, 128u) << "none was too large for an Intent";
    const std::vector<Message> out = table.take();
    EXPECT_EQ(commandsOf(out).size(), asked);
    for (const Message& message : out) {
        const Result<Message> read = readFrame(encode(message));
        ASSERT_TRUE(read.ok()) << read.error().message;
        EXPECT_EQ(*read, message);
    }
}

TEST(Replica, NoMoreCommandsAreUnderWayThanMayWaitAtTheServer) {
    Table table;
    table.queued = 10;
    table.enter();
    for (int i = 0; i < 25; ++i) EXPECT_TRUE(table.act(Release{}));
    const std::vector<Command> first = commandsOf(table.take());
    ASSERT_EQ(first.size(), 10u);
    EXPECT_TRUE(commandsOf(table.take()).empty()) << "nothing more before a frame shows some";
    EXPECT_TRUE(table.say(table.frame({first[0], first[1], first[2]})));
    const std::vector<Command> second = commandsOf(table.take());
    ASSERT_EQ(second.size(), 3u);
    EXPECT_EQ(second.front().sequence, 11u);
    EXPECT_EQ(second.back().sequence, 13u);
}

TEST(Replica, NoMoreBytesAreUnderWayThanMayWaitAtTheServer) {
    Table table;
    table.queuedBytes = 16u << 10;
    table.enter();
    for (int i = 0; i < 25; ++i) EXPECT_TRUE(table.act(octagons(1)));
    std::vector<Command> waiting = commandsOf(table.take());
    std::size_t sent = waiting.size();
    EXPECT_LT(sent, 25u);
    for (int turns = 0; sent < 25 && turns < 25; ++turns) {
        std::size_t bytes = 0;
        for (const Command& command : waiting) bytes += commandBytes(command);
        EXPECT_LE(bytes, table.queuedBytes);
        EXPECT_GT(bytes + commandBytes(waiting[0]), table.queuedBytes) << "room is left";
        EXPECT_TRUE(table.say(table.frame({waiting[0]})));
        waiting.erase(waiting.begin());
        const std::vector<Command> more = commandsOf(table.take());
        waiting.insert(waiting.end(), more.begin(), more.end());
        sent += more.size();
    }
    EXPECT_EQ(sent, 25u);
}

TEST(Replica, AfterAResumeTooNoMoreIsSentAgainThanMayWaitAtTheServer) {
    Table table;
    table.queued = 10;
    table.enter();
    for (int i = 0; i < 25; ++i) EXPECT_TRUE(table.act(Release{}));
    EXPECT_EQ(commandsOf(table.take()).size(), 10u);
    table.replica.disconnected();
    table.welcome(1, 4);  // the server put four in order, whose frames are to come
    const std::vector<Command> again = commandsOf(table.take());
    ASSERT_EQ(again.size(), 6u);
    EXPECT_EQ(again.front().sequence, 5u);
    EXPECT_EQ(table.replica.counts().commandsResent, 6u);
}

TEST(Replica, CommandsThatAFullServerLetGoOfDoNotStopThoseAfterThem) {
    Table table;
    table.queued = 4;
    table.enter();
    for (int i = 0; i < 8; ++i) EXPECT_TRUE(table.act(Release{}));
    EXPECT_EQ(commandsOf(table.take()).size(), 4u);  // all let go of
    std::vector<std::uint64_t> counted;
    std::vector<Command> heard;
    for (int tick = 0; tick < 600; ++tick) {
        EXPECT_TRUE(table.say(table.frame(std::exchange(heard, {}), table.world.tick())));
        for (const Command& command : commandsOf(table.take())) {
            if (!counted.empty() && command.sequence <= counted.back()) continue;  // a repetition
            counted.push_back(command.sequence);
            heard.push_back(command);
        }
    }
    EXPECT_EQ(table.replica.pendingCommands(), 0u);
    EXPECT_EQ(counted, (std::vector<std::uint64_t>{1, 5, 6, 7, 8}));
    EXPECT_EQ(table.replica.counts().commandsLost, 3u);
    EXPECT_EQ(table.replica.counts().commandsSeen, 5u);
}

TEST(Replica, ByeAndPingAreAnsweredAsTheyShould) {
    Table table;
    table.enter();
    table.say(Ping{5, false});
    EXPECT_EQ(*Table::find<Ping>(table.take()), (Ping{5, true}));
    table.say(Bye{ByeReason::ServerStops, "stops", true});
    ASSERT_TRUE(table.replica.bye().has_value());
    EXPECT_EQ(table.replica.bye()->reason, ByeReason::ServerStops);
    EXPECT_FALSE(table.replica.following());
}

TEST(Replica, ARefusedTokenIsNotOfferedAgain) {
    Table table;
    table.enter();
    table.replica.disconnected();
    table.replica.connected(table.now);
    table.take();
    table.say(Bye{ByeReason::ResumeRefused, "used", false});
    table.replica.disconnected();
    table.replica.connected(table.now);
    EXPECT_FALSE(Table::find<Hello>(table.take())->resume.has_value());
}

}  // namespace
}  // namespace huestep::client
