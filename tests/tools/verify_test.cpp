// `huestep verify` as a process: what it finds equal, what it does not, and what it says of peers.
#include <map>
#include <set>

#include "core/solver/simd.h"
#include "tests/tools/document.h"

namespace huestep::test {
namespace {

/// The ten benchmark scenes in small: as large as it takes for threads, batches and giants, and as
/// long as it takes until their bodies meet.
struct Verified {
    std::string scene;
    std::string ticks;
};
void PrintTo(const Verified& verified, std::ostream* out) {
    *out << verified.scene;
}

class BenchmarkScene : public testing::TestWithParam<Verified> {};

TEST_P(BenchmarkScene, IsEqualOnAllThreadsAndWidthsRestoredReorderedAndAfterNoise) {
    const Json document =
        documentOf({"verify", GetParam().scene, "--ticks", GetParam().ticks, "--threads", "1,2,3,8",
                    "--simd", "all", "--restore-every", "37", "--reorder"});
    EXPECT_EQ(document["equal"], true) << document.value("difference", "");
    std::set<std::string> stories, widths, ways;
    for (const Json& row : document["combinations"]) {
        stories.insert(row["story"]);
        if (row["story"] != "as given") continue;
        widths.insert(row["simd"]);
        ways.insert(row["threads"].dump() + (row["restore_every"] == 37 ? " restored"
                                             : row["disturbed"] == true ? " disturbed"
                                                                        : ""));
    }
    EXPECT_EQ(stories.size(), 5u);
    EXPECT_EQ(widths.size(), availableSimd().size());
    EXPECT_EQ(ways.size(), 4u * 3u);
}

std::string nameOfVerified(const testing::TestParamInfo<Verified>& info) {
    return info.param.scene.substr(0, info.param.scene.find(':'));
}

INSTANTIATE_TEST_SUITE_P(
    Verify, BenchmarkScene,
    testing::Values(Verified{"joint_grid:n=24", "60"},
                    Verified{"many_pyramids:rows=4,columns=4,base=8", "50"},
                    Verified{"pyramid:base=34", "40"}, Verified{"smash:columns=28,rows=20", "100"},
                    Verified{"spinner:bodies=500", "80"}, Verified{"tumbler:count=23", "110"},
                    Verified{"washer:count=23", "60"},
                    Verified{"compounds:columns=8,rows=40", "90"},
                    Verified{"junkyard:columns=100,rows=6", "120"},
                    Verified{"rain:floors=2,columns=8,group=3,period=6", "110"}),
    nameOfVerified);

TEST(Verify, FindsASmallWorldEqualInEveryOrderAfterNoiseAndRestores) {
    const Json document = documentOf({"verify", "mixed", "--ticks", "90", "--threads", "1,2",
                                      "--restore-every", "7", "--reorder"});
    EXPECT_EQ(document["equal"], true) << document.value("difference", "");
    std::set<std::string> stories;
    for (const Json& row : document["combinations"]) {
        stories.insert(row["story"]);
        EXPECT_EQ(row["tick"], 90);
    }
    EXPECT_EQ(stories.size(), 5u);
}

TEST(Verify, FindsScriptedScenesEqualInEveryOrderAfterNoiseAndRestores) {
    for (const char* scene :
         {"rain:floors=1,columns=3,group=2,period=7", "junkyard:columns=20,rows=3"}) {
        const Json document =
            documentOf({"verify", scene, "--ticks", "130", "--threads", "1,3", "--simd", "scalar",
                        "--restore-every", "11", "--reorder"});
        EXPECT_EQ(document["equal"], true) << document.value("difference", "");
    }
}

TEST(Verify, GivesAPeerTheCommandsOfAScriptedScene) {
    const Json document = documentOf({"verify", "rain:floors=1,columns=2,group=1,period=5",
                                      "--engine", "box2d", "--ticks", "40"});
    EXPECT_EQ(document["equal"], true);
}

TEST(Verify, FindsEverySceneOfTheCatalogueEqualInEveryOrderAndAfterNoise) {
    // Large scenes in small: what is tried is their kinds of bodies and joints.
    const std::map<std::string, std::string> smaller = {
        {"compounds", "compounds:columns=3,rows=3"},
        {"joint_grid", "joint_grid:n=8"},
        {"junkyard", "junkyard:columns=3,rows=3"},
        {"many_pyramids", "many_pyramids:rows=2"},
        {"pyramid", "pyramid:base=8"},
        {"rain", "rain:floors=1,columns=2,group=1,period=3"},
        {"smash", "smash:columns=4,rows=4"},
        {"spinner", "spinner:bodies=20"},
        {"tumbler", "tumbler:count=3"},
        {"washer", "washer:count=5"}};
    const Json scenes = documentOf({"scenes"});
    ASSERT_GE(scenes["scenes"].size(), 8u);
    for (const Json& scene : scenes["scenes"]) {
        const std::string name = scene["name"];
        const auto small = smaller.find(name);
        const std::string text = small == smaller.end() ? name : small->second;
        std::vector<std::string> words = {"verify",    text, "--ticks", "12",
                                          "--threads", "2",  "--simd",  "scalar"};
        // Rules may know bodies by their ids, which noise changes: a sentence refuses that.
        if (scene["rules"] == "") words.emplace_back("--reorder");
        const Json document = documentOf(words);
        EXPECT_EQ(document["equal"], true) << text << ": " << document.value("difference", "");
    }
}

/// A scene file's name in the folder, with bodies at the given places and limits as given.
std::string sceneFile(const TemporaryFolder& folder, const Json& bodies, const Json& limits) {
    const std::string path = folder / "scene.json";
    std::ofstream(path) << Json{{"version", 1}, {"bodies", bodies}, {"limits", limits}};
    return path;
}

TEST(Verify, FindsRoomForNoiseBesideAWorldThatIsWideOrAtItsLimits) {
    const TemporaryFolder folder;
    const Json floor = {
        {"position", {{"x", 950000}, {"y", 0}}},
        {"shapes", Json::array({{{"kind", "segment"},
                                 {"vertices",
                                  Json::array({{{"x", -9000}, {"y", 0}}, {{"x", 9000}, {"y", 0}}})},
                                 {"radius", 0}}})}};
    const std::string path =
        sceneFile(folder, Json::array({floor}),
                  {{"bodies", 1000000}, {"shapes", 2000000}, {"joints", 1000000}});
    const Json document =
        documentOf({"verify", path, "--ticks", "10", "--threads", "1", "--reorder"});
    EXPECT_EQ(document["equal"], true) << document.value("difference", "");
}

TEST(Verify, GivesTheSameAnswerForAnyNumberOfJobs) {
    const std::vector<std::string> words = {"verify", "hinges:columns=2", "--ticks", "40",
                                            "--reorder"};
    std::vector<std::string> one = words;
    one.insert(one.end(), {"--jobs", "1"});
    std::vector<std::string> many = words;
    many.insert(many.end(), {"--jobs", "5"});
    EXPECT_EQ(documentOf(one), documentOf(many));
}

TEST(Verify, SaysWhereABox2dWorldDependsOnItsHistory) {
    const Json document = documentOf(
        {"verify", "pyramid:base=10", "--ticks", "120", "--engine", "box2d", "--reorder"}, 1);
    EXPECT_EQ(document["equal"], false);
    EXPECT_EQ(document["combinations"][0]["equal"], true) << "the same history, the same world";
    int different = 0;
    for (const Json& row : document["combinations"])
        if (!row["equal"]) {
            ++different;
            EXPECT_GE(row["differs_at"], 1);
            EXPECT_NE(row["difference"].get<std::string>().find("body "), std::string::npos);
        }
    EXPECT_GE(different, 1);
}

TEST(Verify, SaysWhatAPeerLeavesOutOfTheScene) {
    const std::vector<std::string> words = {"verify", "mixed", "--ticks", "2", "--engine", "box2d"};
    EXPECT_FALSE(documentOf(words)["notes"].empty());
    EXPECT_EQ(linesWith(huestep(words).err, "capsule"), 1);
}

}  // namespace
}  // namespace huestep::test
