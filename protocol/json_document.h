/// A JSON document as a tree that keeps what a validating walk needs: the order of fields, numbers
/// as they stand in the text, and the refusal of what must not be in any of our documents.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace huestep::protocol {

struct JsonValue {
    enum class Kind : std::uint8_t { Null, Boolean, Number, String, Array, Object };
    Kind kind = Kind::Null;
    bool boolean = false;
    std::string text;                ///< of a string; of a number, its digits
    std::vector<std::string> keys;   ///< of an object; no two are equal
    std::vector<JsonValue> entries;  ///< of an array, or of an object in the order of `keys`

    /// The field of an object, or null.
    [[nodiscard]] const JsonValue* find(std::string_view key) const;
};

/// "a number", "an object"
std::string_view nameOf(JsonValue::Kind kind);

inline constexpr std::size_t maxJsonDepth = 16;
inline constexpr std::size_t maxJsonFields = 64;        ///< of one object
inline constexpr std::size_t maxJsonValues = 4u << 20;  ///< of a document: 200,000 bodies or so

/// Parses UTF-8 text. Refused with the path: a field that stands twice, a number beyond the range
/// of doubles, nesting, fields and values beyond the caps; with line and column: what is not JSON.
Result<JsonValue> parseJson(std::span<const std::byte> text);

/// The text in quotes, with escapes; bytes that are not UTF-8 become U+FFFD.
std::string quoted(const std::string& text);

}  // namespace huestep::protocol
