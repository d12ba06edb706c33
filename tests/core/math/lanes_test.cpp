// Lanes: each is the operation of a single float, zeros, NaN and all, whatever the width.

#include "core/math/lanes.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

constexpr std::size_t most = 16;
using Row = std::array<float, most>;

/// Values that tell operations apart, and random ones.
Row rowOf(Random& random) {
    const std::array<float, 8> odd{0.0f,
                                   -0.0f,
                                   1.0f,
                                   -1.0f,
                                   std::numeric_limits<float>::infinity(),
                                   -std::numeric_limits<float>::infinity(),
                                   std::numeric_limits<float>::quiet_NaN(),
                                   1e-45f};
    Row row{};
    for (float& v : row) v = random.once(2) ? odd[random.below(8)] : random.betweenF(-9.0, 9.0);
    return row;
}

void expectSameBits(float a, float b) {
    if (std::isnan(a) && std::isnan(b)) return;
    ASSERT_EQ(std::bit_cast<std::uint32_t>(a), std::bit_cast<std::uint32_t>(b)) << a << " " << b;
}

template <int W>
void compareWithScalar(Random& random) {
    const Row a = rowOf(random), b = rowOf(random);
    Row greater{}, smaller{}, chosen{}, sum{}, spread{};
    const float one = random.betweenF(-2.0, 2.0);
    for (std::size_t i = 0; i < most; i += W) {
        const LaneF<W> x = loadLanes<W>(&a[i]), y = loadLanes<W>(&b[i]);
        storeLanes<W>(&greater[i], maxLanes(x, y));
        storeLanes<W>(&smaller[i], minLanes(x, y));
        storeLanes<W>(&chosen[i], selectLanes(x > splat<W>(0.0f), x, y));
        storeLanes<W>(&sum[i], x * y + x);
        storeLanes<W>(&spread[i], splat<W>(one));
    }
    for (std::size_t i = 0; i < most; ++i) {
        expectSameBits(greater[i], a[i] > b[i] ? a[i] : b[i]);
        expectSameBits(smaller[i], a[i] < b[i] ? a[i] : b[i]);
        expectSameBits(chosen[i], a[i] > 0.0f ? a[i] : b[i]);
        volatile float product = a[i] * b[i];  // rounded on its own: no fused operation
        expectSameBits(sum[i], product + a[i]);
        expectSameBits(spread[i], one);
    }
}

TEST(Lanes, OfEveryWidthDoWhatSingleFloatsDo) {
    Random random(31);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 2000; ++i) {
        compareWithScalar<1>(random);
        compareWithScalar<4>(random);
        compareWithScalar<8>(random);
        compareWithScalar<16>(random);
        if (testing::Test::HasFatalFailure()) return;
    }
}

TEST(Lanes, SplatKeepsTheSignOfZero) {
    Row row{};
    storeLanes<4>(row.data(), splat<4>(-0.0f));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(std::signbit(row[i]));
}

TEST(Lanes, AllAreSetOnlyWhereNoneOfFourIsNot) {
    for (unsigned set = 0; set < 16; ++set) {
        std::array<std::int32_t, 4> lanes{};
        for (unsigned i = 0; i < 4; ++i) lanes[i] = (set >> i & 1u) != 0 ? -1 : 0;
        EXPECT_EQ(allSet(loadMask<4>(lanes.data())), set == 15) << set;
    }
}

TEST(Lanes, LoadAndStoreNeedNoAlignment) {
    alignas(64) std::array<float, 40> memory{};
    for (std::size_t i = 0; i < memory.size(); ++i) memory[i] = static_cast<float>(i);
    for (std::size_t offset = 0; offset < 4; ++offset) {
        std::array<float, 24> out{};
        storeLanes<16>(&out[offset], loadLanes<16>(&memory[offset]));
        for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(out[offset + i], memory[offset + i]);
    }
}

}  // namespace
}  // namespace huestep::test
