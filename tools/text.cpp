#include "tools/text.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <string_view>

namespace huestep::tools {
namespace {

/// Characters, not bytes: the micro and middle dot signs take two bytes each.
std::size_t widthOf(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u;
    }));
}

bool looksLikeNumber(std::string_view text) {
    // The whole of it: a sentence may begin with a digit.
    return !text.empty() && text.find_first_not_of("0123456789.+-e%") == std::string_view::npos;
}

}  // namespace

std::string hex(std::uint64_t value) {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value));
    return digits;
}

std::string number(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.4g", value);
    return digits;
}

std::string withUnit(double value, std::string_view unit) {
    return unit == "1" ? number(value) : number(value) + " " + std::string(unit);
}

std::string unitText(std::string_view unit) {
    return unit == "1" ? "-" : std::string(unit);
}

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

Table::Table(std::vector<std::string> head) {
    m_rows.push_back(std::move(head));
}

void Table::add(std::vector<std::string> row) {
    assert(row.size() == m_rows.front().size());
    m_rows.push_back(std::move(row));
}

void Table::print() const {
    std::vector<std::size_t> widths(m_rows.front().size(), 0);
    for (const auto& row : m_rows)
        for (std::size_t c = 0; c < row.size(); ++c)
            widths[c] = std::max(widths[c], widthOf(row[c]));
    for (const auto& row : m_rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            const std::string gap(widths[c] - widthOf(row[c]), ' ');
            line += looksLikeNumber(row[c]) ? gap + row[c] : row[c] + gap;
            line += "  ";
        }
        line.erase(line.find_last_not_of(' ') + 1);
        std::printf("%s\n", line.c_str());
    }
}

void print(const Json& document) {
    std::printf("%s\n", document.dump(2).c_str());
}

}  // namespace huestep::tools
