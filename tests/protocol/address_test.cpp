#include "protocol/address.h"

#include <gtest/gtest.h>

namespace huestep::protocol {
namespace {

TEST(Address, ReadsNamesNumbersAndBracketedIpv6) {
    EXPECT_EQ(*parseAddress("127.0.0.1:7777", false), (Address{"127.0.0.1", 7777}));
    EXPECT_EQ(*parseAddress("localhost:0", true), (Address{"localhost", 0}));
    EXPECT_EQ(*parseAddress("[::1]:65535", false), (Address{"::1", 65535}));
}

TEST(Address, IsWrittenAsItIsRead) {
    for (const char* text : {"127.0.0.1:7777", "[::1]:80", "localhost:1"}) {
        EXPECT_EQ(toText(*parseAddress(text, false)), text);
    }
}

TEST(Address, RefusesWhatIsNoneWithASentenceThatShowsIt) {
    for (const char* text : {"", "host", ":80", "host:", "host:x", "host:65536", "host:-1",
                             "host:80 ", "::1:80", "[::1:80", "[]:80", "host:0"}) {
        const Result<Address> address = parseAddress(text, false);
        ASSERT_FALSE(address.ok()) << text;
        const std::string shown = "'" + std::string(text) + "'";
        EXPECT_EQ(address.error().message.rfind(shown, 0), 0u) << address.error().message;
    }
}

}  // namespace
}  // namespace huestep::protocol
