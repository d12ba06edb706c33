#include "tools/serve_config.h"

#include <toml++/toml.h>

#include <charconv>
#include <optional>
#include <sstream>
#include <string_view>

namespace huestep::tools {
namespace {

std::string placeOf(const std::string& file, const toml::node& node) {
    return file + ":" + std::to_string(node.source().begin.line) + ": ";
}

Status takeText(const std::string& file, const toml::node& node, const std::string& key,
                std::string& into) {
    const auto value = node.value_exact<std::string>();
    if (!value) return Error{placeOf(file, node) + "'" + key + "' must be a text in quotes"};
    if (into.empty()) into = *value;
    return Done{};
}

/// A number, or a text as on the command line.
Status takeDelay(const std::string& file, const toml::node& node, std::string& into) {
    std::string text;
    if (const auto ticks = node.value_exact<std::int64_t>()) {
        text = std::to_string(*ticks);
    } else if (const Status taken = takeText(file, node, "input-delay", text); !taken) {
        return Error{placeOf(file, node) + "'input-delay' must be a number of ticks, or a text"};
    }
    const Result<InputDelay> delay = parseInputDelay(text);
    if (!delay) return Error{placeOf(file, node) + delay.error().message};
    if (into.empty()) into = text;
    return Done{};
}

Status takeSessions(const std::string& file, const toml::node& node,
                    std::vector<std::string>& into) {
    const toml::array* list = node.as_array();
    if (list == nullptr)
        return Error{placeOf(file, node) + "'session' must be a list, as in [\"play=sandbox\"]"};
    std::vector<std::string> sessions;
    for (const toml::node& entry : *list) {
        std::string text;
        if (const Status taken = takeText(file, entry, "session", text); !taken) return taken;
        sessions.push_back(std::move(text));
    }
    if (into.empty()) into = std::move(sessions);
    return Done{};
}

Status takeKey(const std::string& file, const std::string& key, const toml::node& node,
               ServeOptions& options) {
    if (key == "listen") return takeText(file, node, key, options.listen);
    if (key == "web") return takeText(file, node, key, options.web);
    if (key == "tickets") return takeText(file, node, key, options.tickets);
    if (key == "tls-cert") return takeText(file, node, key, options.tlsCertificates);
    if (key == "tls-key") return takeText(file, node, key, options.tlsKey);
    if (key == "data") return takeText(file, node, key, options.data);
    if (key == "input-delay") return takeDelay(file, node, options.inputDelay);
    if (key == "session") return takeSessions(file, node, options.sessions);
    if (key == "open") {
        const auto value = node.value_exact<bool>();
        if (!value) return Error{placeOf(file, node) + "'open' must be true or false"};
        options.open = options.open || *value;
        return Done{};
    }
    return Error{placeOf(file, node) + "there is no key '" + key +
                 "'; there are listen, web, data, session, input-delay, tickets, tls-cert, "
                 "tls-key and open"};
}

constexpr std::uint32_t mostDelay = 60;     // a second at 60 ticks a second
constexpr std::uint32_t mostAdaptive = 12;  // of `adaptive`

std::optional<std::uint32_t> ticksIn(std::string_view text) {
    std::uint32_t ticks = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ticks);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole && ticks <= mostDelay ? std::optional(ticks) : std::nullopt;
}

}  // namespace

Result<InputDelay> parseInputDelay(const std::string& text) {
    if (text.empty()) return InputDelay{};
    if (text == "adaptive") return InputDelay{0, mostAdaptive};
    const std::size_t dash = text.find('-');
    const std::optional<std::uint32_t> least = ticksIn(std::string_view(text).substr(0, dash));
    const std::optional<std::uint32_t> most =
        dash == std::string::npos ? least : ticksIn(std::string_view(text).substr(dash + 1));
    if (!least || !most || *least > *most)
        return Error{"input-delay: '" + text +
                     "' is neither a number of ticks up to 60, nor LOW-HIGH, nor adaptive"};
    return InputDelay{*least, *most};
}

Status fillFromFile(ServeOptions& options) {
    if (options.config.empty()) return Done{};
    const std::string& file = options.config;
    try {
        const toml::table table = toml::parse_file(file);
        for (const auto& [key, node] : table) {
            const std::string name(key.str());
            if (const Status taken = takeKey(file, name, node, options); !taken) return taken;
        }
    } catch (const toml::parse_error& wrong) {
        const auto line = wrong.source().begin.line;  // 0: no line was read
        return Error{file + (line == 0 ? "" : ":" + std::to_string(line)) + ": " +
                     std::string(wrong.description())};
    }
    return Done{};
}

}  // namespace huestep::tools
