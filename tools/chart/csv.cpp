#include "tools/chart/csv.h"

#include <algorithm>
#include <vector>

namespace huestep::tools::chart {
namespace {

std::string cell(const Json& value) {
    if (value.is_null()) return "";
    if (!value.is_string()) return value.dump();
    const auto& text = value.get_ref<const std::string&>();
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

}  // namespace

std::string csvOf(const Json& document, const std::string& table) {
    const std::vector<std::string> origin = {"commit", "machine", "compiler", "date"};
    std::vector<std::string> keys;
    for (const Json& row : document.at(table))
        for (const auto& [key, value] : row.items())
            if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    std::string csv;
    for (const std::string& key : origin) csv += cell(key) + ',';
    for (const std::string& key : keys) csv += cell(key) + ',';
    csv.back() = '\n';
    for (const Json& row : document.at(table)) {
        for (const std::string& key : origin) csv += cell(document.at(key)) + ',';
        for (const std::string& key : keys)
            csv += (row.contains(key) ? cell(row.at(key)) : "") + ',';
        csv.back() = '\n';
    }
    return csv;
}

}  // namespace huestep::tools::chart
