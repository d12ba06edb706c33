#include "tools/stability/report.h"

#include <cmath>
#include <cstdio>
#include <set>

#include "tools/stability/run.h"

namespace huestep::tools::stability {

namespace {

Json numberOrNull(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

std::string resultText(bool pass, bool judged) {
    return std::string(pass ? "pass" : "FAIL") + (judged ? "" : ", not judged");
}

/// How far the value is from its limit, of the limit.
std::string marginText(const StabilityVerdict& verdict) {
    if (verdict.limit == 0.0 || !std::isfinite(verdict.value)) return "-";
    return number(std::round(100.0 * (verdict.limit - verdict.value) / verdict.limit)) + "%";
}

std::string frontierText(int frontier) {
    if (frontier < 0) return "-";
    return frontier == 0 ? "none" : std::to_string(frontier);
}

std::vector<std::string> cellsOf(const StabilityVerdict& v) {
    return {"",
            "  " + v.scene,
            resultText(v.pass, v.judged),
            number(v.value),
            number(v.limit),
            unitText(v.unit),
            marginText(v),
            frontierText(v.frontier),
            v.what};
}

std::vector<StabilityVerdict> verdictsOf(const std::vector<StabilityVerdict>& all, int row) {
    std::vector<StabilityVerdict> found;
    for (const StabilityVerdict& verdict : all)
        if (verdict.row == row) found.push_back(verdict);
    return found;
}

/// Why each failure is one, and how to see it again. A scene that fails upright is not named once
/// more for failing turned, unless it was saved.
void printFailures(const std::vector<StabilityVerdict>& verdicts) {
    std::set<std::string> named;
    for (const StabilityVerdict& verdict : verdicts) {
        if (verdict.pass) continue;
        const std::string upright = verdict.scene.substr(0, verdict.scene.find(",turn="));
        const std::string key = std::to_string(verdict.row) + upright;
        if (!named.insert(key).second && verdict.savedTo.empty()) continue;
        std::printf("\nrow %d, %s: %s\n", verdict.row, verdict.scene.c_str(), verdict.why.c_str());
        if (!verdict.replay.empty()) std::printf("    %s\n", verdict.replay.c_str());
    }
}

bool anyJudged(const std::vector<StabilityVerdict>& verdicts) {
    for (const StabilityVerdict& verdict : verdicts)
        if (verdict.judged) return true;
    return false;
}

Json asJson(const StabilityVerdict& v, const StabilityConfiguration& configuration) {
    Json json = {{"row", v.row},
                 {"name", stabilityRowName(v.row)},
                 {"scene", v.scene},
                 {"engine", configuration.engine},
                 {"method", v.method},
                 {"substeps", configuration.substeps},
                 {"pass", v.pass},
                 {"judged", v.judged},
                 {"what", v.what},
                 {"value", numberOrNull(v.value)},
                 {"limit", v.limit},
                 {"unit", v.unit},
                 {"frontier", v.frontier < 0 ? Json() : Json(v.frontier)},
                 {"why", v.why},
                 {"hashes", v.hashes},
                 {"replay", v.replay}};
    if (!v.savedTo.empty()) json["saved_to"] = v.savedTo;
    return json;
}

}  // namespace

Json asJson(const std::vector<Configured>& all, bool finished) {
    Json rows = Json::array();
    Json summary = Json::array();
    for (const Configured& configured : all) {
        for (const StabilityVerdict& verdict : configured.result.verdicts)
            rows.push_back(asJson(verdict, configured.configuration));
        const Score score = scoreOf(configured.result.verdicts);
        summary.push_back({{"engine", configured.configuration.engine},
                           {"method", configured.configuration.method},
                           {"substeps", configured.configuration.substeps},
                           {"rows", score.judged},
                           {"passed", score.passed}});
    }
    return {{"rows", rows}, {"summary", summary}, {"finished", finished}};
}

Score scoreOf(const std::vector<StabilityVerdict>& verdicts) {
    Score score;
    for (int row = 1; row <= stabilityRows; ++row) {
        if (!anyJudged(verdictsOf(verdicts, row))) continue;
        ++score.judged;
        score.passed += rowPasses(verdicts, row) ? 1 : 0;
    }
    return score;
}

void print(const Configured& configured) {
    const std::vector<StabilityVerdict>& verdicts = configured.result.verdicts;
    if (verdicts.empty()) return;
    Table table({"row", "scene", "result", "value", "limit", "unit", "margin", "frontier", "what"});
    for (int row = 1; row <= stabilityRows; ++row) {
        const std::vector<StabilityVerdict> scenes = verdictsOf(verdicts, row);
        if (scenes.empty()) continue;
        const std::string result =
            anyJudged(scenes) ? resultText(rowPasses(verdicts, row), true) : "-";
        table.add({std::to_string(row), std::string(stabilityRowName(row)), result, "", "", "", "",
                   "", ""});
        for (const StabilityVerdict& verdict : scenes) table.add(cellsOf(verdict));
    }
    table.print();
    printFailures(verdicts);
    const Score score = scoreOf(verdicts);
    const std::uint32_t substeps = configured.configuration.substeps;
    std::string effort;
    if (isHuestep(configured.configuration))
        effort = substeps == 0 ? ", substeps as needed" : ", n = " + std::to_string(substeps);
    std::printf("\n%s%s: %d of %d rows\n", verdicts.front().method.c_str(), effort.c_str(),
                score.passed, score.judged);
}

}  // namespace huestep::tools::stability
