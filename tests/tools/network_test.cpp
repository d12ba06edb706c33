// A server and its clients as processes on loopback.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/session.h"

namespace huestep::test {
namespace {

using Json = nlohmann::json;

Json documentOf(const std::string& text) {
    Json document = Json::parse(text, nullptr, false);
    EXPECT_FALSE(document.is_discarded()) << text;
    return document;
}

/// Plays a short session to its end and leaves its journal in `data`/play.
void playShortSession(const std::string& data) {
    Server server(data, "play=sandbox", "127.0.0.1:0");
    const std::string address = server.address();
    ASSERT_NE(address, "");
    const auto wander = join(address, "play", {"--ticks", "90"});
    const auto idle = join(address, "play", {"--ticks", "60", "--bot", "idle"});
    for (Process* client : {wander.get(), idle.get()}) {
        ASSERT_EQ(client->wait(60.0), 0) << client->err();
        const Json document = documentOf(client->out());
        EXPECT_EQ(document["mismatches"], 0);
        EXPECT_GE(document["hashes_compared"], 60);
    }
    server.process().send(SIGTERM);
    ASSERT_EQ(server.process().wait(20.0), 0) << server.process().err();
}

TEST(Session, ClientsAgreeAndTheJournalReplaysWithAnyThreads) {
    const TemporaryFolder folder;
    playShortSession(folder / "data");
    Json first;
    for (const char* threads : {"1", "8"}) {
        const Ended replay =
            huestep({"replay", folder / "data/play", "--threads", threads, "--json"});
        EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
        const Json document = documentOf(replay.out);
        EXPECT_EQ(document["mismatches"], 0);
        EXPECT_GE(document["hashes_compared"], document["tick"]);
        EXPECT_GE(document["tick"], 90);
        if (first.is_null()) first = document;
        EXPECT_EQ(document["hash"], first["hash"]);
    }
    const Ended verify = huestep(
        {"verify", folder / "data/play", "--threads", "1,2", "--restore-every", "11", "--json"});
    EXPECT_EQ(verify.status, 0) << verify.out << verify.err;
    const Ended diff = huestep({"diff", folder / "data/play", folder / "data/play"});
    EXPECT_EQ(diff.status, 0) << diff.out << diff.err;
}

TEST(Session, ReplayFromASnapshotComesToTheSameStateAsFromTheStart) {
    const TemporaryFolder folder;
    playShortSession(folder / "data");
    const std::string log = folder / "data/play";
    const Json whole = documentOf(huestep({"replay", log, "--json"}).out);
    const std::string end = std::to_string(whole["tick"].get<int>());
    // The server wrote a snapshot when it stopped.
    const Json rest = documentOf(huestep({"replay", log, "--from", end, "--json"}).out);
    EXPECT_EQ(rest["first_tick"], whole["tick"]);
    EXPECT_EQ(rest["hash"], whole["hash"]);
}

TEST(Session, AFlippedByteInAJournalIsRefusedWithFileAndOffset) {
    const TemporaryFolder folder;
    playShortSession(folder / "data");
    const std::string segment = folder / "data/play/segment-000000000000.log";
    std::string bytes = textOf(segment);
    const std::size_t at = bytes.size() / 2;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    std::ofstream(segment, std::ios::binary) << bytes;
    const Ended replay = huestep({"replay", folder / "data/play"});
    EXPECT_EQ(replay.status, 2) << replay.out;
    EXPECT_NE(replay.err.find(segment), std::string::npos) << replay.err;
    EXPECT_NE(replay.err.find("byte"), std::string::npos) << replay.err;
}

TEST(Session, TwoJournalsThatDifferAreComparedToTheFirstTickThatDoes) {
    const TemporaryFolder folder;
    playShortSession(folder / "a");
    playShortSession(folder / "b");
    // Two sessions of wandering bots: the commands differ, and so does the world after them.
    const Ended diff = huestep({"diff", folder / "a/play", folder / "b/play", "--json"});
    EXPECT_EQ(diff.status, 1) << diff.err;
    const Json found = documentOf(diff.out)["difference"];
    EXPECT_GT(found["tick"], 0);
    EXPECT_NE(found["sentence"], "");
}

TEST(Session, AClientLeavesCleanlyAtCtrlC) {
    const TemporaryFolder folder;
    Server server(folder / "data", "play=sandbox", "127.0.0.1:0");
    const std::string address = server.address();
    ASSERT_NE(address, "");
    const auto client = join(address, "play");
    ASSERT_TRUE(server.welcomes(1, 30.0)) << server.process().err();
    client->send(SIGINT);
    EXPECT_EQ(client->wait(20.0), 0) << client->err();
    EXPECT_EQ(documentOf(client->out())["mismatches"], 0);
    EXPECT_TRUE(Process::until(20.0, [&] {
        return linesWith(server.process().err(), "event=left") == 1;
    })) << server.process().err();
}

TEST(Serve, WithoutOpenItRefusesToStart) {
    const TemporaryFolder folder;
    const Ended ended = huestep({"serve", "--listen", "127.0.0.1:0", "--data", folder / "data",
                                 "--session", "play=sandbox"});
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.err.find("--open"), std::string::npos) << ended.err;
    EXPECT_EQ(ended.out, "");
}

TEST(Serve, TakesItsOptionsFromAFileAndWarnsOfAnOpenDoor) {
    const TemporaryFolder folder;
    const std::string config = folder / "serve.toml";
    std::ofstream(config) << "listen = \"127.0.0.1:0\"\nopen = true\n"
                          << "session = [\"one=small\", \"two=sandbox\"]\n"
                          << "web = \"127.0.0.1:0\"\n"
                          << "data = \"" << (folder / "data") << "\"\n";
    Process server({huestepProgram, "serve", "--config", config});
    ASSERT_TRUE(Process::until(30.0, [&] {
        return server.out().find("listening on 127.0.0.1:") != std::string::npos;
    })) << server.err();
    server.send(SIGINT);
    EXPECT_EQ(server.wait(20.0), 0) << server.err();
    EXPECT_NE(server.err().find("--open"), std::string::npos) << server.err();
    for (const char* name : {"one", "two"})
        EXPECT_EQ(huestep({"replay", folder / (std::string("data/") + name)}).status, 0) << name;
}

}  // namespace
}  // namespace huestep::test
