// Rows of rigid joints: derivatives against differences of what they are derivatives of.
#include "core/joint/rigid_rows.h"

#include <functional>

#include "core/math/trig.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

constexpr std::array kinds{JointKind::Revolute, JointKind::Weld, JointKind::Distance,
                           JointKind::Prismatic};

/// A joint that holds only roughly, of bodies that have moved.
struct Case {
    JointRow row;
    BodyDelta a, b;
};

Case randomCase(JointKind kind, Random& random) {
    Case c;
    c.row.kind = kind;
    c.row.anchorA = random.point(-2.0, 2.0);
    c.row.anchorB = random.point(-2.0, 2.0);
    c.row.centers = random.point(-3.0, 3.0);
    c.row.axis = rotate(rotationOf(random.betweenF(-3.0, 3.0)), {1.0f, 0.0f});
    c.row.length = random.betweenF(0.5, 3.0);
    c.row.angle = rotationOf(random.betweenF(-0.5, 0.5));
    c.a = {random.point(-0.5, 0.5), rotationOf(random.betweenF(-0.5, 0.5))};
    c.b = {random.point(-0.5, 0.5), rotationOf(random.betweenF(-0.5, 0.5))};
    return c;
}

/// The case with one coordinate moved: 0 to 2 of A, 3 to 5 of B; x, y, angle.
Case movedBy(Case c, std::size_t coordinate, float by) {
    BodyDelta& body = coordinate < 3 ? c.a : c.b;
    if (coordinate % 3 == 0) body.moved.x += by;
    if (coordinate % 3 == 1) body.moved.y += by;
    if (coordinate % 3 == 2) body.turned = compose(rotationOf(by), body.turned);
    return c;
}

double derivative(const Case& c, std::size_t coordinate,
                  const std::function<double(const Case&)>& of) {
    const float step = 0x1p-6f;
    const auto at = [&](float by) { return of(movedBy(c, coordinate, by)); };
    // Of fourth order: what is left is a few 1e-6 in single precision.
    return (8.0 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12.0 * wide(step));
}

double jacobian(const Case& c, std::uint32_t row, std::size_t coordinate) {
    const RigidRow r = rigidRows(c.row, c.a, c.b)[row];
    const std::array<float, 6> all{-r.n.x, -r.n.y, -r.armA, r.n.x, r.n.y, r.armB};
    return wide(all[coordinate]);
}

TEST(RigidRows, AreTheDerivativesOfTheirErrors) {
    Random random(61);
    SCOPED_TRACE(random.trace());
    for (std::size_t i = 0; i < 400; ++i) {
        const Case c = randomCase(kinds[i % kinds.size()], random);
        const Vec2 between =
            (c.row.centers + c.b.moved - c.a.moved) +
            (rotate(c.b.turned, c.row.anchorB) - rotate(c.a.turned, c.row.anchorA));
        if (length(between) < 0.5f) continue;  // a distance has no direction there
        for (std::uint32_t row = 0; row < rigidRowCount(c.row); ++row) {
            for (std::size_t k = 0; k < 6; ++k) {
                const double difference = derivative(c, k, [&](const Case& at) {
                    return wide(rigidErrors(at.row, at.a, at.b)[row]);
                });
                EXPECT_NEAR(jacobian(c, row, k), difference, 2e-3)
                    << "case " << i << ", row " << row << ", coordinate " << k;
            }
        }
    }
}

/// Second derivative of −λ·C by one coordinate.
double stiffness(const Case& c, const RigidValues& impulses, std::size_t coordinate) {
    return -derivative(c, coordinate, [&](const Case& at) {
        double force = 0.0;
        for (std::uint32_t row = 0; row < rigidRowCount(c.row); ++row) {
            force += wide(impulses[row]) * jacobian(at, row, coordinate);
        }
        return force;
    });
}

TEST(RigidRows, StiffnessOfPinsAndSlidesIsTheSecondDerivativeOfTheirWork) {
    Random random(62);
    SCOPED_TRACE(random.trace());
    for (std::size_t i = 0; i < 400; ++i) {
        const JointKind kind = kinds[i % kinds.size()];
        const Case c = randomCase(kind, random);
        if (kind == JointKind::Distance) continue;
        const RigidValues impulses{random.betweenF(-5.0, 5.0), random.betweenF(-5.0, 5.0),
                                   random.betweenF(-5.0, 5.0)};
        const JointStiffness k = geometricStiffness(c.row, impulses, c.a, c.b);
        EXPECT_NEAR(wide(k.a.angular), stiffness(c, impulses, 2), 2e-2) << "case " << i;
        EXPECT_NEAR(wide(k.b.angular), stiffness(c, impulses, 5), 2e-2) << "case " << i;
        EXPECT_EQ(k.a.linear, 0.0f);
        EXPECT_EQ(k.b.linear, 0.0f);
    }
}

TEST(RigidRows, StiffnessOfARopeBoundsTheSecondDerivativesOfItsWork) {
    Random random(63);
    SCOPED_TRACE(random.trace());
    int pulled = 0;
    for (std::size_t i = 0; i < 400; ++i) {
        Case c = randomCase(JointKind::Distance, random);
        const Vec2 between =
            (c.row.centers + c.b.moved - c.a.moved) +
            (rotate(c.b.turned, c.row.anchorB) - rotate(c.a.turned, c.row.anchorA));
        if (length(between) < 0.5f) continue;
        const RigidValues impulses{random.betweenF(-5.0, 0.0)};
        const JointStiffness k = geometricStiffness(c.row, impulses, c.a, c.b);
        // Both ends of a rope that swing against each other feel it twice.
        EXPECT_GE(wide(k.a.linear), 2.0 * stiffness(c, impulses, 0) - 2e-2) << "case " << i;
        EXPECT_GE(wide(k.b.linear), 2.0 * stiffness(c, impulses, 4) - 2e-2) << "case " << i;
        EXPECT_GE(wide(k.a.angular), stiffness(c, impulses, 2) - 2e-2) << "case " << i;
        EXPECT_GE(wide(k.b.angular), stiffness(c, impulses, 5) - 2e-2) << "case " << i;
        EXPECT_EQ(geometricStiffness(c.row, {5.0f}, c.a, c.b).a.linear, 0.0f) << "a pole";
        ++pulled;
    }
    EXPECT_GT(pulled, 300);
}

TEST(RigidRows, ImpulsesComeBackAsTheyWerePut) {
    for (const JointKind kind : kinds) {
        JointRow row;
        row.kind = kind;
        RigidValues impulses{};
        for (std::uint32_t i = 0; i < rigidRowCount(row); ++i) {
            impulses[i] = static_cast<float>(i + 1);
        }
        setRigidImpulses(row, impulses);
        EXPECT_EQ(rigidImpulses(row), impulses);
    }
}

TEST(RigidRows, SpringsAndRangesHoldNothing) {
    const auto countOf = [](JointKind kind, std::uint32_t flags) {
        JointRow row;
        row.kind = kind;
        row.flags = flags;
        return rigidRowCount(row);
    };
    EXPECT_EQ(countOf(JointKind::Revolute, JointInfo::spring | JointInfo::limit), 2u);
    EXPECT_EQ(countOf(JointKind::Prismatic, JointInfo::motor), 2u);
    EXPECT_EQ(countOf(JointKind::Weld, 0), 3u);
    EXPECT_EQ(countOf(JointKind::Weld, JointInfo::spring), 2u);
    EXPECT_EQ(countOf(JointKind::Distance, 0), 1u);
    EXPECT_EQ(countOf(JointKind::Distance, JointInfo::spring), 0u);
    EXPECT_EQ(countOf(JointKind::Distance, JointInfo::limit), 0u);
    EXPECT_EQ(countOf(JointKind::Mouse, 0), 0u);
}

}  // namespace
}  // namespace huestep::test
