// The server's small parts: queue, clock, bucket, tokens, log lines.
#include <gtest/gtest.h>

#include <numeric>

#include "server/command_queue.h"
#include "server/log.h"
#include "server/resume_token.h"
#include "server/tick_clock.h"
#include "server/token_bucket.h"

namespace huestep::server {
namespace {

using Admission = CommandQueue::Admission;

Command impulse(PlayerId author, std::uint64_t sequence) {
    return {author, sequence, ApplyImpulse{1, {1.0f, 0.0f}, {}}};
}

TEST(CommandQueue, ARepeatedSequenceIsLetGo) {
    CommandQueue queue{Limits{}};
    EXPECT_EQ(queue.push(impulse(1, 5), 0, 4), Admission::Queued);
    EXPECT_EQ(queue.push(impulse(1, 5), 0, 4), Admission::Old);
    EXPECT_EQ(queue.push(impulse(1, 4), 0, 4), Admission::Old);
    EXPECT_EQ(queue.push(impulse(2, 1), 0, 0), Admission::Queued);
    EXPECT_EQ(queue.lastQueued(1), 5u);
    EXPECT_EQ(queue.size(), 2u);
}

TEST(CommandQueue, APlayersShareAndTheWholeAreBoundedByNumber) {
    Limits limits;
    limits.queuedPerPlayer = 3;
    limits.queuedInTotal = 5;
    CommandQueue queue{limits};
    for (std::uint64_t s = 1; s <= 3; ++s) queue.push(impulse(1, s), 0, 0);
    EXPECT_EQ(queue.push(impulse(1, 4), 0, 0), Admission::PlayerFull);
    queue.push(impulse(2, 1), 0, 0);
    queue.push(impulse(2, 2), 0, 0);
    EXPECT_EQ(queue.push(impulse(3, 1), 0, 0), Admission::QueueFull);
    EXPECT_EQ(queue.size(), 5u);
}

TEST(CommandQueue, APlayersShareAndTheWholeAreBoundedByBytes) {
    Limits limits;
    limits.queuedBytesPerPlayer = 2'000;
    limits.queuedBytes = 3'000;
    CommandQueue queue{limits};
    Spawn spawn;
    spawn.bodies.resize(4);
    for (BodyDef& body : spawn.bodies) body.shapes.push_back(ShapeDef::box(1.0f, 1.0f));
    std::uint64_t sequence = 0;
    while (queue.push({1, ++sequence, spawn}, 0, 0) == Admission::Queued) {
    }
    EXPECT_EQ(queue.push({1, ++sequence, spawn}, 0, 0), Admission::PlayerFull);
    EXPECT_LE(queue.bytes(), 2'000u);
    while (queue.push({2, ++sequence, spawn}, 0, 0) == Admission::Queued) {
    }
    EXPECT_EQ(queue.push({3, ++sequence, spawn}, 0, 0), Admission::QueueFull);
    EXPECT_LE(queue.bytes(), 3'000u);
}

TEST(CommandQueue, GivesEachPlayersCommandsInOrderWithinTheFramesCaps) {
    Limits limits;
    limits.perPlayerPerFrame = 2;
    CommandQueue queue{limits};
    for (std::uint64_t s = 1; s <= 5; ++s) queue.push(impulse(7, s), 0, 0);
    EXPECT_EQ(queue.take(0, 100).commands, (std::vector<Command>{impulse(7, 1), impulse(7, 2)}));
    EXPECT_EQ(queue.take(1, 1).commands, (std::vector<Command>{impulse(7, 3)}));
    EXPECT_EQ(queue.take(2, 100).commands, (std::vector<Command>{impulse(7, 4), impulse(7, 5)}));
    EXPECT_TRUE(queue.take(3, 100).commands.empty());
    EXPECT_EQ(queue.size(), 0u);
    EXPECT_EQ(queue.bytes(), 0u);
}

TEST(CommandQueue, NothingIsTakenBeforeItsEarliestTick) {
    CommandQueue queue{Limits{}};
    queue.push(impulse(1, 1), 10, 0);
    EXPECT_TRUE(queue.take(9, 100).commands.empty());
    EXPECT_EQ(queue.take(10, 100).commands.size(), 1u);
}

TEST(CommandQueue, WhoseCommandsCameLateIsToldOnceAFrame) {
    CommandQueue queue{Limits{}};
    queue.push(impulse(9, 1), 5, 0, true);
    queue.push(impulse(9, 2), 5, 0, true);
    queue.push(impulse(3, 1), 5, 0, true);
    queue.push(impulse(3, 2), 6, 0, true);
    queue.push(impulse(4, 1), 5, 0, false);
    EXPECT_TRUE(queue.take(4, 100).late.empty());
    EXPECT_EQ(queue.take(5, 100).late, (std::vector<PlayerId>{3, 9}));
    EXPECT_EQ(queue.take(6, 100).late, (std::vector<PlayerId>{3}));
}

TEST(CommandQueue, AFullFrameStarvesNobody) {
    CommandQueue queue{Limits{}};
    for (PlayerId player = 1; player <= 4; ++player) {
        for (std::uint64_t s = 1; s <= 8; ++s) queue.push(impulse(player, s), 0, 0);
    }
    std::array<int, 5> served{};
    for (std::uint64_t tick = 0; tick < 4; ++tick) {
        const CommandQueue::Due due = queue.take(tick, 3);
        for (const Command& command : due.commands) ++served[command.author];
    }
    for (PlayerId player = 1; player <= 4; ++player) EXPECT_EQ(served[player], 3) << player;
}

TEST(CommandQueue, AForgottenPlayerTakesNoRoom) {
    CommandQueue queue{Limits{}};
    queue.push(impulse(1, 1), 0, 0);
    queue.push(impulse(2, 1), 0, 0);
    queue.forget(1);
    EXPECT_EQ(queue.take(0, 100).commands, (std::vector<Command>{impulse(2, 1)}));
    EXPECT_EQ(queue.bytes(), 0u);
}

TEST(TickClock, DoesNotDriftOverAnHourOfLateTimers) {
    TickClock clock(second, 60.0, 0.0, 4);
    std::uint64_t ticks = 0;
    // A timer with whole milliseconds, up to 3 ms late.
    for (Instant now = second; now <= 3'601 * second; now += 7 * millisecond) {
        ticks += clock.due(now);
    }
    EXPECT_NEAR(static_cast<double>(ticks), 3'600.0 * 60.0, 1.0);
    EXPECT_EQ(clock.letGo(), 0u);
}

TEST(TickClock, ADeadlineIsNotReachedBeforeItsTime) {
    TickClock clock(0, 60.0, 0.0, 4);
    for (int i = 0; i < 10'000; ++i) {
        const Instant deadline = clock.nextDeadline();
        if (deadline > 0) {
            EXPECT_EQ(clock.due(deadline - 1), 0u);
        }
        ASSERT_EQ(clock.due(deadline), 1u) << i;
    }
}

TEST(TickClock, AfterALongPauseABoundedNumberIsCaughtUpAndTheRestLetGo) {
    TickClock clock(0, 100.0, 0.0, 4);
    EXPECT_EQ(clock.due(0), 1u);
    EXPECT_EQ(clock.due(second), 4u);
    EXPECT_EQ(clock.letGo(), 96u);
    EXPECT_EQ(clock.due(second + 9 * millisecond), 0u);
    EXPECT_EQ(clock.due(second + 10 * millisecond), 1u);
}

TEST(TickClock, PhasesStaggerSessions) {
    EXPECT_EQ(TickClock(0, 100.0, 0.25, 4).nextDeadline(), 2'500'000u);
}

TEST(TokenBucket, HoldsItsBurstAndFillsAtItsRate) {
    TokenBucket bucket(10.0, 3.0, 0);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(bucket.take(0));
    EXPECT_FALSE(bucket.take(0));
    EXPECT_FALSE(bucket.take(99 * millisecond));
    EXPECT_TRUE(bucket.take(101 * millisecond));
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(bucket.take(60 * second));
    EXPECT_FALSE(bucket.take(60 * second));
}

// Vectors of the reference: key 00 01 … 0f, message 00 01 … of n bytes.
TEST(ResumeToken, TagsAreSipHash) {
    ResumeKey key{};
    std::iota(key.begin(), key.end(), std::uint8_t{0});
    std::array<std::uint8_t, 15> message{};
    std::iota(message.begin(), message.end(), std::uint8_t{0});
    EXPECT_EQ(sipHash(key, {}), 0x726fdb47dd0e0e31u);
    EXPECT_EQ(sipHash(key, message), 0xa129ca6149be45e5u);
}

TEST(ResumeToken, IsReadBackByItsSessionAlone) {
    const ResumeKey key{1, 2, 3};
    const ResumeClaim claim{41, 7, 3};
    const protocol::ResumeToken token = makeToken(key, "play", claim);
    EXPECT_EQ(readToken(key, "play", token), claim);
    EXPECT_FALSE(readToken(key, "other", token).has_value());
    EXPECT_FALSE(readToken(ResumeKey{1, 2, 4}, "play", token).has_value());
}

TEST(ResumeToken, AnyFlippedBitIsSeen) {
    const ResumeKey key{9, 8, 7};
    const protocol::ResumeToken token = makeToken(key, "play", {41, 7, 3});
    for (std::size_t bit = 0; bit < 128; ++bit) {
        protocol::ResumeToken flipped = token;
        flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1u << (bit % 8)));
        EXPECT_FALSE(readToken(key, "play", flipped).has_value()) << bit;
    }
}

TEST(LogLine, IsKeysAndValuesThatAClientCannotForge) {
    LogLine line("bye");
    line.with("player", std::uint64_t{3}).with("text", "a b\nevent=x \"q\"").hex("root", 255);
    EXPECT_EQ(line.text(),
              "event=bye player=3 text=\"a b\\x0aevent=x \\\"q\\\"\" root=00000000000000ff");
}

}  // namespace
}  // namespace huestep::server
