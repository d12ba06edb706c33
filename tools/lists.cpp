#include "tools/lists.h"

#include <algorithm>
#include <charconv>

namespace huestep::tools {
namespace {

std::string availableNames() {
    std::string names = "auto";
    for (const Simd simd : availableSimd()) names += ", " + std::string(nameOf(simd));
    return names;
}

}  // namespace

std::vector<std::string> splitAtCommas(const std::string& text) {
    std::vector<std::string> pieces(1);
    for (const char c : text) {
        if (c == ',')
            pieces.emplace_back();
        else
            pieces.back() += c;
    }
    return pieces;
}

Result<std::vector<int>> parseThreads(const std::string& text) {
    std::vector<int> counts;
    for (const std::string& piece : splitAtCommas(text)) {
        int count = 0;
        const char* const end = piece.data() + piece.size();
        const auto [stop, wrong] = std::from_chars(piece.data(), end, count);
        if (wrong != std::errc{} || stop != end || count < 1 || count > maxThreads)
            return Error{"--threads: '" + piece + "' is no thread count; give 1 to " +
                         std::to_string(maxThreads) + ", as in 1,2,8"};
        if (std::find(counts.begin(), counts.end(), count) != counts.end())
            return Error{"--threads: " + piece + " is given twice"};
        counts.push_back(count);
    }
    return counts;
}

Result<Simd> parseSimd(const std::string& text) {
    const std::optional<Simd> simd = simdFromName(text);
    if (!simd)
        return Error{"--simd: '" + text + "' is no width; this machine has " + availableNames()};
    const std::vector<Simd> here = availableSimd();
    if (*simd != Simd::Auto && std::find(here.begin(), here.end(), *simd) == here.end())
        return Error{"--simd: this machine cannot run " + text + "; it has " + availableNames()};
    return *simd;
}

Result<std::vector<Simd>> parseSimdList(const std::string& text) {
    if (text == "all") return availableSimd();
    std::vector<Simd> widths;
    for (const std::string& piece : splitAtCommas(text)) {
        const Result<Simd> simd = parseSimd(piece);
        if (!simd) return simd.error();
        if (std::find(widths.begin(), widths.end(), *simd) != widths.end())
            return Error{"--simd: " + piece + " is given twice"};
        widths.push_back(*simd);
    }
    return widths;
}

}  // namespace huestep::tools
