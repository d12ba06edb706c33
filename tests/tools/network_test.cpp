// A server and its clients as processes on loopback.
#include <gtest/gtest.h>

#include <algorithm>
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

TEST(Session, ClientsThatPredictAgreeWithThoseThatDoNotAndTellWhatItTook) {
    const TemporaryFolder folder;
    Server server(folder / "data", "play=sandbox", "127.0.0.1:0", {"--input-delay", "1-4"});
    const std::string address = server.address();
    ASSERT_NE(address, "");
    const auto lockstep = join(address, "play", {"--ticks", "240"});
    const auto near = join(address, "play", {"--ticks", "240", "--predict"});
    const auto far = join(address, "play",
                          {"--ticks", "240", "--predict", "--lag", "150", "--jitter", "20",
                           "--input-delay", "2", "--guess", "pushes"});
    Json documents[3];
    Process* clients[] = {lockstep.get(), near.get(), far.get()};
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(clients[i]->wait(60.0), 0) << clients[i]->err();
        documents[i] = documentOf(clients[i]->out());
        EXPECT_EQ(documents[i]["mismatches"], 0) << i;
        EXPECT_GE(documents[i]["hashes_compared"], 240) << i;
        EXPECT_GT(documents[i]["commands"]["seen"], 0) << i;
    }
    EXPECT_FALSE(documents[0].contains("prediction"));
    const Json& close = documents[1]["prediction"];
    EXPECT_GE(close["input_delay_ticks"], 1);
    EXPECT_LE(close["input_delay_ticks"], 4);
    const Json& late = documents[2]["prediction"];
    EXPECT_EQ(late["input_delay_ticks"], 2);
    EXPECT_GE(late["round_trip_s"], 0.15);
    EXPECT_GT(late["rollbacks"], 0);
    EXPECT_GT(late["depth_ticks"]["max"], 4);
    EXPECT_LE(late["depth_ticks"]["max"], 60);
    EXPECT_GT(late["rollback_ms"]["sum"], 0.0);
    server.process().send(SIGTERM);
    ASSERT_EQ(server.process().wait(20.0), 0) << server.process().err();
    const Ended replay = huestep({"replay", folder / "data/play", "--threads", "2", "--json"});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
    EXPECT_EQ(documentOf(replay.out)["mismatches"], 0);
}

TEST(Session, ReplayFromASnapshotInItsMiddleComesToTheSameStateAsFromTheStart) {
    const TemporaryFolder folder;
    const std::string data = folder / "data";
    const std::string log = data + "/play";
    // The server writes a snapshot when it stops; the session goes on from there.
    playShortSession(data);
    const auto middle = documentOf(huestep({"replay", log, "--json"}).out)["tick"].get<int>();
    playShortSession(data);
    const Json whole = documentOf(huestep({"replay", log, "--json"}).out);
    ASSERT_GT(whole["tick"], middle);
    const Json rest =
        documentOf(huestep({"replay", log, "--from", std::to_string(middle), "--json"}).out);
    EXPECT_EQ(rest["first_tick"], middle);
    EXPECT_GE(rest["hashes_compared"], whole["tick"].get<int>() - middle - 1);
    EXPECT_GT(rest["hashes_compared"], 0);
    EXPECT_EQ(rest["mismatches"], 0);
    EXPECT_EQ(rest["tick"], whole["tick"]);
    EXPECT_EQ(rest["hash"], whole["hash"]);

    // From the very end there is nothing to compare, and that is what it says.
    const Ended none = huestep({"replay", log, "--from", std::to_string(whole["tick"].get<int>())});
    EXPECT_EQ(none.status, 0) << none.err;
    EXPECT_NE(none.out.find("nothing was compared"), std::string::npos) << none.out;
    EXPECT_EQ(none.out.find("equal"), std::string::npos) << none.out;

    // A path that cannot be written is refused before anything is played.
    const Ended refused = huestep({"replay", log, "--snapshot", "/nowhere/x.snap"});
    EXPECT_EQ(refused.status, 2);
    EXPECT_EQ(refused.out, "");
}

TEST(Session, ASnapshotOfAJournalIsReadUnderAnyName) {
    const TemporaryFolder folder;
    playShortSession(folder / "data");
    playShortSession(folder / "data");
    std::vector<std::filesystem::path> snapshots;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "data/play"))
        if (entry.path().extension() == ".snap") snapshots.push_back(entry.path());
    ASSERT_GE(snapshots.size(), 2u);
    std::sort(snapshots.begin(), snapshots.end());
    const std::string copy = folder / "copy";
    std::filesystem::copy_file(snapshots.front(), copy);
    EXPECT_EQ(huestep({"diff", copy, snapshots.front().string()}).status, 0);
    const Ended other = huestep({"diff", copy, snapshots.back().string()});
    EXPECT_EQ(other.status, 1) << other.err;
    // A name that says another tick than the file: it is not read in another file's stead.
    const std::string wrong = snapshots.back().parent_path() / "snapshot-000000099999.snap";
    std::filesystem::copy_file(copy, wrong);
    const Ended refused = huestep({"diff", copy, wrong});
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find(wrong), std::string::npos) << refused.err;
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
    ASSERT_TRUE(Process::until(30.0, [&] {
        return linesWith(client->err(), "connected to " + address) == 1;
    })) << client->err();
    client->send(SIGINT);
    EXPECT_EQ(client->wait(20.0), 0) << client->err();
    EXPECT_EQ(documentOf(client->out())["mismatches"], 0);
    EXPECT_TRUE(Process::until(20.0, [&] {
        return linesWith(server.process().err(), "event=left") == 1;
    })) << server.process().err();
}

TEST(Session, ASignalBeforeTheLoopHasItsHandlersIsNotLost) {
    // Sent as soon as the program catches signals at all: it is still running its self-test.
    const TemporaryFolder folder;
    for (const int signal : {SIGINT, SIGTERM}) {
        Server server(folder / "data", "play=sandbox", "127.0.0.1:0");
        ASSERT_TRUE(server.process().catches(signal, 20.0));
        server.process().send(signal);
        EXPECT_EQ(server.process().wait(20.0), 0) << server.process().err();

        Server other(folder / "other", "play=sandbox", "127.0.0.1:0");
        const std::string address = other.address();
        ASSERT_NE(address, "");
        const auto client = join(address, "play");
        ASSERT_TRUE(client->catches(signal, 20.0));
        client->send(signal);
        // Status 2 says that it was stopped before it was connected, which it mostly was.
        const int status = client->wait(20.0).value_or(-1);
        EXPECT_TRUE(status == 0 || status == 2) << status << client->err();
        EXPECT_EQ(status == 2, linesWith(client->err(), "huestep: stopped before it was") == 1)
            << client->err();
        other.process().send(SIGTERM);
        EXPECT_EQ(other.process().wait(20.0), 0);
    }
}

TEST(Session, AClientThatLosesItsServerSaysSoAndKeepsWhatItVerified) {
    const TemporaryFolder folder;
    const std::string data = folder / "data";
    auto server = std::make_unique<Server>(data, "play=sandbox", "127.0.0.1:0");
    const std::string address = server->address();
    ASSERT_NE(address, "");
    const auto client = join(address, "play");
    const auto says = [&](const std::string& sentence) {
        return Process::until(60.0, [&] { return linesWith(client->err(), sentence) > 0; });
    };
    ASSERT_TRUE(says("connected to ")) << client->err();
    server->process().send(SIGKILL);
    ASSERT_TRUE(server->process().wait(20.0));
    ASSERT_TRUE(says("connection lost: ")) << client->err();
    EXPECT_EQ(linesWith(client->err(), "trying again for 30 s"), 1) << client->err();
    server = std::make_unique<Server>(data, "play=sandbox", address);
    ASSERT_TRUE(says("connected again")) << client->err();
    server.reset();  // for good
    ASSERT_EQ(client->wait(90.0), 2) << client->err();
    EXPECT_EQ(linesWith(client->err(), "huestep: no connection to " + address), 1) << client->err();
    const Json document = documentOf(client->out());
    EXPECT_GT(document["hashes_compared"], 0);
    EXPECT_EQ(document["mismatches"], 0);
    EXPECT_NE(document["failure"], "");
}

TEST(Session, AClientThatIsStoppedBeforeItEverConnectedSaysWhy) {
    Process client({huestepProgram, "join", "127.0.0.1:1", "--session", "play"});
    ASSERT_TRUE(Process::until(30.0, [&] {
        return linesWith(client.err(), "trying again for 10 s") == 1;
    })) << client.err();
    client.send(SIGINT);
    EXPECT_EQ(client.wait(20.0), 2);
    EXPECT_EQ(client.out(), "");
    EXPECT_EQ(linesWith(client.err(), "huestep: stopped before it was in session 'play'"), 1)
        << client.err();
    EXPECT_EQ(linesWith(client.err(), "refused"), 2) << client.err();
}

TEST(Session, AReplayThatIsStoppedDiffersFromNothing) {
    // A world that takes long enough that a replay of it can be stopped at all.
    const TemporaryFolder folder;
    Server server(folder / "data", "play=pyramid:base=60", "127.0.0.1:0");
    const std::string address = server.address();
    ASSERT_NE(address, "");
    const auto idle = join(address, "play", {"--ticks", "90", "--bot", "idle"});
    ASSERT_EQ(idle->wait(120.0), 0) << idle->err();
    server.process().send(SIGTERM);
    ASSERT_EQ(server.process().wait(20.0), 0);
    Process replay({huestepProgram, "replay", folder / "data/play", "--json"});
    ASSERT_TRUE(replay.catches(SIGINT, 20.0));
    replay.send(SIGINT);
    EXPECT_EQ(replay.wait(20.0), 130) << replay.err();
    EXPECT_EQ(linesWith(replay.err(), "huestep: stopped before the end, at tick "), 1);
    const Json document = documentOf(replay.out());
    EXPECT_EQ(document["finished"], false);
    EXPECT_EQ(document["mismatches"], 0);
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
