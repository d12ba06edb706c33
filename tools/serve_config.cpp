#include "tools/serve_config.h"

#include <toml++/toml.h>

#include <sstream>

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
    if (key == "data") return takeText(file, node, key, options.data);
    if (key == "session") return takeSessions(file, node, options.sessions);
    if (key == "open") {
        const auto value = node.value_exact<bool>();
        if (!value) return Error{placeOf(file, node) + "'open' must be true or false"};
        options.open = options.open || *value;
        return Done{};
    }
    return Error{placeOf(file, node) + "there is no key '" + key +
                 "'; there are listen, web, data, session and open"};
}

}  // namespace

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
