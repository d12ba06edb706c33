/// Network addresses as people write them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.h"

namespace huestep::protocol {

struct Address {
    std::string host;  ///< name or number; without the brackets of an IPv6 number
    std::uint16_t port = 0;
    friend bool operator==(const Address&, const Address&) = default;
};

/// Reads HOST:PORT, such as `127.0.0.1:7777`, `[::1]:7777` or `localhost:0`. Port 0 asks for any
/// free one and is refused unless `mayBeZero`. The sentence shows the text and what is wrong.
Result<Address> parseAddress(std::string_view text, bool mayBeZero);

/// Whether only this machine can be there: 127.x.y.z or ::1, as numbers.
bool isLoopback(const Address& address);

/// HOST:PORT, with brackets around an IPv6 number.
std::string toText(const Address& address);

}  // namespace huestep::protocol
