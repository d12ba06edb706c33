/// What a stranger or an operator brings to the door: tickets after decryption and before, key
/// files, addresses, and bytes as text.
#include <string>

#include "protocol/address.h"
#include "protocol/keys.h"
#include "protocol/ticket.h"
#include "server/visitors.h"
#include "tests/fuzz/target.h"

namespace {

using namespace huestep::protocol;
using huestep::fuzz::require;

/// Keys that are the same in every run.
const Keys& keys() {
    static const Keys made = *parseKeys(
        "huestep key 1\n"
        "signing 9d61b19deffd5a60ba844af492ec2cc44449c5697b326919703bac031cae7f60\n"
        "sealing 4ccd089b28ff96da9db6c346ec114e0f5b8a319f35aba624da8cf6ed4fb8a6fb\n");
    return made;
}

void readTicket(std::span<const std::byte> bytes) {
    const auto sealed = openTicket(bytes, *keys().verifying, *keys().sealing);
    require(!sealed.ok(), "nobody but the issuer makes a ticket");
    const auto ticket = parseTicket(bytes);
    if (!ticket) return require(!ticket.error().message.empty(), "a refusal has a sentence");
    const auto again = sealTicket(*ticket, keys(), {});
    require(again.ok(), "what was taken may be issued");
    const auto back = openTicket(*again, *keys().verifying, *keys().sealing);
    require(back.ok() && *back == *ticket, "a second round trip changes nothing");
}

void readKeys(std::string_view text) {
    const auto read = parseKeys(text);
    if (!read) return require(!read.error().message.empty(), "a refusal has a sentence");
    const auto again = parseKeys(toText(*read));
    require(again.ok() && toText(*again) == toText(*read), "a second round trip changes nothing");
}

void readUrlText(std::string_view text) {
    const auto bytes = fromUrlText(text);
    if (bytes) require(toUrlText(*bytes) == text, "one text for each sequence of bytes");
}

void readAddress(std::string_view text) {
    const auto address = parseAddress(text, true);
    if (address) require(parseAddress(toText(*address), true).ok(), "an address reads again");
    require(huestep::server::visitorOf(text).size() <= text.size() + 64, "a visitor has a limit");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = huestep::fuzz::bytesOf(data, size);
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    readTicket(bytes);
    readKeys(text);
    readUrlText(text);
    readAddress(text);
    return 0;
}
