// Queries: rays and overlaps, against the definition of each shape, in key order.

#include <algorithm>
#include <cmath>

#include "core/math/trig.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

TEST(Queries, ARayMeetsWhatLiesOnItInOrderOfFraction) {
    const World world = worldOf(
        sceneOf({ground(), boxAt({2.0f, 1.0f}), discAt({5.0f, 1.0f}), boxAt({8.0f, 4.0f})}));
    const std::vector<RayHit> hits = world.castRay({0.0f, 1.0f}, {10.0f, 1.0f});
    ASSERT_EQ(hits.size(), 2u);
    EXPECT_EQ(hits[0].body, 2u);
    EXPECT_NEAR(wide(hits[0].fraction), 0.15, 1e-6);
    EXPECT_NEAR(wide(hits[0].normal.x), -1.0, 1e-6);
    EXPECT_NEAR(wide(hits[0].point.x), 1.5, 1e-5);
    EXPECT_EQ(hits[1].body, 3u);
    EXPECT_NEAR(wide(hits[1].fraction), 0.45, 1e-6);
    EXPECT_TRUE(world.castRay({0.0f, 1.0f}, {1.0f, 1.0f}).empty());
    EXPECT_EQ(world.castRay({2.0f, 1.0f}, {10.0f, 1.0f}).size(), 1u) << "from within: no hit";
}

TEST(Queries, RaysThatMeetSeveralShapesAtOnceNameThemByShapeId) {
    BodyDef a = boxAt({3.0f, 0.0f});
    BodyDef b = a;
    b.shapes.push_back(ShapeDef::box(0.5f, 0.5f));
    const World world = worldOf(sceneOf({a, b}));
    const std::vector<RayHit> hits = world.castRay({0.0f, 0.0f}, {6.0f, 0.0f});
    ASSERT_EQ(hits.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(hits[i].shape, i + 1);
}

TEST(Queries, OfDiscsAreThoseOfGeometry) {
    Random random(501);
    SCOPED_TRACE(random.trace());
    Scene scene;
    for (int i = 0; i < 200; ++i) {
        scene.bodies.push_back(discAt(random.point(-20.0, 20.0), random.betweenF(0.2, 1.5)));
        scene.bodies.back().type = BodyType::Static;
    }
    const World world = worldOf(scene);
    int met = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const Vec2T<double> from = wide(random.point(-25.0, 25.0));
        const Vec2T<double> to = wide(random.point(-25.0, 25.0));
        const double r = random.between(0.1, 2.0);
        const auto probe = ShapeDef::circle({}, static_cast<float>(r));
        const Vec2 at{static_cast<float>(from.x), static_cast<float>(from.y)};
        const std::vector<RayHit> hits =
            world.castRay(at, {static_cast<float>(to.x), static_cast<float>(to.y)});
        const std::vector<ShapeId> overlaps = world.overlap(probe, {at, {}});
        EXPECT_TRUE(std::is_sorted(overlaps.begin(), overlaps.end()));
        EXPECT_TRUE(std::is_sorted(hits.begin(), hits.end(), [](const auto& a, const auto& b) {
            return a.fraction < b.fraction;
        }));
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            const auto id = static_cast<ShapeId>(i + 1);
            const Vec2T<double> center = wide(scene.bodies[i].position);
            const double radius = wide(scene.bodies[i].shapes[0].radius);
            const double gap = length(from - center) - radius - r;
            const bool found = std::count(overlaps.begin(), overlaps.end(), id) != 0;
            if (std::abs(gap) > 1e-4) {
                EXPECT_EQ(found, gap < 0.0) << "disc " << i;
            }

            // |m + t d|² = R² for the first t.
            const Vec2T<double> m = from - center, d = to - from;
            const double a = dot(d, d), b = dot(m, d), c = dot(m, m) - radius * radius;
            const double root = b * b - a * c;
            const double t = root > 0.0 ? (-b - std::sqrt(root)) / a : -1.0;
            const bool clear = std::abs(root) > 1e-3 && std::abs(t) > 1e-3 &&
                               std::abs(t - 1.0) > 1e-3 && std::abs(c) > 1e-3;
            if (!clear) continue;
            const auto hit = std::find_if(hits.begin(), hits.end(),
                                          [&](const RayHit& h) { return h.shape == id; });
            ASSERT_EQ(hit != hits.end(), t >= 0.0 && t <= 1.0) << "disc " << i;
            if (hit == hits.end()) continue;
            ++met;
            EXPECT_NEAR(wide(hit->fraction), t, 2e-4);
            const Vec2T<double> n = (1.0 / radius) * (m + t * d);
            EXPECT_NEAR(dot(n, wide(hit->normal)), 1.0, 1e-3);
        }
    }
    EXPECT_GT(met, 500);
}

TEST(Queries, SeeBodiesWhereTheyAreTurned) {
    BodyDef bar = bodyAt(BodyType::Static, {5.0f, 0.0f}, ShapeDef::box(2.0f, 0.1f));
    bar.rotation = rotationOf(1.5707964f);
    const World world = worldOf(sceneOf({bar}));
    EXPECT_EQ(world.castRay({0.0f, 1.5f}, {10.0f, 1.5f}).size(), 1u);
    EXPECT_TRUE(world.castRay({0.0f, 2.5f}, {10.0f, 2.5f}).empty());
    const Pose turned{{5.6f, 0.0f}, rotationOf(0.7853982f)};
    EXPECT_EQ(world.overlap(ShapeDef::box(0.5f, 0.5f), turned).size(), 1u) << "corner at 4.89";
    EXPECT_TRUE(world.overlap(ShapeDef::box(0.5f, 0.5f), {{5.7f, 0.0f}, {}}).empty());
}

TEST(Queries, FindBodiesByIdAndTheirShapesAsARun) {
    BodyDef two = boxAt({0.0f, 5.0f});
    two.shapes.push_back(ShapeDef::circle({}, 0.7f));
    World world = worldOf(sceneOf({ground(), two, discAt({4.0f, 5.0f})}));
    EXPECT_EQ(world.find(2), 1u);
    EXPECT_FALSE(world.find(0));
    EXPECT_FALSE(world.find(4));
    ASSERT_EQ(world.shapesOf(2).size(), 2u);
    EXPECT_EQ(world.shapesOf(2)[0].id, 2u);
    EXPECT_TRUE(world.shapesOf(9).empty());
    world.step(std::vector<Command>{{0, 1, RemoveBody{2}}});
    EXPECT_FALSE(world.find(2));
    EXPECT_EQ(world.find(3), 1u);
    EXPECT_TRUE(world.shapesOf(2).empty());
}

TEST(Queries, ContactViewsShowTheContactsOfTheStateAndTheirImpulsesCarryTheWeight) {
    World world = worldOf(sceneOf({ground(), boxAt({0.0f, 0.5f}, 0.5f)}));
    run(world, 20);
    const std::vector<ContactView> views = world.contactViews();
    ASSERT_EQ(views.size(), 1u);
    EXPECT_EQ(views[0].pointCount, 2);
    EXPECT_NEAR(wide(views[0].normal.y), 1.0, 1e-5);
    const double h = 1.0 / 240.0;
    EXPECT_NEAR(wide(views[0].normalImpulse[0] + views[0].normalImpulse[1]), 10.0 * h, 1e-3 * h);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(std::abs(wide(views[0].point[i].x)), 0.5, 1e-3);
        EXPECT_NEAR(wide(views[0].separation[i]), 0.0, 2e-3);
    }
    EXPECT_GE(views[0].colour, 0);
    EXPECT_EQ(world.contacts().size(), 1u);
    run(world, 100);
    ASSERT_TRUE(world.motions()[1].asleep());
    ASSERT_EQ(world.contactViews().size(), 1u);
    EXPECT_EQ(world.contactViews()[0].colour, -1) << "asleep";
}

}  // namespace
}  // namespace huestep::test
