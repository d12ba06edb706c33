/// Numbers and tables as people and programs read them.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace huestep::tools {

/// Keeps keys in the order in which they were put in.
using Json = nlohmann::ordered_json;

/// 16 hexadecimal digits.
std::string hex(std::uint64_t value);

/// Four significant digits: 0.01234, 12.34, 1.2e-07.
std::string number(double value);

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
