// Tickets at the door: who is let in, and what is said to and counted of everyone else.
#include <gtest/gtest.h>

#include "desk.h"
#include "protocol/ticket.h"

namespace huestep::server {
namespace {

using protocol::ByeReason;
using protocol::Role;
using test::Desk;
using test::Peer;

constexpr std::uint64_t noon = 1'700'000'000'000;

/// An issuer, and a desk that asks for its tickets. Both have the same wall clock.
struct Door {
    protocol::Keys keys = protocol::makeKeys(true);
    std::uint64_t wall = noon;
    std::uint8_t issued = 0;
    Desk desk;

    explicit Door(Limits limits = {})
        : desk(limits, test::deskScene(),
               TicketRules{*keys.verifying, *keys.sealing, [this] { return wall; }}) {}

    protocol::Ticket ticket(const std::string& player = "ann", Role role = Role::Player) {
        return {"play", role, player, wall, wall + 45'000, {++issued}};
    }
    static std::vector<std::byte> sealed(const protocol::Ticket& ticket, const protocol::Keys& by) {
        protocol::SealNonce nonce{};
        protocol::fillRandom(nonce);
        const auto bytes = protocol::sealTicket(ticket, by, nonce);
        EXPECT_TRUE(bytes.ok()) << (bytes ? "" : bytes.error().message);
        return bytes ? *bytes : std::vector<std::byte>();
    }
    /// Shows a ticket; the sentence of the Bye, or "welcome".
    std::string show(Peer& peer, std::vector<std::byte> bytes, Role role = Role::Player) {
        protocol::Hello hello = peer.hello();
        hello.role = role;
        hello.ticket = std::move(bytes);
        peer.say(hello);
        desk.tick(3);
        peer.read();
        const auto* bye = peer.last<protocol::Bye>();
        if (!bye) return peer.count<protocol::Welcome>() == 1 ? "welcome" : "nothing";
        EXPECT_EQ(bye->reason, ByeReason::TicketRefused);
        EXPECT_EQ(peer.count<protocol::Welcome>(), 0u);
        return bye->text;
    }
    std::string show(std::vector<std::byte> bytes, Role role = Role::Player) {
        Peer peer(desk);
        return show(peer, std::move(bytes), role);
    }
    [[nodiscard]] const Counters& counters() const { return desk.hub.counters(); }
};

TEST(Tickets, LetTheirHolderInOnce) {
    Door door;
    const auto bytes = Door::sealed(door.ticket(), door.keys);
    EXPECT_EQ(door.show(bytes), "welcome");
    EXPECT_EQ(door.show(bytes), "this ticket was used already");
    EXPECT_EQ(door.counters().ticketsTaken, 1u);
    EXPECT_EQ(door.counters().ticketsUsed, 1u);
    EXPECT_TRUE(door.desk.logged("holder=ann"));
}

TEST(Tickets, WhoHasNoneStaysOutside) {
    Door door;
    EXPECT_EQ(door.show({}), "this server asks for a ticket, and there is none in the Hello");
    EXPECT_EQ(door.show({}, Role::Spectator),
              "this server asks for a ticket, and there is none in the Hello");
    EXPECT_EQ(door.counters().ticketsMissing, 2u);
    EXPECT_EQ(door.desk.session->seats().taken(), 0u);
}

TEST(Tickets, OfAnotherIssuerOrChangedAreForged) {
    Door door;
    const std::string forged = "no issuer of this server's made this ticket";
    EXPECT_EQ(door.show(Door::sealed(door.ticket(), protocol::makeKeys(true))), forged);
    auto changed = Door::sealed(door.ticket(), door.keys);
    changed.back() ^= std::byte{1};
    EXPECT_EQ(door.show(changed), forged);
    EXPECT_EQ(door.show(std::vector<std::byte>(256, std::byte{7})), forged);
    EXPECT_EQ(door.counters().ticketsForged, 3u);
}

TEST(Tickets, ForAnotherSessionOrRoleAreRefused) {
    Door door;
    protocol::Ticket elsewhere = door.ticket();
    elsewhere.session = "arena";
    EXPECT_EQ(door.show(Door::sealed(elsewhere, door.keys)),
              "this ticket is for another session, arena");
    EXPECT_EQ(door.show(Door::sealed(door.ticket("ann", Role::Spectator), door.keys)),
              "this ticket is for a spectator, not for a player");
    EXPECT_EQ(door.show(Door::sealed(door.ticket(), door.keys), Role::Spectator),
              "this ticket is for a player, not for a spectator");
    EXPECT_EQ(door.counters().ticketsMisplaced, 3u);
}

TEST(Tickets, HoldFromTheirIssueToTheirExpiry) {
    Door door;
    const auto late = Door::sealed(door.ticket("late"), door.keys);
    const auto inTime = Door::sealed(door.ticket("in-time"), door.keys);
    protocol::Ticket early = door.ticket("early");
    early.issued += TicketDesk::clockSkew + 1;
    EXPECT_EQ(door.show(Door::sealed(early, door.keys)),
              "this ticket is of a time to come: the issuer's clock is ahead");
    door.wall = noon + 45'000;
    EXPECT_EQ(door.show(inTime), "welcome");
    door.wall = noon + 48'500;
    EXPECT_EQ(door.show(late), "this ticket expired 3 s ago");
    EXPECT_EQ(door.counters().ticketsExpired, 2u);
}

TEST(Tickets, OfBeforeTheServersStartAreRefusedAsItForgotWhichWereUsed) {
    Door door;
    protocol::Ticket before = door.ticket();
    before.issued = noon - 1;
    EXPECT_EQ(door.show(Door::sealed(before, door.keys)),
              "this ticket was issued before this server started; get another");
}

TEST(Tickets, ThatWereUsedAreRememberedUntilTheyExpireAndNoLonger) {
    Limits limits;
    limits.ticketsUsed = 2;
    protocol::Keys keys = protocol::makeKeys(true);
    std::uint64_t wall = noon;
    TicketDesk desk({*keys.verifying, *keys.sealing, [&wall] { return wall; }}, limits);
    const auto issue = [&](std::uint8_t id) {
        return Door::sealed({"play", Role::Player, "ann", wall, wall + 45'000, {id}}, keys);
    };
    const auto take = [&](const std::vector<std::byte>& ticket) {
        return desk.take(ticket, "play", Role::Player).verdict;
    };
    const auto first = issue(1);
    EXPECT_EQ(take(first), TicketDesk::Verdict::Taken);
    EXPECT_EQ(take(issue(2)), TicketDesk::Verdict::Taken);
    EXPECT_EQ(take(issue(3)), TicketDesk::Verdict::TooMany) << "rather than forget one";
    wall = noon + 45'001;
    EXPECT_EQ(take(first), TicketDesk::Verdict::Expired);
    EXPECT_EQ(take(issue(4)), TicketDesk::Verdict::Taken);
    EXPECT_EQ(desk.remembered(), 1u);
    // A clock that is set back does not bring an old ticket to life.
    wall = noon;
    EXPECT_EQ(take(first), TicketDesk::Verdict::Expired);
}

TEST(Tickets, AreNotAskedOfWhoResumesHisSeat) {
    Door door;
    Peer first(door.desk);
    ASSERT_EQ(door.show(first, Door::sealed(door.ticket(), door.keys)), "welcome");
    const protocol::Welcome welcome = *first.last<protocol::Welcome>();
    door.desk.hub.closed(first.id(), door.desk.now);
    Peer again(door.desk);
    EXPECT_EQ(again.join(welcome.resume).player, welcome.player);
    EXPECT_EQ(door.counters().ticketsMissing, 0u);

    // But a token is no ticket for those who watch.
    Peer watcher(door.desk);
    protocol::Hello hello = watcher.hello();
    hello.role = Role::Spectator;
    hello.resume = welcome.resume;
    watcher.say(hello);
    EXPECT_EQ(watcher.bye(), ByeReason::TicketRefused);
}

TEST(Tickets, OfTheSamePlayerLeadToTheSameSeat) {
    Door door;
    Peer first(door.desk);
    ASSERT_EQ(door.show(first, Door::sealed(door.ticket("ann"), door.keys)), "welcome");
    const protocol::Welcome welcome = *first.last<protocol::Welcome>();
    Peer second(door.desk);
    ASSERT_EQ(door.show(second, Door::sealed(door.ticket("ann"), door.keys)), "welcome");
    EXPECT_EQ(second.last<protocol::Welcome>()->player, welcome.player);
    EXPECT_EQ(first.bye(), ByeReason::Done);
    door.desk.hub.closed(first.id(), door.desk.now);
    Peer other(door.desk);
    ASSERT_EQ(door.show(other, Door::sealed(door.ticket("bob"), door.keys)), "welcome");
    EXPECT_NE(other.last<protocol::Welcome>()->player, welcome.player);

    // Whoever had the seat before has no right to it any more.
    Peer thief(door.desk);
    protocol::Hello hello = thief.hello();
    hello.resume = welcome.resume;
    thief.say(hello);
    EXPECT_EQ(thief.bye(), ByeReason::ResumeRefused);
}

TEST(Tickets, TwoOfOnePlayerAtOnceMakeOneSeat) {
    Door door;
    Peer first(door.desk), second(door.desk);
    for (Peer* peer : {&first, &second}) {
        protocol::Hello hello = peer->hello();
        hello.ticket = Door::sealed(door.ticket("ann"), door.keys);
        peer->say(hello);
    }
    EXPECT_EQ(second.bye(), ByeReason::TicketRefused);
    door.desk.tick(3);
    first.read();
    EXPECT_EQ(first.count<protocol::Welcome>(), 1u);
    EXPECT_EQ(door.desk.session->seats().taken(), 1u);
}

TEST(Tickets, AreAskedOfThoseWhoWatchThePageToo) {
    Door door;
    EXPECT_FALSE(door.desk.hub.admit({}, "play", Role::Spectator).ok());
    const auto ticket = Door::sealed(door.ticket("ann", Role::Spectator), door.keys);
    EXPECT_TRUE(door.desk.hub.admit(ticket, "play", Role::Spectator).ok());
    EXPECT_FALSE(door.desk.hub.admit(ticket, "play", Role::Spectator).ok()) << "twice";
    Desk open;
    EXPECT_TRUE(open.hub.admit({}, "play", Role::Spectator).ok());
}

}  // namespace
}  // namespace huestep::server
