// Hostile clients, in simulated time: whatever they do, one who plays by the rules gets every frame
// in its tick, and what the server holds stays under its caps. How much real time they cost is
// measured in tests/simulation/hostile_host_test.cpp.
#include <gtest/gtest.h>
#include <malloc.h>

#include <memory>
#include <random>

#include "desk.h"
#include "protocol/codec.h"
#include "protocol/ticket.h"

namespace huestep::server {
namespace {

using test::Desk;
using test::Peer;

constexpr int ticks = 600;  // 10 s

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool heapIsCounted = false;
#elif defined(__has_feature)
constexpr bool heapIsCounted =
    !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
constexpr bool heapIsCounted = true;
#endif

/// Bytes that this program holds.
std::size_t heap() {
    return heapIsCounted ? mallinfo2().uordblks + mallinfo2().hblkhd : 0;
}

/// A desk with one who plays by the rules, beside whom others do as they like.
class Scene {
 public:
    explicit Scene(Limits limits = {}) : desk(limits), m_good(desk, "192.0.2.1:5000") {
        m_good.join();
        m_good.read();
        m_before = heap();
    }

    /// Closes a tick; the good one moves and reads.
    void tick() {
        m_good.say(protocol::Intent{{{1, ++m_sequence, Release{}}}, std::nullopt});
        desk.tick();
        desk.journal.closed.clear();
        m_good.heard.clear();
        m_good.read();
        std::size_t frames = 0;
        for (const protocol::Message& message : m_good.heard) {
            const auto* frame = std::get_if<protocol::Frame>(&message);
            if (!frame) continue;
            ++frames;
            EXPECT_EQ(frame->tick + 1, desk.session->tick());
            // Its own command, and none that another gave out as its.
            const auto mine = std::count_if(frame->commands.begin(), frame->commands.end(),
                                            [](const Command& c) { return c.author == 1; });
            EXPECT_EQ(mine, 1) << "tick " << frame->tick;
        }
        EXPECT_EQ(frames, 1u) << "in tick " << desk.session->tick();
        m_most = std::max(m_most, heap());
        // What the transport does.
        for (const ConnectionId id : desk.hub.displaced()) desk.hub.closed(id, desk.now);
        for (const ConnectionId id : desk.hub.connections()) {
            if (desk.hub.overdue(id, desk.now)) desk.hub.closed(id, desk.now);
        }
    }

    /// What a test asks at its end: nobody but hostile ones is gone, and memory was bounded.
    void expectUnmoved(std::size_t mostBytes) const {
        EXPECT_TRUE(m_good.connection() && m_good.connection()->live());
        EXPECT_LE(desk.hub.connections().size(), desk.hub.limits().connections);
        EXPECT_LE(m_most - std::min(m_most, m_before), mostBytes);
        std::printf("heap: %zu KiB more than before\n",
                    (m_most - std::min(m_most, m_before)) >> 10);
    }

    Desk desk;

 private:
    Peer m_good;
    std::uint64_t m_sequence = 0;
    std::size_t m_before = 0;
    std::size_t m_most = 0;
};

/// An address of its own for each.
std::string someone(int number) {
    return "198.51." + std::to_string(100 + number / 250 % 100) + "." +
           std::to_string(1 + number % 250) + ":4000";
}

/// What a session and its ring of frames may grow by in these ticks, whoever plays.
constexpr std::size_t sessionBytes = 8u << 20;

TEST(Hostile, MalformedBytesOfManyKindsEndTheirSenderAlone) {
    Scene scene;
    std::mt19937_64 random(11);
    for (int t = 0; t < ticks; ++t) {
        for (int i = 0; i < 4; ++i) {
            Peer bad(scene.desk, someone(4 * t + i));
            if (!bad.accepted()) continue;
            std::vector<std::byte> bytes = protocol::encode(bad.hello());
            if (i == 0) {
                for (std::byte& b : bytes) b = static_cast<std::byte>(random());
            } else if (i == 1) {
                bytes[random() % bytes.size()] ^= std::byte{16};
            } else if (i == 2) {
                bytes.insert(bytes.end(), 2'000, static_cast<std::byte>(random()));
            } else {
                bytes = protocol::encode(protocol::Frame{});
            }
            bad.bytes(bytes);
            static_cast<void>(bad.read());
        }
        scene.tick();
    }
    EXPECT_GE(scene.desk.hub.counters().badMessages, static_cast<std::uint64_t>(3 * ticks));
    // The log is no door either: some lines at first, then a few a second.
    EXPECT_LE(scene.desk.log.size(), 400u + 10 * 20u);
    EXPECT_GT(scene.desk.hub.counters().notesLetGo, 500u);
    scene.expectUnmoved(sessionBytes);
}

TEST(Hostile, FloodsOfMessagesAndBytesEndTheirSenderAlone) {
    Scene scene;
    std::vector<std::unique_ptr<Peer>> floods;
    const std::vector<std::byte> ping = protocol::encode(protocol::Ping{1, false});
    std::vector<std::byte> many;
    while (many.size() < 60'000) many.insert(many.end(), ping.begin(), ping.end());
    protocol::Intent large;
    large.commands.push_back({1, 1, Spawn{std::vector<BodyDef>(8), {}}});
    for (BodyDef& body : std::get<Spawn>(large.commands[0].action).bodies) body.shapes.resize(8);
    const std::vector<std::byte> spawn = protocol::encode(large);
    for (int t = 0; t < ticks; ++t) {
        if (t % 10 == 0) {
            floods.push_back(std::make_unique<Peer>(scene.desk, someone(t)));
            if (floods.back()->accepted()) floods.back()->say(floods.back()->hello());
        }
        for (std::size_t i = 0; i < floods.size(); ++i) {
            if (floods[i]->accepted()) floods[i]->bytes(i % 2 == 0 ? many : spawn);
        }
        scene.tick();
    }
    EXPECT_GE(scene.desk.hub.counters().tooFast, 20u);
    scene.expectUnmoved(sessionBytes);
}

TEST(Hostile, ThoseWhoStallInTheMiddleOfAWordAreEndedInTime) {
    Scene scene;
    std::vector<std::unique_ptr<Peer>> stalled;
    std::vector<std::byte> hello;
    std::size_t sent = 0;
    for (int t = 0; t < ticks; ++t) {
        if (t < 40) {
            stalled.push_back(std::make_unique<Peer>(scene.desk, someone(t)));
            hello = protocol::encode(stalled.back()->hello());
        }
        // A byte a tick: never silent, and never done in time.
        for (const auto& each : stalled) each->bytes(std::span(hello).subspan(sent % 16, 1));
        sent = t < 16 ? sent + 1 : sent;
        scene.tick();
    }
    EXPECT_GE(scene.desk.hub.counters().timeouts + scene.desk.hub.counters().badMessages, 40u);
    EXPECT_EQ(scene.desk.hub.connections().size(), 1u) << "none is left after 10 s";
    scene.expectUnmoved(sessionBytes);
}

TEST(Hostile, AMessageBegunIsFinishedAtAKibibyteASecondOrEndsItsSender) {
    Desk desk;
    Peer quick(desk), slow(desk);
    quick.join();
    slow.join();
    protocol::Intent intent;
    intent.commands.push_back({1, 1, Spawn{std::vector<BodyDef>(8), {}}});
    for (BodyDef& body : std::get<Spawn>(intent.commands[0].action).bodies) body.shapes.resize(8);
    const std::vector<std::byte> bytes = protocol::encode(intent);
    ASSERT_GT(bytes.size(), 4'000u);
    const auto trickle = [&](Peer& peer, std::size_t bytesPerSecond) {
        std::size_t at = 0;
        for (std::size_t t = 0; at < bytes.size() && t < 60 * 40; ++t) {
            const std::size_t until = std::min(bytes.size(), (t + 1) * bytesPerSecond / 60);
            peer.bytes(std::span(bytes).subspan(at, until - at));
            at = until;
            desk.tick();
            peer.read();
        }
        return peer.bye();
    };
    EXPECT_EQ(trickle(quick, 1'100), std::nullopt);
    EXPECT_EQ(trickle(slow, 500), protocol::ByeReason::Timeout);
}

TEST(Hostile, ARecordedConnectionPlayedBackBringsNothing) {
    // All that a good client said, ticket and all, said again by those who overheard it.
    const protocol::Keys keys = protocol::makeKeys(true);
    std::uint64_t wall = 1'700'000'000'000;
    Desk desk({}, test::deskScene(),
              TicketRules{*keys.verifying, *keys.sealing, [&wall] { return wall; }});
    Peer good(desk, "192.0.2.1:5000");
    protocol::Hello hello = good.hello();
    hello.ticket = *protocol::sealTicket(
        {"play", protocol::Role::Player, "ann", wall, wall + 45'000, {1}}, keys, {});
    std::vector<std::byte> recorded = protocol::encode(hello);
    good.bytes(recorded);
    desk.tick(3);
    good.read();
    ASSERT_EQ(good.count<protocol::Welcome>(), 1u);
    for (std::uint64_t s = 1; s <= 5; ++s) {
        const auto said = protocol::encode(protocol::Intent{{{1, s, Release{}}}, std::nullopt});
        good.bytes(said);
        recorded.insert(recorded.end(), said.begin(), said.end());
        desk.tick();
    }
    const std::uint64_t queued = desk.hub.counters().commandsQueued;
    for (int i = 0; i < 100; ++i) {
        wall += 500;
        Peer thief(desk, someone(i));
        ASSERT_TRUE(thief.accepted());
        thief.bytes(recorded);
        EXPECT_EQ(thief.bye(), protocol::ByeReason::TicketRefused);
        desk.tick();
    }
    EXPECT_EQ(desk.hub.counters().ticketsTaken, 1u);
    EXPECT_EQ(desk.hub.counters().ticketsUsed + desk.hub.counters().ticketsExpired, 100u);
    EXPECT_EQ(desk.hub.counters().commandsQueued, queued);
    EXPECT_TRUE(good.connection()->live()) << "nobody took its seat";
    EXPECT_EQ(desk.session->seats().taken(), 1u);
    // Its own words a second time, on its own connection: old, and let go.
    good.bytes(protocol::encode(protocol::Intent{{{1, 3, Release{}}}, std::nullopt}));
    EXPECT_EQ(desk.hub.counters().commandsOld, 1u);
}

TEST(Hostile, HundredsOfHalfOpenConnectionsKeepNobodyOut) {
    Scene scene;
    std::vector<std::unique_ptr<Peer>> open;
    int entered = 0;
    for (int t = 0; t < ticks; ++t) {
        for (int i = 0; i < 8; ++i) {
            open.push_back(std::make_unique<Peer>(scene.desk, someone(8 * t + i)));
        }
        if (t % 100 == 50) {
            // Says Hello a round trip after it came, while the flood goes on.
            // His address comes before and after the others' in turn: it must not matter.
            const std::string net = t % 200 == 50 ? "10.0.0." : "203.0.113.";
            Peer guest(scene.desk, net + std::to_string(t / 100) + ":99");
            ASSERT_TRUE(guest.accepted());
            for (int i = 0; i < 6; ++i) {
                scene.tick();
                for (int k = 0; k < 8; ++k) {
                    open.push_back(std::make_unique<Peer>(scene.desk, someone(9'000 + t * 8 + k)));
                }
            }
            if (guest.connection()) {
                guest.watch();
                ++entered;
            }
            scene.desk.hub.closed(guest.id(), scene.desk.now);
        }
        scene.tick();
        EXPECT_LE(scene.desk.hub.connections().size(), scene.desk.hub.limits().halfOpen + 64);
    }
    EXPECT_EQ(entered, 6);
    EXPECT_GE(scene.desk.hub.counters().displaced, 1'000u);
    scene.expectUnmoved(sessionBytes);
}

TEST(Hostile, OneAddressMayNotHaveManyHalfOpenConnections) {
    Scene scene;
    int let = 0;
    for (int i = 0; i < 300; ++i) {
        let += scene.desk.hub.accept("198.51.100.7:" + std::to_string(1'000 + i), scene.desk.now)
                   ? 1
                   : 0;
    }
    EXPECT_EQ(let, 16);
    EXPECT_EQ(scene.desk.hub.counters().displaced, 0u) << "others are not pushed out for it";
    scene.tick();
    scene.expectUnmoved(sessionBytes);
}

TEST(Hostile, ThoseWhoNeverReadHoldNoMoreThanTheirShare) {
    Scene scene;
    std::vector<std::unique_ptr<Peer>> slow;
    for (int i = 0; i < 100; ++i) {
        slow.push_back(std::make_unique<Peer>(scene.desk, someone(i)));
        protocol::Hello hello = slow.back()->hello();
        hello.role = protocol::Role::Spectator;
        slow.back()->say(hello);
    }
    for (int t = 0; t < ticks + 300; ++t) {
        for (const auto& each : slow) {
            if (t % 30 == 0) each->say(protocol::Ping{1, true});
            if (each->connection() && !each->connection()->reads()) continue;
            EXPECT_LE(each->stall(), scene.desk.hub.limits().clientBytes);
        }
        scene.tick();
    }
    EXPECT_EQ(scene.desk.hub.counters().tooSlow, 100u);
    EXPECT_EQ(scene.desk.hub.connections().size(), 1u);
    scene.expectUnmoved(sessionBytes + 100 * scene.desk.hub.limits().clientBytes);
}

TEST(Hostile, HashesAreNotMadeForWhoDoesNotRead) {
    Limits limits;
    limits.lowWater = 2'000;
    limits.heavyBurst = 100;
    Desk desk(limits);
    desk.tick(70);
    Peer peer(desk);
    peer.watch();
    desk.tick(120);
    peer.stall();
    peer.say(protocol::HashQuery{desk.session->tick() - 1});
    desk.tick(80);
    EXPECT_EQ(desk.hub.counters().hashesLetGo, 1u);
    peer.unstall();
    peer.read();
    ASSERT_NE(peer.last<protocol::HashNodes>(), nullptr);
    EXPECT_TRUE(peer.last<protocol::HashNodes>()->leaves.empty());
}

TEST(Hostile, WhatComesBehindAnEndIsReadForAWhileAndNoLonger) {
    Desk desk;
    Peer peer(desk);
    peer.say(protocol::Intent{});
    ASSERT_FALSE(peer.connection()->live());
    const std::vector<std::byte> more(8'192);
    std::size_t read = 0;
    while (desk.hub.reads(peer.id()) && read < (8u << 20)) {
        peer.bytes(more);
        read += more.size();
    }
    EXPECT_LE(read, desk.hub.limits().byeBytes + more.size());
    EXPECT_EQ(peer.bye(), protocol::ByeReason::UnexpectedMessage) << "the word is still there";
}

}  // namespace
}  // namespace huestep::server
