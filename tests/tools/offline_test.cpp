// Subcommands without a network, as processes.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/tools/document.h"

namespace huestep::test {
namespace {

TEST(Help, EverySubcommandAnswersWithAnExample) {
    for (const char* name :
         {"scenes", "run", "verify", "serve", "join", "replay", "diff", "bench", "stability"}) {
        const Ended ended = huestep({name, "--help"});
        EXPECT_EQ(ended.status, 0) << name;
        const std::string example = after(ended.out, "Example:\n");
        EXPECT_TRUE(example.starts_with(std::string("  huestep ") + name)) << ended.out;
    }
}

TEST(Scenes, EverySceneOfTheListBuildsAndSteps) {
    const Json document = documentOf({"scenes"});
    EXPECT_GE(document["scenes"].size(), 8u);
    for (const Json& scene : document["scenes"]) {
        const Json run = documentOf({"run", scene["name"], "--ticks", "2"});
        // The list counts those of the start, to which a host or a game may have added some.
        if (scene["scripted"] == true || scene["rules"] != "")
            EXPECT_GE(run["bodies"], scene["bodies"]) << scene["name"];
        else
            EXPECT_EQ(run["bodies"], scene["bodies"]) << scene["name"];
    }
}

TEST(Scenes, TheListAlignsItsPurposesAndExplainsEveryParameter) {
    const Ended ended = huestep({"scenes"});
    const std::size_t column = ended.out.find("purpose");
    ASSERT_NE(column, std::string::npos);
    const Json document = documentOf({"scenes"});
    for (const Json& scene : document["scenes"]) {
        const std::size_t row =
            ("\n" + ended.out).find("\n" + scene["name"].get<std::string>() + " ");
        ASSERT_NE(row, std::string::npos) << scene["name"];
        const std::string purpose = scene["purpose"];
        EXPECT_EQ(ended.out.substr(row + column, purpose.size()), purpose);
        for (const Json& parameter : scene["parameters"])
            EXPECT_GE(linesWith(ended.out, parameter["meaning"]), 1) << parameter;
    }
}

TEST(Run, NamesTheWidthThatAutoChose) {
    const Ended ended = huestep({"run", "small:n=3", "--ticks", "3"});
    const std::string width = after(ended.out, "simd auto (");
    ASSERT_TRUE(width.ends_with(" here)")) << ended.out;
    const std::string name = width.substr(0, width.find(' '));
    EXPECT_EQ(huestep({"run", "small:n=3", "--ticks", "3", "--simd", name}).status, 0) << name;
    EXPECT_EQ(linesWith(ended.out, "mean ms a tick: "), 1) << ended.out;
}

TEST(Bench, ItsHelpExplainsItsColumns) {
    const Ended help = huestep({"bench", "--help"});
    for (const char* column : {"psm: ", "ratio: ", "drift: "})
        EXPECT_EQ(linesWith(help.out, column), 1) << column << help.out;
}

TEST(Run, SaysTheSameHashForEveryThreadCountAndWidth) {
    const Json one = documentOf({"run", "pyramid:base=12", "--ticks", "60", "--simd", "scalar"});
    const Json many = documentOf({"run", "pyramid:base=12", "--ticks", "60", "--threads", "3"});
    EXPECT_EQ(one["hash"], many["hash"]);
    EXPECT_EQ(one["ticks"], 60);
    EXPECT_EQ(one["bodies"], 79);  // 12 · 13 / 2 boxes and the ground
    EXPECT_EQ(many["waited_ms"].size(), 3u);
}

TEST(Run, PrintsAHashAfterEveryKTicksAndTheLastOneAgrees) {
    const Json run = documentOf({"run", "small:n=6", "--ticks", "30", "--hash-every", "10"});
    ASSERT_EQ(run["hashes"].size(), 3u);
    EXPECT_EQ(run["hashes"][2]["tick"], 30);
    EXPECT_EQ(run["hashes"][2]["motion"], run["hash"]["motion"]);
    EXPECT_EQ(run["hashes"][2]["full"], run["hash"]["full"]);
}

TEST(Run, ReadsNumbersAsDecimalWhateverZerosStandInFront) {
    EXPECT_EQ(documentOf({"run", "small:n=3", "--ticks", "010"})["ticks"], 10);
}

TEST(Run, MeasuresAPendulumAgainstItsClosedForm) {
    const Json run = documentOf({"run", "pendulum:angle=90", "--ticks", "600"});
    const Json& pendulum = run["accuracy"]["pendulum"];
    // The elliptic integral K(1/2) = 1.8540746773: T = 4 K √(L/g) with L = 1 + r²/2, r = 0.1.
    EXPECT_NEAR(pendulum["exact_period_s"].get<double>(),
                4.0 * 1.85407467730137 * std::sqrt(1.005 / 10.0), 1e-6);
    EXPECT_NEAR(pendulum["period_s"].get<double>() / pendulum["exact_period_s"].get<double>(), 1.0,
                1e-3);
    EXPECT_LT(std::abs(pendulum["energy_loss"].get<double>()), 0.02);
}

TEST(Run, MeasuresFreeFlightAgainstItsParabola) {
    const Json run = documentOf({"run", "ballistic"});
    EXPECT_NEAR(run["accuracy"]["ballistic"]["seconds"].get<double>(), 1.0, 1e-6);
    EXPECT_LT(run["accuracy"]["ballistic"]["max_error_m"].get<double>(), 1e-4);
    const Json peer = documentOf({"run", "ballistic", "--engine", "box2d"});
    // Box2D's Euler step is off by g·t·Δt/2 = 8.3 cm after one second.
    EXPECT_NEAR(peer["accuracy"]["ballistic"]["max_error_m"].get<double>(), 10.0 / 120.0, 1e-3);
}

TEST(Run, SeesNoFreeFlightWhereBodiesSleepAtTheStart) {
    for (const char* engine : {"huestep", "box2d"}) {
        const Json run = documentOf(
            {"run", "smash:columns=1,rows=1", "--ticks", "30", "--engine", std::string(engine)});
        EXPECT_FALSE(run["accuracy"].contains("ballistic")) << engine;
    }
}

TEST(Run, StepsAScriptedSceneAndSaysNoDriftWhereBodiesCameAndWent) {
    const std::string rain = "rain:floors=1,columns=3,group=2,period=7";
    for (const char* engine : {"huestep", "box2d"}) {
        const Json run = documentOf({"run", rain, "--ticks", "60", "--engine", engine});
        EXPECT_EQ(run["bodies"], 2 + 3 * 2 * 11) << engine;
        EXPECT_TRUE(run["accuracy"]["energy_drift"].is_null()) << engine;
        EXPECT_LT(run["accuracy"]["max_joint_error_m"].get<double>(), 0.05) << engine;
    }
    const Json pushed = documentOf({"run", "junkyard:columns=4,rows=2", "--ticks", "30"});
    EXPECT_TRUE(pushed["accuracy"]["energy_drift"].is_number()) << "nobody came or went";
}

TEST(Scenes, SayWhichOfThemAreScripted) {
    const Json document = documentOf({"scenes"});
    std::set<std::string> scripted;
    for (const Json& scene : document["scenes"])
        if (scene["scripted"] == true) scripted.insert(scene["name"]);
    EXPECT_EQ(scripted, (std::set<std::string>{"dominoes", "hub", "junkyard", "rain", "release"}));
}

TEST(Diff, NamesTheFieldInWhichTwoSnapshotsDiffer) {
    const TemporaryFolder folder;
    for (const char* base : {"3", "4"})
        documentOf(
            {"run", std::string("small:n=") + base, "--ticks", "5", "--snapshot", folder / base});
    documentOf({"run", "small:n=3", "--ticks", "5", "--threads", "2", "--snapshot", folder / "5"});
    EXPECT_EQ(documentOf({"diff", folder / "3", folder / "5"})["equal"], true);
    const Json document = documentOf({"diff", folder / "3", folder / "4"}, 1);
    EXPECT_EQ(document["difference"]["tick"], 5);
    EXPECT_NE(document["difference"]["field"], "");
    EXPECT_NE(document["difference"]["left"], document["difference"]["right"]);
}

TEST(Diff, ReadsASnapshotWhateverItIsCalled) {
    const TemporaryFolder folder;
    const std::string plain = folder / "plain";
    const std::string named = folder / "snapshot-000000000005.snap";  // as a journal calls its own
    for (const std::string& path : {plain, named})
        documentOf({"run", "small:n=3", "--ticks", "5", "--snapshot", path});
    EXPECT_EQ(documentOf({"diff", plain, named})["equal"], true);
}

TEST(Run, ShowsItsResultEvenWhereTheSnapshotCannotBeWrittenInTheEnd) {
    const Ended ended = huestep({"run", "small:n=3", "--ticks", "5", "--snapshot", "/dev/full"});
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.out.find("hash         motion "), std::string::npos) << ended.out;
    EXPECT_NE(ended.err.find("/dev/full"), std::string::npos) << ended.err;
}

TEST(Run, PrintsHashesAsTheyCome) {
    // A run without an end that could be waited for, whose first hashes are there all the same.
    Process process(
        {huestepProgram, "run", "small:n=1", "--ticks", "1000000000", "--hash-every", "10"});
    EXPECT_TRUE(Process::until(
        60.0, [&] { return process.out().find("tick 20  motion ") != std::string::npos; }))
        << process.out() << process.err();
    process.send(SIGINT);
    EXPECT_EQ(process.wait(20.0), 130);
}

TEST(Diff, RefusesASnapshotWithAFlippedByteAndNamesTheOffset) {
    const TemporaryFolder folder;
    const std::string good = folder / "good.snap";
    const std::string bad = folder / "bad.snap";
    documentOf({"run", "small:n=20", "--ticks", "5", "--snapshot", good});
    std::string bytes = textOf(good);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    std::ofstream(bad, std::ios::binary) << bytes;
    const Ended ended = huestep({"diff", good, bad});
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.err.find(bad), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("byte"), std::string::npos) << ended.err;
}

TEST(Bench, PutsEnginesSideBySideWithHashesAndErrors) {
    const TemporaryFolder folder;
    const std::string csv = folder / "bench.csv";
    const Json document = documentOf({"bench", "small:n=10", "--ticks", "20", "--threads", "1,2",
                                      "--engine", "huestep,box2d", "--repeat", "2", "--csv", csv});
    for (const char* key : {"machine", "compiler", "commit"})
        EXPECT_NE(document[key].get<std::string>(), "") << key;
    ASSERT_EQ(document["results"].size(), 3u);  // Box2D has no threads
    EXPECT_EQ(document["results"][0]["hash"], document["results"][1]["hash"]);
    EXPECT_NE(document["results"][0]["hash"], document["results"][2]["hash"]);
    for (const Json& row : document["results"]) {
        const Json& ms = row["ms_per_tick"];
        EXPECT_LE(ms["min"], ms["q1"]);
        EXPECT_LE(ms["q1"], ms["median"]);
        EXPECT_LE(ms["median"], ms["q3"]);
        EXPECT_LE(ms["psm"], ms["median"]);
        EXPECT_GE(row["max_penetration_m"], 0.0);
        EXPECT_GE(row["max_joint_error_m"], 0.0);
        EXPECT_TRUE(row["accuracy"]["energy_drift"].is_number());
    }
    EXPECT_EQ(linesWith(textOf(csv), ""), 4);
}

TEST(Bench, SaysOnceWhatAnEngineLeavesOutAndWhetherEveryRepeatAgreed) {
    const std::vector<std::string> words = {"bench",    "mixed", "--ticks",   "5",
                                            "--repeat", "2",     "--threads", "1,2"};
    const Json document = documentOf(words);
    for (const Json& row : document["results"]) {
        EXPECT_EQ(row["same_hash"], true);
        EXPECT_EQ(row["notes"].empty(), row["engine"] == "huestep") << row;
    }
    // Of the scene's capsules Box2D has none, which `run` says as well.
    const Ended ended = huestep(words);
    EXPECT_EQ(linesWith(ended.err, "capsule"), 1) << ended.err;
}

TEST(Bench, MeasuresGoingBackAndTheBytesOfASnapshot) {
    const Json document = documentOf({"bench", "--rollback", "--repeat", "1"});
    ASSERT_EQ(document["results"].size(), 3u);
    for (const Json& row : document["results"]) {
        EXPECT_EQ(row["same_hash"], true);
        for (const char* key : {"checkpoint_us", "restore_us", "step_us", "rollback_8_ms",
                                "motion_root_ns_a_body", "full_root_ns_a_body"})
            EXPECT_GT(row[key].get<double>(), 0.0) << key;
        // The design's bounds: 64 bytes a body and 48 a contact, definitions apart.
        const double rest =
            row["snapshot_bytes"].get<double>() - row["definition_bytes"].get<double>();
        EXPECT_LE(rest, 64.0 * row["bodies"].get<double>() + 48.0 * row["contacts"].get<double>() +
                            1024.0);
    }
    EXPECT_NEAR(document["results"][1]["bodies"].get<double>(), 901.0, 1.0);
    EXPECT_LE(document["results"][1]["snapshot_bytes"].get<double>() -
                  document["results"][1]["definition_bytes"].get<double>(),
              220'000.0);
}

TEST(Bench, GrowsWorldsAndAgreesOnTheirHashes) {
    const Json document = documentOf({"bench", "--scale", "--quick", "--threads", "1,2"});
    std::map<std::string, std::string> hashes;
    for (const Json& row : document["results"]) {
        EXPECT_GT(row["ns_a_body_and_tick"].get<double>(), 0.0);
        const auto [at, fresh] = hashes.emplace(row["scene"], row["hash"]);
        EXPECT_EQ(at->second, row["hash"]) << row;
    }
    EXPECT_EQ(hashes.size(), 6u);
    EXPECT_EQ(document["results"].size(), 12u);
}

TEST(Run, ExplainsHowItsLastStepWasLaidOut) {
    const Ended ended = huestep({"run", "pyramid:base=34", "--ticks", "5", "--explain"});
    EXPECT_EQ(linesWith(ended.out, "all threads: "), 1) << ended.out;
    EXPECT_EQ(linesWith(ended.out, "kB of records"), 1) << ended.out;
    const Json small =
        documentOf({"run", "many_pyramids:rows=2,columns=4", "--ticks", "5", "--explain"});
    const Json& explained = small["explain"];
    EXPECT_EQ(explained["giants"], 0);
    ASSERT_EQ(explained["largest_islands"].size(), 5u) << "of eight";
    EXPECT_EQ(explained["largest_islands"][0]["bodies"], 55);
    EXPECT_GT(explained["bytes_touched"].get<double>(), 440 * 32.0);
    EXPECT_FALSE(documentOf({"run", "small:n=3", "--ticks", "2"}).contains("explain"));
}

/// A command that takes long is stopped as soon as it can be; what it says in the end.
Ended stopped(std::vector<std::string> words) {
    words.insert(words.begin(), huestepProgram);
    Process process(std::move(words));
    EXPECT_TRUE(process.catches(SIGINT, 20.0));
    process.send(SIGINT);
    const std::optional<int> status = process.wait(60.0);
    EXPECT_EQ(linesWith(process.err(), "huestep: stopped before the end, "), 1) << process.err();
    return {status.value_or(-1), process.out(), process.err()};
}

TEST(Interrupt, CtrlCEndsARunCleanlyWithWhatItHas) {
    const Ended ended = stopped({"run", "small", "--ticks", "1000000000", "--json"});
    EXPECT_EQ(ended.status, 130);
    const Json document = Json::parse(ended.out, nullptr, false);
    ASSERT_FALSE(document.is_discarded()) << ended.out;
    EXPECT_EQ(document["interrupted"], true);
    EXPECT_NE(document["hash"]["motion"], "");
}

TEST(Interrupt, CtrlCEndsAComparisonThatIsThenNeitherEqualNorDifferent) {
    for (const char* engine : {"huestep", "box2d"}) {
        const Ended ended = stopped({"verify", "pyramid:base=30", "--ticks", "1000000", "--engine",
                                     engine, "--reorder", "--json"});
        EXPECT_EQ(ended.status, 130) << engine;
        const Json document = Json::parse(ended.out, nullptr, false);
        ASSERT_FALSE(document.is_discarded()) << ended.out;
        EXPECT_EQ(document["finished"], false) << engine;
        EXPECT_TRUE(document["equal"].is_null()) << engine;
        ASSERT_GE(document["combinations"].size(), 4u);
        for (const Json& row : document["combinations"])
            EXPECT_TRUE(row["equal"].is_null()) << engine << row;
    }
}

TEST(Interrupt, WhatAComparisonDidNotBeginIsNotAmongItsRows) {
    const Ended ended = stopped(
        {"verify", "pyramid:base=30", "--ticks", "1000000", "--engine", "box2d", "--reorder"});
    EXPECT_EQ(ended.status, 130);
    EXPECT_EQ(linesWith(ended.out, "0 ticks, hash 0000000000000000"), 0) << ended.out;
    EXPECT_EQ(linesWith(ended.out, "created in order"), 0) << ended.out;
}

TEST(Interrupt, CtrlCEndsABenchmarkWithTheScenesThatItMeasured) {
    Process process({huestepProgram, "bench", "small:n=3", "pyramid:base=30", "--ticks", "100000",
                     "--repeat", "1", "--engine", "huestep", "--threads", "1", "--json"});
    ASSERT_TRUE(Process::until(60.0, [&] { return linesWith(process.err(), "small:n=3") > 0; }))
        << "it does not say that the first scene is done";
    process.send(SIGINT);
    EXPECT_EQ(process.wait(60.0), 130);
    EXPECT_EQ(linesWith(process.err(), "with 1 of 2 scenes measured"), 1) << process.err();
    const Json document = Json::parse(process.out(), nullptr, false);
    ASSERT_FALSE(document.is_discarded()) << process.out();
    EXPECT_EQ(document["finished"], false);
    ASSERT_EQ(document["results"].size(), 1u);
    EXPECT_EQ(document["results"][0]["scene"], "small:n=3");
}

}  // namespace
}  // namespace huestep::test
