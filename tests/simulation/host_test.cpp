// The edge: real sockets, files, threads and clocks, on 127.0.0.1.
#include "server/host.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <thread>

#include "client/player.h"
#include "protocol/address.h"
#include "protocol/codec.h"
#include "protocol/journal.h"
#include "relay.h"
#include "simulation.h"

#if defined(__SANITIZE_THREAD__)
// libuv closes files by a direct system call, which the sanitizer does not see: to it, a number
// that is given out again looks shared. What our own code does is still watched.
extern "C" const char* __tsan_default_suppressions() {
    return "called_from_lib:libuv.so";
}
#endif

namespace huestep::test {
namespace {

const protocol::Fingerprint print{1, 2, 3};

/// A data folder that is gone after the test.
struct Folder {
    Folder() {
        std::string pattern = testing::TempDir() + "huestep_host_XXXXXX";
        path = ::mkdtemp(pattern.data());
    }
    ~Folder() { std::filesystem::remove_all(path); }
    std::string path;
};

server::HostConfig configFor(const Folder& folder) {
    server::HostConfig config;
    config.listen = "127.0.0.1:0";
    config.data = folder.path;
    config.sessions.push_back({"play", playground()});
    config.open = true;
    config.fingerprint = print;
    config.handleSignals = false;
    config.log = [](server::Severity, const std::string&) {};
    return config;
}

/// A host on a thread of its own.
class Running {
 public:
    explicit Running(server::HostConfig config) {
        auto opened = server::Host::open(std::move(config));
        EXPECT_TRUE(opened.ok()) << opened.error().message;
        if (!opened) return;
        host = std::move(*opened);
        m_thread = std::thread([this] { m_status = host->run(); });
    }
    ~Running() { static_cast<void>(stop()); }
    Status stop() {
        if (!m_thread.joinable()) return m_status;
        host->stop();
        m_thread.join();
        return m_status;
    }
    std::unique_ptr<server::Host> host;

 private:
    Status m_status = Done{};
    std::thread m_thread;
};

client::PlayerConfig playerFor(const std::string& address, std::uint64_t seed,
                               std::uint64_t ticks) {
    client::PlayerConfig config;
    config.address = address;
    config.session = "play";
    config.fingerprint = print;
    config.bot = client::makeWanderBot(seed);
    config.ticks = ticks;
    config.handleSignals = false;
    return config;
}

TEST(Host, ServesPlayersOverTcpAndItsJournalReplaysToTheirRoots) {
    Folder folder;
    Running running(configFor(folder));
    const std::string address = running.host->address();
    EXPECT_NE(address, "127.0.0.1:0") << "the port as bound";
    std::vector<Result<client::Statistics>> results(3, Error{"not run"});
    std::vector<std::thread> players;
    for (std::size_t i = 0; i < results.size(); ++i) {
        players.emplace_back([&, i] { results[i] = client::play(playerFor(address, i + 1, 90)); });
    }
    for (std::thread& player : players) player.join();
    EXPECT_TRUE(running.stop().ok());

    auto store = protocol::openFolder(folder.path + "/play");
    ASSERT_TRUE(store.ok());
    const auto journal = protocol::readJournal(**store);
    ASSERT_TRUE(journal.ok()) << journal.error().message;
    std::map<std::uint64_t, std::uint64_t> roots;
    World world = *World::create(playground());
    for (const protocol::JournalEntry& entry : journal->entries) {
        const auto* frame = std::get_if<protocol::Frame>(&entry.content);
        if (!frame) continue;
        ASSERT_EQ(frame->previousRoot, world.motionRoot());
        world.step(frame->commands);
        roots[world.tick()] = world.motionRoot();
    }
    EXPECT_EQ(journal->snapshotTick, world.tick()) << "a clean stop leaves a snapshot";
    for (const auto& result : results) {
        ASSERT_TRUE(result.ok()) << result.error().message;
        EXPECT_GE(result->ticks, 90u);
        EXPECT_EQ(result->mismatches, 0u);
        EXPECT_GT(result->commandsSeen, 0u);
        EXPECT_EQ(roots[result->tick], result->root);
    }
}

TEST(Host, APlayerComesBackToItsSeatAfterARestart) {
    Folder folder;
    auto first = std::make_unique<Running>(configFor(folder));
    const std::string address = first->host->address();
    std::atomic<std::uint64_t> seen{0};
    Result<client::Statistics> result = Error{"not run"};
    std::thread player([&] {
        client::PlayerConfig config = playerFor(address, 5, 300);
        config.onProgress = [&](const client::Statistics& now) { seen = now.ticks; };
        result = client::play(std::move(config));
    });
    while (seen < 30) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_TRUE(first->stop().ok());
    first.reset();
    server::HostConfig again = configFor(folder);
    again.listen = address;
    Running second(std::move(again));
    player.join();
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_EQ(result->connections, 2u);
    EXPECT_EQ(result->resumes, 1u);
    EXPECT_EQ(result->mismatches, 0u);
    EXPECT_EQ(result->committedLost, 0u);
    EXPECT_EQ(result->player, 1u);
}

TEST(Host, APlayerWhoseLineFallsSilentComesBackToItsSeat) {
    Folder folder;
    Running running(configFor(folder));
    Relay relay(protocol::parseAddress(running.host->address(), false)->port);
    std::atomic<bool> stop{false};
    std::atomic<std::uint64_t> seen{0};
    Result<client::Statistics> result = Error{"not run"};
    std::thread player([&] {
        client::PlayerConfig config = playerFor(relay.address(), 5, 0);
        config.stop = &stop;
        config.silenceSeconds = 1.0;
        config.onProgress = [&](const client::Statistics& now) { seen = now.ticks; };
        result = client::play(std::move(config));
    });
    const auto waitFor = [](auto condition) {
        for (int i = 0; i < 4'000 && !condition(); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return condition();
    };
    EXPECT_TRUE(waitFor([&] { return seen >= 30; }));
    relay.fallSilent();
    EXPECT_TRUE(waitFor([&] { return relay.connections() >= 2; })) << "it waits for ever";
    const std::uint64_t before = seen;
    EXPECT_TRUE(waitFor([&] { return seen >= before + 30; }));
    stop = true;
    player.join();
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_GE(result->connections, 2u);
    EXPECT_EQ(result->resumes + 1, result->connections);
    EXPECT_EQ(result->player, 1u);
    EXPECT_EQ(result->mismatches, 0u);
    EXPECT_EQ(result->committedLost, 0u);
}

TEST(Host, IsOpenToThisMachineAloneUnlessToldOtherwise) {
    Folder folder;
    server::HostConfig config = configFor(folder);
    config.open = false;
    EXPECT_TRUE(server::Host::open(config).ok());
    config.listen = "0.0.0.0:0";
    const auto host = server::Host::open(config);
    ASSERT_FALSE(host.ok());
    EXPECT_NE(host.error().message.find("--tickets"), std::string::npos);
    config.open = true;
    EXPECT_TRUE(server::Host::open(std::move(config)).ok());
}

TEST(Host, WhatCannotBeServedIsToldInASentence) {
    Folder folder;
    const auto sentence = [&](auto change) {
        server::HostConfig config = configFor(folder);
        change(config);
        const auto host = server::Host::open(std::move(config));
        return host.ok() ? std::string() : host.error().message;
    };
    EXPECT_NE(sentence([](auto& c) { c.listen = "nonsense"; }).find("'nonsense'"),
              std::string::npos);
    EXPECT_NE(sentence([](auto& c) { c.sessions.clear(); }).find("no session"), std::string::npos);
    EXPECT_NE(sentence([](auto& c) { c.sessions.push_back(c.sessions[0]); }).find("two sessions"),
              std::string::npos);
    EXPECT_NE(sentence([](auto& c) { c.sessions[0].name = "../x"; }).find("'../x'"),
              std::string::npos);
    const Running running(configFor(folder));
    Folder elsewhere;
    const std::string taken = running.host->address();
    const std::string inUse = sentence([&](auto& c) {
        c.data = elsewhere.path;
        c.listen = taken;
    });
    EXPECT_NE(inUse.find("cannot listen on " + taken), std::string::npos) << inUse;
    EXPECT_NE(sentence([](auto&) {}), "") << "the folder is in use by the other host";
}

TEST(Host, AnUnreachableServerIsToldInASentence) {
    client::PlayerConfig config = playerFor("127.0.0.1:1", 1, 10);
    config.connectSeconds = 0.2;
    const auto result = client::play(std::move(config));
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().message.rfind("no connection to 127.0.0.1:1: ", 0), 0u)
        << result.error().message;
}

TEST(Host, ARefusalIsToldInASentence) {
    Folder folder;
    Running running(configFor(folder));
    client::PlayerConfig config = playerFor(running.host->address(), 1, 10);
    config.session = "nowhere";
    const auto result = client::play(std::move(config));
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().message.find("there is no session of that name"), std::string::npos);
}

TEST(Host, GarbageOnTheSocketHurtsNobody) {
    Folder folder;
    Running running(configFor(folder));
    const auto address = *protocol::parseAddress(running.host->address(), false);
    Dice dice(3);
    std::vector<int> sockets;
    for (int i = 0; i < 20; ++i) {
        const int handle = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(address.port);
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        ASSERT_EQ(::connect(handle, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
        std::vector<std::uint8_t> noise(dice.between(1, 3'000));
        for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(dice.roll());
        ::send(handle, noise.data(), noise.size(), MSG_NOSIGNAL);
        sockets.push_back(handle);
    }
    const auto result = client::play(playerFor(running.host->address(), 9, 30));
    for (const int handle : sockets) ::close(handle);
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_EQ(result->mismatches, 0u);
}

/// A part that counts what it is told.
struct CountingPart : server::HostPart {
    std::atomic<int> ticks{0}, stops{0};
    std::atomic<std::size_t> poses{0};
    void afterTick(const server::Session& session) override {
        ++ticks;
        poses = session.view(true).poses.size();
    }
    void stopping() override { ++stops; }
};

TEST(Host, PartsAreToldOfTicksAndOfTheEnd) {
    Folder folder;
    auto opened = server::Host::open(configFor(folder));
    ASSERT_TRUE(opened.ok());
    const auto part = std::make_shared<CountingPart>();
    (*opened)->add(part);
    std::thread thread([&] { EXPECT_TRUE((*opened)->run().ok()); });
    while (part->ticks < 5) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    (*opened)->stop();
    thread.join();
    EXPECT_EQ(part->stops, 1);
    EXPECT_EQ(part->poses, playground().bodies.size());
}

/// A part that holds the host up after each tick, so that ticks are always late; not for good.
struct SlowPart : server::HostPart {
    std::atomic<int> ticks{0};
    void afterTick(const server::Session&) override {
        if (++ticks < 150) std::this_thread::sleep_for(std::chrono::milliseconds(25));
    }
    void stopping() override {}
};

TEST(Host, OneWhoseStepsExceedTheirPeriodStillHearsAndStops) {
    Folder folder;
    auto opened = server::Host::open(configFor(folder));
    ASSERT_TRUE(opened.ok());
    const auto part = std::make_shared<SlowPart>();
    (*opened)->add(part);
    std::thread thread([&] { EXPECT_TRUE((*opened)->run().ok()); });
    while (part->ticks < 5) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    (*opened)->stop();
    thread.join();
    EXPECT_LT(part->ticks, 150) << "it stopped while it was late";
}

int connectTo(const std::string& text) {
    const auto address = *protocol::parseAddress(text, false);
    const int handle = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(address.port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(handle, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    return handle;
}

/// Lets a client of session `b` vanish within the turn of the loop in which `a` closes a tick, and
/// waits until `b` is due too: so the host writes to it before it can learn of it.
struct VanishingClient : server::HostPart {
    int client = -1;
    std::atomic<int> ticks{0};
    void afterTick(const server::Session& session) override {
        if (session.name() != "a" || ++ticks != 20) return;
        ::shutdown(client, SHUT_WR);
        const linger reset{1, 0};
        ::setsockopt(client, SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
        ::close(client);
        std::this_thread::sleep_for(std::chrono::milliseconds(40));
    }
    void stopping() override {}
};

TEST(Host, AClientThatVanishesBeforeAWriteEndsNothingButItself) {
    std::signal(SIGPIPE, SIG_DFL);
    Folder folder;
    server::HostConfig config = configFor(folder);
    config.sessions = {{"a", playground()}, {"b", playground()}};
    auto opened = server::Host::open(std::move(config));
    ASSERT_TRUE(opened.ok());
    const auto part = std::make_shared<VanishingClient>();
    part->client = connectTo((*opened)->address());
    protocol::Hello hello;
    hello.fingerprint = print;
    hello.session = "b";
    hello.role = protocol::Role::Spectator;
    const std::vector<std::byte> bytes = protocol::encode(hello);
    ASSERT_EQ(::send(part->client, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
    (*opened)->add(part);
    std::thread thread([&] { EXPECT_TRUE((*opened)->run().ok()); });
    while (part->ticks < 40) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    (*opened)->stop();
    thread.join();
    EXPECT_EQ((*opened)->hub().counters().accepted, 1u);
    EXPECT_TRUE((*opened)->hub().connections().empty());
}

}  // namespace
}  // namespace huestep::test
