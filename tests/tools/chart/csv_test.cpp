// A table written as CSV and read back by RFC 4180's grammar, not by the writer's code.
#include "tools/chart/csv.h"

#include <gtest/gtest.h>

#include "tests/tools/chart/csv_reader.h"

namespace huestep::tools::chart {
namespace {

TEST(Csv, ReadsBackAsTheRowsOfTheDocument) {
    const Json document = {
        {"commit", "abc1234-dirty"},
        {"machine", "Processor, of some kind x2"},
        {"compiler", "g++ \"12\""},
        {"date", "2026-11-22 15:04 UTC"},
        {"rows", Json::array({{{"scene", "chain:ratio=10,angle=90"}, {"time", 1.25}, {"n", 4}},
                              {{"scene", "two\nlines"}, {"time", nullptr}, {"why", "it \"fell\""}},
                              {{"scene", ""}, {"time", 1e-300}, {"good", true}}})}};
    const std::vector<std::vector<std::string>> table = test::csvRows(csvOf(document, "rows"));
    ASSERT_EQ(table.size(), 4u);
    const std::vector<std::string> head = {"commit", "machine", "compiler", "date", "scene",
                                           "time",   "n",       "why",      "good"};
    EXPECT_EQ(table[0], head);
    for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_EQ(table[i + 1].size(), head.size());
        for (std::size_t k = 0; k < head.size(); ++k) {
            const Json& row = document.at("rows").at(i);
            const Json& from = k < 4 ? document : row;
            const std::string& cell = table[i + 1][k];
            if (!from.contains(head[k]) || from.at(head[k]).is_null())
                EXPECT_EQ(cell, "");
            else if (from.at(head[k]).is_string())
                EXPECT_EQ(cell, from.at(head[k]).get<std::string>());
            else
                EXPECT_EQ(Json::parse(cell), from.at(head[k]));
        }
    }
}

TEST(Csv, OfNoRowsIsItsHeadAlone) {
    const Json document = {{"commit", "a"},
                           {"machine", "b"},
                           {"compiler", "c"},
                           {"date", "d"},
                           {"rows", Json::array()}};
    EXPECT_EQ(csvOf(document, "rows"), "commit,machine,compiler,date\n");
}

}  // namespace
}  // namespace huestep::tools::chart
