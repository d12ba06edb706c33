/// Log lines of `key=value` pairs.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace huestep::server {

enum class Severity : std::uint8_t { Info, Warning, Error };

/// Takes one finished line. Thread rule: called on the host's thread only.
using LogSink = std::function<void(Severity severity, const std::string& line)>;

/// To standard error through spdlog, with time and severity in front.
LogSink logToStandardError();

/// 16 digits.
std::string hexOf(std::uint64_t value);

/// Builds one line: `event=joined session=play player=3`. Values with spaces, quotes or control
/// bytes are quoted and escaped, so that a client cannot forge a line.
class LogLine {
 public:
    explicit LogLine(std::string_view event);
    LogLine& with(std::string_view key, std::string_view value);
    LogLine& with(std::string_view key, std::uint64_t value);
    LogLine& hex(std::string_view key, std::uint64_t value);
    void to(const LogSink& sink, Severity severity = Severity::Info) const;
    [[nodiscard]] const std::string& text() const { return m_text; }

 private:
    std::string m_text;
};

}  // namespace huestep::server
