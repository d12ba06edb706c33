#include "tools/whole_number.h"

#include <charconv>
#include <string>

namespace huestep::tools {

CLI::Validator wholeNumber(std::uint64_t low, std::uint64_t high) {
    const bool open = high == std::numeric_limits<std::uint64_t>::max();
    const std::string range = open ? std::to_string(low) + " or more"
                                   : "of " + std::to_string(low) + " to " + std::to_string(high);
    return CLI::Validator(
        [low, high, range](std::string& text) {
            std::uint64_t value = 0;
            const char* const end = text.data() + text.size();
            const auto [stop, wrong] = std::from_chars(text.data(), end, value);
            if (text.empty() || wrong != std::errc{} || stop != end || value < low || value > high)
                return "'" + text + "' is no whole number " + range;
            text = std::to_string(value);
            return std::string();
        },
        range);
}

}  // namespace huestep::tools
