// Projected Gauss-Seidel against a dense complementarity problem solved in double, and what its two
// ways to keep positions do to an overlap.

#include "core/solver/pgs.h"

#include <bit>
#include <optional>

#include "core/math/trig.h"
#include "tests/core/joint/jointed.h"
#include "tests/core/solver/line_of_discs.h"

namespace huestep::test {
namespace {

constexpr double dt = 1.0 / 60.0;

/// Solves a x = b by elimination with pivots; none where it is singular.
std::optional<std::vector<double>> solved(std::vector<std::vector<double>> a,
                                          std::vector<double> b) {
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k; i < n; ++i) {
            if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
        }
        if (std::abs(a[pivot][k]) < 1e-12) return std::nullopt;
        std::swap(a[k], a[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t i = 0; i < n; ++i) {
            if (i == k) continue;
            const double f = a[i][k] / a[k][k];
            for (std::size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    for (std::size_t k = 0; k < n; ++k) b[k] /= a[k][k];
    return b;
}

/// Velocities after a step of rigid rows: λ ≥ 0, w = A λ + b ≥ 0, λ·w = 0, found by trying every
/// set of rows that push. `bias(gap)`: the speed at which a gap may close, or must open if > 0.
template <class Bias>
std::vector<double> exactVelocities(const LineOfDiscs& line, Bias&& bias) {
    const std::size_t rows = line.size() - 1;
    std::vector<std::vector<double>> a(rows, std::vector<double>(rows, 0.0));
    std::vector<double> b(rows);
    for (std::size_t i = 0; i < rows; ++i) {
        a[i][i] = 1.0 / line.mass[i] + 1.0 / line.mass[i + 1];
        if (i + 1 < rows) a[i][i + 1] = a[i + 1][i] = -1.0 / line.mass[i + 1];
        b[i] = line.velocity[i + 1] - line.velocity[i] - bias(line.gap(i));
    }
    for (std::uint32_t set = 0; set < (1u << rows); ++set) {
        std::vector<std::size_t> pushing;
        for (std::size_t i = 0; i < rows; ++i) {
            if ((set >> i & 1u) != 0) pushing.push_back(i);
        }
        std::vector<std::vector<double>> part;
        std::vector<double> rhs;
        for (const std::size_t i : pushing) {
            part.emplace_back();
            for (const std::size_t j : pushing) part.back().push_back(a[i][j]);
            rhs.push_back(-b[i]);
        }
        const auto found = solved(part, rhs);
        if (!found) continue;
        std::vector<double> impulse(rows, 0.0);
        for (std::size_t k = 0; k < pushing.size(); ++k) impulse[pushing[k]] = (*found)[k];
        bool fits = true;
        for (std::size_t i = 0; i < rows; ++i) {
            double w = b[i];
            for (std::size_t j = 0; j < rows; ++j) w += a[i][j] * impulse[j];
            fits = fits && impulse[i] > -1e-9 && w > -1e-9;
        }
        if (!fits) continue;
        std::vector<double> v = line.velocity;
        for (std::size_t i = 0; i < rows; ++i) {
            v[i] -= impulse[i] / line.mass[i];
            v[i + 1] += impulse[i] / line.mass[i + 1];
        }
        return v;
    }
    ADD_FAILURE() << "every such problem has a solution";
    return line.velocity;
}

/// Some discs overlap, some have a gap, some come together, some part.
LineOfDiscs mixedLine(Random& random) {
    LineOfDiscs line;
    double x = 0.0;
    for (int i = 0; i < 7; ++i) {
        line.mass.push_back(random.between(1.0, 4.0));
        line.position.push_back(x);
        line.velocity.push_back(random.between(-1.0, 1.0));
        x += 1.0 + random.between(-0.03, 0.015);
    }
    return line;
}

/// The largest difference of velocities from the exact ones, m/s.
template <class Bias>
double apartFromExact(const LineOfDiscs& line, Method method, std::uint32_t iterations,
                      Bias&& bias) {
    Scene scene = sceneOf(line);
    scene.method = method;
    scene.substeps = iterations;
    World world = worldOf(scene);
    world.step({});
    LineOfDiscs exact = line;
    exact.velocity = exactVelocities(line, bias);
    return distanceOf(world, exact);
}

TEST(Pgs, ConvergesToTheSolutionOfTheDenseProblem) {
    Random random(501);
    SCOPED_TRACE(random.trace());
    const auto baumgarte = [](double gap) {
        return gap > 0.0 ? -gap / dt : std::min(-0.2 / dt * std::min(gap + 0.005, 0.0), 4.0);
    };
    const auto none = [](double gap) { return gap > 0.0 ? -gap / dt : 0.0; };
    double first = 0.0;
    for (int trial = 0; trial < 20; ++trial) {
        const LineOfDiscs line = mixedLine(random);
        EXPECT_LT(apartFromExact(line, Method::Pgs, 64, baumgarte), 2e-4);
        EXPECT_LT(apartFromExact(line, Method::PgsNgs, 64, none), 2e-4);
        first = std::max(first, apartFromExact(line, Method::Pgs, 2, baumgarte));
    }
    EXPECT_GT(first, 1e-2) << "two iterations are not enough";
}

/// Two discs of 1 kg and of 3 kg at rest, with an overlap.
LineOfDiscs overlapping(double by) {
    return {{1.0, 3.0}, {0.0, 1.0 - by}, {0.0, 0.0}};
}

World afterAStep(const LineOfDiscs& line, Method method, std::uint32_t iterations) {
    Scene scene = sceneOf(line);
    scene.method = method;
    scene.substeps = iterations;
    World world = worldOf(scene);
    world.step({});
    return world;
}

TEST(Pgs, PushesAnOverlapApartAtAFifthOfWhatIsBeyondTheSlopAndAtFourMetresASecondAtMost) {
    for (const double overlap : {0.004, 0.03, 0.1, 0.5}) {
        const World world = afterAStep(overlapping(overlap), Method::Pgs, 4);
        const double speed = std::min(0.2 / dt * std::max(overlap - 0.005, 0.0), 4.0);
        const double apart =
            wide(world.motions()[1].velocity.x) - wide(world.motions()[0].velocity.x);
        EXPECT_NEAR(apart, speed, 1e-4) << overlap;
        EXPECT_NEAR(wide(world.motions()[0].velocity.x), -0.75 * speed, 1e-4);
    }
}

TEST(PgsNgs, TakesAFifthOfTheOverlapBeyondTheSlopAwayInEachOfHalfAsManySweeps) {
    for (const std::uint32_t iterations : {1u, 2u, 8u}) {
        const double overlap = 0.1;
        const World world = afterAStep(overlapping(overlap), Method::PgsNgs, iterations);
        const double sweeps = (iterations + 1) / 2;
        const double left = 0.005 + (overlap - 0.005) * std::pow(0.8, sweeps);
        const BodyMotion &a = world.motions()[0], &b = world.motions()[1];
        EXPECT_NEAR(wide(b.position.x) - wide(a.position.x), 1.0 - left, 1e-5) << iterations;
        EXPECT_NEAR(wide(a.position.x), -3.0 * (wide(b.position.x) - 0.9), 1e-5) << "by mass";
        EXPECT_EQ(a.velocity, Vec2{});
        EXPECT_EQ(b.velocity, Vec2{});
    }
}

TEST(PgsNgs, MovesAnOverlapByAFifthOfAMetreAtMost) {
    Scene scene = sceneOf({discAt({}, 10.0f), discAt({17.0f, 0.0f}, 10.0f)});
    scene.gravity = {};
    scene.method = Method::PgsNgs;
    scene.substeps = 1;
    World world = worldOf(scene);
    world.step({});
    EXPECT_NEAR(wide(motionOf(world, 2).position.x) - wide(motionOf(world, 1).position.x), 17.2,
                1e-4);
}

TEST(PgsNgs, BringsEveryKindOfJointToWhereItHoldsWithoutAVelocity) {
    for (const JointKind kind :
         {JointKind::Revolute, JointKind::Distance, JointKind::Weld, JointKind::Prismatic}) {
        JointDef joint = hinge(0, {1.0f, 0.0f}, 1, {-1.0f, 0.0f});
        joint.kind = kind;
        joint.length = 0.5f;
        Scene scene = sceneOf({boxAt({}), boxAt({2.2f, 0.3f})}, {joint});
        scene.bodies[1].rotation = rotationOf(0.1f);
        scene.gravity = {};
        scene.method = Method::PgsNgs;
        scene.substeps = 8;
        World world = worldOf(scene);
        const double before = errorOf(world);
        ASSERT_GT(before, 0.03);
        world.step({});
        EXPECT_LT(errorOf(world), 1e-3 * before) << static_cast<int>(kind);
        EXPECT_EQ(motionOf(world, 2).velocity, Vec2{});
    }
}

TEST(PgsNgs, LeavesSpringsAndMotorsAlone) {
    JointDef joint = hinge(0, {}, 1, {-1.0f, 0.0f});
    joint.kind = JointKind::Distance;
    joint.length = 0.5f;
    joint.spring = {true, 1.0f, 0.5f};
    Scene scene = sceneOf({BodyDef{}, boxAt({2.0f, 0.0f})}, {joint});
    scene.gravity = {};
    scene.method = Method::PgsNgs;
    World world = worldOf(scene);
    world.step({});
    const BodyMotion m = motionOf(world, 2);
    EXPECT_LT(wide(m.velocity.x), -0.05) << "the spring pulls";
    EXPECT_NEAR(wide(m.position.x), 2.0 + dt * wide(m.velocity.x), 1e-6)
        << "and nothing else moves the box";
}

}  // namespace
}  // namespace huestep::test
