// What compilers were told and what they made of it.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <limits>
#include <regex>

#include "tests/project/sources.h"

namespace huestep::test {
namespace {

const std::filesystem::path build = HUESTEP_BINARY_DIR;

/// Calls `f(line)` for every line of a command's output; says whether the command ended with 0.
template <class F>
bool forEachLineOf(const std::string& command, F f) {
    std::FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) return false;
    std::array<char, 4096> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr)
        f(std::string(line.data()));
    return ::pclose(pipe) == 0;
}

TEST(MachineCode, OfTheCoreHoldsNoFusedMultiplyAdd) {
    const std::string library = (build / "core" / "libhuestep_core.a").string();
    // x86: vfmadd132ps and its kin; ARM: fmadd, fmsub, fnmadd, fmla, fmls and vfma.
    const std::regex fused(R"(\b(vfn?m(add|sub)\w*|fn?m(add|sub)|fml[as]|vfm[as])\b)");
    EXPECT_TRUE(std::regex_search("  c4 e2 vfmadd231ps %ymm1,%ymm2,%ymm3", fused));
    int instructions = 0;
    const bool ended = forEachLineOf("objdump -d --no-show-raw-insn '" + library + "' 2>/dev/null",
                                     [&](const std::string& line) {
                                         ++instructions;
                                         EXPECT_FALSE(std::regex_search(line, fused)) << line;
                                     });
    EXPECT_TRUE(ended) << "objdump failed on " << library;
    EXPECT_GT(instructions, 10'000) << "too few lines: was the library disassembled?";
}

TEST(MachineCode, OfTheCoreCallsNoLibraryForItsMathematics) {
    const std::string library = (build / "core" / "libhuestep_core.a").string();
    // Of libm, square roots and roundings are exact and the same everywhere; these are not.
    const std::regex inexact(
        R"( U (a?(sin|cos|tan)h?|sincos|atan2|exp(2|m1)?|log(2|10|1p)?|pow|hypot|cbrt|fmod)[fl]?\b)");
    EXPECT_TRUE(std::regex_search("                 U sincosf@GLIBC_2.2.5", inexact));
    EXPECT_TRUE(std::regex_search("                 U atan2f", inexact));
    EXPECT_FALSE(std::regex_search("                 U sqrtf", inexact));
    int needed = 0;
    const bool ended =
        forEachLineOf("nm -u '" + library + "' 2>/dev/null", [&](const std::string& line) {
            needed += line.find(" U ") != std::string::npos ? 1 : 0;
            EXPECT_FALSE(std::regex_search(line, inexact)) << line;
        });
    EXPECT_TRUE(ended) << "nm failed on " << library;
    EXPECT_GT(needed, 100) << "too few names: was the library read?";
}

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

TEST(Floats, DenormalsAreOnAtStart) {
    volatile float smallest = std::numeric_limits<float>::min();
    volatile float half = 0.5f;
    volatile float denormal = smallest * half;
    EXPECT_GT(denormal, 0.0f);
    volatile float again = denormal + denormal;
    EXPECT_EQ(again, smallest);
}

}  // namespace
}  // namespace huestep::test
