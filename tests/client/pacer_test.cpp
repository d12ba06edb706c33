// The clock of the predicted world, against servers made of one formula and lines made of another.
#include "client/pacer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <deque>
#include <functional>

#include "tests/simulation/dice.h"

namespace huestep::client {
namespace {

using test::Dice;

constexpr Instant ms = 1'000'000;

/// A server whose tick is a function of time, behind a line of which each way takes its own time.
struct Line {
    std::function<double(Instant)> server;  ///< ticks since the session began, with fractions
    std::function<Instant()> up = [] { return 0; };
    std::function<Instant()> down = [] { return 0; };
    Pacer pacer;
    Instant now = 5'000 * ms;

    Line(std::function<double(Instant)> position, const PacerRules& rules = {},
         std::uint32_t leastDelay = 0, std::uint32_t mostDelay = 0)
        : server(std::move(position)), pacer(rules) {
        protocol::Welcome welcome;
        welcome.inputDelay = leastDelay;
        welcome.maxInputDelay = mostDelay;
        pacer.start(welcome, now);
    }

    void step() {
        now += ms;
        if (const auto ping = pacer.ask(now)) {
            const Instant there = now + up();
            const double at = server(there);
            protocol::Ping reply{ping->nonce, true, static_cast<std::uint64_t>(at), 0};
            reply.sinceClose = static_cast<std::uint32_t>((at - std::floor(at)) * 1e6 / 60.0);
            flying.push_back({there + down(), reply});
        }
        for (std::size_t i = 0; i < flying.size();) {
            if (flying[i].first > now) {
                ++i;
                continue;
            }
            pacer.answered(flying[i].second, now);
            flying.erase(flying.begin() + static_cast<std::ptrdiff_t>(i));
        }
        pacer.advance(now, confirmed);
    }
    /// Steps so long; frames come as the line lets them.
    void run(Instant time) {
        for (const Instant end = now + time; now < end;) {
            confirmed = std::max(confirmed, static_cast<std::uint64_t>(server(now - down())));
            step();
        }
    }
    /// Whether a command that is given now is there before its tick closes.
    bool inTime() {
        return std::floor(server(now + up())) <=
               static_cast<double>(pacer.commandTick(pacer.head()));
    }

    std::deque<std::pair<Instant, protocol::Ping>> flying;
    std::uint64_t confirmed = 0;
};

double sixtyASecond(Instant now) {
    return static_cast<double>(now) * 60e-9 + 1'000.0;
}

TEST(Pacer, KnowsNothingBeforeTheFirstAnswer) {
    Line line(sixtyASecond);
    line.up = [] { return 500 * ms; };
    line.run(400 * ms);
    EXPECT_FALSE(line.pacer.measured());
    EXPECT_EQ(line.pacer.commandTick(line.confirmed), 0u);
    EXPECT_EQ(line.pacer.head(), line.confirmed);
}

TEST(Pacer, IsRightWhicheverOfTheTwoWaysTakesTheTime) {
    for (const Instant up : {10 * ms, 80 * ms, 150 * ms}) {
        Line line(sixtyASecond);
        line.up = [up] { return up; };
        line.down = [up] { return 160 * ms - up; };
        line.run(2'000 * ms);
        // As far as the server is when it arrives there, and half a tick to spare.
        EXPECT_NEAR(line.pacer.position(), line.server(line.now + up) + 0.5, 0.1);
        EXPECT_NEAR(line.pacer.roundTrip(), 0.16, 0.003);
        for (int i = 0; i < 500; ++i) {
            line.run(ms);
            ASSERT_TRUE(line.inTime());
        }
    }
}

TEST(Pacer, JitterMakesFewCommandsLate) {
    constexpr std::uint64_t seed = 17;
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    Dice dice(seed);
    Line line(sixtyASecond);
    line.up = [&] { return (40 + dice.between(0, 50)) * ms; };
    line.down = [&] { return (40 + dice.between(0, 50)) * ms; };
    line.run(5'000 * ms);
    int late = 0;
    constexpr int commands = 2'000;
    for (int i = 0; i < commands; ++i) {
        line.run(7 * ms);
        late += !line.inTime();
    }
    EXPECT_LT(late, commands * 7 / 100);
    EXPECT_GT(line.pacer.jitter(), 0.02);
}

TEST(Pacer, ItsClockIsSteeredNeverSetAndNoTickIsSkipped) {
    // The server's clock is a little fast, and its line gets longer and shorter.
    Line line([](Instant now) { return static_cast<double>(now) * 60.06e-9; });
    Instant way = 50 * ms;
    line.up = [&] { return way; };
    line.down = [&] { return way; };
    line.run(1'000 * ms);
    double last = line.pacer.position();
    double fastest = 0.0, slowest = 2.0;
    for (int i = 0; i < 16'000; ++i) {
        if (i == 3'000) way = 100 * ms;
        if (i == 7'000) way = 20 * ms;
        line.run(ms);
        const double moved = line.pacer.position() - last;
        ASSERT_GT(moved, 0.0) << "ms " << i;
        ASSERT_LE(moved, 0.06 * 1.1 + 1e-6) << "ms " << i;
        last = line.pacer.position();
        fastest = std::max(fastest, line.pacer.speed());
        slowest = std::min(slowest, line.pacer.speed());
    }
    EXPECT_GT(fastest, 1.05) << "it had to catch up";
    EXPECT_LT(slowest, 0.99) << "and to wait";
    EXPECT_NEAR(line.pacer.position(), line.server(line.now + way) + 0.5, 0.5);
}

TEST(Pacer, WhereNoFramesComeTheWorldWaitsAfterSixtyTicks) {
    Line line(sixtyASecond);
    line.run(1'000 * ms);
    const std::uint64_t heard = line.confirmed;
    for (int i = 0; i < 3'000; ++i) {
        line.step();  // time goes by, and nothing is confirmed
        ASSERT_LE(line.pacer.head(), heard + 60);
    }
    EXPECT_EQ(line.pacer.head(), heard + 60);
    line.run(3'000 * ms);
    EXPECT_NEAR(line.pacer.position(), line.server(line.now), 1.5) << "it has caught up";
}

TEST(Pacer, ADelayThatIsFixedStays) {
    for (const bool own : {false, true}) {
        PacerRules rules;
        if (own) rules.inputDelay = 5;
        Line line(sixtyASecond, rules, own ? 1 : 5, own ? 20 : 0);
        line.up = [] { return 200 * ms; };
        line.run(3'000 * ms);
        EXPECT_EQ(line.pacer.inputDelay(), 5u);
        EXPECT_NEAR(line.pacer.position(), line.server(line.now + 200 * ms) + 0.5 - 5.0, 0.2);
        EXPECT_TRUE(line.inTime());
    }
}

TEST(Pacer, AnAdaptiveDelayTakesWhatTheLeadDoesNotAndGivesItBackByAndBy) {
    PacerRules rules;
    rules.wantedLead = 6;
    Line line(sixtyASecond, rules, 1, 12);
    Instant way = 20 * ms;
    line.up = [&] { return way; };
    line.down = [&] { return way; };
    line.run(2'000 * ms);
    EXPECT_EQ(line.pacer.inputDelay(), 1u) << "40 ms are less than six ticks: the least there is";
    way = 75 * ms;
    line.run(5'000 * ms);  // until it is the middle of what is remembered
    EXPECT_EQ(line.pacer.inputDelay(), 4u) << "150 ms and half a tick are 9.5 ticks";
    way = 400 * ms;
    line.run(5'000 * ms);
    EXPECT_EQ(line.pacer.inputDelay(), 12u) << "the most there is";
    way = 20 * ms;
    std::uint32_t last = 12;
    for (int second = 0; second < 25; ++second) {
        line.run(1'000 * ms);
        EXPECT_LE(line.pacer.inputDelay(), last);
        EXPECT_GE(line.pacer.inputDelay() + 1, last) << "more than a tick in second " << second;
        last = line.pacer.inputDelay();
    }
    EXPECT_EQ(line.pacer.inputDelay(), 1u);
}

TEST(Pacer, AnswersThatNobodyAskedForAreLetGo) {
    Line line(sixtyASecond);
    line.run(1'000 * ms);
    const std::uint64_t head = line.pacer.head();
    for (const std::uint64_t nonce : {std::uint64_t{1}, ~std::uint64_t{0}}) {
        line.pacer.answered(protocol::Ping{nonce, true, 1'000'000, 0}, line.now);
    }
    line.pacer.answered(protocol::Ping{}, line.now);
    line.pacer.advance(line.now, line.confirmed);
    EXPECT_EQ(line.pacer.head(), head);
}

TEST(Pacer, WhatAServerClaimsTakesItNoFurtherThanTheLimits) {
    for (const std::uint64_t tick : {std::uint64_t{1}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
        for (const std::uint64_t confirmed : {std::uint64_t{500}, ~std::uint64_t{0} - 100}) {
            Pacer pacer(PacerRules{});
            pacer.start(protocol::Welcome{}, 0);
            const auto ping = pacer.ask(0);
            ASSERT_TRUE(ping.has_value());
            pacer.answered(protocol::Ping{ping->nonce, true, tick, ~std::uint32_t{0}}, ms);
            pacer.advance(2 * ms, confirmed);
            const std::uint64_t head = pacer.head();
            EXPECT_TRUE(head <= confirmed || head - confirmed <= 60) << tick << ' ' << confirmed;
            const std::uint64_t asked = pacer.commandTick(500);
            EXPECT_GE(asked, 500u);
            EXPECT_LE(asked, 560u);
        }
    }
}

TEST(Pacer, SaysWhenTheNextTickIsDue) {
    Line line(sixtyASecond);
    line.run(2'000 * ms);
    const std::uint64_t next = line.pacer.head() + 1;
    const Instant due = line.pacer.timeOf(next);
    EXPECT_GE(due, line.now);
    EXPECT_LE(due, line.now + 20 * ms);
    line.pacer.advance(due, line.confirmed);
    EXPECT_EQ(line.pacer.head(), next);
}

}  // namespace
}  // namespace huestep::client
