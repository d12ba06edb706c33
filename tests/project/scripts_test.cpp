// Scripts: they parse, they take only what they know, and the list of packages can be read.
#include <gtest/gtest.h>

#include <set>

#include "tests/project/sources.h"
#include "tests/tools/process.h"

namespace huestep::test {
namespace {

Ended run(std::vector<std::string> words) {
    Process process(std::move(words));
    const int status = process.wait(60.0).value_or(-1);
    return {status, process.out(), process.err()};
}

TEST(Scripts, AreProgramsThatParse) {
    for (const char* name : {"scripts/demo", "scripts/test", "scripts/install", ".ci/run"}) {
        const std::string path = (root / name).string();
        EXPECT_EQ(::access(path.c_str(), X_OK), 0) << name << " is not executable";
        EXPECT_EQ(run({"/bin/bash", "-n", path}).status, 0) << name;
    }
}

TEST(Scripts, RefuseWhatTheyDoNotKnow) {
    for (const char* name : {"scripts/demo", "scripts/test"}) {
        const Ended ended = run({(root / name).string(), "--nonsense"});
        EXPECT_EQ(ended.status, 2) << name;
        EXPECT_NE(ended.err.find("--nonsense"), std::string::npos) << ended.err;
    }
    for (const char* seconds : {"0", "soon", ""})
        EXPECT_EQ(run({(root / "scripts/demo").string(), "--seconds", seconds}).status, 2);
}

TEST(Packages, EveryLineNamesGroupPackageAndHowToSeeIt) {
    const std::set<std::string> groups = {"build", "test", "page", "lint"};
    const std::set<std::string> kinds = {"command", "pkgconfig", "header"};
    std::set<std::string> packages;
    for (const std::string& line : linesOf(textOf(root / "scripts/packages"))) {
        if (line.empty() || line.front() == '#') continue;
        std::istringstream in(line);
        std::string group, package, kind, name, rest;
        in >> group >> package >> kind >> name;
        EXPECT_TRUE(groups.contains(group)) << line;
        EXPECT_TRUE(kinds.contains(kind)) << line;
        EXPECT_FALSE(name.empty()) << line;
        EXPECT_FALSE(in >> rest) << line;
        EXPECT_TRUE(packages.insert(package).second) << package << " is listed twice";
    }
    EXPECT_GT(packages.size(), 10u);
}

}  // namespace
}  // namespace huestep::test
