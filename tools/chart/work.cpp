#include "tools/chart/work.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "tools/chart/pareto.h"
#include "tools/interrupt.h"

namespace huestep::tools::chart {
namespace {

double leastTime(const WorkPoint& point) {
    return spreadOf(point.run.cpu).min;
}

/// Below this share of the product's error two errors are taken as equal: it may be zero.
constexpr double leastRatio = 1e-6;

double ratio(double value, double standard) {
    if (!std::isfinite(value)) return std::numeric_limits<double>::infinity();
    if (standard <= 0.0) return value <= 0.0 ? 1.0 : std::numeric_limits<double>::infinity();
    return std::max(value / standard, leastRatio);
}

/// The upper of the two middle ones: no mean, for either may be infinite.
double medianOf(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

std::vector<std::string> workGroups() {
    return {"joint", "stack", "friction", "impact", "mixed"};
}

std::vector<std::uint32_t> workSubsteps(Extent extent) {
    if (extent == Extent::Smoke) return {1, 4};
    if (extent == Extent::Quick) return {1, 2, 4, 8, 16};
    return {1, 2, 4, 8, 16, 32, 64};
}

Verdict settled(Verdict verdict) {
    if (!std::isfinite(verdict.error) && verdict.failure.empty())
        verdict.failure = "no finite number came out";
    if (!verdict.failure.empty()) verdict.error = std::numeric_limits<double>::infinity();
    return verdict;
}

Result<bool> measureCase(const Case& of, std::span<const Contender> contenders, Extent extent,
                         std::vector<WorkPoint>& points) {
    const std::size_t first = points.size();
    for (const Contender& contender : contenders) {
        if (!of.applies(contender)) continue;
        WorkPoint point;
        point.of = &of;
        point.run.scene = of.scene;
        point.run.contender = contender;
        point.run.ticks = of.ticks;
        Result<Verdict> verdict = of.judge(contender);
        if (interrupted()) return false;
        if (!verdict)
            return Error{of.id + ", " + contender.name() + ": " + verdict.error().message};
        point.verdict = settled(std::move(*verdict));
        points.push_back(std::move(point));
    }
    std::vector<Run*> runs;
    std::vector<Cost> costs;
    for (std::size_t i = first; i < points.size(); ++i) runs.push_back(&points[i].run);
    const Result<bool> done = timeRepeatedly(runs, repeatsOf(extent));
    if (!done || !*done) return done;
    for (std::size_t i = first; i < points.size(); ++i)
        costs.push_back({points[i].verdict.error, leastTime(points[i])});
    const std::vector<bool> front = paretoFront(costs);
    for (std::size_t i = 0; i < front.size(); ++i) points[first + i].front = front[i];
    return true;
}

std::vector<Overall> overall(std::span<const WorkPoint> points) {
    struct Ratios {
        Contender contender;
        std::vector<double> errors;
        std::vector<double> times;
        std::size_t failures = 0;
    };
    std::map<const Case*, const WorkPoint*> products;
    for (const WorkPoint& point : points)
        if (point.run.contender.product()) products[point.of] = &point;
    std::map<std::pair<std::string, std::uint32_t>, Ratios> byContender;
    for (const WorkPoint& point : points) {
        const auto product = products.find(point.of);
        if (product == products.end()) continue;
        const Contender& c = point.run.contender;
        Ratios& ratios = byContender[{c.name(), c.substeps}];
        ratios.contender = c;
        ratios.errors.push_back(ratio(point.verdict.error, product->second->verdict.error));
        ratios.times.push_back(ratio(leastTime(point), leastTime(*product->second)));
        if (point.failed()) ++ratios.failures;
    }
    std::vector<Overall> rows;
    std::vector<Cost> costs;
    for (const auto& [key, r] : byContender) {
        rows.push_back({r.contender, medianOf(r.errors), medianOf(r.times), r.errors.size(),
                        r.failures, false});
        costs.push_back({rows.back().error, rows.back().time});
    }
    const std::vector<bool> front = paretoFront(costs);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].front = front[i];
    return rows;
}

Json asJson(const Case& of) {
    Json floors = Json::array();
    for (const Floor& floor : of.floors)
        floors.push_back({{"label", floor.label}, {"error", floor.error}});
    return {{"id", of.id},       {"class", of.group},       {"metric", of.metric},
            {"title", of.title}, {"what", of.what},         {"reference", of.reference},
            {"unit", of.unit},   {"scene", of.scene->name}, {"ticks", of.ticks},
            {"floors", floors}};
}

Json asJson(const WorkPoint& point) {
    Json json = {{"class", point.of->group},
                 {"case", point.of->id},
                 {"metric", point.of->metric},
                 {"unit", point.of->unit},
                 {"error", point.failed() ? Json() : Json(point.verdict.error)},
                 {"failure", point.verdict.failure},
                 {"front", point.front}};
    json.update(asJson(point.run));
    return json;
}

Json asJson(const Overall& row) {
    const auto orNull = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
    return {{"method", row.contender.name()},
            {"substeps", row.contender.substeps},
            {"standard", row.contender.standard()},
            {"error_ratio_median", orNull(row.error)},
            {"time_ratio_median", orNull(row.time)},
            {"cases", row.cases},
            {"failures", row.failures},
            {"front", row.front}};
}

}  // namespace huestep::tools::chart
