// Pins in lanes: the bits of the one by one form, at every width.

#include "core/joint/pin_block.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

/// Joints that share no body that moves, as in one colour.
struct Field {
    std::vector<SolverBody> bodies;
    std::vector<JointRow> rows;
    std::vector<PinBlock> blocks;
};

/// A number, often a zero of either sign, sometimes one that no state holds.
float anyFloat(Random& random, double most, bool wild) {
    if (random.once(8)) return random.once(2) ? 0.0f : -0.0f;
    if (wild && random.once(6)) {
        const float infinite = std::numeric_limits<float>::infinity();
        return random.once(2) ? infinite : std::numeric_limits<float>::quiet_NaN();
    }
    return random.betweenF(-most, most);
}

Field randomField(Random& random, std::uint32_t count, bool wild) {
    Field f;
    const auto number = [&](double most) { return anyFloat(random, most, wild); };
    const auto body = [&] {
        SolverBody b;
        b.vx = number(5.0);
        b.vy = number(5.0);
        b.w = number(5.0);
        b.dx = number(0.1);
        b.dy = number(0.1);
        const double angle = random.between(-0.3, 0.3);
        b.dc = static_cast<float>(std::cos(angle));
        b.ds = random.once(8) ? -0.0f : static_cast<float>(std::sin(angle));
        f.bodies.push_back(b);
        return static_cast<BodyPlace>(f.bodies.size() - 1);
    };
    f.bodies.push_back({});
    const BodyPlace kinematic = body();
    f.blocks.resize(blocksOf(count));
    for (std::uint32_t i = 0; i < f.blocks.size() * blockLanes; ++i) {
        PinBlock& block = f.blocks[i / blockLanes];
        if (i >= count) {
            clearPinLane(block, i % blockLanes);
            continue;
        }
        JointRow row{};
        const auto end = [&](BodyPlace& place, float& m, float& inertia, bool mayBeStill) {
            if (mayBeStill && random.once(4)) {
                place = random.once(2) ? fixedWorld : ~kinematic;
                return;
            }
            place = body();
            m = random.betweenF(0.01, 3.0);
            inertia = random.once(5) ? 0.0f : random.betweenF(0.01, 30.0);
        };
        end(row.bodyA, row.mA, row.iA, true);
        end(row.bodyB, row.mB, row.iB, row.bodyA >= 0);
        row.anchorA = {number(2.0), number(2.0)};
        row.anchorB = {number(2.0), number(2.0)};
        row.centers = {number(2.0), number(2.0)};
        row.impulses.point = {number(9.0), number(9.0)};
        f.rows.push_back(row);
        setPinLane(block, i % blockLanes, row);
    }
    return f;
}

/// The same bits, zeros' signs included; of what is not a number only that it is none.
bool same(const void* left, const void* right, std::size_t floats) {
    for (std::size_t i = 0; i < floats; ++i) {
        float a, b;
        std::memcpy(&a, static_cast<const char*>(left) + 4 * i, 4);
        std::memcpy(&b, static_cast<const char*>(right) + 4 * i, 4);
        if (!(std::isnan(a) && std::isnan(b)) && std::memcmp(&a, &b, 4) != 0) return false;
    }
    return true;
}

void expectSame(const Field& wide, const Field& single, const std::string& what) {
    for (std::size_t i = 0; i < single.bodies.size(); ++i) {
        EXPECT_TRUE(same(&wide.bodies[i], &single.bodies[i], sizeof(SolverBody) / 4))
            << what << ": body " << i;
    }
    for (std::size_t i = 0; i < single.rows.size(); ++i) {
        const PinBlock& block = wide.blocks[i / blockLanes];
        const Vec2 impulse{block.impulseX[i % blockLanes], block.impulseY[i % blockLanes]};
        EXPECT_TRUE(same(&impulse, &single.rows[i].impulses.point, 2)) << what << ": joint " << i;
    }
}

TEST(PinLanes, GiveTheBitsOfJointsOneByOneAtEveryWidth) {
    Random random(2024);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 300 && !HasFailure(); ++trial) {
        const Field start = randomField(random, 1 + random.below(40), trial % 3 == 0);
        JointPass biased;
        biased.soft = {random.betweenF(1.0, 100.0), random.betweenF(0.1, 1.0),
                       random.betweenF(0.0, 0.5)};
        const JointPass relaxed;
        Field single = start;
        for (const JointRow& row : single.rows) warmStartJoint(single.bodies.data(), row);
        for (JointRow& row : single.rows) solveJoint(single.bodies.data(), row, biased);
        for (JointRow& row : single.rows) solveJoint(single.bodies.data(), row, relaxed);
        for (const Simd simd : availableSimd()) {
            const PinKernels& kernels = pinKernels(simd);
            Field wide = start;
            const auto count = static_cast<std::uint32_t>(wide.rows.size());
            kernels.warmStart(wide.bodies.data(), wide.blocks.data(), count, biased);
            kernels.solve(wide.bodies.data(), wide.blocks.data(), count, biased);
            kernels.solve(wide.bodies.data(), wide.blocks.data(), count, relaxed);
            expectSame(wide, single, std::string(nameOf(simd)));
        }
    }
}

TEST(PinLanes, TakeOnlyJointsWhoseOtherPartsAreStill) {
    JointInfo info{};
    info.flags = static_cast<std::uint32_t>(JointKind::Revolute) | JointInfo::hasMotor;
    JointImpulses still{};
    still.point = {3.0f, 4.0f};
    EXPECT_TRUE(isPin(info, still));
    for (const std::uint32_t part : {JointInfo::spring, JointInfo::limit, JointInfo::motor}) {
        JointInfo busy = info;
        busy.flags |= part;
        EXPECT_FALSE(isPin(busy, still));
    }
    JointImpulses left = still;
    left.motor = 1.0f;
    EXPECT_FALSE(isPin(info, left)) << "its warm start would be lost";
    info.flags = static_cast<std::uint32_t>(JointKind::Distance);
    EXPECT_FALSE(isPin(info, still));
}

}  // namespace
}  // namespace huestep::test
