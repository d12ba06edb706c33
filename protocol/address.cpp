#include "protocol/address.h"

#include <charconv>
#include <utility>

namespace huestep::protocol {

namespace {

Error wrong(std::string_view text, const char* why) {
    std::string sentence = "'";
    sentence.append(text.substr(0, 100)).append("' is no address HOST:PORT: ").append(why);
    return Error{std::move(sentence)};
}

}  // namespace

Result<Address> parseAddress(std::string_view text, bool mayBeZero) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string_view::npos) return wrong(text, "there is no ':' before a port");
    std::string_view host = text.substr(0, colon);
    const std::string_view port = text.substr(colon + 1);
    if (!host.empty() && host.front() == '[') {
        if (host.size() < 3 || host.back() != ']') return wrong(text, "a '[' without its ']'");
        host = host.substr(1, host.size() - 2);
    } else if (host.find(':') != std::string_view::npos) {
        return wrong(text, "an IPv6 number stands in brackets, as in [::1]:7777");
    }
    if (host.empty()) return wrong(text, "the host is missing");
    if (host.size() > 255) return wrong(text, "the host is longer than 255 bytes");
    Address address{std::string(host), 0};
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
    if (port.empty() || error != std::errc{} || end != port.data() + port.size()) {
        return wrong(text, "the port is a number from 0 to 65535");
    }
    if (address.port == 0 && !mayBeZero) return wrong(text, "port 0 cannot be connected to");
    return address;
}

bool isLoopback(const Address& address) {
    return address.host == "::1" ||
           (address.host.starts_with("127.") &&
            address.host.find_first_not_of("0123456789.") == std::string::npos);
}

std::string toText(const Address& address) {
    std::string text = address.host;
    if (text.find(':') != std::string::npos) text.insert(0, 1, '[').push_back(']');
    return text.append(":").append(std::to_string(address.port));
}

}  // namespace huestep::protocol
