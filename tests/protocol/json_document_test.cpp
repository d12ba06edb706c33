#include "protocol/json_document.h"

#include <gtest/gtest.h>

namespace huestep::protocol {
namespace {

Result<JsonValue> parse(const std::string& text) {
    return parseJson(std::as_bytes(std::span(text.data(), text.size())));
}

TEST(JsonDocument, KeepsOrderAndNumbersAsTheyStand) {
    const auto value = parse(R"({"b": [1, -2.50, 1e3], "a": {"x": "t\u00e9\n"}, "n": null})");
    ASSERT_TRUE(value.ok()) << value.error().message;
    EXPECT_EQ(value->keys, (std::vector<std::string>{"b", "a", "n"}));
    const JsonValue* list = value->find("b");
    ASSERT_NE(list, nullptr);
    ASSERT_EQ(list->entries.size(), 3u);
    EXPECT_EQ(list->entries[0].text, "1");
    EXPECT_EQ(list->entries[1].text, "-2.50");
    EXPECT_EQ(list->entries[2].text, "1e3");
    EXPECT_EQ(value->find("a")->find("x")->text, "t\xc3\xa9\n");
    EXPECT_EQ(value->find("n")->kind, JsonValue::Kind::Null);
    EXPECT_EQ(value->find("c"), nullptr);
}

TEST(JsonDocument, NamesTheFieldThatStandsTwiceWhereverItIs) {
    EXPECT_EQ(parse(R"([{"a": 1}, {"a": 1, "b": [0, {"c": 1, "c": 2}]}])").error().message,
              "[1].b[1].c: stands here twice");
}

TEST(JsonDocument, QuotedTextReadsBackTheSame) {
    for (const std::string& text : {std::string("plain"), std::string("\"\\\n\t\x01"),
                                    std::string("\xe2\x82\xac"), std::string("a\0b", 3)}) {
        const auto value = parse(quoted(text));
        ASSERT_TRUE(value.ok()) << value.error().message;
        EXPECT_EQ(value->text, text);
    }
    EXPECT_TRUE(parse(quoted("\xff")).ok());
}

}  // namespace
}  // namespace huestep::protocol
