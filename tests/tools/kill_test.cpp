// kill -9 of a server at random moments, twenty times, with clients that play on.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "tests/tools/session.h"

namespace huestep::test {
namespace {

using Json = nlohmann::json;

constexpr int kills = 20;

/// What a journal held after a kill.
struct Held {
    std::uint64_t tick = 0;
    std::string hash;
};

Held replayed(const std::string& log, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"replay", log, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Ended ended = huestep(words);
    EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
    const Json document = Json::parse(ended.out, nullptr, false);
    if (document.is_discarded()) return {};
    EXPECT_EQ(document["mismatches"], 0) << ended.out;
    return {document["tick"].get<std::uint64_t>(), document["hash"]["motion"].get<std::string>()};
}

TEST(Kill, TwentyTimesAtRandomMomentsLosesNoCommittedTickAndClientsRejoin) {
    const std::uint64_t seed = std::random_device{}();
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<int> milliseconds(20, 600);

    const TemporaryFolder folder;
    const std::string data = folder / "data";
    const std::string log = data + "/play";
    auto server = std::make_unique<Server>(data, "play=sandbox", "127.0.0.1:0");
    const std::string address = server->address();
    ASSERT_NE(address, "") << server->process().err();
    const std::unique_ptr<Process> clients[] = {join(address, "play"), join(address, "play")};

    std::vector<Held> held;
    for (int kill = 0; kill < kills; ++kill) {
        // The server dies at any moment: with both clients back in play, or, every other time,
        // while it may still be reading its journal or welcoming them.
        if (kill % 2 == 0) {
            ASSERT_TRUE(server->welcomes(2, 30.0)) << "after kill " << kill << "\n"
                                                   << server->process().err();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds(random)));
        server->process().send(SIGKILL);
        ASSERT_EQ(server->process().wait(20.0), 128 + SIGKILL);
        held.push_back(replayed(log));
        server = std::make_unique<Server>(data, "play=sandbox", address);
        ASSERT_EQ(server->address(), address) << server->process().err();
    }
    ASSERT_TRUE(server->welcomes(2, 30.0)) << server->process().err();
    for (const auto& client : clients) client->send(SIGINT);
    for (const auto& client : clients) {
        ASSERT_EQ(client->wait(30.0), 0) << client->out() << client->err();
        const Json document = Json::parse(client->out(), nullptr, false);
        ASSERT_FALSE(document.is_discarded()) << client->out();
        EXPECT_EQ(document["mismatches"], 0) << client->out();
        EXPECT_EQ(document["committed_ticks_lost"], 0) << client->out();
        EXPECT_GE(document["connections"], kills / 2 + 1) << client->out();
        EXPECT_GT(document["resumes"], 0) << client->out();
    }
    server->process().send(SIGTERM);
    ASSERT_EQ(server->process().wait(20.0), 0) << server->process().err();

    // What the disk held after each kill is still there: the session went on from it.
    const Held last = replayed(log, {"--threads", "3"});
    std::uint64_t before = 0;
    for (const Held& then : held) {
        EXPECT_GE(then.tick, before);
        EXPECT_LE(then.tick, last.tick);
        before = then.tick;
        const Held now = replayed(log, {"--to", std::to_string(then.tick)});
        EXPECT_EQ(now.tick, then.tick);
        EXPECT_EQ(now.hash, then.hash) << "at tick " << then.tick;
    }
    EXPECT_GT(last.tick, 0u);
    std::printf("ticks on disk after each kill:");
    for (const Held& then : held) std::printf(" %llu", static_cast<unsigned long long>(then.tick));
    std::printf("; at the end %llu\n", static_cast<unsigned long long>(last.tick));
}

}  // namespace
}  // namespace huestep::test
