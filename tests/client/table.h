/// A server of one client, played by hand, and the client.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "client/replica.h"
#include "core/state/hash.h"
#include "protocol/messages.h"

namespace huestep::client {

inline Scene smallScene() {
    Scene scene;
    BodyDef ball;
    ball.type = BodyType::Dynamic;
    ball.position = {0.0f, 5.0f};
    ball.shapes.push_back(ShapeDef::circle({}, 0.5f));
    scene.bodies = {ball, ball};
    scene.bodies[1].position.x = 3.0f;
    PlayerDef players;
    players.body = ball;
    players.spawnPoints = {{0.0f, 6.0f}};
    scene.players = players;
    return scene;
}

/// A server of one client, by hand.
struct Table {
    explicit Table(std::optional<PredictionRules> prediction = std::nullopt,
                   protocol::Role role = protocol::Role::Player)
        : replica(ReplicaConfig{"play", role, {1, 2, 3}, {}, 30, std::move(prediction)}) {}

    Replica replica;
    World world = *World::create(smallScene());
    std::uint64_t now = 1'000;
    std::uint32_t queued = 2'048;  ///< what Welcome says, as below
    std::uint32_t queuedBytes = 1u << 20;
    std::uint32_t inputDelay = 0, maxInputDelay = 0;

    std::vector<protocol::Message> take() { return replica.takeOutgoing(); }
    template <class M>
    static std::optional<M> find(const std::vector<protocol::Message>& messages) {
        for (const protocol::Message& message : messages) {
            if (const auto* found = std::get_if<M>(&message)) return *found;
        }
        return std::nullopt;
    }
    bool say(protocol::Message message) { return replica.receive(std::move(message), now).ok(); }
    bool act(Action action) { return replica.act(std::move(action), now).ok(); }

    void welcome(PlayerId player = 1, std::uint64_t lastSequence = 0, std::uint32_t epoch = 1) {
        replica.connected(now);
        protocol::Welcome welcome;
        welcome.session = "play";
        welcome.player = player;
        welcome.epoch = epoch;
        welcome.tick = world.tick();
        welcome.lastSequence = lastSequence;
        welcome.resume = {9, 9};
        welcome.maxQueuedCommands = queued;
        welcome.maxQueuedBytes = queuedBytes;
        welcome.inputDelay = inputDelay;
        welcome.maxInputDelay = maxInputDelay;
        EXPECT_TRUE(say(welcome));
    }
    void snapshot(std::size_t chunk = 1'000) {
        const std::vector<std::byte> bytes = world.save();
        EXPECT_TRUE(say(protocol::SnapshotBegin{world.tick(), bytes.size(), hash64(bytes)}));
        for (std::size_t at = 0; at < bytes.size(); at += chunk) {
            const std::size_t count = std::min(chunk, bytes.size() - at);
            const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(at);
            EXPECT_TRUE(say(
                protocol::SnapshotChunk{at, {from, from + static_cast<std::ptrdiff_t>(count)}}));
        }
        EXPECT_TRUE(say(protocol::SnapshotEnd{world.tick()}));
    }
    protocol::Frame frame(std::vector<Command> commands = {}, std::uint64_t committed = 0) {
        protocol::Frame out{world.tick(), std::move(commands), {}, world.motionRoot(), committed};
        world.step(out.commands);
        return out;
    }
    void enter() {
        world.step(std::vector<Command>{{0, 1, AddPlayer{1}}});
        welcome();
        snapshot();
        take();
    }
};

}  // namespace huestep::client
