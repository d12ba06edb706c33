/// What a command of the shell prints, line by line.
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace huestep::test {

/// Calls `f(line)` for every line of a command's output; says whether the command ended with 0.
template <class F>
bool forEachLineOf(const std::string& command, F f) {
    std::FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) return false;
    std::array<char, 4096> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr)
        f(std::string(line.data()));
    return ::pclose(pipe) == 0;
}

}  // namespace huestep::test
