/// Server, clients, network and disk in one thread from one seed (network page, "Tests of the
/// whole"). What holds in every run is checked by `Simulation::step` and `checkAgainstJournal`.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client_process.h"
#include "server_process.h"

namespace huestep::test {

/// What goes wrong in a run, and how often. All off: a fair day.
struct Weather {
    LinkWeather link;
    std::uint64_t breakOnceIn = 0;  ///< client steps of 2 ms
    std::uint64_t pauseOnceIn = 0;  ///< a client stops reading for a while
    Instant longestPause = 3'000 * ms;
    std::uint64_t powerOffOnceIn = 0;  ///< steps: the machine stops, unsynced bytes are torn
    std::uint64_t dieOnceIn = 0;       ///< steps: the process dies within one of its next writes
};

class Simulation {
 public:
    static constexpr Instant stepTime = 2 * ms;

    Simulation(std::uint64_t seed, const Scene& scene, server::Limits limits = {})
        : m_dice(seed), m_scene(scene) {
        m_setup.scene = &m_scene;
        m_setup.limits = limits;
        startServer();
    }

    Weather weather;
    protocol::MemoryStore disk;

    std::size_t addClient(protocol::Role role, std::unique_ptr<client::Bot> bot,
                          std::optional<client::PredictionRules> prediction = std::nullopt) {
        client::ReplicaConfig config{m_setup.session,      role, m_setup.fingerprint, {}, 30,
                                     std::move(prediction)};
        m_seats.push_back({std::make_unique<ClientProcess>(config, std::move(bot)), {}, 0, 0});
        return m_seats.size() - 1;
    }
    ClientProcess& client(std::size_t place) { return *m_seats[place].client; }
    [[nodiscard]] std::size_t clients() const { return m_seats.size(); }
    ServerProcess* server() { return m_server.get(); }
    Dice& dice() { return m_dice; }
    [[nodiscard]] Instant now() const { return m_now; }
    [[nodiscard]] std::uint64_t crashes() const { return m_crashes; }
    [[nodiscard]] std::uint64_t breaks() const { return m_breaks; }

    void run(Instant time) {
        for (const Instant end = m_now + time; m_now < end && !testing::Test::HasFatalFailure();) {
            step();
        }
    }

    /// Until every client follows and all are at most `ticks` behind with the server's own root;
    /// false: not within `time`.
    bool converge(Instant time) {
        for (const Instant end = m_now + time; m_now < end;) {
            step();
            if (testing::Test::HasFatalFailure()) return false;
            if (agreed()) return true;
        }
        return false;
    }

    void breakConnection(std::size_t place) { cut(m_seats[place], 30 * ms); }
    void pauseReading(std::size_t place, Instant time) { m_seats[place].deafUntil = m_now + time; }
    void powerOff() {
        crash();
        disk.crash(m_dice.roll());
    }

    /// The oracle: the journal on disk, replayed from its scene.
    void checkAgainstJournal(Executor* executor = nullptr) {
        const Result<protocol::JournalContents> journal = protocol::readJournal(disk);
        ASSERT_TRUE(journal.ok()) << journal.error().message;
        Result<World> world = World::create(m_scene);
        ASSERT_TRUE(world.ok()) << world.error().message;
        std::vector<std::uint64_t> roots{world->motionRoot()};
        std::vector<std::vector<std::byte>> frames;
        std::set<std::pair<PlayerId, std::uint64_t>> counted;
        for (const protocol::JournalEntry& entry : journal->entries) {
            const auto* recorded = std::get_if<protocol::Frame>(&entry.content);
            if (!recorded) continue;
            protocol::Frame frame = *recorded;
            ASSERT_EQ(frame.tick, world->tick());
            ASSERT_EQ(frame.previousRoot, world->motionRoot()) << "tick " << frame.tick;
            StepResources resources;
            resources.executor = executor;
            for (const CommandOutcome& outcome : world->step(frame.commands, resources).commands) {
                if (outcome.reason == Rejection::OldSequence) continue;
                ASSERT_TRUE(counted.insert({outcome.author, outcome.sequence}).second)
                    << "counted twice: player " << outcome.author << " sequence "
                    << outcome.sequence;
            }
            roots.push_back(world->motionRoot());
            frame.committed = 0;
            frames.push_back(protocol::encode(protocol::Message{frame}));
        }
        for (std::size_t i = 0; i < m_seats.size(); ++i) {
            checkClient(i, *m_seats[i].client, roots, frames);
            checkInputs(i, m_seats[i].client->replica(), counted);
        }
    }

 private:
    struct Wire {
        server::ConnectionId id = 0;
        Link up;
        Link down;
    };
    struct Seat {
        std::unique_ptr<ClientProcess> client;
        std::optional<Wire> wire;
        Instant connectAt = 0;
        Instant deafUntil = 0;
    };

    void step() {
        m_now += stepTime;
        if (!m_server && m_now >= m_startAt) startServer();
        if (m_dice.once(weather.powerOffOnceIn)) powerOff();
        if (m_dice.once(weather.dieOnceIn)) disk.dieAfter(m_dice.between(0, 6));
        if (m_server && !m_server->run(m_now)) {
            crash();
            disk.crash(m_dice.roll());
        }
        for (Seat& seat : m_seats) step(seat);
    }

    void step(Seat& seat) {
        if (!seat.wire && m_now >= seat.connectAt) connect(seat);
        if (!seat.wire) return;
        if (m_dice.once(weather.pauseOnceIn)) {
            seat.deafUntil = m_now + m_dice.between(1, weather.longestPause);
        }
        if (m_dice.once(weather.breakOnceIn)) return cut(seat, m_dice.between(1, 500) * ms);
        Wire& wire = *seat.wire;
        server::Hub& hub = m_server->hub();
        seat.client->advance(m_now);
        if (m_dice.once(seat.client->replica().prediction() ? 50 : 0)) {
            seat.client->checkPrediction();
        }
        wire.up.send(seat.client->output(), m_now, weather.link, m_dice);
        for (const auto& piece : wire.up.receive(m_now, 1u << 20, weather.link, m_dice)) {
            hub.receive(wire.id, piece, m_now);
        }
        while (server::SharedBytes bytes = hub.next(wire.id, wire.down.unsent(), m_now)) {
            wire.down.send(*bytes, m_now, weather.link, m_dice);
        }
        ASSERT_LE(wire.down.unsent(), m_setup.limits.clientBytes) << "memory of one client";
        if (m_now >= seat.deafUntil) {
            for (const auto& piece : wire.down.receive(m_now, 1u << 20, weather.link, m_dice)) {
                if (!seat.client->receive(piece, m_now)) return cut(seat, 20 * ms);
            }
        }
        const bool done = hub.finished(wire.id) && wire.down.unsent() == 0;
        if (done || hub.overdue(wire.id, m_now)) cut(seat, 20 * ms);
    }

    void connect(Seat& seat) {
        seat.connectAt = m_now + 100 * ms;
        if (!m_server) return;
        const auto id = m_server->hub().accept("simulated", m_now);
        if (!id) return;
        seat.wire = Wire{*id, {}, {}};
        seat.client->connected(m_now);
    }

    void cut(Seat& seat, Instant pause) {
        if (!seat.wire) return;
        ++m_breaks;
        if (m_server) m_server->hub().closed(seat.wire->id, m_now);
        seat.wire.reset();
        seat.client->disconnected();
        seat.connectAt = m_now + pause;
    }

    void crash() {
        if (!m_server) return;
        ++m_crashes;
        for (Seat& seat : m_seats) cut(seat, m_dice.between(1, 200) * ms);
        m_server.reset();
        m_startAt = m_now + m_dice.between(1, 300) * ms;
    }

    void startServer() {
        Result<std::unique_ptr<ServerProcess>> started =
            ServerProcess::start(m_setup, disk, m_now, m_dice);
        if (started.ok()) {
            m_server = std::move(*started);
            return;
        }
        // Only a write that was told to die may keep a server from starting.
        disk.crash(m_dice.roll());
        started = ServerProcess::start(m_setup, disk, m_now, m_dice);
        ASSERT_TRUE(started.ok()) << started.error().message;
        m_server = std::move(*started);
    }

    [[nodiscard]] bool agreed() const {
        if (!m_server) return false;
        const World& world = m_server->session().world();
        return std::all_of(m_seats.begin(), m_seats.end(), [&](const Seat& seat) {
            const client::Timeline* theirs = seat.client->replica().timeline();
            if (!theirs || !seat.client->replica().following()) return false;
            const auto root = m_server->session().rootAt(theirs->confirmed());
            return theirs->confirmed() + 30 >= world.tick() && root == theirs->confirmedRoot();
        });
    }

    static void checkClient(std::size_t place, const ClientProcess& client,
                            const std::vector<std::uint64_t>& roots,
                            const std::vector<std::vector<std::byte>>& frames) {
        for (const auto& [tick, root] : client.roots) {
            if (tick >= roots.size()) break;  // not on disk when the run ended
            ASSERT_EQ(root, roots[tick]) << "client " << place << " tick " << tick;
        }
        for (const auto& [tick, frame] : client.committedFrames) {
            ASSERT_LT(tick, frames.size()) << "a committed tick is lost, client " << place;
            ASSERT_EQ(frame, frames[tick]) << "client " << place << " tick " << tick;
        }
        const client::Statistics& counts = client.replica().counts();
        EXPECT_EQ(counts.committedLost, 0u) << "client " << place;
    }

    /// A client that kept its seat and waits for nothing: each of its commands counted, once.
    static void checkInputs(std::size_t place, const client::Replica& replica,
                            const std::set<std::pair<PlayerId, std::uint64_t>>& counted) {
        const client::Statistics& counts = replica.counts();
        if (replica.player() == 0) return;  // a spectator
        if (counts.resumes + 1 != counts.connections || replica.pendingCommands() != 0) return;
        const auto first = counted.lower_bound({replica.player(), 0});
        const auto last = counted.lower_bound({replica.player() + 1, 0});
        EXPECT_EQ(static_cast<std::uint64_t>(std::distance(first, last)), counts.commandsSent)
            << "inputs of client " << place;
    }

    Dice m_dice;
    Scene m_scene;
    ServerSetup m_setup;
    std::unique_ptr<ServerProcess> m_server;
    std::vector<Seat> m_seats;
    Instant m_now = 1'000 * ms;
    Instant m_startAt = 0;
    std::uint64_t m_crashes = 0;
    std::uint64_t m_breaks = 0;
};

/// The scene of the runs: small, with joints, a motor, players and room to spawn.
inline Scene playground() {
    Scene scene;
    scene.name = "playground";
    BodyDef ground;
    ground.shapes = {ShapeDef::box(20.0f, 0.5f, {0.0f, -0.5f}),
                     ShapeDef::box(0.5f, 6.0f, {-20.0f, 6.0f}),
                     ShapeDef::box(0.5f, 6.0f, {20.0f, 6.0f})};
    scene.bodies.push_back(ground);
    for (int i = 0; i < 24; ++i) {
        BodyDef box;
        box.type = BodyType::Dynamic;
        box.position = {-9.0f + 1.5f * static_cast<float>(i % 12),
                        0.5f + 1.1f * static_cast<float>(i / 12)};
        box.shapes.push_back(i % 3 == 0 ? ShapeDef::circle({}, 0.5f) : ShapeDef::box(0.5f, 0.5f));
        scene.bodies.push_back(box);
    }
    PlayerDef players;
    BodyDef body;
    body.type = BodyType::Dynamic;
    body.shapes.push_back(ShapeDef::circle({}, 0.4f));
    players.body = body;
    players.spawnPoints = {{-5.0f, 5.0f}, {0.0f, 5.0f}, {5.0f, 5.0f}};
    scene.players = players;
    return scene;
}

}  // namespace huestep::test
