// `huestep chart` as a user runs it: what it leaves in its folder.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <regex>

#include "tests/tools/chart/csv_reader.h"
#include "tests/tools/document.h"

namespace huestep::test {
namespace {

/// The smallest run there is: it takes seconds, so one test looks at all that it leaves.
struct Charts {
    TemporaryFolder folder;
    Json document = documentOf({"chart", "--out", folder / "charts", "--smoke"});
    [[nodiscard]] std::string file(const std::string& name) const {
        return textOf(folder / "charts" + ("/" + name));
    }
};

const std::vector<std::string> timed = {"work_precision", "sizes", "scenes", "prices", "effort"};

void givesEveryTimeTheHashOfTheStateItEndedIn(const Charts& charts) {
    for (const std::string& table : timed) {
        EXPECT_FALSE(charts.document.at(table).empty()) << table;
        for (const Json& row : charts.document.at(table)) {
            EXPECT_TRUE(
                std::regex_match(row.at("hash").get<std::string>(), std::regex("[0-9a-f]{16}")))
                << table << ": " << row;
            EXPECT_GT(row.at("cpu_us_min"), 0.0) << row;
            EXPECT_LE(row.at("cpu_us_min"), row.at("cpu_us_q1")) << row;
            EXPECT_LE(row.at("cpu_us_q1"), row.at("cpu_us_median")) << row;
            EXPECT_LE(row.at("cpu_us_median"), row.at("cpu_us_q3")) << row;
        }
    }
}

void itsHashesAreThoseOfTheSameRuns(const Charts& charts) {
    // A run of the product from its beginning, without sleep: pyramids never sleep.
    int compared = 0;
    for (const Json& row : charts.document.at("prices")) {
        if (row.at("method") != "soft-step") continue;
        const std::string scene = row.at("scene");
        const Json run = documentOf({"run", scene, "--ticks", row.at("ticks").dump(), "--method",
                                     "soft-step", "--substeps", row.at("substeps").dump()});
        EXPECT_EQ(row.at("hash"), run.at("hash").at("motion")) << row;
        ++compared;
    }
    EXPECT_GT(compared, 1) << "one and two threads";
}

void itsTablesReadBackAsTheRowsOfTheDocument(const Charts& charts) {
    for (const std::string& table : timed) {
        const auto rows = csvRows(charts.file(table + ".csv"));
        ASSERT_EQ(rows.size(), charts.document.at(table).size() + 1) << table;
        const auto& head = rows.front();
        for (std::size_t i = 1; i < rows.size(); ++i) {
            ASSERT_EQ(rows[i].size(), head.size()) << table;
            for (std::size_t k = 0; k < head.size(); ++k) {
                const Json& from = charts.document.contains(head[k])
                                       ? charts.document
                                       : charts.document.at(table).at(i - 1);
                const Json& value = from.at(head[k]);
                EXPECT_EQ(rows[i][k], value.is_string() ? value.get<std::string>()
                                      : value.is_null() ? ""
                                                        : value.dump())
                    << table << ", " << head[k];
            }
        }
    }
    EXPECT_EQ(Json::parse(charts.file("results.json")), charts.document);
}

void listsEveryPointThatFailedWithAReason(const Charts& charts) {
    for (const Json& row : charts.document.at("work_precision"))
        EXPECT_EQ(row.at("error").is_null(), row.at("failure") != "") << row;
    // Every contender meets every case, whatever became of it.
    const std::size_t cases = charts.document.at("cases").size();
    EXPECT_EQ(charts.document.at("work_precision").size() % cases, 0u);
    EXPECT_GT(charts.document.at("work_precision").size() / cases,
              charts.document.at("methods").size());
}

void putsEveryMethodToTheStabilitySuite(const Charts& charts) {
    for (const Json& method : charts.document.at("methods")) {
        int rows = 0;
        for (const Json& row : charts.document.at("stability")) {
            if (row.at("method") != method.at("name")) continue;
            ++rows;
            EXPECT_EQ(row.at("pass") == false, row.at("why") != "") << row;
            EXPECT_EQ(row.at("frontier").is_number(), method.at("name") != "box2d") << row;
        }
        EXPECT_GT(rows, 0) << method;
    }
    EXPECT_EQ(csvRows(charts.file("stability.csv")).size(),
              charts.document.at("stability").size() + 1);
}

void itsFrontHoldsWhatNoPointOfTheCaseBeats(const Charts& charts) {
    for (const Json& p : charts.document.at("work_precision")) {
        bool beaten = p.at("error").is_null();
        for (const Json& q : charts.document.at("work_precision")) {
            if (beaten || q.at("case") != p.at("case") || q.at("error").is_null()) continue;
            const double error = q.at("error").get<double>() - p.at("error").get<double>();
            const double time = q.at("cpu_us_min").get<double>() - p.at("cpu_us_min").get<double>();
            beaten = error <= 0.0 && time <= 0.0 && (error < 0.0 || time < 0.0);
        }
        EXPECT_EQ(p.at("front").get<bool>(), !beaten) << p;
    }
}

void writesOnePageThatAsksNobodyForAnything(const Charts& charts) {
    const std::string page = charts.file("index.html");
    EXPECT_TRUE(page.starts_with("<!doctype html>"));
    EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
    for (const char* way : {"src=\"http", "@import", "href=\"http", "url(http"})
        EXPECT_EQ(page.find(way), std::string::npos) << way;
    EXPECT_NE(page.find(charts.document.at("commit").get<std::string>()), std::string::npos);
}

void writesAPictureForEveryCase(const Charts& charts) {
    for (const Json& one : charts.document.at("cases")) {
        const std::string name = "work-" + one.at("class").get<std::string>() + "-" +
                                 one.at("id").get<std::string>() + ".svg";
        const std::string svg = charts.file(name);
        EXPECT_TRUE(svg.starts_with("<svg ")) << name;
        EXPECT_NE(svg.find("soft-step, planned (Huestep)"), std::string::npos) << name;
    }
    for (const char* name :
         {"overall.svg", "scenes.svg", "overflow.svg", "waiting.svg", "effort.svg"})
        EXPECT_TRUE(charts.file(name).starts_with("<svg ")) << name;
}

TEST(Chart, LeavesAPageTablesAndPicturesWithAHashForEveryTime) {
    const Charts charts;
    ASSERT_TRUE(charts.document.is_object());
    givesEveryTimeTheHashOfTheStateItEndedIn(charts);
    itsHashesAreThoseOfTheSameRuns(charts);
    itsTablesReadBackAsTheRowsOfTheDocument(charts);
    listsEveryPointThatFailedWithAReason(charts);
    putsEveryMethodToTheStabilitySuite(charts);
    itsFrontHoldsWhatNoPointOfTheCaseBeats(charts);
    writesOnePageThatAsksNobodyForAnything(charts);
    writesAPictureForEveryCase(charts);
}

TEST(Chart, ShowsTheVerdictsOfAFileInsteadOfRunningTheSuite) {
    const TemporaryFolder folder;
    const std::string path = folder / "verdicts.json";
    const Json rows = Json::parse(R"([{"row": 1, "name": "tall stack", "scene": "stack:n=10",
        "method": "soft-step", "pass": false, "judged": true, "value": null, "limit": 0.5,
        "unit": "m", "frontier": 0, "why": "it fell", "what": "farthest"}])");
    std::ofstream(path) << Json{{"rows", rows}};
    const Json document =
        documentOf({"chart", "--out", folder / "charts", "--smoke", "--stability", path});
    EXPECT_EQ(document.at("stability"), rows);
    EXPECT_NE(textOf(folder / "charts/stability.svg").find("tall stack"), std::string::npos);

    std::ofstream(path) << "{}";
    const Ended ended =
        huestep({"chart", "--out", folder / "charts", "--smoke", "--stability", path});
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.err.find(path + ": not what"), std::string::npos) << ended.err;
}

TEST(Chart, LeavesNoEmptyFolderWhereItIsStoppedBeforeAnythingWasWritten) {
    const TemporaryFolder folder;
    Process process({huestepProgram, "chart", "--out", folder / "charts", "--quick"});
    ASSERT_TRUE(process.catches(SIGINT, 20.0));
    process.send(SIGINT);
    EXPECT_EQ(process.wait(60.0), 130) << process.err();
    EXPECT_NE(process.err().find("nothing was written"), std::string::npos) << process.err();
    EXPECT_FALSE(std::filesystem::exists(folder / "charts"));
}

}  // namespace
}  // namespace huestep::test
