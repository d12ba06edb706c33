// The dependency rules of the design, read off the #include lines.
#include <gtest/gtest.h>

#include <map>

#include "tests/project/sources.h"

namespace huestep::test {
namespace {

const std::vector<std::string> folders = {"core", "protocol", "server", "client", "tools"};

/// The folder at the head of a path, or the path itself.
std::string headOf(const std::string& path) {
    return path.substr(0, path.find('/'));
}

/// Calls `f(source, line number, included)` for every include of the sources.
template <class F>
void forEachInclude(const std::vector<Source>& sources, F f) {
    for (const Source& source : sources)
        for (std::size_t i = 0; i < source.lines.size(); ++i)
            if (const std::string included = includedBy(source.lines[i]); !included.empty())
                f(source, i + 1, included);
}

std::string place(const Source& source, std::size_t line) {
    return source.path + ":" + std::to_string(line);
}

TEST(Dependencies, PointOneWay) {
    const std::map<std::string, std::vector<std::string>> allowed = {
        {"core", {"core"}},
        {"protocol", {"protocol", "core"}},
        {"server", {"server", "protocol", "core"}},
        {"client", {"client", "protocol", "core"}},
        {"tools", {"tools", "server", "client", "protocol", "core"}}};
    int seen = 0;
    forEachInclude(sourcesIn(folders),
                   [&](const Source& source, std::size_t line, const std::string& included) {
                       const std::string target = headOf(included);
                       if (included == target || !allowed.contains(target)) return;
                       ++seen;
                       const std::vector<std::string>& may = allowed.at(headOf(source.path));
                       EXPECT_NE(std::find(may.begin(), may.end(), target), may.end())
                           << place(source, line) << " includes " << included;
                   });
    EXPECT_GT(seen, 100) << "the includes were not found";
}

TEST(Dependencies, ThirdPartyHeadersStandOnlyInTheFoldersThatOwnThem) {
    struct Owner {
        std::string header;                // how the included path begins
        std::vector<std::string> folders;  // how the including path may begin
    };
    const std::vector<Owner> owners = {{"box2d/", {"core/box2d/", "tests/oracle/"}},
                                       {"xxhash", {"core/state/"}},
                                       {"capnp/", {"protocol/"}},
                                       {"kj/", {"protocol/"}},
                                       {"protocol/messages.capnp.h", {"protocol/"}},
                                       {"protocol/scene.capnp.h", {"protocol/"}},
                                       {"uv.h",
                                        {"server/host.", "server/listening.", "server/sockets.",
                                         "server/web_", "client/connection.", "client/player."}},
                                       {"libwebsockets", {"server/web_"}},
                                       {"sodium", {"protocol/keys."}},
                                       {"openssl/", {"protocol/tls.", "tests/"}},
                                       {"spdlog/", {"server/log.", "tools/"}},
                                       {"CLI/", {"tools/"}},
                                       {"toml++/", {"tools/"}},
                                       {"duktape.h", {"tools/chart/"}},
                                       {"nlohmann/", {"protocol/", "tools/", "tests/"}},
                                       {"gtest/", {"tests/"}}};
    std::vector<std::string> all = folders;
    all.push_back("tests");
    std::map<std::string, int> seen;
    forEachInclude(
        sourcesIn(all), [&](const Source& source, std::size_t line, const std::string& included) {
            for (const Owner& owner : owners) {
                if (!included.starts_with(owner.header)) continue;
                ++seen[owner.header];
                const bool owned = std::any_of(
                    owner.folders.begin(), owner.folders.end(),
                    [&](const std::string& folder) { return source.path.starts_with(folder); });
                EXPECT_TRUE(owned) << place(source, line) << " includes " << included;
            }
        });
    for (const char* header : {"box2d/", "xxhash", "uv.h", "CLI/", "gtest/"})
        EXPECT_GT(seen[header], 0) << header << " was not found anywhere";
}

TEST(Dependencies, TheCoreIncludesTheStandardLibraryAndItself) {
    forEachInclude(sourcesIn({"core"}), [](const Source& source, std::size_t line,
                                           const std::string& included) {
        if (source.path.starts_with("core/box2d/") || included.starts_with("core/")) return;
        const bool standard = included.find_first_of("./") == std::string::npos;
        const bool hash = included == "xxhash.h" && source.path == "core/state/hash.cpp";
        const bool lanes = included == "immintrin.h";  // of the compiler, not of a library
        EXPECT_TRUE(standard || hash || lanes) << place(source, line) << " includes " << included;
    });
}

/// A line without what follows `//` and without texts in quotes.
std::string codeOf(const std::string& line) {
    std::string code;
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"' && (i == 0 || line[i - 1] != '\\')) quoted = !quoted;
        if (quoted) continue;
        if (line.compare(i, 2, "//") == 0) break;
        code += line[i];
    }
    return code;
}

/// Whether the code names the word, not as a part of a longer one.
bool names(const std::string& code, const std::string& word) {
    const auto part = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    };
    for (std::size_t at = code.find(word); at != std::string::npos; at = code.find(word, at + 1)) {
        const bool begins = at == 0 || !part(code[at - 1]);
        const std::size_t end = at + word.size();
        if (begins && (end == code.size() || !part(code[end]))) return true;
    }
    return false;
}

TEST(Core, UsesNothingOnWhichAResultMustNotDepend) {
    // libm's transcendental functions, clocks, randomness, orders of hash tables, globals a thread.
    const std::vector<std::string> banned = {"std::sin",
                                             "std::cos",
                                             "std::tan",
                                             "std::asin",
                                             "std::acos",
                                             "std::atan",
                                             "std::atan2",
                                             "std::exp",
                                             "std::log",
                                             "std::pow",
                                             "std::hypot",
                                             "std::fma",
                                             "std::fmod",
                                             "sinf",
                                             "cosf",
                                             "atan2f",
                                             "powf",
                                             "hypotf",
                                             "std::rand",
                                             "rand",
                                             "srand",
                                             "std::random_device",
                                             "std::mt19937",
                                             "std::hash",
                                             "std::unordered_map",
                                             "std::unordered_set",
                                             "std::chrono",
                                             "steady_clock",
                                             "system_clock",
                                             "thread_local",
                                             "std::reduce",
                                             "std::cout",
                                             "std::cerr",
                                             "std::ifstream",
                                             "std::ofstream",
                                             "printf",
                                             "fopen",
                                             "getenv",
                                             "throw",
                                             "dynamic_cast"};
    for (const Source& source : sourcesIn({"core"})) {
        if (source.path.starts_with("core/box2d/")) continue;
        for (std::size_t i = 0; i < source.lines.size(); ++i) {
            const std::string code = codeOf(source.lines[i]);
            for (const std::string& word : banned)
                EXPECT_FALSE(names(code, word)) << place(source, i + 1) << " uses " << word;
        }
    }
    EXPECT_TRUE(names("x = std::sin(y);", "std::sin"));
    EXPECT_FALSE(names("x = std::sinh(y);", "std::sin"));
    EXPECT_EQ(codeOf("a; // std::sin"), "a; ");
}

TEST(Sources, HoldNoWordThatPutsWorkOff) {
    std::vector<std::string> all = folders;
    all.push_back("tests");
    const std::vector<std::string> words = {
        "TO"
        "DO",
        "FIX"
        "ME",
        "X"
        "XX",
        "HA"
        "CK"};
    for (const Source& source : sourcesIn(all))
        for (std::size_t i = 0; i < source.lines.size(); ++i)
            for (const std::string& word : words)
                EXPECT_FALSE(names(source.lines[i], word)) << place(source, i + 1);
}

}  // namespace
}  // namespace huestep::test
