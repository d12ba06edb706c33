// docs/write_a_game.md holds a whole game: here it is compiled and run as the page says.
#include <gtest/gtest.h>

#include <map>

#include "tests/project/sources.h"
#include "tests/tools/process.h"

namespace huestep::test {
namespace {

const char* const page = "docs/write_a_game.md";

/// The code blocks of the page with the given word after the fence, one after another.
std::string blocksOf(const std::string& kind) {
    std::string text;
    bool inside = false;
    for (const std::string& line : linesOf(textOf(root / page))) {
        if (line.starts_with("```")) {
            inside = !inside && line == "```" + kind;
            continue;
        }
        if (inside) text += line + "\n";
    }
    return text;
}

/// The page's command with this build's compiler and library in place of a reader's.
std::vector<std::string> compileCommand(const TemporaryFolder& folder) {
    const std::string line = linesOf(blocksOf("sh")).front();
    const std::map<std::string, std::string> here = {
        {"c++", HUESTEP_CXX},
        {"potato.cpp", folder / "potato.cpp"},
        {"potato", folder / "potato"},
        {"-I.", "-I" + root.string()},
        {"build/release/core/libhuestep_core.a",
         std::string(HUESTEP_BINARY_DIR) + "/core/libhuestep_core.a"}};
    std::vector<std::string> words = {"/usr/bin/env"};
    std::istringstream in(line + " " + HUESTEP_SANITIZE_FLAG);
    for (std::string word; in >> word;) {
        const auto other = here.find(word);
        words.push_back(other == here.end() ? word : other->second);
    }
    return words;
}

TEST(GamePage, ItsProgramCompilesAsItSaysAndPrintsWhatItSays) {
    const std::string program = blocksOf("cpp");
    ASSERT_NE(program.find("class Potato final : public RulesOver<PotatoState>"),
              std::string::npos);
    const TemporaryFolder folder;
    std::ofstream(folder / "potato.cpp") << program;
    const std::vector<std::string> words = compileCommand(folder);
    EXPECT_NE(std::find(words.begin(), words.end(), "-ffp-contract=off"), words.end());
    Process compiler(words);
    EXPECT_EQ(compiler.wait(200.0).value_or(-1), 0) << compiler.err();
    Process game({folder / "potato"});
    EXPECT_EQ(game.wait(60.0).value_or(-1), 0) << game.err();
    EXPECT_EQ(game.out(), blocksOf("text"));
}

TEST(GamePage, ItsLinksAndItsGamesAreThere) {
    for (const char* path :
         {"core/games/building.cpp", "core/games/catalog.cpp", "core/rules/rules.h"}) {
        EXPECT_TRUE(std::filesystem::exists(root / path)) << path;
        EXPECT_NE(textOf(root / page).find(std::string("](../") + path), std::string::npos) << path;
    }
    const Ended scenes = huestep({"scenes"});
    for (const char* scene : {"ball", "building"}) {
        EXPECT_NE(("\n" + scenes.out).find("\n" + std::string(scene) + " "), std::string::npos);
        EXPECT_NE(textOf(root / page).find("=" + std::string(scene)), std::string::npos);
    }
}

}  // namespace
}  // namespace huestep::test
