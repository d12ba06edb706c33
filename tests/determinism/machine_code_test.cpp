// What compilers made of the core, on every processor that it is built for.
#include <gtest/gtest.h>

#include <limits>
#include <regex>

#include "tests/command_output.h"

namespace huestep::test {
namespace {

const std::string library = HUESTEP_BINARY_DIR "/core/libhuestep_core.a";

TEST(MachineCode, OfTheCoreHoldsNoFusedMultiplyAdd) {
    // x86: vfmadd132ps and its kin; ARM: fmadd, fmsub, fnmadd, fmla, fmls and vfma.
    const std::regex fused(R"(\b(vfn?m(add|sub)\w*|fn?m(add|sub)|fml[as]|vfm[as])\b)");
    EXPECT_TRUE(std::regex_search("  c4 e2 vfmadd231ps %ymm1,%ymm2,%ymm3", fused));
    int instructions = 0;
    const bool ended =
        forEachLineOf(HUESTEP_OBJDUMP " -d --no-show-raw-insn '" + library + "' 2>/dev/null",
                      [&](const std::string& line) {
                          ++instructions;
                          EXPECT_FALSE(std::regex_search(line, fused)) << line;
                      });
    EXPECT_TRUE(ended) << "objdump failed on " << library;
    EXPECT_GT(instructions, 10'000) << "too few lines: was the library disassembled?";
}

TEST(MachineCode, OfTheCoreCallsNoLibraryForItsMathematics) {
    // Of libm, square roots and roundings are exact and the same everywhere; these are not.
    const std::regex inexact(
        R"( U (a?(sin|cos|tan)h?|sincos|atan2|exp(2|m1)?|log(2|10|1p)?|pow|hypot|cbrt|fmod)[fl]?\b)");
    EXPECT_TRUE(std::regex_search("                 U sincosf@GLIBC_2.2.5", inexact));
    EXPECT_TRUE(std::regex_search("                 U atan2f", inexact));
    EXPECT_FALSE(std::regex_search("                 U sqrtf", inexact));
    int needed = 0;
    const bool ended =
        forEachLineOf(HUESTEP_NM " -u '" + library + "' 2>/dev/null", [&](const std::string& line) {
            needed += line.find(" U ") != std::string::npos ? 1 : 0;
            EXPECT_FALSE(std::regex_search(line, inexact)) << line;
        });
    EXPECT_TRUE(ended) << "nm failed on " << library;
    EXPECT_GT(needed, 100) << "too few names: was the library read?";
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
