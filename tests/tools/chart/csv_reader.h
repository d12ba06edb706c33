/// CSV as RFC 4180 has it, for tests.
#pragma once

#include <string>
#include <vector>

namespace huestep::test {

inline std::vector<std::vector<std::string>> csvRows(const std::string& text) {
    std::vector<std::vector<std::string>> rows;
    bool fresh = true;  // a row begins with the next character
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (fresh) rows.push_back({""});
        fresh = false;
        if (text[i] == ',') {
            rows.back().emplace_back();
        } else if (text[i] == '\n') {
            fresh = true;
        } else if (text[i] == '"') {
            for (++i; i < text.size() && (text[i] != '"' || text[i + 1] == '"'); ++i) {
                if (text[i] == '"') ++i;
                rows.back().back() += text[i];
            }
        } else {
            rows.back().back() += text[i];
        }
    }
    return rows;
}

}  // namespace huestep::test
