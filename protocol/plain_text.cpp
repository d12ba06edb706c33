#include "protocol/plain_text.h"

namespace huestep::protocol {

namespace {

/// Bytes of the UTF-8 sequence that starts `text`, or 0 if there is none.
std::size_t sequenceLength(std::string_view text) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    };
    const auto continues = [&](std::size_t i) { return (byte(i) & 0xc0u) == 0x80u; };
    const unsigned first = byte(0);
    if (first < 0x80u) return 1;
    if (first >= 0xc2u && first <= 0xdfu) return continues(1) ? 2 : 0;
    if (first >= 0xe0u && first <= 0xefu) {
        const bool overlong = first == 0xe0u && byte(1) < 0xa0u;
        const bool surrogate = first == 0xedu && byte(1) >= 0xa0u;
        return continues(1) && continues(2) && !overlong && !surrogate ? 3 : 0;
    }
    if (first >= 0xf0u && first <= 0xf4u) {
        const bool overlong = first == 0xf0u && byte(1) < 0x90u;
        const bool tooHigh = first == 0xf4u && byte(1) >= 0x90u;
        return continues(1) && continues(2) && continues(3) && !overlong && !tooHigh ? 4 : 0;
    }
    return 0;
}

}  // namespace

bool isPlainText(std::string_view text) {
    while (!text.empty()) {
        const auto first = static_cast<unsigned char>(text[0]);
        if (first < 0x20u || first == 0x7fu) return false;
        const std::size_t length = sequenceLength(text);
        if (length == 0) return false;
        text.remove_prefix(length);
    }
    return true;
}

std::string cutText(std::string text, std::size_t most) {
    if (text.size() <= most) return text;
    while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xc0u) == 0x80u) --most;
    text.resize(most);
    return text;
}

}  // namespace huestep::protocol
