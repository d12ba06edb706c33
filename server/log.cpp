#include "server/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <memory>

namespace huestep::server {

namespace {

bool plain(std::string_view value) {
    if (value.empty()) return false;
    for (const char c : value) {
        if (c <= ' ' || c > '~' || c == '"' || c == '\\' || c == '=') return false;
    }
    return true;
}

std::string quoted(std::string_view value) {
    std::string out = "\"";
    for (const char c : value) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (c >= ' ' && c <= '~') {
            out += c;
        } else {
            char escape[8];
            std::snprintf(escape, sizeof escape, "\\x%02x",
                          static_cast<unsigned>(static_cast<unsigned char>(c)));
            out += escape;
        }
    }
    return out + '"';
}

spdlog::level::level_enum levelOf(Severity severity) {
    switch (severity) {
        case Severity::Warning:
            return spdlog::level::warn;
        case Severity::Error:
            return spdlog::level::err;
        case Severity::Info:
            break;
    }
    return spdlog::level::info;
}

}  // namespace

LogSink logToStandardError() {
    // A logger of our own instead of spdlog's registry, which is a global.
    auto logger = std::make_shared<spdlog::logger>(
        "huestep", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    logger->set_pattern("time=%Y-%m-%dT%H:%M:%S.%e%z level=%l %v");
    return [logger](Severity severity, const std::string& line) {
        logger->log(levelOf(severity), spdlog::string_view_t(line));
    };
}

LogLine::LogLine(std::string_view event) {
    with("event", event);
}

LogLine& LogLine::with(std::string_view key, std::string_view value) {
    if (!m_text.empty()) m_text += ' ';
    m_text += key;
    m_text += '=';
    if (plain(value)) {
        m_text += value;
    } else {
        m_text += quoted(value);
    }
    return *this;
}

LogLine& LogLine::with(std::string_view key, std::uint64_t value) {
    return with(key, std::string_view(std::to_string(value)));
}

std::string hexOf(std::uint64_t value) {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value));
    return digits;
}

LogLine& LogLine::hex(std::string_view key, std::uint64_t value) {
    return with(key, hexOf(value));
}

void LogLine::to(const LogSink& sink, Severity severity) const {
    if (sink) sink(severity, m_text);
}

}  // namespace huestep::server
