/// A client in virtual time: a replica, a bot, a splitter, and a record of what it saw. Beside one
/// that predicts runs a world which only frames step: see `checkPrediction`.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "client/bot.h"
#include "client/replica.h"
#include "link.h"
#include "protocol/codec.h"
#include "protocol/frame.h"

namespace huestep::test {

class ClientProcess {
 public:
    ClientProcess(client::ReplicaConfig config, std::unique_ptr<client::Bot> bot)
        : m_replica(std::move(config)), m_bot(std::move(bot)) {}

    client::Replica& replica() { return m_replica; }
    [[nodiscard]] const client::Replica& replica() const { return m_replica; }
    bool playing = true;   ///< whether the bot acts
    bool spoiled = false;  ///< its world is wrong on purpose: `checkPrediction` says nothing

    /// Root after so many steps, for every tick it stands by.
    std::map<std::uint64_t, std::uint64_t> roots;
    /// Frames it was told are on disk, by tick, encoded without `committed`.
    std::map<std::uint64_t, std::vector<std::byte>> committedFrames;

    void connected(Instant now) {
        m_splitter.emplace();
        m_replica.connected(now);
    }
    void disconnected() {
        m_splitter.reset();
        m_replica.disconnected();
    }

    /// Lets time pass.
    void advance(Instant now) {
        m_replica.advance(now);
        if (m_replica.prediction()) act(now);
    }

    /// The oracle of prediction: the world that is shown is what the frames led to, stepped by
    /// the commands that it claims to be predicted with, and by nothing else.
    void checkPrediction() const {
        const client::Timeline* timeline = m_replica.timeline();
        if (!m_replica.prediction() || !timeline || !m_framed || spoiled) return;
        ASSERT_LE(timeline->ahead(), 60u);
        ASSERT_EQ(timeline->confirmed(), m_framed->tick());
        ASSERT_EQ(timeline->confirmedRoot(), m_framed->motionRoot());
        World expected = *m_framed;
        for (std::uint32_t i = 0; i < timeline->ahead(); ++i) expected.step(timeline->predicted(i));
        ASSERT_EQ(timeline->world().tick(), expected.tick());
        ASSERT_EQ(timeline->world().fullRoot(), expected.fullRoot()) << "at " << expected.tick();
    }

    /// False: the client ends the connection.
    bool receive(std::span<const std::byte> bytes, Instant now) {
        std::vector<protocol::Message> messages;
        const Status fed = m_splitter->feed(bytes, messages);
        for (protocol::Message& message : messages) {
            if (!take(std::move(message), now)) return false;
        }
        if (!fed) return false;
        act(now);
        return true;
    }

    std::vector<std::byte> output() {
        std::vector<std::byte> out;
        for (const protocol::Message& message : m_replica.takeOutgoing()) {
            const std::vector<std::byte> bytes = protocol::encode(message);
            out.insert(out.end(), bytes.begin(), bytes.end());
        }
        return out;
    }

 private:
    bool take(protocol::Message message, Instant now) {
        const auto* frame = std::get_if<protocol::Frame>(&message);
        const std::optional<protocol::Frame> copy =
            frame ? std::optional<protocol::Frame>(*frame) : std::nullopt;
        if (const auto* welcome = std::get_if<protocol::Welcome>(&message)) {
            m_restarted = m_restarted || welcome->epoch != m_epoch;
            m_epoch = welcome->epoch;
        }
        const std::uint64_t snapshots = m_replica.counts().snapshots;
        const std::uint64_t ticks = m_replica.counts().ticks;
        if (!m_replica.receive(std::move(message), now)) return false;
        if (m_replica.bye()) return false;
        if (m_replica.counts().snapshots != snapshots) {
            // A server that started again may have lost what was not committed, and be past it.
            const World* world = m_replica.world();
            const std::uint64_t kept =
                m_restarted ? std::min(world->tick(), m_replica.committed()) : world->tick();
            roots.erase(roots.upper_bound(kept), roots.end());
            m_uncommitted.erase(m_uncommitted.lower_bound(kept), m_uncommitted.end());
            roots[world->tick()] = world->motionRoot();
            m_restarted = false;
            if (m_replica.prediction()) m_framed = *world;
        }
        if (copy && m_replica.counts().ticks != ticks) note(*copy);
        return true;
    }

    void note(protocol::Frame frame) {
        m_restarted = false;
        const client::Timeline& timeline = *m_replica.timeline();
        roots[timeline.confirmed()] = timeline.confirmedRoot();
        if (m_framed) m_framed->step(frame.commands);
        const std::uint64_t committed = frame.committed;
        frame.committed = 0;
        m_uncommitted[frame.tick] = protocol::encode(protocol::Message{frame});
        while (!m_uncommitted.empty() && m_uncommitted.begin()->first < committed) {
            committedFrames.insert(m_uncommitted.extract(m_uncommitted.begin()));
        }
    }

    void act(Instant now) {
        const World* world = m_replica.world();
        if (!playing || !world || !m_replica.following()) return;
        const std::uint64_t ticks = m_replica.counts().ticks;
        const std::uint64_t stage = m_replica.prediction() ? world->tick() : ticks;
        if (std::exchange(m_actedAt, stage) == stage) return;
        BodyId body = 0;
        for (const PlayerRecord& player : world->players()) {
            if (player.id == m_replica.player()) body = player.body;
        }
        for (Action& action : m_bot->act({*world, m_replica.player(), body, ticks})) {
            static_cast<void>(
                m_replica.act(std::move(action), now));  // refused: not counted as sent
        }
    }

    client::Replica m_replica;
    std::unique_ptr<client::Bot> m_bot;
    std::optional<protocol::FrameSplitter> m_splitter;
    std::optional<World> m_framed;  ///< stepped by frames alone, from the last snapshot
    std::map<std::uint64_t, std::vector<std::byte>> m_uncommitted;
    std::uint64_t m_actedAt = 0;
    std::uint32_t m_epoch = 0;
    bool m_restarted = false;  ///< since the last snapshot or frame
};

}  // namespace huestep::test
