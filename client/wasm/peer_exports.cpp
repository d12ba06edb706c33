// A peer for a page: a replica that is given the bytes of its connection, one message a call.
#include <deque>
#include <memory>

#include "client/replica.h"
#include "client/wasm/exports.h"
#include "protocol/codec.h"
#include "protocol/drawing.h"
#include "protocol/fingerprint.h"
#include "protocol/frame.h"

namespace huestep::wasm {

namespace {

/// Of a view, as the server's are.
constexpr std::size_t drawn = 32'768;

client::Instant instantOf(double milliseconds) {
    return static_cast<client::Instant>(milliseconds * 1e6);
}

/// What is told of a peer, in the order in which a page reads it.
struct Numbers {
    std::uint64_t tick = 0;
    std::uint64_t root = 0;  ///< motion root of the world now
    std::uint64_t ticks = 0;
    std::uint64_t hashesCompared = 0;
    std::uint64_t mismatches = 0;
    std::uint64_t corrections = 0;
    std::uint64_t snapshots = 0;
    std::uint64_t connections = 0;
    std::uint64_t resumes = 0;
    std::uint64_t committed = 0;
    std::uint64_t player = 0;
    std::uint64_t waiting = 0;  ///< messages that have come and are not handled
};

struct Peer {
    explicit Peer(client::ReplicaConfig config) : replica(std::move(config)) {}

    client::Replica replica;
    protocol::FrameSplitter splitter;
    std::deque<protocol::Message> inbox;
    protocol::DefinitionsMark mark;
    std::uint32_t definitions = 0;
    Numbers numbers;
};

std::uint32_t refused(const Error& error, Bytes& why) {
    write(why, error.message);
    return 0;
}

std::uint32_t answered(const Status& status, Bytes& why) {
    return status ? 1 : refused(status.error(), why);
}

std::string sentenceOf(const protocol::DesyncReport& report) {
    return "tick " + std::to_string(report.tick) + ": body " + std::to_string(report.body) + " " +
           report.field + " " + report.here + " here, " + report.there + " at the server";
}

}  // namespace

/// A peer of a session, by the session's name. Steps a scene of 120 ticks first, so that a browser
/// that computes otherwise shows itself to the server before it takes part.
HUESTEP_EXPORT(peerNew)(const Bytes* session, std::uint32_t spectator, Bytes* why)->Peer* {
    const Result<protocol::Fingerprint> fingerprint = protocol::selfTest();
    if (!fingerprint) {
        write(*why, fingerprint.error().message);
        return nullptr;
    }
    client::ReplicaConfig config;
    config.session = textOf(*session);
    config.role = spectator != 0 ? protocol::Role::Spectator : protocol::Role::Player;
    config.fingerprint = *fingerprint;
    return new Peer(std::move(config));
}
HUESTEP_EXPORT(peerDelete)(Peer* peer)->void {
    delete peer;
}

/// The ticket to show at the door, sealed; before the first connection.
HUESTEP_EXPORT(peerTicket)(Peer* peer, const Bytes* ticket)->void {
    peer->replica.showTicket(*ticket);
}

/// A connection is up; times are in ms since some fixed moment.
HUESTEP_EXPORT(peerConnected)(Peer* peer, double now)->void {
    peer->splitter = protocol::FrameSplitter();
    peer->inbox.clear();
    peer->replica.connected(instantOf(now));
}
HUESTEP_EXPORT(peerDisconnected)(Peer* peer)->void {
    peer->inbox.clear();
    peer->replica.disconnected();
}

/// Takes bytes as they came. 0: they are no messages, and the connection must end.
HUESTEP_EXPORT(peerReceive)(Peer* peer, const Bytes* bytes, Bytes* why)->std::uint32_t {
    std::vector<protocol::Message> messages;
    const Status status = peer->splitter.feed(*bytes, messages);
    for (protocol::Message& message : messages) peer->inbox.push_back(std::move(message));
    return answered(status, *why);
}
/// How many messages have come and are not handled.
HUESTEP_EXPORT(peerWaiting)(const Peer* peer)->std::uint32_t {
    return peer->inbox.size();
}
/// Handles the next message; of a Frame that is one step. 0: the connection must end.
HUESTEP_EXPORT(peerTurn)(Peer* peer, double now, Bytes* why)->std::uint32_t {
    if (peer->inbox.empty()) return 1;
    protocol::Message message = std::move(peer->inbox.front());
    peer->inbox.pop_front();
    const Status status = peer->replica.receive(std::move(message), instantOf(now));
    if (status && peer->replica.bye()) return refused({peer->replica.bye()->text}, *why);
    return answered(status, *why);
}
/// Takes out what is to be sent; may be empty.
HUESTEP_EXPORT(peerOutgoing)(Peer* peer, Bytes* into)->void {
    into->clear();
    for (const protocol::Message& message : peer->replica.takeOutgoing()) {
        const std::vector<std::byte> frame = protocol::encode(message);
        into->insert(into->end(), frame.begin(), frame.end());
    }
}

/// Whether its world follows the session's.
HUESTEP_EXPORT(peerFollowing)(const Peer* peer)->std::uint32_t {
    return peer->replica.following() ? 1 : 0;
}
/// The world that it steps; null before its first snapshot.
HUESTEP_EXPORT(peerWorld)(const Peer* peer)->const World* {
    return peer->replica.world();
}
/// Numbers of 64 bits each: see `Numbers`.
HUESTEP_EXPORT(peerNumbers)(Peer* peer)->const Numbers* {
    const client::Statistics& counts = peer->replica.counts();
    const World* const world = peer->replica.world();
    peer->numbers = {world ? world->tick() : 0,
                     world ? world->motionRoot() : 0,
                     counts.ticks,
                     counts.hashesCompared,
                     counts.mismatches,
                     counts.corrections,
                     counts.snapshots,
                     counts.connections,
                     counts.resumes,
                     peer->replica.committed(),
                     counts.player,
                     peer->inbox.size()};
    return &peer->numbers;
}
/// The last difference that was found between its world and the server's, as a sentence; empty if
/// there was none.
HUESTEP_EXPORT(peerDifference)(const Peer* peer, Bytes* into)->void {
    const auto& report = peer->replica.counts().lastDesync;
    write(*into, report ? sentenceOf(*report) : "");
}

/// A frame of the protocol with a View of its world, as a server sends them to who watches.
/// `known`: the definitions whose shapes the page has. 0: there is no world yet.
HUESTEP_EXPORT(peerView)(Peer* peer, std::uint32_t known, Bytes* into)->std::uint32_t {
    const World* const world = peer->replica.world();
    if (world == nullptr) return 0;
    if (peer->mark.note(*world)) ++peer->definitions;
    protocol::View view = protocol::drawingOf(*world, known != peer->definitions, drawn);
    view.definitions = peer->definitions;
    for (const PlayerRecord& player : world->players()) view.players += player.id != 0 ? 1 : 0;
    *into = protocol::encode(view);
    return 1;
}
/// Those of the last `peerView`.
HUESTEP_EXPORT(peerDefinitions)(const Peer* peer)->std::uint32_t {
    return peer->definitions;
}

/// Place of the player's own body among the motions, from 1 on; 0 if it has none.
HUESTEP_EXPORT(peerOwnBody)(const Peer* peer)->std::uint32_t {
    const World* const world = peer->replica.world();
    if (world == nullptr) return 0;
    for (const PlayerRecord& player : world->players()) {
        if (player.id == 0 || player.id != peer->replica.player()) continue;
        const std::optional<std::uint32_t> place = world->find(player.body);
        return place ? *place + 1 : 0;
    }
    return 0;
}

/// Takes hold of the movable body at a point of the world, and draws it to there. 0: there is
/// none, or this peer does not play now.
HUESTEP_EXPORT(peerGrab)(Peer* peer, float x, float y, double now, Bytes* why)->std::uint32_t {
    const World* const world = peer->replica.world();
    if (world == nullptr) return refused({"there is no world yet"}, *why);
    const Vec2 at{x, y};
    for (const ShapeId id : world->overlap(ShapeDef::circle({}, 0.05f), {at, {1.0f, 0.0f}})) {
        for (const ShapeInfo& shape : world->shapes()) {
            if (shape.id != id) continue;
            const std::optional<std::uint32_t> place = world->find(shape.body);
            if (!place || !world->bodies()[*place].dynamic()) continue;
            return answered(peer->replica.act(Grab{shape.body, at, at}, instantOf(now)), *why);
        }
    }
    return refused({"there is no body that moves"}, *why);
}
HUESTEP_EXPORT(peerMoveGrab)(Peer* peer, float x, float y, double now, Bytes* why)->std::uint32_t {
    return answered(peer->replica.act(MoveGrab{{x, y}}, instantOf(now)), *why);
}
HUESTEP_EXPORT(peerRelease)(Peer* peer, double now, Bytes* why)->std::uint32_t {
    return answered(peer->replica.act(Release{}, instantOf(now)), *why);
}
/// Gives up its place for good.
HUESTEP_EXPORT(peerLeave)(Peer* peer)->void {
    peer->replica.leave();
}

}  // namespace huestep::wasm
