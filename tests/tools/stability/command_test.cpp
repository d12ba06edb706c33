// `huestep stability` as a process: what it prints, what it saves, how it ends.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "tests/tools/document.h"

namespace huestep::test {
namespace {

/// A chain with a ball of 100,000 links, released horizontally, at one substep: it tears.
const std::vector<std::string> tearing = {"stability", "chain:ratio=100000,angle=90", "--substeps",
                                          "1", "--quick"};

TEST(Stability, PrintsOneDocumentWithARowAScene) {
    const Json document =
        documentOf({"stability", "17", "dominoes", "--method", "soft-step,box2d", "--quick"});
    EXPECT_EQ(document["finished"], true);
    std::set<std::pair<int, std::string>> seen;
    for (const Json& row : document["rows"]) {
        for (const char* key : {"row", "scene", "method", "pass", "value", "limit", "unit",
                                "frontier", "what", "why", "judged", "substeps"})
            EXPECT_TRUE(row.contains(key)) << key << row;
        EXPECT_EQ(row["pass"], true) << row;
        EXPECT_TRUE(row["value"].is_number());
        seen.emplace(row["row"].get<int>(), row["method"].get<std::string>());
        const std::string hashes = row["hashes"];
        EXPECT_EQ(hashes.find("equal on 2 threads") != std::string::npos,
                  row["method"] == "soft-step")
            << hashes;
    }
    EXPECT_EQ(seen, (std::set<std::pair<int, std::string>>{
                        {17, "soft-step"}, {17, "box2d"}, {23, "soft-step"}, {23, "box2d"}}));
    ASSERT_EQ(document["summary"].size(), 2u);
    EXPECT_EQ(document["summary"][0]["rows"], 2);
    EXPECT_EQ(document["summary"][0]["passed"], 2);
}

TEST(Stability, PrintsATableWithASummaryAndExitStatus1WhereARowFails) {
    const Ended good = huestep({"stability", "dominoes", "--quick"});
    EXPECT_EQ(good.status, 0) << good.out;
    EXPECT_EQ(linesWith(good.out, "soft-step, substeps as needed: 1 of 1 rows"), 1) << good.out;
    const Ended bad = huestep(tearing);
    EXPECT_EQ(bad.status, 1) << bad.out;
    EXPECT_EQ(linesWith(bad.out, "soft-step, n = 1: 0 of 1 rows"), 1) << bad.out;
    EXPECT_EQ(linesWith(bad.out, "largest joint error: "), 1) << "why: " << bad.out;
    EXPECT_EQ(linesWith(bad.out,
                        "huestep run chain:ratio=100000,angle=90,seed=1 --method "
                        "soft-step --substeps 1 --ticks 1200"),
              1)
        << bad.out;
}

TEST(Stability, FindsTheFewestSubstepsThatPass) {
    std::map<std::string, int> fewest;
    for (const int substeps : {32, 16, 8, 4, 2, 1}) {
        const Ended ended = huestep({"stability", "chain:ratio=100", "--no-frontier", "--json",
                                     "--substeps", std::to_string(substeps)});
        ASSERT_TRUE(ended.status == 0 || ended.status == 1) << ended.err;
        const Json document = Json::parse(ended.out, nullptr, false);
        ASSERT_FALSE(document.is_discarded()) << ended.out;
        for (const Json& row : document["rows"]) {
            EXPECT_TRUE(row["frontier"].is_null()) << row;
            if (row["pass"] == true) fewest[row["scene"]] = substeps;
        }
    }
    const Json document = documentOf({"stability", "chain:ratio=100", "--substeps", "32"});
    EXPECT_EQ(document["rows"].size(), 4u) << "hanging and swinging, upright and turned";
    for (const Json& row : document["rows"])
        EXPECT_EQ(row["frontier"], fewest[row["scene"]]) << row;
    const Json quick = documentOf({"stability", "dominoes", "--quick"});
    EXPECT_TRUE(quick["rows"][0]["frontier"].is_null()) << quick;
}

TEST(Stability, SavesAFailureThatCanBePlayedAgain) {
    const TemporaryFolder folder;
    std::vector<std::string> words = tearing;
    words.insert(words.end(), {"--save", folder / "failures"});
    const Json document = documentOf(words, 1);
    ASSERT_EQ(document["rows"].size(), 1u);
    const std::string saved = document["rows"][0]["saved_to"];
    const std::string command = document["rows"][0]["replay"];
    const std::string start = "huestep replay " + saved + " --from ";
    ASSERT_TRUE(command.starts_with(start)) << command;

    const Json whole = documentOf({"replay", saved});
    EXPECT_EQ(whole["mismatches"], 0);
    EXPECT_GT(whole["hashes_compared"], 0);
    const Json late = documentOf({"replay", saved, "--from", command.substr(start.size())});
    EXPECT_EQ(late["started_from"].get<std::string>().substr(0, 9), "snapshot-") << late;
    EXPECT_EQ(late["hash"], whole["hash"]);
    EXPECT_EQ(documentOf({"verify", saved, "--threads", "1,2"})["equal"], true);
    // The scene alone, as it was set up: the same motions as the journal's.
    const Json run = documentOf({"run", saved + "/scene.bin", "--ticks",
                                 std::to_string(whole["tick"].get<std::uint64_t>())});
    EXPECT_EQ(run["hash"], whole["hash"]);
}

TEST(Stability, SavesTheSceneOfAFailureOnAPeer) {
    const TemporaryFolder folder;
    const Json document = documentOf({"stability", "chain:ratio=100000,angle=90", "--method",
                                      "box2d", "--quick", "--save", folder / "failures"},
                                     1);
    const std::string saved = document["rows"][0]["saved_to"];
    EXPECT_EQ(document["rows"][0]["replay"],
              "huestep run " + saved + "/scene.bin --engine box2d --ticks 1200");
    EXPECT_EQ(huestep({"run", saved + "/scene.bin", "--engine", "box2d", "--ticks", "5"}).status,
              0);
}

TEST(Stability, RefusesWhatIsNoRowNoSceneNoMethodAndNoNewFolder) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "full/inside");
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
        {{"stability", "29"}, "there is no row 29; there are 1 to 28"},
        {{"stability", ""}, "no row has a scene ''"},
        {{"stability", "pyrmaid"}, "no row has a scene 'pyrmaid'"},
        {{"stability", "--method", "magic"}, "--method: there is no 'magic'; there is soft-step, "},
        {{"stability", "2", "--save", folder / "full"}, "is not an empty folder"}};
    for (const auto& [words, sentence] : wrong) {
        const Ended ended = huestep(words);
        EXPECT_EQ(ended.status, 2) << sentence;
        EXPECT_EQ(linesWith(ended.err, sentence), 1) << ended.err;
    }
}

TEST(Stability, EndsCleanlyOnCtrlCAndPrintsWhatThereIs) {
    Process process({huestepProgram, "stability", "2", "3", "--json"});
    ASSERT_TRUE(process.catches(SIGINT, 20.0));
    process.send(SIGINT);
    EXPECT_EQ(process.wait(60.0), 130);
    const Json document = Json::parse(process.out(), nullptr, false);
    ASSERT_FALSE(document.is_discarded()) << process.out();
    EXPECT_EQ(document["finished"], false);
}

/// What a machine runs on every submission: all that is quick, and all of it passes but for what
/// docs/stability.md says.
TEST(Stability, RunsItsQuickFormOverEveryRowThatHasOne) {
    const TemporaryFolder folder;
    Process process({huestepProgram, "stability", "--quick", "--json"});
    const std::optional<int> status = process.wait(200.0);
    ASSERT_TRUE(status == 0 || status == 1) << process.err();
    const Json document = Json::parse(process.out(), nullptr, false);
    ASSERT_FALSE(document.is_discarded());
    std::set<int> rows;
    for (const Json& row : document["rows"]) {
        rows.insert(row["row"].get<int>());
        EXPECT_EQ(row["why"].get<std::string>().find("hashes differ"), std::string::npos) << row;
    }
    for (const int row :
         {1, 2, 4, 5, 6, 7, 9, 10, 11, 12, 13, 16, 17, 18, 19, 20, 22, 23, 26, 27, 28})
        EXPECT_TRUE(rows.contains(row)) << row;
}

}  // namespace
}  // namespace huestep::test
