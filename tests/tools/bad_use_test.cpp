// Bad use and bad input: status 2, nothing on standard output, and one sentence on standard error
// that says what and where.
#include <gtest/gtest.h>

#include "tests/tools/process.h"

namespace huestep::test {
namespace {

struct Misuse {
    std::vector<std::string> words;
    std::string mustSay;  // a part of the sentence
};

void PrintTo(const Misuse& misuse, std::ostream* out) {
    for (const std::string& word : misuse.words) *out << word << ' ';
}

class BadUse : public testing::TestWithParam<Misuse> {};

TEST_P(BadUse, IsAnsweredWithOneSentenceAndStatusTwo) {
    const Ended ended = huestep(GetParam().words);
    EXPECT_EQ(ended.status, 2);
    EXPECT_EQ(ended.out, "");
    EXPECT_NE(ended.err.find(GetParam().mustSay), std::string::npos) << ended.err;
    EXPECT_EQ(linesWith(ended.err, ""), 1) << ended.err;
    EXPECT_TRUE(ended.err.starts_with("huestep: ")) << ended.err;
}

INSTANTIATE_TEST_SUITE_P(
    CommandLine, BadUse,
    testing::Values(
        Misuse{{}, "subcommand"}, Misuse{{"fly"}, "'fly'; there are scenes, run, verify"},
        Misuse{{"verfy", "pyramid"}, "no subcommand 'verfy'; did you mean 'verify'?"},
        Misuse{{"run"}, "SCENE is required; see huestep run --help"},
        Misuse{{"run", "pyramid", "--tick", "3"}, "--tick 3; see huestep run --help"},
        Misuse{{"replay", "/tmp"}, "/tmp is no journal: it has no scene.bin"},
        Misuse{{"run", "pyramid", "--ticks", "many"}, "--ticks"},
        Misuse{{"run", "pyramid", "--ticks", "0"}, "--ticks"},
        Misuse{{"run", "pyramid", "--ticks", "-5"}, "--ticks"},
        Misuse{{"run", "pyramid", "--ticks", "0x10"}, "--ticks"},
        Misuse{{"run", "pyramid", "--ticks", "1e3"}, "--ticks"},
        Misuse{{"run", "pyramid", "--hash-every", "-1"}, "--hash-every"},
        Misuse{{"run", "pyramid", "--hash-every", "0"}, "--hash-every"},
        Misuse{{"run", "pyramid", "--ticks", "5", "--hash-every", "6"}, "--hash-every"},
        Misuse{{"run", "small", "--ticks", "1000000000", "--hash-every", "1", "--json"},
               "--hash-every"},
        Misuse{{"verify", "small", "--restore-every", "-1"}, "--restore-every"},
        Misuse{{"verify", "small", "--restore-every", "0"}, "--restore-every"},
        Misuse{{"verify", "small", "--ticks", "30", "--restore-every", "37"}, "nothing"},
        Misuse{{"verify", "small", "--ticks", "1000000000"}, "10000000"},
        Misuse{{"replay", "/nowhere/journal", "--from", "-1"}, "--from"},
        Misuse{{"replay", "/nowhere/journal", "--to", "0x10"}, "--to"},
        Misuse{{"bench", "small", "--repeat", "0x2"}, "--repeat"},
        Misuse{{"chart"}, "--out is required; see huestep chart --help"},
        Misuse{{"chart", "--out", "/dev/null/charts", "--smoke"},
               "--out: /dev/null/charts: cannot be made"},
        Misuse{{"bench", "--rollback", "--threads", "1"}, "--threads excludes --rollback"},
        Misuse{{"bench", "--rollback", "--engine", "huestep"}, "--engine excludes --rollback"},
        Misuse{{"bench", "--rollback", "--ticks", "3"}, "--ticks excludes --rollback"},
        Misuse{{"bench", "--scale", "--repeat", "3"}, "--repeat excludes --scale"},
        Misuse{{"accuracy", "A5", "--engine", "box2d", "--substeps", "4"},
               "--substeps: box2d takes 8 velocity and 3 position iterations"},
        Misuse{{"accuracy", "A5", "--engine", "box2d", "--method", "pgs"},
               "--method: box2d has its own"},
        Misuse{{"accuracy", "A5", "--substeps", "4,4"}, "--substeps: 4 is given twice"},
        Misuse{{"stability", "18", "--method", "box2d", "--substeps", "4", "--quick"},
               "--substeps: box2d takes 8 velocity and 3 position iterations"},
        Misuse{{"run", "small", "--engine", "box2d", "--method", "pgs"},
               "--method: box2d has its own"},
        Misuse{{"chart", "--out", "charts", "--quick", "--smoke"}, "--quick"},
        Misuse{{"stability", "3", "--quick"}, "row 3 has no scene for --quick; leave --quick out"},
        Misuse{{"stability", "dominoes", "joint_grid", "--quick"}, "'joint_grid' has no scene for"},
        Misuse{{"run", "pyramid", "--threads", "65"}, "--threads"},
        Misuse{{"run", "pyramid", "--simd", "mmx"}, "scalar"},
        Misuse{{"run", "pyramid", "--engine", "havok"}, "havok"},
        Misuse{{"run", "pyramid", "--method", "gauss"}, "no 'gauss'; there is soft-step, seq"},
        Misuse{{"verify", "pyramid", "--method", "gauss"}, "no 'gauss'; there is soft-step, seq"},
        Misuse{{"bench", "small", "--engine", "huestep:gauss"}, "no 'gauss'; there is soft-step"},
        Misuse{{"run", "pyramid", "--engine", "box2d", "--threads", "2"}, "box2d"},
        Misuse{{"run", "pyramid", "--engine", "box2d", "--snapshot", "x"}, "--snapshot"},
        Misuse{{"run", "pyramid:base=0"}, "base"}, Misuse{{"run", "pyramid:height=3"}, "height"},
        Misuse{{"run", "pyramids"}, "many_pyramids"},
        Misuse{{"run", "small:n=4", "--ticks", "1", "--snapshot", "/nowhere/x.snap"},
               "/nowhere/x.snap"},
        // Hours of work are not begun where their result could not be written.
        Misuse{{"run", "small", "--ticks", "1000000000", "--snapshot", "/nowhere/x.snap"},
               "/nowhere/x.snap"},
        Misuse{{"bench", "small", "--ticks", "1000000", "--repeat", "1000", "--csv", "/nowhere/x"},
               "/nowhere/x"},
        Misuse{{"run", "pyramid", "--engine", "box2d", "--substeps", "8"}, "--substeps"},
        Misuse{{"verify", "pyramid", "--engine", "box2d", "--jobs", "8"}, "--jobs"},
        Misuse{{"diff", "/", "/nowhere/journal"}, "/nowhere/journal: there is no such file"},
        Misuse{{"verify", "pyramid", "--threads", "1,,2"}, "--threads"},
        Misuse{{"verify", "pyramid", "--threads", "1,2,1"}, "twice"},
        Misuse{{"verify", "pyramid", "--simd", "scalar,scalar"}, "twice"},
        Misuse{{"verify", "pyramid", "--engine", "box2d", "--restore-every", "3"}, "box2d"},
        Misuse{{"verify", "/nowhere/journal"}, "nor a folder with a journal"},
        Misuse{{"replay", "/nowhere/journal"}, "/nowhere/journal"},
        Misuse{{"diff", "/nowhere/a", "/nowhere/b"}, "/nowhere/a"},
        Misuse{{"bench", "pyramid", "--engine", "huestep,havok"}, "havok"},
        Misuse{{"serve"}, "--session"}, Misuse{{"serve", "--session", "play"}, "NAME=SCENE"},
        Misuse{{"serve", "--session", "play=nothing"}, "nothing"},
        Misuse{{"serve", "--config", "/nowhere/x.toml"}, "/nowhere/x.toml: "},
        Misuse{{"serve", "--session", "play=small", "--input-delay", "61"}, "'61'"},
        Misuse{{"serve", "--session", "play=small", "--input-delay", "9-3"}, "'9-3'"},
        Misuse{{"join", "127.0.0.1:7777"}, "--session"},
        Misuse{{"join", "127.0.0.1:7777", "--session", "s", "--input-delay", "3"}, "--predict"},
        Misuse{{"join", "127.0.0.1:7777", "--session", "s", "--predict", "--guess", "tarot"},
               "tarot"},
        Misuse{{"join", "127.0.0.1:7777", "--session", "s", "--bot", "dance"}, "wander"},
        Misuse{{"join", "127.0.0.1:7777", "--session", "s", "--bot", "script:/nowhere/x"},
               "/nowhere/x"}));

TEST(BadInput, ASceneFileThatIsWrongIsRefusedWithItsPathInsideTheDocument) {
    const TemporaryFolder folder;
    const std::string path = folder / "wrong.json";
    std::ofstream(path) << R"({"version": 1, "bodies": [{"mass": 3}]})";
    const Ended ended = huestep({"run", path});
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.err.find(path), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("bodies[0].mass"), std::string::npos) << ended.err;
}

TEST(BadOutput, AFullDiskIsNoSuccess) {
    const std::vector<std::string> all = {
        "scenes",     "run small --ticks 3", "run small --ticks 3 --json", "accuracy A5", "--help",
        "run --help", "--version",           "stability dominoes --quick"};
    for (const std::string& words : all) {
        Process process({"/bin/sh", "-c", huestepProgram + " " + words + " >/dev/full"});
        EXPECT_EQ(process.wait(120.0), 2) << words;
        EXPECT_EQ(process.err(), "huestep: the output cannot be written\n") << words;
    }
}

TEST(BadInput, AnEmptyFolderIsNoJournal) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "empty");
    const Ended ended = huestep({"replay", folder / "empty"});
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.err.find("empty"), std::string::npos) << ended.err;
    EXPECT_TRUE(std::filesystem::is_empty(folder / "empty")) << "a reader must write nothing";
}

TEST(BadInput, AnInputDelayInAConfigFileIsRefusedWithItsLine) {
    const TemporaryFolder folder;
    const std::string path = folder / "serve.toml";
    for (const char* wrong : {"-1", "61", "\"4-2\"", "\"much\"", "true"}) {
        std::ofstream(path) << "open = true\ninput-delay = " << wrong << "\n";
        const Ended ended = huestep({"serve", "--config", path});
        EXPECT_EQ(ended.status, 2);
        EXPECT_NE(ended.err.find(path + ":2: "), std::string::npos) << ended.err;
        EXPECT_NE(ended.err.find("input-delay"), std::string::npos) << ended.err;
    }
}

TEST(BadInput, AConfigFileIsRefusedWithFileLineAndKey) {
    const TemporaryFolder folder;
    const std::string path = folder / "serve.toml";
    std::ofstream(path) << "open = true\nlissten = \"127.0.0.1:0\"\n";
    const Ended ended = huestep({"serve", "--config", path});
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.err.find(path + ":2: "), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("lissten"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace huestep::test
