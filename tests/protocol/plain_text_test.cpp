#include "protocol/plain_text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

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

TEST(PlainText, IsCutBetweenCharacters) {
    const std::string text = "a\u00e9\u20ac\U0001f600z";  // 1, 2, 3, 4 and 1 bytes
    const std::vector<std::size_t> lengths{0, 1, 1, 3, 3, 3, 6, 6, 6, 6, 10, 11, 11};
    for (std::size_t most = 0; most < lengths.size(); ++most) {
        const std::string cut = cutText(text, most);
        EXPECT_EQ(cut.size(), lengths[most]) << most;
        EXPECT_TRUE(isPlainText(cut)) << most;
        EXPECT_EQ(text.rfind(cut, 0), 0u);
    }
}

}  // namespace
}  // namespace huestep::protocol
