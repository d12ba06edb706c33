// Revolute joints in lanes: the bits of the one by one form, at every width.

#include "core/joint/revolute_block.h"

#include <algorithm>
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
    std::vector<RevoluteBlock> blocks;
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
    const bool pins = random.once(3);
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
        RevoluteBlock& block = f.blocks[i / blockLanes];
        if (i >= count) {
            clearRevoluteLane(block, i % blockLanes);
            continue;
        }
        JointRow row{};
        const auto end = [&](BodyPlace& place, float& m, float& inertia, bool mayBeStill) {
            if (mayBeStill && random.once(4)) {
                place = random.once(2) ? fixedWorld : ~kinematic;
                return;
            }
            place = body();
            m = f.bodies.back().inverseMass = random.betweenF(0.01, 3.0);
            inertia = random.once(5) ? 0.0f : random.betweenF(0.01, 30.0);
        };
        end(row.bodyA, row.mA, row.iA, true);
        end(row.bodyB, row.mB, row.iB, row.bodyA >= 0);
        row.anchorA = {number(2.0), number(2.0)};
        row.anchorB = {number(2.0), number(2.0)};
        row.centers = {number(2.0), number(2.0)};
        row.impulses.point = {number(9.0), number(9.0)};
        // Every third field is of pins alone: their blocks skip the other parts.
        if (!pins) {
            const auto maybe = [&](std::uint32_t part) {
                if (random.once(2)) row.flags |= part;
            };
            maybe(JointInfo::spring);
            maybe(JointInfo::motor);
            maybe(JointInfo::limit);
            const double angle = random.between(-3.1, 3.1);
            row.angle = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
            row.spring = {random.betweenF(0.0, 50.0), random.betweenF(0.0, 1.0),
                          random.betweenF(0.0, 1.0)};
            row.motorSpeed = number(5.0);
            row.motorMaxEffort = random.betweenF(0.0, 100.0);
            row.lower = random.betweenF(-2.0, 0.0);
            row.upper = random.betweenF(0.0, 2.0);
            row.impulses.spring = number(1.0);
            row.impulses.motor = number(1.0);
            row.impulses.lower = std::max(number(1.0), 0.0f);
            row.impulses.upper = std::max(number(1.0), 0.0f);
        }
        f.rows.push_back(row);
        setRevoluteLane(block, i % blockLanes, row);
    }
    for (RevoluteBlock& block : f.blocks) findParts(block);
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
        const RevoluteBlock& block = wide.blocks[i / blockLanes];
        const std::size_t lane = i % blockLanes;
        const JointImpulses impulses{{block.impulseX[lane], block.impulseY[lane]},
                                     block.springImpulse[lane],
                                     block.motorImpulse[lane],
                                     block.lowerImpulse[lane],
                                     block.upperImpulse[lane]};
        EXPECT_TRUE(same(&impulses, &single.rows[i].impulses, sizeof impulses / 4))
            << what << ": joint " << i;
    }
}

TEST(RevoluteLanes, GiveTheBitsOfJointsOneByOneAtEveryWidth) {
    Random random(2024);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 300 && !HasFailure(); ++trial) {
        const Field start = randomField(random, 1 + random.below(40), trial % 3 == 0);
        JointPass biased;
        biased.h = 1.0f / 240.0f;
        biased.inverseH = 240.0f;
        biased.soft = {random.betweenF(1.0, 100.0), random.betweenF(0.1, 1.0),
                       random.betweenF(0.0, 0.5)};
        JointPass relaxed = biased;
        relaxed.soft = {};
        Field single = start;
        for (const JointRow& row : single.rows) warmStartJoint(single.bodies.data(), row);
        for (JointRow& row : single.rows) solveJoint(single.bodies.data(), row, biased);
        for (JointRow& row : single.rows) solveJoint(single.bodies.data(), row, relaxed);
        for (const Simd simd : availableSimd()) {
            const RevoluteKernels& kernels = revoluteKernels(simd);
            Field wide = start;
            const auto count = static_cast<std::uint32_t>(wide.rows.size());
            kernels.warmStart(wide.bodies.data(), wide.blocks.data(), count, biased);
            kernels.solve(wide.bodies.data(), wide.blocks.data(), count, biased);
            kernels.solve(wide.bodies.data(), wide.blocks.data(), count, relaxed);
            expectSame(wide, single, std::string(nameOf(simd)));
        }
    }
}

TEST(RevoluteLanes, CorrectPositionsAsJointsOneByOneDoAtEveryWidth) {
    Random random(2025);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 200 && !HasFailure(); ++trial) {
        const Field start = randomField(random, 1 + random.below(40), false);
        Field single = start;
        for (const JointRow& row : single.rows) correctJoint(single.bodies.data(), row);
        for (const Simd simd : availableSimd()) {
            Field wide = start;
            revoluteKernels(simd).correct(wide.bodies.data(), wide.blocks.data(),
                                          static_cast<std::uint32_t>(wide.rows.size()), {});
            expectSame(wide, single, std::string(nameOf(simd)));
        }
    }
}

}  // namespace
}  // namespace huestep::test
