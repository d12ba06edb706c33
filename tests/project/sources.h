/// The project's own source files, as tests about the project read them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/process.h"

namespace huestep::test {

inline const std::filesystem::path root = HUESTEP_SOURCE_DIR;

inline std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

/// A C++ file by its path from the root, as in "core/result.h".
struct Source {
    std::string path;
    std::vector<std::string> lines;
};

/// All C++ files below the folders, by path.
inline std::vector<Source> sourcesIn(const std::vector<std::string>& folders) {
    std::vector<Source> sources;
    for (const std::string& folder : folders)
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".h" && extension != ".cpp") continue;
            sources.push_back({std::filesystem::relative(entry.path(), root).generic_string(),
                               linesOf(textOf(entry.path()))});
        }
    std::sort(sources.begin(), sources.end(),
              [](const Source& a, const Source& b) { return a.path < b.path; });
    return sources;
}

/// What a line includes, without quotes or brackets; empty: nothing.
inline std::string includedBy(const std::string& line) {
    const std::string word = "#include ";
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos || line.compare(begin, word.size(), word) != 0) return "";
    const std::size_t open = line.find_first_of("\"<", begin);
    if (open == std::string::npos) return "";
    const std::size_t close = line.find_first_of("\">", open + 1);
    return close == std::string::npos ? "" : line.substr(open + 1, close - open - 1);
}

}  // namespace huestep::test
