/// Text from outside that may be logged, shown and quoted as it is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace huestep::protocol {

/// Whether the bytes are UTF-8 (RFC 3629) without control characters (U+0000 to U+001F, U+007F).
bool isPlainText(std::string_view text);

/// At most `most` bytes of a UTF-8 text, from its beginning, no character cut in two.
std::string cutText(std::string text, std::size_t most);

}  // namespace huestep::protocol
