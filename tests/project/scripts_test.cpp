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
    for (const char* name :
         {"scripts/demo", "scripts/test", "scripts/install", "scripts/layout", ".ci/run"}) {
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
    const std::string demo = (root / "scripts/demo").string();
    for (const char* seconds : {"0", "00", "-1", "soon", ""}) {
        const Ended ended = run({demo, "--seconds", seconds});
        EXPECT_EQ(ended.status, 2) << seconds;
        EXPECT_NE(ended.err.find("--seconds"), std::string::npos) << ended.err;
    }
    // Digits are decimal, whatever stands in front of them: it goes on to the next option.
    const Ended ended = run({demo, "--seconds", "08", "--program", "/nowhere/huestep"});
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.err.find("/nowhere/huestep"), std::string::npos) << ended.err;
}

/// A folder with the script that looks at the layout, and one C++ file.
class Layout : public testing::Test {
 protected:
    Layout() {
        std::filesystem::create_directory(m_folder / "scripts");
        for (const char* name : {"scripts/layout", ".clang-format"})
            std::filesystem::copy_file(root / name, m_folder / name);
    }
    Ended git(std::vector<std::string> words) {
        words.insert(words.begin(), {"/usr/bin/env", "git", "-C", m_folder / "."});
        return run(std::move(words));
    }
    void write(const std::string& text) { std::ofstream(m_folder / "one.cpp") << text; }
    Ended look() { return run({m_folder / "scripts/layout"}); }

    TemporaryFolder m_folder;
};

TEST_F(Layout, IsFoundWrongInAFileThatGitKnows) {
    ASSERT_EQ(git({"init", "--quiet"}).status, 0);
    write("int  one( ) ;\n");
    ASSERT_EQ(git({"add", "one.cpp"}).status, 0);
    const Ended wrong = look();
    EXPECT_NE(wrong.status, 0);
    EXPECT_NE(wrong.out.find("one.cpp"), std::string::npos) << wrong.out << wrong.err;
    write("int one();\n");
    const Ended right = look();
    EXPECT_EQ(right.status, 0) << right.out << right.err;
}

TEST_F(Layout, IsNotFoundRightWhereNoFileWasSeen) {
    write("int one();\n");
    EXPECT_NE(look().status, 0) << "no repository";
    ASSERT_EQ(git({"init", "--quiet"}).status, 0);
    EXPECT_NE(look().status, 0) << "no file that git knows";
}

TEST(Packages, EveryLineNamesGroupPackageAndHowToSeeIt) {
    const std::set<std::string> groups = {"build", "test", "arm", "page", "lint"};
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
