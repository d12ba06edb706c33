#include "protocol/wire/reading.h"

#include "protocol/plain_text.h"

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
