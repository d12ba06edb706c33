// Three scenes once more by another method each, written for this test alone: the reference solver
// must not be judged by its own kind.
//   two boxes upon each other that slide: Lemke's method on the equations of Stewart and Trinkle
//   a box that tips over a corner: the equation of the pendulum that it is until it lands
//   boxes that slide on a hinged bar: springs and dashpots at steps of two microseconds
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "tests/tools/reference/lemke.h"
#include "tools/metrics/scenes.h"
#include "tools/reference/linkage.h"
#include "tools/reference/reference_world.h"

namespace huestep::reference {
namespace {

constexpr double g = 10.0;

std::vector<Body> solved(const Scene& scene, std::uint64_t ticks, int substeps) {
    Accuracy accuracy;
    accuracy.substeps = substeps;
    const Result<Trajectory> trajectory = follow(*World::create(scene), ticks, accuracy);
    EXPECT_TRUE(trajectory.ok());
    testing::Test::RecordProperty("uncertainty", std::to_string(trajectory->uncertainty));
    return trajectory->ticks.back();
}

// ---- Lemke ------------------------------------------------------------------------------------

/// Unit boxes of 1 kg: x, y and the angle of each; the angle stays 0 to the last bit but for
/// rounding, so that faces stay parallel.
struct Boxes {
    std::array<double, 6> at{};    // x, y, angle of the lower, then of the upper
    std::array<double, 6> pace{};  // their rates
    static constexpr std::array<double, 6> inverseMass{1.0, 1.0, 6.0, 1.0, 1.0, 6.0};
};

struct Row {
    std::array<double, 6> normal{}, tangent{};
    double gap = 0.0, friction = 0.0;
};

/// Of a point of the upper of two bodies (none: the lower one is the floor), in the plane.
Row rowAt(const Boxes& boxes, double x, double y, bool onFloor, double gap, double friction) {
    Row row;
    row.gap = gap;
    row.friction = friction;
    const auto act = [&](std::size_t body, double sign) {
        const std::size_t i = 3 * body;
        row.normal[i + 1] = sign;
        row.normal[i + 2] = sign * (x - boxes.at[i]);
        row.tangent[i] = sign;
        row.tangent[i + 2] = -sign * (y - boxes.at[i + 1]);
    };
    act(onFloor ? 0 : 1, 1.0);
    if (!onFloor) act(0, -1.0);
    return row;
}

double product(const std::array<double, 6>& a, const std::array<double, 6>& b, bool byMass) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i] * (byMass ? Boxes::inverseMass[i] : 1.0);
    return sum;
}

/// One step: unknowns λn, λt+, λt−, σ of each point.
void stewartTrinkle(Boxes& boxes, const std::vector<Row>& rows, double h) {
    std::array<double, 6> free = boxes.pace;
    free[1] -= h * g;
    free[4] -= h * g;
    const std::size_t n = rows.size();
    test::Lemke::Matrix m(4 * n, std::vector<double>(4 * n, 0.0));
    std::vector<double> q(4 * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            const double nn = product(rows[i].normal, rows[j].normal, true);
            const double nt = product(rows[i].normal, rows[j].tangent, true);
            const double tn = product(rows[i].tangent, rows[j].normal, true);
            const double tt = product(rows[i].tangent, rows[j].tangent, true);
            const std::size_t r = 4 * i;
            const std::size_t c = 4 * j;
            m[r][c] = nn, m[r][c + 1] = nt, m[r][c + 2] = -nt;
            m[r + 1][c] = tn, m[r + 1][c + 1] = tt, m[r + 1][c + 2] = -tt;
            m[r + 2][c] = -tn, m[r + 2][c + 1] = -tt, m[r + 2][c + 2] = tt;
        }
        const std::size_t r = 4 * i;
        m[r + 1][r + 3] = m[r + 2][r + 3] = 1.0;
        m[r + 3][r] = rows[i].friction, m[r + 3][r + 1] = m[r + 3][r + 2] = -1.0;
        q[r] = product(rows[i].normal, free, false) + rows[i].gap / h;
        q[r + 1] = product(rows[i].tangent, free, false);
        q[r + 2] = -q[r + 1];
        for (std::size_t k = 0; k < 4; ++k) q[r + k] += 1e-13 * static_cast<double>(r + k + 1);
    }
    const std::optional<std::vector<double>> z = test::Lemke::solve(m, q);
    ASSERT_TRUE(z.has_value());
    for (std::size_t k = 0; k < 6; ++k) {
        double after = free[k];
        for (std::size_t i = 0; i < n; ++i) {
            const double tangent = (*z)[4 * i + 1] - (*z)[4 * i + 2];
            after += Boxes::inverseMass[k] *
                     (rows[i].normal[k] * (*z)[4 * i] + rows[i].tangent[k] * tangent);
        }
        boxes.at[k] += 0.5 * h * (boxes.pace[k] + after);
        boxes.pace[k] = after;
    }
}

TEST(SecondMethod, LemkesFindsTwoBoxesThatSlideUponEachOtherInTheSamePlace) {
    constexpr double lowerFriction = 0.3, upperFriction = 0.2, floorFriction = 0.6;
    Scene scene = tools::straightStack(2);
    scene.bodies[1].velocity = {3.0f, 0.0f};
    scene.bodies[1].shapes[0].material.friction = static_cast<float>(lowerFriction);
    scene.bodies[2].shapes[0].material.friction = static_cast<float>(upperFriction);
    const std::vector<Body> there = solved(scene, 12, 64);

    const double below = std::sqrt(lowerFriction * floorFriction);
    const double between = std::sqrt(lowerFriction * upperFriction);
    Boxes boxes;
    boxes.at = {0.0, 0.5, 0.0, 0.0, 1.5, 0.0};
    boxes.pace = {3.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    constexpr int steps = 400;
    for (int step = 0; step < steps; ++step) {
        const double left = std::max(boxes.at[0], boxes.at[3]) - 0.5;
        const double right = std::min(boxes.at[0], boxes.at[3]) + 0.5;
        const double floorGap = boxes.at[1] - 0.5;
        const double gap = boxes.at[4] - boxes.at[1] - 1.0;
        stewartTrinkle(boxes,
                       {rowAt(boxes, boxes.at[0] - 0.5, 0.0, true, floorGap, below),
                        rowAt(boxes, boxes.at[0] + 0.5, 0.0, true, floorGap, below),
                        rowAt(boxes, left, boxes.at[1] + 0.5, false, gap, between),
                        rowAt(boxes, right, boxes.at[1] + 0.5, false, gap, between)},
                       0.2 / steps);
        if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_NEAR(there[1].position.x, boxes.at[0], 1e-6);
    EXPECT_NEAR(there[2].position.x, boxes.at[3], 1e-6);
    EXPECT_NEAR(there[1].velocity.x, boxes.pace[0], 1e-6);
    EXPECT_NEAR(there[2].velocity.x, boxes.pace[3], 1e-6);
    EXPECT_GT(boxes.at[0] - boxes.at[3], 0.2) << "they must slide on each other";
}

// ---- A pendulum upside down ---------------------------------------------------------------------

TEST(SecondMethod, TheEquationOfAPendulumFindsABoxThatTipsOverItsCornerInTheSamePlace) {
    Scene hinged = tools::awake(false);
    const std::uint32_t post = tools::add(hinged, BodyDef{});
    BodyDef box = tools::tippingBox().bodies[1];
    box.shapes[0].filter.group = -1;
    tools::hinge(hinged, post, tools::add(hinged, box), {0.0f, 0.0f});
    const LinkageSolution exact = solveLinkage(*Linkage::find(*World::create(hinged)), 18.0 / 60.0);

    const std::vector<Body> there = solved(tools::tippingBox(), 18, 256);
    EXPECT_NEAR(there[1].position.x, exact.linkage.position(1).x, 1e-4);
    EXPECT_NEAR(there[1].position.y, exact.linkage.position(1).y, 1e-4);
    EXPECT_NEAR(there[1].angle, exact.linkage.angle(1), 1e-4);
    EXPECT_LT(there[1].angle, 0.2) << "it must have tipped";
}

// ---- Springs and dashpots -----------------------------------------------------------------------

/// A box of 0.5 m upon a bar of 4 m × 0.2 m that is hinged at its middle.
struct Loose {
    double mass, x, y, angle = 0.0, vx = 0.0, vy = 0.0, spin = 0.0;
};

/// What a corner of the box pushes the bar with, and is pushed with itself.
void pressCorner(Loose& box, double side, double angle, double rate, double h, double& torque) {
    constexpr double stiffness = 2e6, damping = 500.0, creep = 1e-4;  // N/m, N·s/m, m/s
    constexpr double quarter = 0.25, top = 0.1, friction = 0.3;       // √(0.15 · 0.6)
    const double rx = std::cos(box.angle) * side * quarter + std::sin(box.angle) * quarter;
    const double ry = std::sin(box.angle) * side * quarter - std::cos(box.angle) * quarter;
    const double x = box.x + rx, y = box.y + ry;
    const double nx = -std::sin(angle), ny = std::cos(angle);
    const double depth = top - (x * nx + y * ny);
    const double vx = box.vx - box.spin * ry + rate * y;
    const double vy = box.vy + box.spin * rx - rate * x;
    const double normal = std::max(0.0, stiffness * depth - damping * (vx * nx + vy * ny));
    if (depth <= 0.0 || normal <= 0.0) return;
    const double slip = vx * ny - vy * nx;
    const double drag = -friction * normal * std::clamp(slip / creep, -1.0, 1.0);
    const double fx = normal * nx + drag * ny, fy = normal * ny - drag * nx;
    box.vx += h * fx / box.mass;
    box.vy += h * fy / box.mass;
    box.spin += h * (rx * fy - ry * fx) / (box.mass * (0.25 + 0.25) / 12.0);
    torque -= x * fy - y * fx;
}

TEST(SecondMethod, SpringsAndDashpotsFindBoxesThatSlideOnAHingedBarInTheSamePlace) {
    const std::vector<Body> there = solved(tools::seesaw(), 45, 256);
    constexpr double h = 2e-6;
    constexpr double inertia = 0.8 * (16.0 + 0.04) / 12.0;  // of the bar, kg·m²
    double angle = 0.0, rate = 0.0;
    std::array<Loose, 2> boxes{Loose{0.25, -1.2, 0.35}, Loose{0.75, 1.2, 0.35}};
    for (int step = 0; step < 375'000; ++step) {
        double torque = 0.0;
        for (Loose& box : boxes) {
            box.vy -= h * g;
            const Loose before = box;
            Loose pushed = before;
            for (const double side : {-1.0, 1.0}) {
                Loose one = before;  // both corners see the same motion
                pressCorner(one, side, angle, rate, h, torque);
                pushed.vx += one.vx - before.vx;
                pushed.vy += one.vy - before.vy;
                pushed.spin += one.spin - before.spin;
            }
            box = pushed;
            box.x += h * box.vx;
            box.y += h * box.vy;
            box.angle += h * box.spin;
        }
        rate += h * torque / inertia;
        angle += h * rate;
    }
    EXPECT_NEAR(there[1].angle, angle, 1e-3);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(there[i + 2].position.x, boxes[i].x, 1e-3);
        EXPECT_NEAR(there[i + 2].position.y, boxes[i].y, 1e-3);
    }
    EXPECT_GT(boxes[0].x, -1.0) << "it must have slid";
}

}  // namespace
}  // namespace huestep::reference
