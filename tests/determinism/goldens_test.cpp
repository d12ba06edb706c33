// Whole runs against hashes that are kept: any change of any bit of any tick shows here.
//
// Where results change on purpose, mint again and say why; the words end up in the file:
//   HUESTEP_MINT="why the results changed" build/release/bin/test_determinism
//     --gtest_filter='*Golden*'
// A missing golden is a failure, and so is one minted without saying why.
//
// HUESTEP_RUNS=brief runs as far as debug builds do, in few configurations: for processors that are
// emulated, 10 to 50 times slower. With -ffp-contract=fast, g++'s default, 17 of those 18 runs fail
// on aarch64.

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>

#include "tests/determinism/golden_runs.h"
#include "tests/determinism/together.h"

namespace huestep::test {

static void PrintTo(const GoldenRun& run, std::ostream* out) {
    *out << run.scene;
}

namespace {

std::string fileName() {
    return std::string(HUESTEP_SOURCE_DIR) + "/tests/determinism/goldens.txt";
}

struct Golden {
    std::string minted;                         ///< why it was minted last
    std::map<std::string, std::string> hashes;  ///< "tick 60" or "asleep" → values
};

/// Reads the file: `scene NAME`, then `guards …`, `minted …` and lines `KEY = VALUES`.
std::map<std::string, Golden> readGoldens() {
    std::map<std::string, Golden> all;
    std::ifstream file(fileName());
    std::string line, scene;
    while (std::getline(file, line)) {
        const auto rest = [&](const std::string& word) -> std::optional<std::string> {
            if (line.rfind(word, 0) != 0) return std::nullopt;
            return line.substr(word.size());
        };
        if (const auto name = rest("scene ")) {
            scene = *name;
        } else if (const auto why = rest("  minted: ")) {
            all[scene].minted = *why;
        } else if (const auto at = line.find(" = "); at != std::string::npos && line[0] == ' ') {
            all[scene].hashes[line.substr(2, at - 2)] = line.substr(at + 3);
        }
    }
    return all;
}

void writeGoldens(const std::map<std::string, Golden>& all) {
    std::ofstream file(fileName());
    file << "# Full root and motion root of whole runs, the same for every machine, compiler,\n"
            "# thread count and SIMD width. Read and written by goldens_test.cpp; to mint again:\n"
            "#   HUESTEP_MINT=\"why the results changed\" build/release/bin/test_determinism "
            "--gtest_filter='*Golden*'\n";
    for (const GoldenRun& run : goldenRuns()) {
        const auto golden = all.find(run.scene);
        if (golden == all.end()) continue;
        file << "\nscene " << run.scene << "\n  guards: " << run.guards
             << "\n  minted: " << golden->second.minted << "\n";
        for (const std::uint64_t tick : run.ticks) {
            const std::string key = "tick " + std::to_string(tick);
            const auto hash = golden->second.hashes.find(key);
            if (hash != golden->second.hashes.end())
                file << "  " << key << " = " << hash->second << "\n";
        }
        const auto asleep = golden->second.hashes.find("asleep from tick");
        if (asleep != golden->second.hashes.end()) {
            file << "  asleep from tick = " << asleep->second << "\n";
        }
    }
}

std::string rootsOf(const World& world) {
    char text[64];
    std::snprintf(text, sizeof text, "%016llx %016llx",
                  static_cast<unsigned long long>(world.fullRoot()),
                  static_cast<unsigned long long>(world.motionRoot()));
    return text;
}

/// Whether the text says why: in words, of which a sentence has a few.
bool saysWhy(const std::string& text) {
    return std::count(text.begin(), text.end(), ' ') >= 1 && text != "without words";
}

/// How much is done of each run.
struct Extent {
    bool whole;  ///< until the last tick
    std::vector<Configuration> configurations;
};

/// Nothing if HUESTEP_RUNS asks for what there is not.
std::optional<Extent> extentOfRuns(bool minting) {
#ifdef HUESTEP_WHOLE_RUNS
    const bool optimized = true;
#else
    const bool optimized = false;
#endif
    const char* const asked = std::getenv("HUESTEP_RUNS");
    if (asked == nullptr || minting) return Extent{optimized || minting, allConfigurations()};
    if (std::string_view(asked) != "brief") return std::nullopt;
    return Extent{false, fewConfigurations()};
}

class GoldenHashes : public testing::TestWithParam<GoldenRun> {};

TEST_P(GoldenHashes, AreThoseOfEveryConfiguration) {
    const GoldenRun& golden = GetParam();
    const char* mint = std::getenv("HUESTEP_MINT");
    ASSERT_TRUE(mint == nullptr || saysWhy(mint))
        << "HUESTEP_MINT='" << mint << "' does not say why the results changed";
    const std::optional<Extent> extent = extentOfRuns(mint != nullptr);
    ASSERT_TRUE(extent) << "HUESTEP_RUNS is 'brief' or not set";
    const std::uint64_t last = extent->whole ? golden.ticks.back() : golden.debugTicks;
    std::map<std::string, std::string> found;
    std::optional<std::uint64_t> asleep;
    const auto look = [&](const World& world) {
        const bool kept = std::count(golden.ticks.begin(), golden.ticks.end(), world.tick()) != 0;
        if (kept) found["tick " + std::to_string(world.tick())] = rootsOf(world);
        if (golden.watchSleep && !asleep && world.tick() > 0 && allAsleep(world)) {
            asleep = world.tick();
        }
    };
    runTogether(worldOf(golden.scene), last, golden.commandsOf, 1, look, extent->configurations);
    if (HasFatalFailure()) return;
    if (golden.watchSleep) {
        ASSERT_TRUE(asleep) << "nothing slept within " << last << " ticks";
        found["asleep from tick"] = std::to_string(*asleep);
    }
    std::map<std::string, Golden> all = readGoldens();
    if (mint != nullptr) {
        Golden& kept = all[golden.scene];
        if (kept.hashes != found) kept.minted = mint;
        kept.hashes = found;
        writeGoldens(all);
        return;
    }
    for (const auto& [key, hash] : found) {
        const auto& kept = all[golden.scene].hashes;
        ASSERT_TRUE(kept.contains(key))
            << fileName() << " has no \"" << key << "\" of " << golden.scene;
        EXPECT_EQ(hash, kept.at(key)) << golden.scene << ", " << key;
    }
}

std::string nameOfRun(const testing::TestParamInfo<GoldenRun>& info) {
    std::string name = info.param.scene;
    for (char& c : name) {
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(Runs, GoldenHashes, testing::ValuesIn(goldenRuns()), nameOfRun);

TEST(GoldenRuns, SayWhyTheyWereMintedLast) {
    const std::map<std::string, Golden> all = readGoldens();
    for (const GoldenRun& run : goldenRuns()) {
        ASSERT_TRUE(all.contains(run.scene)) << run.scene;
        EXPECT_TRUE(saysWhy(all.at(run.scene).minted)) << run.scene;
    }
    EXPECT_FALSE(saysWhy("1"));
    EXPECT_FALSE(saysWhy(""));
}

TEST(GoldenRuns, ReachThreadsBarriersAndBatches) {
    // If thresholds move, the scenes above have to grow with them, or they guard nothing.
    Executor executor(2);
    const auto reportAfter = [&](const std::string& scene) {
        World world = worldOf(scene);
        run(world, 2, {&executor, Simd::Auto, nullptr});
        return world.report();
    };
    const StepReport giant = reportAfter("pyramid:base=34");
    EXPECT_EQ(giant.batches, 1u);
    EXPECT_GT(giant.contacts, 1100u) << "one island above a batch";
    const StepReport many = reportAfter("many_pyramids:rows=5,columns=5,base=8");
    EXPECT_GT(many.batches, 1u);
    EXPECT_GT(many.islands, many.batches) << "several islands a batch";
    EXPECT_GT(reportAfter("joint_grid:n=30").joints, 1100u);
}

TEST(GoldenRuns, AreSolvedInOtherBatchesWhereAConfigurationSaysSo) {
    const auto layoutIn = [](std::uint32_t batchSize) {
        Configuration configuration{.name = "packed otherwise", .limits = {.batchSize = batchSize}};
        ConfiguredRun run(configuration, worldOf("many_pyramids:rows=5,columns=5,base=8"), 1);
        run.step({});
        return std::pair(run.world().report(), run.world().stepLayout());
    };
    const auto [alone, eachGiant] = layoutIn(0);
    EXPECT_EQ(alone.islands, 25u);
    EXPECT_EQ(alone.batches, alone.islands);
    EXPECT_EQ(eachGiant.giants, alone.islands);
    const auto [together, noGiant] = layoutIn(1'000'000);
    EXPECT_EQ(together.batches, 1u);
    EXPECT_EQ(noGiant.giants, 0u);
    EXPECT_EQ(together.islands, alone.islands);
}

}  // namespace
}  // namespace huestep::test
