#include <algorithm>
#include <cstdio>
#include <numeric>
#include <utility>

#include "tools/bench.h"
#include "tools/machine.h"
#include "tools/statistics.h"

namespace huestep::tools {
namespace {

/// Equal decimals down a column.
std::string fixed(double value, int decimals) {
    char digits[64];
    std::snprintf(digits, sizeof digits, "%.*f", decimals, value);
    return digits;
}

std::string power(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.2e", value);
    return digits;
}

/// Its time over that of Huestep with as many threads, if that was measured.
std::string ratioOf(const BenchResult& result, const std::vector<BenchResult>& all) {
    for (const BenchResult& other : all)
        if (other.engine == "huestep" && other.scene == result.scene &&
            other.threads == result.threads && other.psm() > 0.0)
            return fixed(result.psm() / other.psm(), 2);
    return "";
}

}  // namespace

double BenchResult::psm() const {
    if (leastByTick.empty()) return 0.0;
    const auto sum = std::accumulate(leastByTick.begin(), leastByTick.end(), std::uint64_t{0});
    return static_cast<double>(sum) * 1e-6 / static_cast<double>(leastByTick.size());
}

Json benchJson(const std::vector<BenchResult>& results, bool finished) {
    Json rows = Json::array();
    for (const BenchResult& r : results)
        rows.push_back({{"scene", r.scene},
                        {"engine", r.engine},
                        {"threads", r.threads},
                        {"ticks", r.ticks},
                        {"ms_per_tick",
                         {{"min", quantile(r.repeats, 0.0)},
                          {"q1", quantile(r.repeats, 0.25)},
                          {"median", quantile(r.repeats, 0.5)},
                          {"q3", quantile(r.repeats, 0.75)},
                          {"psm", r.psm()}}},
                        {"hash", hex(r.hash)},
                        {"same_hash", r.sameHash},
                        {"notes", r.notes},
                        {"max_penetration_m", r.errors.maxPenetration},
                        {"max_joint_error_m", r.errors.maxJointError},
                        {"accuracy", asJson(r.errors)}});
    return documentOf(std::move(rows), finished);
}

void printBench(const std::vector<BenchResult>& results) {
    std::printf("%s\n", originLine().c_str());
    Table table({"scene", "engine", "threads", "ticks", "psm, ms", "min", "q1", "median", "q3",
                 "ratio", "drift", "penetration, m", "joint error, m", "hash"});
    for (const BenchResult& r : results)
        table.add({r.scene, r.engine, std::to_string(r.threads), std::to_string(r.ticks),
                   fixed(r.psm(), 4), fixed(quantile(r.repeats, 0.0), 4),
                   fixed(quantile(r.repeats, 0.25), 4), fixed(quantile(r.repeats, 0.5), 4),
                   fixed(quantile(r.repeats, 0.75), 4), ratioOf(r, results),
                   r.errors.energyDrift ? power(*r.errors.energyDrift) : "-",
                   power(r.errors.maxPenetration), power(r.errors.maxJointError),
                   hex(r.hash) + (r.sameHash ? "" : " (not in every repeat)")});
    table.print();
    for (const BenchResult& r : results)
        for (const std::string& line : closedForms(r.errors))
            std::printf("%s, %s, %s\n", r.scene.c_str(), r.engine.c_str(), line.c_str());
}

std::string benchCsv(const std::vector<BenchResult>& results) {
    // A machine's name may hold a comma, so texts are quoted.
    const auto quoted = [](const std::string& text) { return '"' + text + '"'; };
    std::string csv =
        "commit,machine,compiler,threads,scene,engine,ticks,ms_per_step,min,q1,median,q3,hash,"
        "max_penetration_m,max_joint_error_m\n";
    for (const BenchResult& r : results) {
        csv += quoted(commitName()) + ',' + quoted(machineName()) + ',' + quoted(compilerName()) +
               ',' + std::to_string(r.threads) + ',' + quoted(r.scene) + ',' + r.engine + ',' +
               std::to_string(r.ticks) + ',' + number(r.psm());
        for (const double q : {0.0, 0.25, 0.5, 0.75}) csv += ',' + number(quantile(r.repeats, q));
        csv += ',' + hex(r.hash) + ',' + number(r.errors.maxPenetration) + ',' +
               number(r.errors.maxJointError) + '\n';
    }
    return csv;
}

}  // namespace huestep::tools
