// Jacobi sweeps against a line of discs in double, and what mass splitting keeps and mends.

#include "core/solver/jacobi.h"

#include <algorithm>
#include <numeric>

#include "core/scene/measure.h"
#include "tests/core/solver/line_of_discs.h"

namespace huestep::test {
namespace {

double stepApart(const LineOfDiscs& start, Method method, Order order, std::uint32_t substeps) {
    Scene scene = sceneOf(start);
    scene.method = method;
    scene.substeps = substeps;
    World world = worldOf(scene);
    world.step({});
    LineOfDiscs line = start;
    softStepOf(line, static_cast<int>(substeps), order);
    return distanceOf(world, line);
}

TEST(Jacobi, TakesAStepOfDiscsOnALineAsWorkedOutInDouble) {
    Random random(401);
    SCOPED_TRACE(random.trace());
    for (const std::uint32_t substeps : {1u, 3u}) {
        for (const std::size_t count : {2u, 3u, 9u, 40u}) {
            const LineOfDiscs line = randomLine(random, count);
            const std::string what =
                std::to_string(count) + " discs, " + std::to_string(substeps) + " substeps";
            // Jacobi without shares grows without bound along the line: one disc tells of many.
            const double bound = count > 9 ? 1e-3 : 1e-4;
            EXPECT_LT(stepApart(line, Method::Jacobi, Order::SideBySide, substeps), bound) << what;
            EXPECT_LT(stepApart(line, Method::JacobiSplit, Order::Split, substeps), 1e-4) << what;
            EXPECT_LT(stepApart(line, Method::Sequential, Order::OneByOne, substeps), 1e-4) << what;
            if (count == 2) continue;
            EXPECT_GT(stepApart(line, Method::Jacobi, Order::OneByOne, substeps), 1e-3) << what;
            EXPECT_GT(stepApart(line, Method::JacobiSplit, Order::SideBySide, substeps), 1e-3)
                << what;
        }
    }
}

/// The largest difference of velocities, m/s, between the line and itself listed in another order.
double orderMatters(Method method, const LineOfDiscs& line,
                    const std::vector<std::uint32_t>& order) {
    Scene listed = sceneOf(line), shuffled = sceneOf(line, order);
    listed.method = shuffled.method = method;
    World a = worldOf(listed), b = worldOf(shuffled);
    a.step({});
    b.step({});
    double most = 0.0;
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        const Vec2 apart = b.motions()[i].velocity - a.motions()[order[i]].velocity;
        most = std::max(most, std::sqrt(lengthSquared(wide(apart))));
    }
    return most;
}

TEST(Jacobi, DoesNotDependOnTheOrderOfConstraints) {
    Random random(402);
    SCOPED_TRACE(random.trace());
    const LineOfDiscs line = randomLine(random, 12);
    std::vector<std::uint32_t> order(line.size());
    std::iota(order.begin(), order.end(), 0u);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    EXPECT_LT(orderMatters(Method::Jacobi, line, order), 1e-4);
    EXPECT_LT(orderMatters(Method::JacobiSplit, line, order), 1e-5);
    EXPECT_GT(orderMatters(Method::Sequential, line, order), 1e-2) << "where order does matter";
}

struct Momentum {
    Vec2T<double> linear;  // kg·m/s
    double angular = 0.0;  // kg·m²/s, about the origin
};

Momentum momentumOf(const World& world) {
    Momentum sum;
    for (std::size_t i = 0; i < world.bodies().size(); ++i) {
        const double m = wide(world.bodies()[i].mass), inertia = wide(world.bodies()[i].inertia);
        const BodyMotion& at = world.motions()[i];
        sum.linear += m * wide(at.velocity);
        sum.angular +=
            inertia * wide(at.angularVelocity) + m * cross(wide(at.position), wide(at.velocity));
    }
    return sum;
}

/// Boxes that press into each other and turn, with pins between some, far from any fixed body.
Scene swarm(Random& random) {
    Scene scene;
    scene.gravity = {};
    for (int i = 0; i < 36; ++i) {
        BodyDef box = boxAt({0.95f * static_cast<float>(i % 6), 0.95f * static_cast<float>(i / 6)});
        box.shapes[0].density = random.betweenF(0.5, 4.0);
        box.velocity = random.point(-1.0, 1.0);
        box.angularVelocity = random.betweenF(-1.0, 1.0);
        scene.bodies.push_back(box);
    }
    for (std::uint32_t i = 0; i < 30; i += 4) {
        scene.joints.push_back(hinge(i, {0.0f, 0.475f}, i + 6, {0.0f, -0.475f}));
    }
    return scene;
}

TEST(Jacobi, WithSplitMassesKeepsMomentum) {
    Random random(403);
    SCOPED_TRACE(random.trace());
    for (int round = 0; round < 4; ++round) {
        Scene scene = swarm(random);
        scene.method = Method::JacobiSplit;
        World world = worldOf(scene);
        const Momentum before = momentumOf(world);
        world.step({});
        ASSERT_GT(world.report().contacts, 30u);
        ASSERT_NEAR(momentumOf(world).angular, before.angular, 0.05);
        run(world, 9);
        const Momentum after = momentumOf(world);
        EXPECT_NEAR(after.linear.x, before.linear.x, 1e-4);
        EXPECT_NEAR(after.linear.y, before.linear.y, 1e-4);
    }
}

/// The largest speed in the last second of five, m/s, of a stack that stands.
double unrestOf(Method method, int boxes) {
    Scene scene = *sceneFromCatalog("stack:n=" + std::to_string(boxes));
    scene.method = method;
    scene.sleep = false;
    World world = worldOf(scene);
    run(world, 240);
    double most = 0.0;
    for (int tick = 0; tick < 60; ++tick) {
        world.step({});
        for (const BodyMotion& m : world.motions()) {
            most = std::max(most, std::sqrt(lengthSquared(wide(m.velocity))));
        }
    }
    return most;
}

TEST(Jacobi, WithSplitMassesLetsAStackRestThatWholeMassesShake) {
    EXPECT_LT(unrestOf(Method::JacobiSplit, 6), 0.03);
    EXPECT_GT(unrestOf(Method::Jacobi, 6), 0.1);
}

}  // namespace
}  // namespace huestep::test
