// A client that predicts, fed by hand: what it shows, what it asks for, and how it goes back.
#include "client/prediction.h"

#include "table.h"
#include "tests/core/spoil.h"

namespace huestep::client {
namespace {

using namespace protocol;

constexpr Instant tickTime = 1'000'000'000 / 60;

/// A client that is let in, and to which the server is `way` ticks ahead of what it has heard.
struct Ahead : Table {
    explicit Ahead(std::uint64_t way, PredictionRules rules = {}) : Table(std::move(rules)) {
        enter();
        measure(way);
    }
    /// Answers the Pings of the client as a server that is so far along.
    void measure(std::uint64_t way) {
        replica.advance(now);
        for (const Message& message : take()) {
            const auto* ping = std::get_if<Ping>(&message);
            if (ping) say(Ping{ping->nonce, true, confirmed() + way, 0});
        }
        replica.advance(now);
    }
    [[nodiscard]] std::uint64_t confirmed() const { return replica.timeline()->confirmed(); }
    [[nodiscard]] std::uint64_t head() const { return replica.timeline()->head(); }
    [[nodiscard]] PredictionFigures figures() const { return *replica.statistics().prediction; }
    /// A tick goes by for both; the server has these commands in it.
    void pass(std::vector<Command> commands = {}) {
        now += tickTime;
        EXPECT_TRUE(say(frame(std::move(commands))));
        replica.advance(now);
    }
    std::vector<Intent> intents() {
        std::vector<Intent> out;
        for (const Message& message : take()) {
            const auto* intent = std::get_if<Intent>(&message);
            if (intent && !intent->commands.empty()) out.push_back(*intent);
        }
        return out;
    }
};

const ApplyImpulse pushOfOwn{3, {0.2f, 1.0f}, {0.0f, 6.0f}};

TEST(Prediction, TheWorldRunsAheadByTheWayToTheServer) {
    Ahead table(8);
    EXPECT_EQ(table.head(), table.confirmed() + 8);
    for (int i = 0; i < 30; ++i) {
        table.pass();
        EXPECT_NEAR(static_cast<double>(table.head() - table.confirmed()), 8.0, 1.0);
    }
    EXPECT_EQ(table.figures().rollbacks, 0u);
    EXPECT_EQ(table.replica.counts().mismatches, 0u);
    EXPECT_EQ(table.replica.statistics().root, table.world.motionRoot());
}

TEST(Prediction, BeforeTheWayIsKnownNothingIsPredicted) {
    Table table(PredictionRules{});
    table.enter();
    for (int i = 0; i < 20; ++i) {
        table.now += tickTime;
        EXPECT_TRUE(table.say(table.frame()));
        table.replica.advance(table.now);
        EXPECT_EQ(table.replica.timeline()->ahead(), 0u);
    }
    EXPECT_TRUE(table.act(pushOfOwn));
    for (const Message& message : table.take()) {
        const auto* intent = std::get_if<Intent>(&message);
        EXPECT_TRUE(!intent || intent->tick == 0u);
    }
}

TEST(Prediction, WhoeverWatchesDoesNotPredict) {
    Table table(PredictionRules{}, Role::Spectator);
    table.welcome(0);
    table.snapshot();
    table.replica.advance(table.now);
    EXPECT_EQ(table.replica.prediction(), nullptr);
    EXPECT_FALSE(Table::find<Ping>(table.take()).has_value());
    EXPECT_FALSE(table.replica.statistics().prediction.has_value());
}

TEST(Prediction, AnOwnCommandIsShownInTheNextTickAndConfirmedWithoutAStepMore) {
    Ahead table(6);
    const std::uint64_t given = table.head();
    EXPECT_TRUE(table.act(pushOfOwn));
    const std::vector<Intent> sent = table.intents();
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_EQ(sent[0].tick, given) << "it asks for the tick in which it is shown";
    table.pass();
    const World* shown = table.replica.world();
    ASSERT_GT(shown->tick(), given);
    EXPECT_GT(shown->motions()[*shown->find(3)].velocity.x, 0.0f);
    while (table.world.tick() < given) table.pass();
    EXPECT_EQ(table.replica.counts().commandsSeen, 0u);
    table.pass(sent[0].commands);
    EXPECT_EQ(table.replica.counts().commandsSeen, 1u);
    EXPECT_EQ(table.figures().rollbacks, 0u);
    for (int i = 0; i < 10; ++i) table.pass();
    EXPECT_EQ(table.replica.counts().mismatches, 0u);
}

TEST(Prediction, ARejectedOwnCommandIsCountedWhereItIsConfirmed) {
    Ahead table(5);
    EXPECT_TRUE(table.act(Release{}));
    const std::vector<Intent> sent = table.intents();
    for (int i = 0; i < 3; ++i) table.pass();
    EXPECT_EQ(table.replica.counts().commandsRejected, 0u) << "not yet more than a guess";
    while (table.world.tick() < sent.at(0).tick) table.pass();
    table.pass(sent[0].commands);
    EXPECT_EQ(table.replica.counts().commandsRejected, 1u);
}

TEST(Prediction, ACommandThatComesLateIsPredictedAgainUntilAFrameHasIt) {
    Ahead table(6);
    EXPECT_TRUE(table.act(pushOfOwn));
    const std::vector<Intent> sent = table.intents();
    while (table.world.tick() <= sent.at(0).tick) table.pass();  // its tick closes without it
    const PredictionFigures once = table.figures();
    EXPECT_EQ(once.rollbacks, 1u);
    const World* shown = table.replica.world();
    EXPECT_GT(shown->motions()[*shown->find(3)].velocity.x, 0.0f) << "it is still to come";
    table.now += tickTime;
    Frame late = table.frame(sent[0].commands);
    late.substituted = {1};
    EXPECT_TRUE(table.say(late));
    table.replica.advance(table.now);
    EXPECT_EQ(table.figures().rollbacks, 1u) << "it was expected in the next frame";
    EXPECT_EQ(table.figures().late, 1u);
    for (int i = 0; i < 10; ++i) table.pass();
    EXPECT_EQ(table.replica.counts().commandsSeen, 1u);
    EXPECT_EQ(table.replica.counts().mismatches, 0u);
    EXPECT_EQ(table.replica.statistics().root, table.world.motionRoot());
}

TEST(Prediction, FramesThatComeTogetherCostOneWayBackAndNoneAnswersForTheOthers) {
    Ahead table(10);
    std::vector<Frame> late;
    for (std::uint64_t i = 0; i < 5; ++i) {
        table.now += tickTime;
        table.replica.advance(table.now);
        late.push_back(table.frame({{0, 2 + i, ApplyImpulse{1, {1.0f, 0.0f}, {0.0f, 5.0f}}}}));
    }
    const std::uint64_t head = table.head();
    EXPECT_GT(head, table.confirmed() + 10);
    for (const Frame& frame : late) EXPECT_TRUE(table.say(frame));
    EXPECT_EQ(table.replica.timeline()->ahead(), 0u) << "nothing is stepped before it is asked for";
    table.replica.advance(table.now);
    EXPECT_EQ(table.head(), head) << "the world is not seen to go back";
    const PredictionFigures f = table.figures();
    EXPECT_EQ(f.rollbacks, 1u);
    EXPECT_EQ(f.deepest, head - late.front().tick);
    EXPECT_EQ(f.again, head - table.confirmed());
}

TEST(Prediction, NoMoreThanSixtyTicksAreUndoneHoweverFarTheServerSaysItIs) {
    for (const std::uint64_t way : {std::uint64_t{59}, std::uint64_t{200}, ~std::uint64_t{0} / 2}) {
        Ahead table(way);
        EXPECT_EQ(table.head() - table.confirmed(), std::min<std::uint64_t>(way, 60)) << way;
        EXPECT_TRUE(table.act(pushOfOwn));
        const std::vector<Intent> sent = table.intents();
        // What is beyond is felt: the command asks for when it can be there, within reason.
        EXPECT_GE(sent.at(0).tick, table.confirmed() + std::min<std::uint64_t>(way, 120)) << way;
        EXPECT_LE(sent.at(0).tick, table.confirmed() + 120) << way;
        table.pass({{0, 2, ApplyImpulse{1, {1.0f, 0.0f}, {0.0f, 5.0f}}}});
        EXPECT_EQ(table.figures().deepest, std::min<std::uint64_t>(way, 60)) << way;
    }
}

TEST(Prediction, AnInputDelayIsFeltAndTakesAsMuchFromTheLead) {
    PredictionRules rules;
    rules.pacing.inputDelay = 4;
    Ahead table(10, rules);
    EXPECT_EQ(table.head(), table.confirmed() + 6);
    const std::uint64_t given = table.head();
    EXPECT_TRUE(table.act(pushOfOwn));
    EXPECT_EQ(table.intents().at(0).tick, given + 4);
    const auto speed = [&] {
        const World* shown = table.replica.world();
        return shown->motions()[*shown->find(3)].velocity.x;
    };
    while (table.head() < given + 4) {
        table.pass();
        EXPECT_TRUE(table.head() > given + 4 || speed() == 0.0f);
    }
    table.pass();
    EXPECT_GT(speed(), 0.0f);
    EXPECT_EQ(table.figures().inputDelay, 4u);
}

TEST(Prediction, WhereTheServerSaysSoItsDelayHolds) {
    Table table(PredictionRules{});
    table.inputDelay = 3;
    table.enter();
    EXPECT_EQ(table.replica.statistics().prediction->inputDelay, 3u);
}

TEST(Prediction, CommandsOfDifferentTicksGoInIntentsOfTheirOwnInTheirOrder) {
    PredictionRules rules;
    rules.pacing.inputDelay = 2;
    Ahead table(6, rules);
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(table.act(Release{}));
        EXPECT_TRUE(table.act(Release{}));
        table.now += tickTime;
        table.say(table.frame());
        table.replica.advance(table.now);
    }
    const std::vector<Intent> sent = table.intents();
    ASSERT_EQ(sent.size(), 3u);
    std::uint64_t sequence = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(sent[i].commands.size(), 2u);
        for (const Command& command : sent[i].commands) EXPECT_EQ(command.sequence, ++sequence);
        EXPECT_TRUE(i == 0 || sent[i].tick > sent[i - 1].tick);
    }
}

TEST(Prediction, AGuessThatIsRightIsNeverSteppedAgain) {
    PredictionRules rules;
    rules.guess = [](const GuessInput& in) {
        // A game that knows that the host pushes in every tenth tick.
        std::vector<Command> out;
        if (in.world.tick() % 10 != 0) return out;
        std::uint64_t sequence = 0;
        for (const PlayerRecord& player : in.world.players()) {
            if (player.id == 0) sequence = player.lastSequence;
        }
        out.push_back({0, sequence + 1, ApplyImpulse{1, {0.1f, 0.0f}, {0.0f, 5.0f}}});
        return out;
    };
    Ahead table(7, rules);
    std::uint64_t sequence = 1;
    for (int i = 0; i < 100; ++i) {
        std::vector<Command> commands;
        if (table.world.tick() % 10 == 0) {
            commands.push_back({0, ++sequence, ApplyImpulse{1, {0.1f, 0.0f}, {0.0f, 5.0f}}});
        }
        table.pass(std::move(commands));
    }
    EXPECT_GT(sequence, 9u);
    EXPECT_EQ(table.figures().rollbacks, 0u);
    EXPECT_EQ(table.replica.counts().mismatches, 0u);
}

TEST(Prediction, WhatIsShownDoesNotJumpWhenTheWorldGoesBack) {
    Ahead table(8);
    for (int i = 0; i < 5; ++i) table.pass();
    const auto shown = [&](BodyId body) {
        const World& world = *table.replica.world();
        const Pose pose = world.motions()[*world.find(body)].pose();
        return table.replica.prediction()->smoothing().posed(body, pose);
    };
    const Pose before = shown(1);
    // Frames come that move body 1, and no time goes by: what is drawn stays where it is.
    EXPECT_TRUE(table.say(table.frame({{0, 2, ApplyImpulse{1, {1.0f, 0.0f}, {0.0f, 5.0f}}}})));
    table.replica.advance(table.now);
    const World& world = *table.replica.world();
    EXPECT_GT(length(world.motions()[*world.find(1)].position - before.p), 0.05f) << "it is moved";
    EXPECT_LT(length(shown(1).p - before.p), 1e-5f);
    EXPECT_EQ(table.replica.prediction()->smoothing().errors().size(), 1u) << "others are not";
    EXPECT_GT(table.figures().errorMost, 0.05);
    // Then it draws nearer, to the very place in the end.
    float rest = 1e9f;
    for (int i = 0; i < 60; ++i) {
        table.pass();
        const World& now = *table.replica.world();
        const float error = length(shown(1).p - now.motions()[*now.find(1)].position);
        EXPECT_LE(error, rest);
        rest = error;
    }
    EXPECT_EQ(rest, 0.0f);
    EXPECT_TRUE(table.replica.prediction()->smoothing().errors().empty());
    EXPECT_EQ(table.replica.statistics().root, table.world.motionRoot());
}

TEST(Prediction, AFlippedBitIsNamedAtItsTickThoughTheWorldWasAheadOfIt) {
    Ahead table(6);
    for (int i = 0; i < 5; ++i) table.pass();
    const std::uint64_t tick = table.head();
    WorldSpoiler::flip(*table.replica.world(), 2, 4, 12);
    while (table.world.tick() < tick) table.pass();
    const World frozen = table.world;
    EXPECT_TRUE(table.say(table.frame()));
    EXPECT_FALSE(table.replica.following());
    EXPECT_EQ(table.replica.timeline()->ahead(), 0u);
    table.world = frozen;
    table.take();
    table.snapshot();
    const auto report = Table::find<DesyncReport>(table.take());
    ASSERT_TRUE(report.has_value());
    EXPECT_EQ(report->tick, tick);
    EXPECT_EQ(report->body, 2u);
    EXPECT_EQ(report->field, "velocity.x");
    for (int i = 0; i < 20; ++i) table.pass();
    EXPECT_EQ(table.replica.counts().mismatches, 1u);
    EXPECT_EQ(table.replica.counts().corrections, 1u);
}

TEST(Prediction, AfterAReconnectionItGoesOnFromWhatIsConfirmed) {
    Ahead table(6);
    EXPECT_TRUE(table.act(pushOfOwn));
    const std::vector<Intent> sent = table.intents();
    table.replica.disconnected();
    table.replica.connected(table.now);
    const auto hello = Table::find<Hello>(table.take());
    EXPECT_EQ(hello->haveTick, table.confirmed());
    EXPECT_EQ(hello->haveHash, table.world.motionRoot());
    table.welcome(1, 0, 1);
    const std::vector<Intent> again = table.intents();
    ASSERT_EQ(again.size(), 1u);
    EXPECT_EQ(again[0].commands, sent.at(0).commands);
    EXPECT_EQ(again[0].tick, 0u) << "as soon as it may";
    table.pass(again[0].commands);
    table.measure(6);
    for (int i = 0; i < 20; ++i) table.pass();
    EXPECT_EQ(table.replica.counts().commandsSeen, 1u);
    EXPECT_EQ(table.replica.statistics().root, table.world.motionRoot());
}

TEST(Prediction, WithAClockItTellsWhatGoingBackCosts) {
    static std::uint64_t nanoseconds;
    nanoseconds = 0;
    PredictionRules rules;
    rules.clock = [] { return nanoseconds += 1'000; };
    Ahead table(6, rules);
    EXPECT_EQ(table.figures().nanoseconds, 0u);
    for (std::uint64_t i = 0; i < 3; ++i) {
        table.pass({{0, 2 + i, ApplyImpulse{1, {1.0f, 0.0f}, {0.0f, 5.0f}}}});
    }
    // A way back reads it twice when it goes back and twice when it steps again.
    EXPECT_EQ(table.figures().rollbacks, 3u);
    EXPECT_EQ(table.figures().nanoseconds, 6'000u);
    EXPECT_EQ(table.figures().nanosecondsMost, 2'000u);
}

}  // namespace
}  // namespace huestep::client
