/// Numbers and tables as people and programs read them.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace huestep::tools {

/// Keeps keys in the order in which they were put in.
using Json = nlohmann::ordered_json;

/// 16 hexadecimal digits.
std::string hex(std::uint64_t value);

/// Four significant digits: 0.01234, 12.34, 1.2e-07.
std::string number(double value);

/// The same with its unit. A share or ratio, whose unit is "1", is a number alone.
std::string withUnit(double value, std::string_view unit);

/// A unit as tables show it: "-" where there is none.
std::string unitText(std::string_view unit);

/// Of ASCII letters.
std::string lowerCase(std::string_view text);

/// A table with a head; every column as wide as its widest cell, numbers to the right.
class Table {
 public:
    explicit Table(std::vector<std::string> head);
    void add(std::vector<std::string> row);
    void print() const;  ///< on standard output

 private:
    std::vector<std::vector<std::string>> m_rows;
};

/// The one JSON document of a command, on standard output.
void print(const Json& document);

}  // namespace huestep::tools
