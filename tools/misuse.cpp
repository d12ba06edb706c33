#include "tools/misuse.h"

#include <algorithm>
#include <numeric>

namespace huestep::tools {
namespace {

constexpr std::size_t nearEnough = 2;  // letters

/// Levenshtein's distance, row by row.
std::size_t distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

std::string unknownSubcommand(const CLI::App& app, const std::string& word) {
    std::vector<std::string> names;
    std::string list;
    for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
        names.push_back(sub->get_name());
        list += (list.empty() ? "" : ", ") + sub->get_name();
    }
    const std::string near = nearest(word, names);
    return "there is no subcommand '" + word + "'; " +
           (near.empty() ? "there are " + list : "did you mean '" + near + "'?") +
           "; see huestep --help";
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& names) {
    std::string best;
    std::size_t least = nearEnough + 1;
    for (const std::string& name : names) {
        const std::size_t letters = distance(word, name);
        // Of short names half would be another word.
        if (letters >= least || 2 * letters > name.size()) continue;
        least = letters;
        best = name;
    }
    return best;
}

std::string explainMisuse(const CLI::App& app, const CLI::ParseError& wrong,
                          const std::vector<std::string>& words) {
    const bool named = !words.empty() && !words[0].empty() && words[0][0] != '-';
    const CLI::App* sub = nullptr;
    for (const CLI::App* each : app.get_subcommands([](const CLI::App*) { return true; }))
        if (named && each->get_name() == words[0]) sub = each;
    if (sub == nullptr && named) return unknownSubcommand(app, words[0]);
    const std::string help = "; see huestep " + (sub ? sub->get_name() + " " : "") + "--help";
    if (dynamic_cast<const CLI::ExtrasError*>(&wrong) == nullptr) return wrong.what() + help;
    // The library lists them from last to first.
    std::string extras;
    for (const std::string& word : sub ? sub->remaining() : app.remaining())
        extras += (extras.empty() ? "" : " ") + word;
    return "not understood: " + extras + help;
}

}  // namespace huestep::tools
