#include "tools/chart/document.h"

#include <chrono>
#include <cmath>
#include <ctime>

#include "core/solver/method.h"
#include "tools/chart/gain.h"
#include "tools/machine.h"

namespace huestep::tools::chart {
namespace {

/// Of the day's clock, in UTC: "2026-11-22 15:04 UTC".
std::string dateNow() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    char text[64];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &parts);
    return text;
}

std::string_view nameOf(Extent extent) {
    return extent == Extent::Full ? "full" : extent == Extent::Quick ? "quick" : "smoke";
}

Json methodsOf() {
    Json methods = Json::array();
    for (const MethodTraits& traits : allMethods())
        methods.push_back({{"name", traits.name},
                           {"summary", traits.summary},
                           {"product", traits.method == Method::SoftStep},
                           {"deterministic", traits.deterministic},
                           {"teams", traits.teams}});
    methods.push_back({{"name", "box2d"},
                       {"summary", "Box2D 2.4.1 as Debian ships it, 8 and 3 iterations"},
                       {"product", false},
                       {"deterministic", true},
                       {"teams", false}});
    return methods;
}

template <class Row>
Json listOf(const std::vector<Row>& rows) {
    Json list = Json::array();
    for (const Row& row : rows) list.push_back(asJson(row));
    return list;
}

Json waysOf(const std::vector<WaysRow>& rows) {
    Json list = Json::array();
    for (const WaysRow& row : rows) addRows(list, row);
    return list;
}

/// By how much a way must be faster to count: less is within what times differ by.
constexpr double worthWhile = 1.05;

/// From which size on threads pay, family by family.
Json crossingsOf(const std::vector<WaysRow>& sizes) {
    struct Question {
        const char* text;
        Way way;
        Way against;
    };
    constexpr Question questions[] = {
        {"a second thread pays", coloursAlways, colours},
        {"the product is faster for a second thread", coloursChosen, colours},
        {"colours in lanes beat key order", colours, keyOrder},
        {"colours on two threads beat key order", coloursAlways, keyOrder}};
    Json list = Json::array();
    std::vector<std::string> families;
    for (const WaysRow& row : sizes)
        if (families.empty() || families.back() != row.family) families.push_back(row.family);
    for (const std::string& family : families)
        for (const Question& question : questions) {
            std::vector<Gain> gains;
            for (const WaysRow& row : sizes)
                if (row.family == family)
                    gains.push_back({static_cast<double>(row.constraints()),
                                     row.ratio(question.against, question.way) / worthWhile});
            const std::optional<Crossing> from = paysFrom(gains);
            list.push_back(
                {{"family", family},
                 {"question", question.text},
                 {"from_constraints", from ? Json(std::round(from->constraints)) : Json()},
                 {"at_most", from && from->atMost},
                 {"least_measured", gains.front().constraints},
                 {"most_measured", gains.back().constraints}});
        }
    return list;
}

}  // namespace

Json documentOf(const Findings& f) {
    return {{"machine", machineName()},
            {"compiler", compilerName()},
            {"commit", commitName()},
            {"date", dateNow()},
            {"extent", nameOf(f.extent)},
            {"finished", f.finished},
            {"seconds", std::round(f.seconds)},
            {"repeats", repeatsOf(f.extent)},
            {"standard_substeps", standardSubsteps},
            {"methods", methodsOf()},
            {"cases", listOf(f.cases)},
            {"work_precision", listOf(f.points)},
            {"overall", listOf(overall(f.points))},
            {"stability", f.stability},
            {"crossings", crossingsOf(f.sizes)},
            {"sizes", waysOf(f.sizes)},
            {"scenes", waysOf(f.scenes)},
            {"prices", listOf(f.prices)},
            {"effort", listOf(f.effort)},
            {"effort_answers", listOf(answersOf(f.effort))}};
}

std::vector<std::string> tableNames() {
    return {"work_precision", "overall", "stability", "crossings",     "sizes",
            "scenes",         "prices",  "effort",    "effort_answers"};
}

}  // namespace huestep::tools::chart
