// Limits by address: who counts as one visitor, and what one may take.
#include "server/visitors.h"

#include <gtest/gtest.h>

namespace huestep::server {
namespace {

Limits few() {
    Limits limits;
    limits.connectionsPerAddress = 3;
    limits.acceptsPerSecond = 2.0;
    limits.acceptBurst = 5.0;
    return limits;
}

TEST(Visitors, OneIsAnIpv4NumberOrTheHalfOfAnIpv6Number) {
    EXPECT_EQ(visitorOf("192.0.2.7:4000"), "192.0.2.7");
    EXPECT_EQ(visitorOf("192.0.2.7"), "192.0.2.7");
    EXPECT_EQ(visitorOf("[2001:db8:1:2:3:4:5:6]:4000"), "2001:db8:1:2::/64");
    EXPECT_EQ(visitorOf("2001:db8:1:2:9:9:9:9"), visitorOf("[2001:db8:1:2::1]:80"));
    EXPECT_NE(visitorOf("2001:db8:1:3::1"), visitorOf("2001:db8:1:2::1"));
    // As a listener of both families sees IPv4.
    EXPECT_EQ(visitorOf("[::ffff:192.0.2.7]:80"), "192.0.2.7");
    EXPECT_EQ(visitorOf("[::1]:80"), "::1");
    EXPECT_EQ(visitorOf("simulated"), "simulated");
}

TEST(Visitors, OneAddressHasSoManyConnectionsAndNoMore) {
    Visitors visitors(few(), {}, 0);
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(visitors.mayCome("192.0.2.7", 0));
        visitors.came("192.0.2.7");
    }
    EXPECT_FALSE(visitors.mayCome("192.0.2.7", 0));
    EXPECT_TRUE(visitors.mayCome("192.0.2.8", 0)) << "another's are its own";
    visitors.left("192.0.2.7");
    EXPECT_TRUE(visitors.mayCome("192.0.2.7", 0));
    visitors.left("192.0.2.7");
    visitors.left("192.0.2.7");
    EXPECT_EQ(visitors.known(), 0u);
}

TEST(Visitors, OneAddressComesAtARate) {
    Visitors visitors(few(), {}, 0);
    int let = 0;
    for (int i = 0; i < 1'000; ++i) let += visitors.mayCome("192.0.2.7", 0) ? 1 : 0;
    EXPECT_EQ(let, 5);
    for (int i = 0; i < 1'000; ++i)
        let += visitors.mayCome("192.0.2.7", 2 * second + second / 4) ? 1 : 0;
    EXPECT_EQ(let, 9);
}

TEST(Visitors, OfThisMachineAreNotCounted) {
    Visitors visitors(few(), {}, 0);
    for (int i = 0; i < 100; ++i) {
        EXPECT_TRUE(visitors.mayCome("127.0.0.1", 0));
        visitors.came("127.0.0.1");
    }
}

TEST(Visitors, AnotherKeyPutsAddressesInOtherBuckets) {
    Limits limits = few();
    limits.rateBuckets = 64;
    limits.acceptBurst = 1.0;
    const auto sharing = [&](std::uint8_t key) {
        Visitors visitors(limits, ResumeKey{key}, 0);
        EXPECT_TRUE(visitors.mayCome("192.0.2.0", 0));
        std::string shared;
        for (int i = 1; i < 200; ++i) {
            Visitors fresh(limits, ResumeKey{key}, 0);
            fresh.mayCome("192.0.2.0", 0);
            const std::string other = "192.0.2." + std::to_string(i);
            if (!fresh.mayCome(other, 0)) shared += other + " ";
        }
        return shared;
    };
    EXPECT_NE(sharing(1), "") << "the test needs some that share";
    EXPECT_NE(sharing(1), sharing(2));
}

}  // namespace
}  // namespace huestep::server
