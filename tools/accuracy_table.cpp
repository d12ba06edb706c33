/// `huestep accuracy`: the metrics A1 to A20 of the physics page, a row a case.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "core/solver/effort.h"
#include "core/solver/method.h"
#include "tools/command.h"
#include "tools/engines.h"
#include "tools/interrupt.h"
#include "tools/lists.h"
#include "tools/metrics/metric.h"
#include "tools/progress.h"
#include "tools/text.h"

namespace huestep::tools {
namespace {

struct Options {
    std::vector<std::string> cases;  // none: all
    std::string engine = "huestep";
    std::string method;    // empty: soft-step
    std::string substeps;  // empty: auto
    bool list = false;
    bool json = false;
};

/// A setting and what stands over its column.
struct Column {
    std::string head;
    Setting setting;
};

/// A case with what came out in each column; none: the case says nothing of the setting.
struct Row {
    const MetricCase* metric = nullptr;
    std::vector<std::optional<double>> errors;
};

Result<std::vector<std::uint32_t>> parseSubsteps(const std::string& text) {
    std::vector<std::uint32_t> all;
    for (const std::string& piece : splitAtCommas(text)) {
        if (piece == "auto") {
            all.push_back(0);
            continue;
        }
        const bool digits = !piece.empty() && piece.size() <= 2 &&
                            piece.find_first_not_of("0123456789") == std::string::npos;
        const int n = digits ? std::stoi(piece) : 0;
        if (n < 1 || n > 64)
            return Error{"--substeps: '" + piece +
                         "' is neither auto nor a whole number from 1 to 64"};
        all.push_back(static_cast<std::uint32_t>(n));
        if (std::count(all.begin(), all.end(), all.back()) > 1)
            return Error{"--substeps: " + piece + " is given twice"};
    }
    return all;
}

/// What a method does that is not told how much: the product plans it, all others take the
/// standard.
std::string headOfAuto(Method method) {
    if (method == Method::SoftStep) return "planned";
    return "as it comes (" + std::to_string(huestep::substepsOf(standardEffort)) + ")";
}

Result<std::vector<Column>> columnsOf(const Options& o) {
    if (const Status known = checkEngine(o.engine, benchEngineNames()); !known)
        return known.error();
    const Status own = checkOwnWay(o.engine, !o.method.empty(), !o.substeps.empty());
    if (!own) return own.error();
    const auto make = [engine = o.engine](const Scene& scene) { return makeEngine(engine, scene); };
    if (o.engine != "huestep") return std::vector<Column>{{o.engine, {make, std::nullopt, 0}}};
    const Result<Method> method = parseMethod(o.method.empty() ? "soft-step" : o.method);
    if (!method) return method.error();
    const Result<std::vector<std::uint32_t>> substeps =
        parseSubsteps(o.substeps.empty() ? "auto" : o.substeps);
    if (!substeps) return substeps.error();
    std::vector<Column> columns;
    for (const std::uint32_t n : *substeps)
        columns.push_back(
            {n == 0 ? headOfAuto(*method) : "n = " + std::to_string(n), {make, *method, n}});
    return columns;
}

/// Those named, by case or by metric; all if none is.
Result<std::vector<const MetricCase*>> chosenCases(const std::vector<std::string>& names) {
    std::vector<const MetricCase*> chosen;
    const auto isCalled = [](const MetricCase& metric, const std::string& name) {
        return lowerCase(name) == lowerCase(metric.name) ||
               lowerCase(name) == lowerCase(metric.metric);
    };
    for (const MetricCase& metric : metricCases())
        if (names.empty() || std::any_of(names.begin(), names.end(), [&](const std::string& name) {
                return isCalled(metric, name);
            }))
            chosen.push_back(&metric);
    for (const std::string& name : names) {
        const bool known = std::any_of(chosen.begin(), chosen.end(),
                                       [&](const MetricCase* c) { return isCalled(*c, name); });
        if (!known)
            return Error{"there is no case '" + name +
                         "'; --list shows them, and A1 to A20 or R take all of a metric"};
    }
    return chosen;
}

Answer showList(const std::vector<const MetricCase*>& cases, bool json) {
    Table table({"metric", "case", "class", "unit", "against", "what"});
    Json list = Json::array();
    for (const MetricCase* c : cases) {
        table.add({std::string(c->metric), c->name, std::string(nameOf(c->kind)), unitText(c->unit),
                   std::string(c->reference), c->what});
        list.push_back({{"metric", c->metric},
                        {"case", c->name},
                        {"class", nameOf(c->kind)},
                        {"unit", c->unit},
                        {"reference", c->reference},
                        {"ticks", c->ticks},
                        {"what", c->what}});
    }
    if (json)
        print(Json{{"cases", list}});
    else
        table.print();
    return Exit::Done;
}

std::string cell(const std::optional<double>& error) {
    if (!error) return "-";
    return std::isfinite(*error) ? number(*error) : "failed";
}

/// A number, "auto", or null of an engine that takes none.
Json substepsOf(const Setting& setting) {
    if (!setting.method) return {};
    return setting.substeps != 0 ? Json(setting.substeps) : Json("auto");
}

void printJson(const Options& o, const std::vector<Column>& columns, const std::vector<Row>& rows) {
    Json results = Json::array();
    for (const Row& row : rows)
        for (std::size_t i = 0; i < row.errors.size(); ++i) {
            if (!row.errors[i]) continue;
            const Setting& setting = columns[i].setting;
            const double error = *row.errors[i];
            results.push_back(
                {{"metric", row.metric->metric},
                 {"case", row.metric->name},
                 {"engine", o.engine},
                 {"method", setting.method ? Json(traitsOf(*setting.method).name) : Json()},
                 {"substeps", substepsOf(setting)},
                 {"error", std::isfinite(error) ? Json(error) : Json()},
                 {"unit", row.metric->unit},
                 {"reference", row.metric->reference}});
        }
    print(Json{{"results", results}});
}

void printTable(const std::vector<Column>& columns, const std::vector<Row>& rows) {
    std::vector<std::string> head{"metric", "case"};
    for (const Column& column : columns) head.push_back(column.head);
    head.insert(head.end(), {"unit", "against"});
    Table table(head);
    for (const Row& row : rows) {
        std::vector<std::string> cells{std::string(row.metric->metric), row.metric->name};
        for (const std::optional<double>& error : row.errors) cells.push_back(cell(error));
        cells.insert(cells.end(), {unitText(row.metric->unit), std::string(row.metric->reference)});
        table.add(cells);
    }
    table.print();
    // Orders say nothing of a single effort, and nothing of any that cannot be doubled.
    const auto isOrder = [](const Row& row) { return row.metric->unit == "order"; };
    const auto silent = [&](const Row& row) {
        return isOrder(row) && std::none_of(row.errors.begin(), row.errors.end(),
                                            [](const auto& error) { return error.has_value(); });
    };
    if (std::any_of(rows.begin(), rows.end(), silent))
        std::printf("orders need --substeps, as in 1,2,4, of 32 at most\n");
}

Answer accuracy(const Options& o) {
    const Result<std::vector<const MetricCase*>> cases = chosenCases(o.cases);
    if (!cases) return cases.error();
    if (o.list) return showList(*cases, o.json);
    const Result<std::vector<Column>> columns = columnsOf(o);
    if (!columns) return columns.error();
    std::vector<Row> rows;
    Progress progress("measuring", cases->size() * columns->size());
    for (const MetricCase* metric : *cases) {
        if (interrupted()) break;
        Row row{metric, {}};
        for (const Column& column : *columns) {
            progress.advance();
            row.errors.emplace_back();
            if (!appliesTo(*metric, column.setting)) continue;
            const Result<double> error = errorOf(*metric, column.setting);
            if (!error) return Error{metric->name + ": " + error.error().message};
            row.errors.back() = *error;
        }
        rows.push_back(std::move(row));
    }
    progress.clear();
    if (o.json)
        printJson(o, *columns, rows);
    else
        printTable(*columns, rows);
    if (rows.size() == cases->size()) return Exit::Done;
    return stopped("after " + std::to_string(rows.size()) + " of " + std::to_string(cases->size()) +
                   " cases");
}

}  // namespace

void addAccuracy(Menu& menu) {
    const auto o = std::make_shared<Options>();
    CLI::App* sub =
        menu.add("accuracy", "Says how far runs are from closed forms and references.",
                 "huestep accuracy A5 ramp-slide --substeps 1,2,4,8", [o] { return accuracy(*o); });
    sub->add_option("CASE", o->cases, "Cases by name, or metrics, as in A5 (default: all)");
    sub->add_option("--engine", o->engine, "Who steps them (default: huestep)");
    sub->add_option("--method", o->method, "How huestep solves (default: soft-step)");
    sub->add_option("--substeps", o->substeps, "One column each, as in auto,1,2,4 (default: auto)");
    sub->add_flag("--list", o->list, "Only list the cases: what, unit, reference");
    sub->add_flag("--json", o->json, "Print one JSON document");
}

}  // namespace huestep::tools
