#include "protocol/json_document.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace huestep::protocol {

namespace {

using nlohmann::json;

/// Takes the parser's events and builds the tree. nlohmann's own tree keeps the last of two equal
/// keys without a word and turns numbers into doubles; from the events both can be seen.
class TreeBuilder final : public nlohmann::json_sax<json> {
 public:
    explicit TreeBuilder(std::string_view text) : m_text(text) {}

    bool null() override { return add({}); }
    bool boolean(bool value) override {
        JsonValue node;
        node.kind = JsonValue::Kind::Boolean;
        node.boolean = value;
        return add(std::move(node));
    }
    bool number_integer(number_integer_t value) override { return number(std::to_string(value)); }
    bool number_unsigned(number_unsigned_t value) override { return number(std::to_string(value)); }
    bool number_float(number_float_t, const string_t& text) override { return number(text); }
    bool string(string_t& text) override {
        JsonValue node;
        node.kind = JsonValue::Kind::String;
        node.text = std::move(text);
        return add(std::move(node));
    }
    bool binary(binary_t&) override { return false; }  // text has none

    bool start_object(std::size_t) override { return open(JsonValue::Kind::Object); }
    bool start_array(std::size_t) override { return open(JsonValue::Kind::Array); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& key) override;

    bool parse_error(std::size_t position, const std::string& token,
                     const json::exception& exception) override;

    JsonValue takeRoot() { return std::move(m_root); }
    [[nodiscard]] const std::string& failure() const { return m_failure; }

 private:
    bool add(JsonValue value);
    bool open(JsonValue::Kind kind);
    bool close();
    bool number(std::string text);
    bool fail(const std::string& reason, bool inside = true);
    [[nodiscard]] std::string path(bool inside) const;

    std::string_view m_text;
    JsonValue m_root;
    // Containers under construction. They move into their parents when they end, so that no
    // pointer into a growing vector is kept.
    std::vector<JsonValue> m_open;
    std::size_t m_values = 0;
    std::string m_failure;
};

/// The path of the value that comes next in the innermost container; of the container itself
/// unless `inside`.
std::string TreeBuilder::path(bool inside) const {
    std::string path;
    const std::size_t depth = m_open.size() - (inside || m_open.empty() ? 0 : 1);
    for (std::size_t i = 0; i < depth; ++i) {
        const JsonValue& container = m_open[i];
        if (container.kind == JsonValue::Kind::Array) {
            path += '[';
            path += std::to_string(container.entries.size());
            path += ']';
        } else if (!container.keys.empty()) {
            if (!path.empty()) path += '.';
            path += container.keys.back().substr(0, 100);
        }
    }
    return path;
}

bool TreeBuilder::fail(const std::string& reason, bool inside) {
    m_failure = path(inside);
    if (!m_failure.empty()) m_failure += ": ";
    m_failure += reason;
    return false;
}

bool TreeBuilder::add(JsonValue value) {
    if (++m_values > maxJsonValues) {
        return fail("the document has more than " + std::to_string(maxJsonValues) + " values");
    }
    if (m_open.empty()) {
        m_root = std::move(value);
    } else {
        m_open.back().entries.push_back(std::move(value));
    }
    return true;
}

bool TreeBuilder::open(JsonValue::Kind kind) {
    if (m_open.size() >= maxJsonDepth) {
        return fail("nested deeper than " + std::to_string(maxJsonDepth) + " levels");
    }
    JsonValue value;
    value.kind = kind;
    m_open.push_back(std::move(value));
    return true;
}

bool TreeBuilder::close() {
    JsonValue value = std::move(m_open.back());
    m_open.pop_back();
    return add(std::move(value));
}

bool TreeBuilder::number(std::string text) {
    JsonValue node;
    node.kind = JsonValue::Kind::Number;
    node.text = std::move(text);
    return add(std::move(node));
}

bool TreeBuilder::key(string_t& key) {
    std::vector<std::string>& keys = m_open.back().keys;
    const bool twice = std::find(keys.begin(), keys.end(), key) != keys.end();
    keys.push_back(key);
    if (twice) return fail("stands here twice");
    if (keys.size() > maxJsonFields) {
        return fail("the object has more than " + std::to_string(maxJsonFields) + " fields", false);
    }
    return true;
}

bool TreeBuilder::parse_error(std::size_t position, const std::string& token,
                              const json::exception& exception) {
    constexpr int numberOverflow = 406;
    if (exception.id == numberOverflow)
        return fail(token.substr(0, 40) + " is not a finite number");
    // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error ..."
    std::string reason = exception.what();
    const std::size_t syntax = reason.find(": ");
    if (syntax != std::string::npos) reason.erase(0, syntax + 2);
    const std::string_view before = m_text.substr(0, position > 0 ? position - 1 : 0);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t lineStart = before.rfind('\n') + 1;  // 0 if there is none
    m_failure = "line " + std::to_string(line) + ", column " +
                std::to_string(before.size() - lineStart + 1) + ": " + reason.substr(0, 200);
    return false;
}

}  // namespace

const JsonValue* JsonValue::find(std::string_view key) const {
    const auto found = std::find(keys.begin(), keys.end(), key);
    return found == keys.end() ? nullptr : &entries[static_cast<std::size_t>(found - keys.begin())];
}

std::string_view nameOf(JsonValue::Kind kind) {
    using Kind = JsonValue::Kind;
    switch (kind) {
        case Kind::Null:
            return "null";
        case Kind::Boolean:
            return "true or false";
        case Kind::Number:
            return "a number";
        case Kind::String:
            return "a text";
        case Kind::Array:
            return "a list";
        case Kind::Object:
            return "an object";
    }
    return "nothing";
}

Result<JsonValue> parseJson(std::span<const std::byte> text) {
    const std::string_view view(reinterpret_cast<const char*>(text.data()), text.size());
    TreeBuilder builder(view);
    if (!json::sax_parse(view.begin(), view.end(), &builder)) return Error{builder.failure()};
    return builder.takeRoot();
}

std::string quoted(const std::string& text) {
    return json(text).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace huestep::protocol
