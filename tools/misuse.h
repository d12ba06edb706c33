/// What is wrong with a command line, in a sentence.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace huestep::tools {

/// Of a parse that failed: names what is wrong in the user's order, the nearest subcommand to a
/// misspelt one, and the help to read. `words` are those after the program's name.
std::string explainMisuse(const CLI::App& app, const CLI::ParseError& wrong,
                          const std::vector<std::string>& words);

/// Of `names` the one that is fewest letters put in, left out or changed from `word`, if that are
/// at most two; empty: none is near.
std::string nearest(const std::string& word, const std::vector<std::string>& names);

}  // namespace huestep::tools
