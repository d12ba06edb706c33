#include "protocol/wire/reading.h"

namespace huestep::protocol::wire {

std::string Reading::text(const char* field, std::string_view value, std::size_t most) {
    at(field, [&] {
        if (value.size() > most) {
            refuse(std::to_string(value.size()) + " bytes, at most " + std::to_string(most));
        }
        if (!isPlainText(value)) refuse("not UTF-8 text without control characters");
        spend(textWords(value));
    });
    return std::string(value);
}

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

std::string reasonOf(const ::kj::Exception& exception) {
    // The description may quote source text and the values of the message; never its trace, which
    // would start a program to look up symbols.
    const ::kj::StringPtr description = exception.getDescription();
    std::string reason(description.cStr(), description.size());
    const std::size_t message = reason.find("; ");
    if (reason.rfind("expected ", 0) == 0 && message != std::string::npos) {
        reason.erase(0, message + 2);
    }
    for (char& c : reason) {
        if (static_cast<unsigned char>(c) < 0x20u || static_cast<unsigned char>(c) > 0x7eu) c = ' ';
    }
    while (!reason.empty() && (reason.back() == ' ' || reason.back() == '.')) reason.pop_back();
    return reason.substr(0, 120);
}

}  // namespace huestep::protocol::wire
