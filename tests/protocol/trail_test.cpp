#include "protocol/trail.h"

#include <gtest/gtest.h>

namespace huestep::protocol {
namespace {

template <class F>
std::string sentenceOf(F&& read) {
    try {
        read();
    } catch (const Refused& refused) {
        return refused.sentence;
    }
    return "accepted";
}

TEST(Trail, NamesThePlaceOfARefusal) {
    Trail trail("Frame");
    EXPECT_EQ(sentenceOf([&] {
                  trail.at("commands", 3, [&] {
                      trail.at("done", [] {});
                      trail.at("spawn", [&] { trail.refuse("bodies", "too many"); });
                  });
              }),
              "Frame.commands[3].spawn.bodies: too many");
}

TEST(Trail, ComesBackFromFieldsAndEntriesThatWereFine) {
    Trail trail("");
    EXPECT_EQ(trail.at("a", [&] { return trail.at("b", 2, [&] { return trail.where(); }); }),
              "a.b[2]");
    EXPECT_EQ(trail.where(), "");
    trail.at("list", [&] {
        trail.atIndex(0, [] {});
        trail.atIndex(7, [&] { EXPECT_EQ(trail.where(), "list[7]"); });
        EXPECT_EQ(trail.where(), "list");
    });
    EXPECT_EQ(trail.sentence("why"), "why");
}

TEST(Trail, GoesDeeperThanItCanNameWithoutHarm) {
    Trail trail("");
    const auto dive = [&](auto&& self, int depth) -> void {
        if (depth == 0) trail.refuse("deep");
        trail.at("a", [&] { self(self, depth - 1); });
    };
    EXPECT_NE(sentenceOf([&] { dive(dive, 100); }).find("a.a.a"), std::string::npos);
}

}  // namespace
}  // namespace huestep::protocol
