// What compilers were told.
#include <gtest/gtest.h>

#include "tests/command_output.h"
#include "tests/project/sources.h"

namespace huestep::test {
namespace {

const std::filesystem::path build = HUESTEP_BINARY_DIR;

TEST(Flags, EveryFileIsCompiledWithoutContractionOrReordering) {
    int commands = 0;
    for (const std::string& line : linesOf(textOf(build / "compile_commands.json"))) {
        if (line.find("\"command\":") == std::string::npos) continue;
        if (line.find(".cpp") == std::string::npos) continue;
        ++commands;
        EXPECT_NE(line.find("-ffp-contract=off"), std::string::npos) << line;
        for (const char* bad : {"-ffast-math", "-Ofast", "-march=", "-mfma", "-mfpmath=387",
                                "-funsafe-math-optimizations", "-ffp-contract=fast"})
            EXPECT_EQ(line.find(bad), std::string::npos) << bad << " in " << line;
    }
    EXPECT_GT(commands, 50);
}

/// The last of a command's words that begin with `begin`: the one that a compiler obeys.
std::string lastWord(const std::string& line, const std::string& begin) {
    std::istringstream words(line);
    std::string last;
    for (std::string word; words >> word;)
        if (word.starts_with(begin)) last = word;
    return last;
}

TEST(Flags, APresetsOwnFlagsReachTheCompiler) {
    const std::string cmake = "cmake --log-level=ERROR -DHUESTEP_TESTS=OFF -S '" + root.string();
    for (const auto& [preset, optimization] :
         {std::pair{"asan", "-O1"}, {"tsan", "-O1"}, {"debug", "-O0"}, {"release", "-O3"}}) {
        const TemporaryFolder folder;
        std::string said;
        const bool configured =
            forEachLineOf(cmake + "' -B '" + folder / preset + "' --preset " + preset + " 2>&1",
                          [&](const std::string& line) { said += line; });
        ASSERT_TRUE(configured) << preset << ": " << said;
        const std::string path = folder / (std::string(preset) + "/compile_commands.json");
        int commands = 0;
        for (const std::string& line : linesOf(textOf(path))) {
            if (line.find("\"command\":") == std::string::npos) continue;
            ++commands;
            EXPECT_EQ(lastWord(line, "-O"), optimization) << preset << ": " << line;
            if (std::string(optimization) == "-O3") continue;
            EXPECT_EQ(lastWord(line, "-g"), "-g1") << preset << ": " << line;
        }
        EXPECT_GT(commands, 50) << preset;
    }
}

}  // namespace
}  // namespace huestep::test
