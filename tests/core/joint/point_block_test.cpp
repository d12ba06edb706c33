// Joints of a point alone in lanes: the bits of the one by one form, at every width.

#include "core/joint/point_block.h"

#include <cstring>

#include "core/math/trig.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

/// Joints that share no body, as in one colour; some bodies are fixed, some cannot turn.
struct Field {
    std::vector<SolverBody> bodies;
    std::vector<JointRow> rows;
    std::vector<PointBlock> blocks;
};

Field randomField(Random& random, std::uint32_t count) {
    Field f;
    const auto body = [&] {
        SolverBody b;
        b.vx = random.betweenF(-5.0f, 5.0f);
        b.vy = random.betweenF(-5.0f, 5.0f);
        b.w = random.betweenF(-5.0f, 5.0f);
        b.dx = random.betweenF(-0.1f, 0.1f);
        b.dy = random.betweenF(-0.1f, 0.1f);
        const Rotation q = rotationOf(random.betweenF(-0.3f, 0.3f));
        b.dc = q.c;
        b.ds = q.s;
        f.bodies.push_back(b);
        return static_cast<BodyPlace>(f.bodies.size() - 1);
    };
    f.bodies.push_back({});
    f.blocks.resize((count + blockLanes - 1) / blockLanes);
    for (std::uint32_t i = 0; i < f.blocks.size() * blockLanes; ++i) {
        PointBlock& block = f.blocks[i / blockLanes];
        if (i >= count) {
            clearPointLane(block, i % blockLanes);
            continue;
        }
        JointRow row{};
        row.bodyA = random.once(4) ? fixedWorld : body();
        row.bodyB = body();
        if (row.bodyA >= 0) {
            row.mA = random.betweenF(0.01f, 3.0f);
            row.iA = random.once(5) ? 0.0f : random.betweenF(0.01f, 30.0f);
        }
        row.mB = random.betweenF(0.01f, 3.0f);
        row.iB = random.once(5) ? 0.0f : random.betweenF(0.01f, 30.0f);
        row.anchorA = {random.betweenF(-2.0f, 2.0f), random.betweenF(-2.0f, 2.0f)};
        row.anchorB = {random.betweenF(-2.0f, 2.0f), random.betweenF(-2.0f, 2.0f)};
        row.centers = {random.betweenF(-2.0f, 2.0f), random.betweenF(-2.0f, 2.0f)};
        row.impulses.point = {random.betweenF(-9.0f, 9.0f), random.betweenF(-9.0f, 9.0f)};
        f.rows.push_back(row);
        setPointLane(block, i % blockLanes, row);
    }
    return f;
}

/// Bytes, so that a zero's sign counts.
void expectSame(const Field& wide, const Field& single, const std::string& what) {
    for (std::size_t i = 0; i < single.bodies.size(); ++i) {
        EXPECT_EQ(std::memcmp(&wide.bodies[i], &single.bodies[i], 3 * sizeof(float)), 0)
            << what << ": body " << i;
    }
    for (std::size_t i = 0; i < single.rows.size(); ++i) {
        const PointBlock& block = wide.blocks[i / blockLanes];
        const Vec2 impulse{block.impulseX[i % blockLanes], block.impulseY[i % blockLanes]};
        EXPECT_EQ(std::memcmp(&impulse, &single.rows[i].impulses.point, sizeof impulse), 0)
            << what << ": joint " << i;
    }
}

TEST(PointLanes, GiveTheBitsOfJointsOneByOneAtEveryWidth) {
    Random random(2024);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 200 && !HasFailure(); ++trial) {
        const Field start = randomField(random, 1 + random.below(40));
        JointPass biased;
        biased.soft = {random.betweenF(1.0f, 100.0f), random.betweenF(0.1f, 1.0f),
                       random.betweenF(0.0f, 0.5f)};
        biased.bias = true;
        const JointPass relaxed;
        Field single = start;
        for (const JointRow& row : single.rows) warmStartJoint(single.bodies.data(), row);
        for (JointRow& row : single.rows) solveJoint(single.bodies.data(), row, biased);
        for (JointRow& row : single.rows) solveJoint(single.bodies.data(), row, relaxed);
        for (const Simd simd : availableSimd()) {
            const PointKernels& kernels = pointKernels(simd);
            Field wide = start;
            const auto count = static_cast<std::uint32_t>(wide.rows.size());
            kernels.warmStart(wide.bodies.data(), wide.blocks.data(), count, biased);
            kernels.solve(wide.bodies.data(), wide.blocks.data(), count, biased);
            kernels.solve(wide.bodies.data(), wide.blocks.data(), count, relaxed);
            expectSame(wide, single, std::string(nameOf(simd)));
        }
    }
}

TEST(PointLanes, TakeOnlyJointsWhoseOtherPartsAreStill) {
    JointInfo info{};
    info.flags = static_cast<std::uint32_t>(JointKind::Revolute) | JointInfo::hasMotor;
    JointImpulses still{};
    still.point = {3.0f, 4.0f};
    EXPECT_TRUE(isPointAlone(info, still));
    for (const std::uint32_t part : {JointInfo::spring, JointInfo::limit, JointInfo::motor}) {
        JointInfo busy = info;
        busy.flags |= part;
        EXPECT_FALSE(isPointAlone(busy, still));
    }
    JointImpulses left = still;
    left.motor = 1.0f;
    EXPECT_FALSE(isPointAlone(info, left)) << "its warm start would be lost";
    info.flags = static_cast<std::uint32_t>(JointKind::Distance);
    EXPECT_FALSE(isPointAlone(info, still));
}

}  // namespace
}  // namespace huestep::test
