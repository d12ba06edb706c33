// README.md says only what is so: its commands exist, its map of folders matches the tree.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/project/sources.h"
#include "tests/tools/process.h"

namespace huestep::test {
namespace {

/// The lines of all code blocks with the given word after the fence.
std::vector<std::string> blocksOf(const std::string& file, const std::string& kind) {
    std::vector<std::string> lines;
    bool inside = false;
    for (const std::string& line : linesOf(textOf(root / file))) {
        if (line.starts_with("```")) {
            inside = !inside && line == "```" + kind;
            continue;
        }
        if (inside && !line.empty()) lines.push_back(line);
    }
    return lines;
}

std::vector<std::string> wordsOf(const std::string& line) {
    std::istringstream in(line.substr(0, line.find(" #")));
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

/// The help that a program of the project gives, with its exit status.
Ended helpOf(std::vector<std::string> words) {
    words.emplace_back("--help");
    Process process(std::move(words));
    const int status = process.wait(60.0).value_or(-1);
    return {status, process.out(), process.err()};
}

/// What git says of the repository, which may belong to another user.
Ended git(std::vector<std::string> words) {
    const std::vector<std::string> head = {"/usr/bin/env", "git", "-C",
                                           root.string(),  "-c",  "safe.directory=*"};
    words.insert(words.begin(), head.begin(), head.end());
    Process process(std::move(words));
    const int status = process.wait(60.0).value_or(-1);
    return {status, process.out(), process.err()};
}

class Document : public testing::TestWithParam<const char*> {};

TEST_P(Document, NamesOnlyCommandsAndOptionsThatExist) {
    const std::string program = "build/release/huestep";
    int commands = 0;
    for (const std::string& line : blocksOf(GetParam(), "sh")) {
        SCOPED_TRACE(line);
        const std::vector<std::string> words = wordsOf(line);
        ASSERT_FALSE(words.empty());
        if (words[0] == "git" || words[0] == "cd" || words[0] == "cmake" || words[0] == "ctest")
            continue;
        ++commands;
        const bool own = words[0] == program;
        const std::string path = own ? huestepProgram : (root / words[0]).string();
        ASSERT_TRUE(std::filesystem::exists(path)) << path;
        const Ended help = own && words.size() > 1 ? helpOf({path, words[1]}) : helpOf({path});
        EXPECT_EQ(help.status, 0) << help.err;
        for (const std::string& word : words) {
            if (!word.starts_with("--") || word == "--help") continue;
            EXPECT_NE(help.out.find(word), std::string::npos) << word << " is no option";
        }
    }
    EXPECT_GT(commands, 0);
}

INSTANTIATE_TEST_SUITE_P(Project, Document,
                         testing::Values("README.md", "CONTRIBUTING.md", "docs/tickets.md"));

TEST(Readme, EverySceneItsCommandsNameIsBuiltIn) {
    const Ended scenes = huestep({"scenes"});
    for (const std::string& line : blocksOf("README.md", "sh")) {
        const std::vector<std::string> words = wordsOf(line);
        if (words.size() < 3 || (words[1] != "run" && words[1] != "bench")) continue;
        if (std::filesystem::is_regular_file(root / words[2])) continue;  // a scene file
        if (words[2].starts_with("--")) continue;                         // its own scenes
        const std::string name = words[2].substr(0, words[2].find(':'));
        EXPECT_NE(("\n" + scenes.out).find("\n" + name + " "), std::string::npos) << line;
    }
}

TEST(Readme, MapsEveryFolderThatThereIsAndNoOther) {
    std::set<std::string> mapped;
    for (const std::string& line : blocksOf("README.md", "text"))
        if (const std::string path = wordsOf(line).front(); path.ends_with('/'))
            mapped.insert(path);
    ASSERT_FALSE(mapped.empty());
    for (const std::string& path : mapped)
        EXPECT_TRUE(std::filesystem::is_directory(root / path)) << path;

    // Folders at the top and those of the core; of the rest the map says what it likes.
    const std::vector<std::string> files = linesOf(git({"ls-files"}).out);
    ASSERT_GT(files.size(), 100u);
    std::set<std::string> there;
    for (const std::string& file : files)
        for (const std::string parent : {"", "core/"}) {
            if (!file.starts_with(parent)) continue;
            const std::size_t slash = file.find('/', parent.size());
            if (slash != std::string::npos) there.insert(file.substr(0, slash + 1));
        }
    ASSERT_GT(there.size(), 10u);
    for (const std::string& path : there)
        EXPECT_TRUE(mapped.contains(path)) << path << " is not on the map";
}

TEST(Readme, WhatItsCommandsLeaveBehindIsNotOfTheRepository) {
    // `serve` as it stands there keeps its journals in the folder of that name.
    for (const char* path :
         {"huestep-data/play/scene.bin", "charts/index.html", "build/release/huestep"})
        EXPECT_EQ(git({"check-ignore", "--quiet", path}).status, 0) << path;
    EXPECT_EQ(git({"check-ignore", "--quiet", "README.md"}).status, 1);
}

/// Replaces an option's value, or adds the option.
void setOption(std::vector<std::string>& words, const std::string& option,
               const std::string& value) {
    const auto at = std::find(words.begin(), words.end(), option);
    if (at == words.end())
        words.insert(words.end(), {option, value});
    else
        *(at + 1) = value;
}

TEST(Readme, ItsCommandsWithoutANetworkRun) {
    // As they stand there, but for fewer ticks.
    const std::map<std::string, std::string> ticks = {
        {"run", "3"}, {"verify", "40"}, {"bench", "2"}};
    std::set<std::string> ran;
    for (const std::string& line : blocksOf("README.md", "sh")) {
        std::vector<std::string> words = wordsOf(line);
        if (words[0] != "build/release/huestep") continue;
        words.erase(words.begin());
        if (words[0] != "scenes" && !ticks.contains(words[0])) continue;
        const auto has = [&](const char* option) {
            return std::find(words.begin(), words.end(), option) != words.end();
        };
        // These measure work of their own, of as many ticks as it takes.
        const bool own = has("--rollback") || has("--scale");
        if (words[0] != "scenes" && !own) setOption(words, "--ticks", ticks.at(words[0]));
        for (std::string& word : words)
            if (word.starts_with("docs/")) word = (root / word).string();
        if (words[0] == "bench" && !has("--scale")) setOption(words, "--repeat", "1");
        ran.insert(words[0]);
        const Ended ended = huestep(words);
        // Status 1 is a difference: Box2D's own, which that line is there to show.
        const bool peer = words[0] == "verify" && line.find("box2d") != std::string::npos;
        EXPECT_TRUE(ended.status == 0 || (peer && ended.status == 1)) << line << ended.err;
        EXPECT_NE(ended.out, "") << line;
    }
    EXPECT_EQ(ran.size(), 4u);
}

TEST(Readme, ItsExampleOfASceneFileIsASceneWhoseHashesAgree) {
    const Ended ended = huestep({"verify", (root / "docs/example_scene.json").string(), "--ticks",
                                 "60", "--threads", "1,2", "--reorder"});
    EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
}

TEST(Readme, ItsPicturesAndLinksLeadToFiles) {
    const std::string text = textOf(root / "README.md");
    int links = 0;
    for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
        const std::string target = text.substr(at + 2, text.find(')', at) - at - 2);
        if (target.starts_with("http") || target.starts_with('#')) continue;
        ++links;
        EXPECT_TRUE(std::filesystem::exists(root / target)) << target;
    }
    EXPECT_GT(links, 0);
}

}  // namespace
}  // namespace huestep::test
