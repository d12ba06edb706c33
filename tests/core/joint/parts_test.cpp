// The parts of joints: effective masses against finite differences, and what a rigid solve leaves.

#include "core/joint/parts.h"

#include <array>
#include <cmath>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

const Softness rigid{0.0f, 1.0f, 0.0f};

JointBodies randomBodies(Random& random) {
    JointBodies b;
    b.vA = random.point(-3.0, 3.0);
    b.vB = random.point(-3.0, 3.0);
    b.wA = random.betweenF(-3.0, 3.0);
    b.wB = random.betweenF(-3.0, 3.0);
    b.mA = random.once(5) ? 0.0f : random.betweenF(0.1, 5.0);
    b.iA = b.mA == 0.0f || random.once(5) ? 0.0f : random.betweenF(0.1, 9.0);
    b.mB = random.betweenF(0.1, 5.0);
    b.iB = random.once(5) ? 0.0f : random.betweenF(0.1, 9.0);
    return b;
}

/// How much the rate of a coordinate changes per impulse: the inverse of its effective mass.
template <class Coordinate>
double gainOf(const Coordinate& q, JointBodies b) {
    const double before = wide(q.rate(b));
    q.apply(b, 1.0f);
    return wide(q.rate(b)) - before;
}

TEST(Parts, EffectiveMassesAreTheInverseOfWhatAnImpulseDoes) {
    Random random(101);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 5'000; ++i) {
        const JointBodies b = randomBodies(random);
        const Vec2 u = normalized(random.point(-1.0, 1.0));
        const LinePart line{random.point(-2.0, 2.0), random.point(-2.0, 2.0), u};
        ASSERT_NEAR(wide(line.mass(b)) * gainOf(line, b), 1.0, 1e-4);
        const AxisPart axis;
        if (b.iA + b.iB > 0.0f) {
            ASSERT_NEAR(wide(axis.mass(b)) * gainOf(axis, b), 1.0, 1e-4);
        } else {
            ASSERT_EQ(axis.mass(b), 0.0f) << "nothing that turns";
        }
    }
}

TEST(Parts, ARateIsThatOfTheCoordinateByFiniteDifferences) {
    Random random(102);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 2'000; ++i) {
        const JointBodies b = randomBodies(random);
        const Vec2 rA = random.point(-1.0, 1.0), rB = random.point(-1.0, 1.0);
        const Vec2T<double> centers{3.0, 1.0};
        const auto distanceAt = [&](double t) {
            const auto anchor = [t](Vec2 v, float w, Vec2 r) {
                const double a = wide(w) * t;
                const RotationT<double> q{std::cos(a), std::sin(a)};
                return t * wide(v) + rotate(q, wide(r));
            };
            return length(centers + anchor(b.vB, b.wB, rB) - anchor(b.vA, b.wA, rA));
        };
        const Vec2T<double> d = centers + wide(rB) - wide(rA);
        const double l = length(d);
        const LinePart line{rA, rB, {static_cast<float>(d.x / l), static_cast<float>(d.y / l)}};
        const double t = 1e-5;
        ASSERT_NEAR(wide(line.rate(b)), (distanceAt(t) - distanceAt(-t)) / (2.0 * t), 1e-4);
    }
}

TEST(Parts, ARigidPointStopsAllMotionOfTheAnchorsAndConservesMomentum) {
    Random random(103);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 5'000; ++i) {
        JointBodies b = randomBodies(random);
        b.mA = random.betweenF(0.1, 5.0);
        const JointBodies before = b;
        const Vec2 rA = random.point(-1.0, 1.0), rB = random.point(-1.0, 1.0);
        Vec2 impulse;
        PointPart::solve(b, rA, rB, {}, rigid, impulse);
        ASSERT_LT(length(anchorVelocity(b, rA, rB)), 2e-4f);
        const auto momentum = [](const JointBodies& x) {
            return (1.0 / wide(x.mA)) * wide(x.vA) + (1.0 / wide(x.mB)) * wide(x.vB);
        };
        ASSERT_LT(length(momentum(b) - momentum(before)), 1e-3);
        // What B got is the impulse, and its moment about B's centre.
        ASSERT_NEAR(wide(b.vB.x - before.vB.x), wide(b.mB * impulse.x), 1e-3);
        ASSERT_NEAR(wide(b.wB - before.wB), wide(b.iB * cross(rB, impulse)), 2e-2);
    }
}

/// Row operations on J M⁻¹ Jᵀ of any rows J over (vA, wA, vB, wB), in double: the impulses that
/// make J v zero.
std::vector<double> solvedByRows(const std::vector<std::array<double, 6>>& rows,
                                 const JointBodies& b) {
    const std::array<double, 6> inverse{wide(b.mA), wide(b.mA), wide(b.iA),
                                        wide(b.mB), wide(b.mB), wide(b.iB)};
    const std::array<double, 6> v{wide(b.vA.x), wide(b.vA.y), wide(b.wA),
                                  wide(b.vB.x), wide(b.vB.y), wide(b.wB)};
    const std::size_t n = rows.size();
    std::vector<std::vector<double>> m(n, std::vector<double>(n + 1));
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < 6; ++k) {
            for (std::size_t j = 0; j < n; ++j) m[i][j] += rows[i][k] * inverse[k] * rows[j][k];
            m[i][n] -= rows[i][k] * v[k];
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            if (j == i) continue;
            const double factor = m[j][i] / m[i][i];
            for (std::size_t k = 0; k <= n; ++k) m[j][k] -= factor * m[i][k];
        }
    }
    std::vector<double> impulses;
    for (std::size_t i = 0; i < n; ++i) impulses.push_back(m[i][n] / m[i][i]);
    return impulses;
}

TEST(Parts, PointAndAngleOfAWeldAreThoseOfThreeRowsSolvedTogether) {
    Random random(111);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 5'000; ++i) {
        JointBodies b = randomBodies(random);
        const bool turns = b.iA + b.iB > 0.0f;
        const Vec2 rA = random.point(-2.0, 2.0), rB = random.point(-2.0, 2.0);
        std::vector<std::array<double, 6>> rows{{-1.0, 0.0, wide(rA.y), 1.0, 0.0, -wide(rB.y)},
                                                {0.0, -1.0, -wide(rA.x), 0.0, 1.0, wide(rB.x)}};
        if (turns) rows.push_back({0.0, 0.0, -1.0, 0.0, 0.0, 1.0});
        const std::vector<double> wanted = solvedByRows(rows, b);
        Vec2 impulse;
        float twist = 0.0f;
        FixedPart::solve(b, rA, rB, {}, 0.0f, rigid, impulse, twist);
        ASSERT_NEAR(wide(impulse.x), wanted[0], 2e-4 * (1.0 + std::abs(wanted[0])));
        ASSERT_NEAR(wide(impulse.y), wanted[1], 2e-4 * (1.0 + std::abs(wanted[1])));
        if (turns) {
            ASSERT_NEAR(wide(twist), wanted[2], 2e-4 * (1.0 + std::abs(wanted[2])));
        }
        ASSERT_LT(length(anchorVelocity(b, rA, rB)), 1e-3f);
        if (turns) {
            ASSERT_NEAR(wide(b.wB - b.wA), 0.0, 1e-3);
        }
    }
}

TEST(Parts, PointAndAngleOfASlideAreThoseOfTwoRowsSolvedTogether) {
    Random random(112);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 5'000; ++i) {
        JointBodies b = randomBodies(random);
        const bool turns = b.iA + b.iB > 0.0f;
        const Vec2 n = normalized(random.point(-1.0, 1.0));
        const LinePart across{random.point(-2.0, 2.0), random.point(-2.0, 2.0), n};
        std::vector<std::array<double, 6>> rows{{-wide(n.x), -wide(n.y),
                                                 -cross(wide(across.rA), wide(n)), wide(n.x),
                                                 wide(n.y), cross(wide(across.rB), wide(n))}};
        if (turns) rows.push_back({0.0, 0.0, -1.0, 0.0, 0.0, 1.0});
        const std::vector<double> wanted = solvedByRows(rows, b);
        Vec2 impulse;
        SlidePart::solve(b, across, 0.0f, 0.0f, rigid, impulse);
        ASSERT_NEAR(wide(impulse.x), wanted[0], 2e-4 * (1.0 + std::abs(wanted[0])));
        if (turns) {
            ASSERT_NEAR(wide(impulse.y), wanted[1], 2e-4 * (1.0 + std::abs(wanted[1])));
        }
        ASSERT_NEAR(wide(across.rate(b)), 0.0, 1e-3);
        if (turns) {
            ASSERT_NEAR(wide(b.wB - b.wA), 0.0, 1e-3);
        }
    }
}

TEST(Parts, APointNeverPullsHarderThanItMay) {
    Random random(104);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 2'000; ++i) {
        JointBodies b = randomBodies(random);
        Vec2 impulse;
        const float most = random.betweenF(0.0, 0.5);
        for (int k = 0; k < 5; ++k) {
            PointPart::solve(b, {0.3f, 0.0f}, {0.0f, 0.4f}, {5.0f, 5.0f},
                             softness(5.0f, 0.7f, 1.0f / 240.0f), impulse, most);
            ASSERT_LE(length(impulse), most * 1.00001f);
        }
    }
}

TEST(Parts, AMotorReachesItsSpeedOrItsTorqueWhicheverComesFirst) {
    Random random(105);
    SCOPED_TRACE(random.trace());
    int limited = 0;
    for (int i = 0; i < 5'000; ++i) {
        JointBodies b = randomBodies(random);
        b.iB = random.betweenF(0.1, 9.0);
        const float speed = random.betweenF(-5.0, 5.0), most = random.betweenF(0.0, 3.0);
        float impulse = 0.0f;
        solveMotor(b, AxisPart{}, speed, most, impulse);
        ASSERT_LE(std::abs(impulse), most);
        if (std::abs(impulse) < most) {
            ASSERT_NEAR(wide(b.wB - b.wA), wide(speed), 1e-4);
        } else {
            ++limited;
            ASSERT_EQ(impulse > 0.0f, b.wB - b.wA < speed) << "it pushes the right way";
        }
    }
    EXPECT_GT(limited, 500);
}

TEST(Parts, ALimitPushesOneWayAloneAndLetsAGapCloseWithinTheSubstep) {
    Random random(106);
    SCOPED_TRACE(random.trace());
    const float h = 1.0f / 240.0f;
    for (int i = 0; i < 5'000; ++i) {
        JointBodies b = randomBodies(random);
        b.iB = random.betweenF(0.1, 9.0);
        const JointBodies before = b;
        const float sign = random.once(2) ? 1.0f : -1.0f;
        const float gap = random.betweenF(0.0, 0.02);
        float impulse = 0.0f;
        solveLimit(b, AxisPart{}, sign, gap, 1.0f / h, rigid, impulse);
        ASSERT_GE(impulse, 0.0f);
        const float was = sign * (before.wB - before.wA), is = sign * (b.wB - b.wA);
        const float fastest = -gap / h;  // closes exactly
        if (was >= fastest) {
            ASSERT_EQ(is, was) << "no business here";
        } else {
            ASSERT_NEAR(wide(is), wide(fastest), 1e-3);
        }
    }
}

TEST(Parts, SoftnessIsThatOfADampedOscillatorByItsFormula) {
    Random random(107);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 2'000; ++i) {
        const double hertz = random.between(0.1, 200.0), zeta = random.between(0.0, 20.0);
        const double h = random.between(1e-4, 0.05);
        const Softness s =
            softness(static_cast<float>(hertz), static_cast<float>(zeta), static_cast<float>(h));
        const double omega = 2.0 * M_PI * hertz;
        // Implicit Euler of m x'' + c x' + k x = 0 with k = m ω², c = 2 m ζ ω: a soft row of
        // compliance 1/(h (h k + c)) and bias k/(h k + c).
        const double k = omega * omega, c = 2.0 * zeta * omega;
        const double bias = k / (h * k + c);
        const double compliance = 1.0 / (h * (h * k + c));  // times the effective mass 1
        ASSERT_NEAR(wide(s.biasRate) / bias, 1.0, 1e-4);
        ASSERT_NEAR(wide(s.massScale) * (1.0 + compliance), 1.0, 1e-4);
        ASSERT_NEAR(wide(s.impulseScale) * (1.0 + compliance) / compliance, 1.0, 1e-3);
    }
    EXPECT_EQ(softness(0.0f, 1.0f, 0.01f).massScale, 1.0f);
    EXPECT_EQ(softness(0.0f, 1.0f, 0.01f).impulseScale, 0.0f);
}

}  // namespace
}  // namespace huestep::test
