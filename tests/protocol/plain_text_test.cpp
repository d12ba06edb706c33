#include "protocol/plain_text.h"

#include <gtest/gtest.h>

#include <string>

namespace huestep::protocol {
namespace {

TEST(PlainText, IsUtf8WithoutControlCharacters) {
    for (const std::string& good :
         {std::string(), std::string("a ~"), std::string("\xc3\xa9"), std::string("\xe2\x82\xac"),
          std::string("\xef\xbf\xbf"), std::string("\xf0\x9f\x8e\xb2"),
          std::string("\xf4\x8f\xbf\xbf"), std::string("\xed\x9f\xbf"),
          std::string("\xee\x80\x80")}) {
        EXPECT_TRUE(isPlainText(good)) << good;
    }
    for (const std::string& bad :
         {std::string("\0", 1), std::string("\x1f"), std::string("\x7f"), std::string("\x80"),
          std::string("\xbf"), std::string("\xc1\xbf"), std::string("\xc3"), std::string("\xc3(."),
          std::string("\xe0\x9f\xbf"), std::string("\xe2\x82"), std::string("\xed\xa0\x80"),
          std::string("\xf0\x8f\xbf\xbf"), std::string("\xf0\x9f\x8e"),
          std::string("\xf4\x90\x80\x80"), std::string("\xf5\x80\x80\x80"), std::string("\xff")}) {
        EXPECT_FALSE(isPlainText(bad)) << bad;
    }
}

}  // namespace
}  // namespace huestep::protocol
