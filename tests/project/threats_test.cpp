// docs/threats.md names a test for each attack: every one of them exists.
#include <gtest/gtest.h>

#include <set>

#include "tests/project/sources.h"

namespace huestep::test {
namespace {

/// The cells of a table's line, without blanks around them.
std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line.substr(1));
    for (std::string cell; std::getline(in, cell, '|');) {
        const std::size_t begin = cell.find_first_not_of(' ');
        const std::size_t end = cell.find_last_not_of(' ');
        cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end + 1 - begin));
    }
    return cells;
}

/// "Suite.Name" of every TEST in the sources of the tests.
std::set<std::string> allTests() {
    std::set<std::string> names;
    for (const Source& source : sourcesIn({"tests"})) {
        std::string text;
        for (const std::string& line : source.lines) text += line + " ";
        for (std::size_t at = text.find("TEST("); at != std::string::npos;
             at = text.find("TEST(", at + 1)) {
            const std::string inside = text.substr(at + 5, text.find(')', at) - at - 5);
            const std::size_t comma = inside.find(',');
            if (comma == std::string::npos) continue;
            const std::size_t name = inside.find_first_not_of(' ', comma + 1);
            names.insert(inside.substr(0, comma) + "." + inside.substr(name));
        }
    }
    return names;
}

TEST(Threats, EachHasATestThatExists) {
    const std::set<std::string> tests = allTests();
    ASSERT_TRUE(tests.contains("Threats.EachHasATestThatExists"));
    int rows = 0;
    for (const std::string& line : linesOf(textOf(root / "docs/threats.md"))) {
        if (!line.starts_with("| ") || line.starts_with("| attack ")) continue;
        ++rows;
        const std::vector<std::string> cells = cellsOf(line);
        ASSERT_EQ(cells.size(), 4u) << line;
        EXPECT_FALSE(cells[0].empty() || cells[2].empty()) << line;
        ASSERT_GT(cells[3].size(), 2u) << line;
        const std::string test = cells[3].substr(1, cells[3].size() - 2);
        EXPECT_TRUE(tests.contains(test)) << "there is no test " << test;
    }
    EXPECT_GT(rows, 30);
}

}  // namespace
}  // namespace huestep::test
