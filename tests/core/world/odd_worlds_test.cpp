// Every stage of the step in worlds at the edge of what there is, each stage against an answer of
// its own: all pairs in double, a walk, sums, a closed form. State and hashes: see
// tests/core/state/odd_worlds_test.cpp; configurations: tests/determinism/odd_worlds_test.cpp.

#include <algorithm>
#include <cmath>
#include <set>

#include "core/contact/contact.h"
#include "core/graph/coloring.h"
#include "core/math/finite.h"
#include "tests/core/odd_worlds.h"
#include "tests/core/walk.h"
#include "tests/determinism/random_scene.h"
#include "tests/oracle/brute.h"

namespace huestep::test {
namespace {

using Motions = std::vector<BodyMotion>;
using Pair = std::pair<ShapeId, ShapeId>;

Motions motionsOf(const World& world) {
    return {world.motions().begin(), world.motions().end()};
}

class OddWorlds : public testing::TestWithParam<OddWorld> {
 protected:
    World m_world = worldOf(GetParam().scene);
    Motions m_before = motionsOf(m_world);  ///< of the last step

    [[nodiscard]] static bool seeded() { return GetParam().name.starts_with("Random"); }
    void step() {
        m_before = motionsOf(m_world);
        m_world.step({});
    }
    [[nodiscard]] bool dynamic(std::size_t body) const { return m_world.bodies()[body].dynamic(); }
    /// Whether the last step moved it. (Who is woken does not fall asleep in the same step.)
    [[nodiscard]] bool moved(std::size_t body) const {
        return dynamic(body) && !(m_before[body].asleep() && m_world.motions()[body].asleep());
    }
    /// Whether it went so far that it may have been stopped on its way, which takes the fall of the
    /// rest of the step from it; joints that were drawn apart may throw it out of the world.
    [[nodiscard]] bool leapt(std::size_t body) const {
        const BodyMotion &from = m_before[body], &to = m_world.motions()[body];
        const float fastest = maxOf(length(from.velocity), length(to.velocity));
        const float spin = maxOf(absoluteOf(from.angularVelocity), absoluteOf(to.angularVelocity));
        const auto& broken = m_world.events().quarantined;
        return fastest + spin > 2.5f ||
               std::count(broken.begin(), broken.end(), m_world.bodies()[body].id) != 0;
    }
    [[nodiscard]] bool moved(const Walk::Island& island) const {
        return std::any_of(island.bodies.begin(), island.bodies.end(),
                           [this](std::uint32_t body) { return moved(body); });
    }
};

/// Worlds drawn from seeds, which their names tell: every shape, joint, filter and kind of body.
std::vector<OddWorld> randomWorlds() {
    std::vector<OddWorld> all;
    for (std::uint64_t seed = 9600; seed < 9608; ++seed) {
        Random random(seed);
        all.push_back({"Random" + std::to_string(seed), randomScene(random)});
    }
    return all;
}

INSTANTIATE_TEST_SUITE_P(All, OddWorlds, testing::ValuesIn(oddWorlds()), nameOfOdd);
INSTANTIATE_TEST_SUITE_P(Seeds, OddWorlds, testing::ValuesIn(randomWorlds()), nameOfOdd);

// Pairs and collide.

oracle::Outline outlineOf(const ShapeInfo& shape, const BodyMotion& motion) {
    oracle::Outline outline;
    outline.radius = wide(shape.radius);
    const double c = wide(motion.rotation.c), s = wide(motion.rotation.s);
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.vertexCount()); ++i) {
        const Vec2T<double> v = wide(shape.vertices[i]);
        outline.points.push_back({wide(motion.position.x) + c * v.x - s * v.y,
                                  wide(motion.position.y) + s * v.x + c * v.y});
    }
    return outline;
}

double sizeOf(const ShapeInfo& shape) {
    double far = 0.0;
    for (const Vec2 v : shape.vertices) far = std::max(far, wide(length(v)));
    return far + wide(shape.radius);
}

/// Bodies that a joint keeps from touching.
std::set<std::pair<BodyId, BodyId>> forbiddenBy(const World& world) {
    std::set<std::pair<BodyId, BodyId>> forbidden;
    for (const JointInfo& joint : world.joints()) {
        if (joint.has(JointInfo::collideConnected)) continue;
        forbidden.insert(std::minmax(joint.bodyA, joint.bodyB));
    }
    return forbidden;
}

TEST_P(OddWorlds, HaveTheContactsThatAllPairsInDoubleHave) {
    const auto forbidden = forbiddenBy(m_world);
    for (int tick = 0; tick < 40; ++tick) {
        step();
        if (tick > 2 && tick % 12 != 0) continue;
        std::set<Pair> touching;
        for (const ContactState& contact : m_world.contacts())
            touching.emplace(contact.shapeA, contact.shapeB);
        std::vector<oracle::Outline> outlines;
        std::vector<std::uint32_t> bodyOf;
        for (const ShapeInfo& shape : m_world.shapes()) {
            bodyOf.push_back(*m_world.find(shape.body));
            outlines.push_back(outlineOf(shape, m_before[bodyOf.back()]));
        }
        std::size_t allowed = 0;
        for (std::size_t i = 0; i < outlines.size(); ++i) {
            for (std::size_t j = i + 1; j < outlines.size(); ++j) {
                const ShapeInfo &a = m_world.shapes()[i], &b = m_world.shapes()[j];
                const bool touches = touching.count({a.id, b.id}) != 0;
                const bool may = a.body != b.body && (dynamic(bodyOf[i]) || dynamic(bodyOf[j])) &&
                                 mayTouch(a.filter(), b.filter()) &&
                                 !forbidden.contains(std::minmax(a.body, b.body));
                ASSERT_TRUE(may || !touches) << a.id << " and " << b.id << " may not touch";
                if (!may) continue;
                allowed += touches;
                // What sleeps is not looked at; what is one-sided has tests of its own.
                if (!moved(bodyOf[i]) && !moved(bodyOf[j])) continue;
                if (a.shapeKind() == ShapeKind::ChainSegment) continue;
                if (b.shapeKind() == ShapeKind::ChainSegment) continue;
                const double apart = oracle::separation(outlines[i], outlines[j]);
                const double slack = 1e-3 + 1e-6 * (sizeOf(a) + sizeOf(b));
                ASSERT_TRUE(touches || apart > wide(speculativeDistance) - slack)
                    << "tick " << tick << ": " << a.id << " and " << b.id << ", " << apart;
                // A manifold that is kept follows its bodies for 5 cm.
                ASSERT_TRUE(!touches || apart < wide(speculativeDistance) + 0.05 + slack)
                    << "tick " << tick << ": " << a.id << " and " << b.id << ", " << apart;
            }
        }
        EXPECT_EQ(allowed, touching.size()) << "contacts are those of shapes that are there";
        EXPECT_GE(m_world.report().pairs, touching.size());
    }
}

TEST_P(OddWorlds, MakeAManifoldWhereTheBodiesAreAtTheStartOfTheStep) {
    std::set<Pair> known;
    std::map<ShapeId, BodyId> bodyOf;
    for (const ShapeInfo& shape : m_world.shapes()) bodyOf[shape.id] = shape.body;
    for (int tick = 0; tick < 40; ++tick) {
        step();
        std::set<Pair> now;
        for (const ContactState& contact : m_world.contacts()) {
            const Pair key{contact.shapeA, contact.shapeB};
            ASSERT_LT(key.first, key.second);
            now.insert(key);
            if (known.contains(key)) continue;
            const BodyMotion& a = m_before[*m_world.find(bodyOf.at(key.first))];
            const BodyMotion& b = m_before[*m_world.find(bodyOf.at(key.second))];
            const Vec2T<double> way = wide(b.position) - wide(a.position);
            const double c = wide(a.rotation.c), s = wide(a.rotation.s);
            const double far = 1e-6 * (1.0 + length(way));
            EXPECT_NEAR(wide(contact.relative.p.x), c * way.x + s * way.y, far);
            EXPECT_NEAR(wide(contact.relative.p.y), c * way.y - s * way.x, far);
            const double turned =
                std::atan2(wide(b.rotation.s), wide(b.rotation.c)) - std::atan2(s, c);
            EXPECT_NEAR(wide(contact.relative.q.c), std::cos(turned), 1e-6);
            EXPECT_NEAR(wide(contact.relative.q.s), std::sin(turned), 1e-6);
        }
        known = std::move(now);
    }
}

// Islands, batches, colours.

TEST_P(OddWorlds, AreSolvedInTheIslandsThatAWalkFindsAndInBatchesOfWholeOnes) {
    for (int tick = 0; tick < 40; ++tick) {
        step();
        const Walk walk = walkOver(m_world);
        std::map<BodyId, const Walk::Island*> expected;
        std::size_t free = 0;
        for (const Walk::Island& island : walk.islands) {
            if (!moved(island)) continue;
            if (island.contacts + island.joints == 0)
                ++free;
            else
                expected[island.lowest] = &island;
        }
        const StepLayout layout = m_world.stepLayout();
        ASSERT_EQ(layout.islands.size(), expected.size()) << "tick " << tick;
        EXPECT_EQ(layout.freeBodies, free);
        EXPECT_EQ(m_world.report().islands, expected.size());
        std::map<std::uint32_t, std::uint32_t> sizeOfBatch;
        for (const IslandView& view : layout.islands) {
            ASSERT_TRUE(expected.contains(view.body)) << "island of " << view.body;
            const Walk::Island& island = *expected.at(view.body);
            EXPECT_EQ(view.bodies, island.bodies.size());
            EXPECT_EQ(view.contacts, island.contacts);
            EXPECT_EQ(view.joints, island.joints);
            sizeOfBatch[view.batch] += view.contacts + view.joints;
        }
        EXPECT_EQ(sizeOfBatch.size(), m_world.report().batches);
        for (const IslandView& view : layout.islands) {
            EXPECT_EQ(view.batchConstraints, sizeOfBatch.at(view.batch));
            EXPECT_EQ(view.giant, sizeOfBatch.at(view.batch) > layout.batchConstraints);
        }
    }
}

TEST_P(OddWorlds, HaveNoTwoContactsOfOneColourAtABodyAndOverflowAtHubsAlone) {
    std::map<ShapeId, std::uint32_t> bodyOf;
    for (const ShapeInfo& shape : m_world.shapes()) bodyOf[shape.id] = *m_world.find(shape.body);
    std::uint32_t highest = 0;
    for (int tick = 0; tick < 40; ++tick) {
        step();
        const Walk walk = walkOver(m_world);
        std::uint32_t toMovers = 0, toFixed = 0;
        for (std::size_t body = 0; body < walk.movingOf.size(); ++body) {
            if (!moved(body)) continue;
            toMovers = std::max(toMovers, walk.movingOf[body]);
            toFixed = std::max(toFixed, walk.fixedOf[body]);
        }
        // First fit needs at most a colour more than the constraint has neighbours.
        if (2 * toMovers <= 64 && toFixed <= 64) {
            EXPECT_EQ(m_world.report().overflow, 0u);
        }
        highest = std::max({highest, toMovers, toFixed});
        std::set<std::pair<int, std::uint32_t>> taken;
        for (const ContactView& view : m_world.contactViews()) {
            for (const std::uint32_t body : {bodyOf.at(view.shapeA), bodyOf.at(view.shapeB)}) {
                if (!moved(body) || walk.movingOf[body] > 64 || walk.fixedOf[body] > 64) continue;
                ASSERT_GE(view.colour, 0) << "who moves has a colour";
                // One by one, or by copies of the hub.
                if (view.colour == 255 || isHub(static_cast<std::uint8_t>(view.colour))) continue;
                EXPECT_TRUE(taken.emplace(view.colour, body).second) << "body at " << body;
            }
        }
    }
    EXPECT_EQ(highest > 64, GetParam().name.starts_with("Hub"));
}

// Solve and joints.

TEST_P(OddWorlds, GainTheMomentumThatGravityGivesWhereNothingElseIsTouched) {
    double dt = wide(m_world.info().stepSeconds);
    for (int tick = 0; tick < 40; ++tick) {
        step();
        const Walk walk = walkOver(m_world);
        for (const Walk::Island& island : walk.islands) {
            if (island.touchesFixed || !moved(island)) continue;
            Vec2T<double> gained, expected;
            double scale = 1.0;
            bool damped = false;
            for (const std::uint32_t body : island.bodies) {
                const BodyInfo& info = m_world.bodies()[body];
                const double mass = wide(info.mass);
                gained +=
                    mass * (wide(m_world.motions()[body].velocity) - wide(m_before[body].velocity));
                expected += mass * dt * wide(info.gravityScale) * wide(m_world.info().gravity);
                scale += mass * (length(wide(m_before[body].velocity)) + 1.0);
                damped |= info.linearDamping != 0.0f || (seeded() && leapt(body));
            }
            if (damped) continue;
            EXPECT_NEAR(gained.x, expected.x, 2e-6 * scale) << "island of " << island.lowest;
            EXPECT_NEAR(gained.y, expected.y, 2e-6 * scale) << "island of " << island.lowest;
        }
    }
}

TEST_P(OddWorlds, MoveFreeBodiesAlongTheirParabola) {
    const double dt = wide(m_world.info().stepSeconds);
    for (int tick = 0; tick < 40; ++tick) {
        step();
        for (const Walk::Island& island : walkOver(m_world).islands) {
            if (island.contacts + island.joints != 0 || !moved(island)) continue;
            const std::uint32_t body = island.bodies[0];
            if (m_world.bodies()[body].linearDamping != 0.0f || (seeded() && leapt(body))) continue;
            const Vec2T<double> g =
                wide(m_world.bodies()[body].gravityScale) * wide(m_world.info().gravity);
            const BodyMotion& from = m_before[body];
            const Vec2T<double> to =
                wide(from.position) + dt * wide(from.velocity) + (0.5 * dt * dt) * g;
            const BodyMotion& now = m_world.motions()[body];
            const double ulp = 1.5e-7 * (length(to) + 1.0);
            EXPECT_LT(length(wide(now.position) - to), ulp) << "body " << body;
            const Vec2T<double> v = wide(from.velocity) + dt * g;
            EXPECT_LT(length(wide(now.velocity) - v), 3e-7 * (length(v) + 1.0)) << "body " << body;
        }
    }
}

TEST_P(OddWorlds, KeepImpulsesWithinTheirConesAndJointsTogether) {
    std::map<ShapeId, const ShapeInfo*> shapeOf;
    for (const ShapeInfo& shape : m_world.shapes()) shapeOf[shape.id] = &shape;
    double widest = 0.0;
    for (int tick = 0; tick < 60; ++tick) {
        step();
        EXPECT_TRUE(seeded() || m_world.events().quarantined.empty());
        for (const BodyMotion& m : m_world.motions()) {
            ASSERT_TRUE(isFinite(m.position) && isFinite(m.velocity));
            ASSERT_NEAR(std::hypot(wide(m.rotation.c), wide(m.rotation.s)), 1.0, 1e-6);
        }
        for (const ContactState& contact : m_world.contacts()) {
            const double friction = std::sqrt(wide(shapeOf.at(contact.shapeA)->friction) *
                                              wide(shapeOf.at(contact.shapeB)->friction));
            // Restitution comes last: it changes what friction was measured by.
            const bool bounces = shapeOf.at(contact.shapeA)->restitution != 0.0f ||
                                 shapeOf.at(contact.shapeB)->restitution != 0.0f;
            for (std::size_t point = 0; point < 2; ++point) {
                const double normal = wide(contact.normalImpulse[point]);
                ASSERT_GE(normal, 0.0);
                if (bounces) continue;
                ASSERT_LE(std::abs(wide(contact.tangentImpulse[point])),
                          friction * normal * (1.0 + 1e-5) + 1e-12);
            }
        }
        for (const JointInfo& joint : m_world.joints()) {
            if (joint.kind() != JointKind::Revolute || seeded()) continue;  // drawn apart
            const std::uint32_t a = *m_world.find(joint.bodyA), b = *m_world.find(joint.bodyB);
            if (!dynamic(a) && !dynamic(b)) continue;
            const auto end = [this](std::uint32_t body, Vec2 anchor) {
                const BodyMotion& m = m_world.motions()[body];
                const Vec2T<double> v = wide(anchor);
                return wide(m.position) +
                       Vec2T<double>{wide(m.rotation.c) * v.x - wide(m.rotation.s) * v.y,
                                     wide(m.rotation.s) * v.x + wide(m.rotation.c) * v.y};
            };
            widest = std::max(widest, length(end(a, joint.anchorA) - end(b, joint.anchorB)));
        }
    }
    // Far away a float is a step of 6 cm. At a hub 80 discs of a thousandth of its mass swing on
    // arms of 20 times their radius and jam: they are off by 0.2 to 0.9 m at any n from 2 to 32.
    const double most = GetParam().name == "FarAway" ? 0.2 : 0.03;
    EXPECT_LT(widest, GetParam().name == "HubOfJoints" ? 1.0 : most);
}

// Continuous.

TEST_P(OddWorlds, HoldAWallThatAFastDiscDoesNotPass) {
    // Beside all that is there; at 300 m/s a disc goes 5 m a tick and would be beyond by 1 m.
    Scene scene = GetParam().scene;
    const Vec2 middle = scene.bodies.empty() ? Vec2{} : scene.bodies.back().position;
    const float aside = GetParam().name == "Huge" ? 6.0e4f : 200.0f;
    const Vec2 at = middle + Vec2{-aside, aside};
    scene.bodies.push_back(bodyAt(BodyType::Static, at, ShapeDef::box(0.5f, 50.0f)));
    scene.bodies.push_back(discAt(at + Vec2{-3.0f, 0.0f}));
    scene.bodies.back().velocity = {300.0f, 0.0f};
    World world = worldOf(scene);
    const BodyId disc = world.bodies().back().id;
    for (int tick = 0; tick < 10; ++tick) {
        world.step({});
        ASSERT_LT(motionOf(world, disc).position.x, at.x) << "tick " << tick;
    }
    EXPECT_GT(motionOf(world, disc).position.x, at.x - 3.0f) << "it came to the wall";
}

// Sleep.

TEST_P(OddWorlds, SleepAndWakeByWholeIslandsAndWhoSleepsDoesNotMove) {
    const auto asleep = [this] {
        return std::count_if(m_world.motions().begin(), m_world.motions().end(),
                             [](const BodyMotion& m) { return m.asleep(); });
    };
    std::int64_t most = 0;
    for (int tick = 0; tick < 150; ++tick) {
        step();
        most = std::max(most, asleep());
        if (tick == 120 && asleep() > 0) {
            const auto sleeper = std::find_if(m_world.motions().begin(), m_world.motions().end(),
                                              [](const BodyMotion& m) { return m.asleep(); });
            const auto body = static_cast<std::size_t>(sleeper - m_world.motions().begin());
            m_world.step(std::vector<Command>{
                {0, 1, ApplyImpulse{m_world.bodies()[body].id, {}, sleeper->position}}});
            EXPECT_FALSE(m_world.motions()[body].asleep()) << "touched, it wakes";
        }
        for (std::size_t body = 0; body < m_before.size(); ++body) {
            const BodyMotion& now = m_world.motions()[body];
            ASSERT_TRUE(dynamic(body) || !now.asleep()) << "body " << body;
            if (!now.asleep()) continue;
            EXPECT_EQ(now.velocity, Vec2{});
            EXPECT_EQ(now.angularVelocity, 0.0f);
            if (!m_before[body].asleep()) continue;
            EXPECT_EQ(now.position, m_before[body].position) << "body " << body;
            EXPECT_EQ(now.rotation, m_before[body].rotation) << "body " << body;
        }
        for (const Walk::Island& island : walkOver(m_world).islands) {
            const bool first = m_world.motions()[island.bodies[0]].asleep();
            for (const std::uint32_t body : island.bodies)
                ASSERT_EQ(m_world.motions()[body].asleep(), first) << "body " << body;
        }
    }
    if (GetParam().name == "AllAsleep") {
        EXPECT_EQ(most, 20);
    }
    if (GetParam().name == "HubOfContacts") {
        EXPECT_EQ(most, 101);
    }
    if (GetParam().name == "OneBody") {
        EXPECT_EQ(most, 0);
    }
}

// Events and queries.

TEST_P(OddWorlds, TellOfEveryContactThatBeginsAndEnds) {
    std::set<Pair> known;
    for (int tick = 0; tick < 60; ++tick) {
        step();
        std::set<Pair> now;
        for (const ContactState& contact : m_world.contacts())
            now.emplace(contact.shapeA, contact.shapeB);
        for (const ContactChange& key : m_world.events().ends)
            EXPECT_EQ(known.erase({key.shapeA, key.shapeB}), 1u) << "tick " << tick;
        for (const ContactChange& key : m_world.events().begins)
            EXPECT_TRUE(known.emplace(key.shapeA, key.shapeB).second) << "tick " << tick;
        ASSERT_EQ(known, now) << "tick " << tick;
    }
}

TEST_P(OddWorlds, AnswerForOverlapsAsAllShapesInDoubleDo) {
    Random random(601);
    SCOPED_TRACE(random.trace());
    for (int tick = 0; tick < 10; ++tick) step();
    const bool anything = !m_world.shapes().empty();
    for (int trial = 0; trial < 60; ++trial) {
        Vec2 at = random.point(-3.0, 3.0);
        float radius = random.betweenF(0.05, 2.0);
        if (anything) {
            const ShapeInfo& shape = m_world.shapes()[random.below(m_world.shapes().size())];
            const double near = 1.5 * sizeOf(shape);
            at = m_world.motions()[*m_world.find(shape.body)].position + random.point(-near, near);
            radius =
                std::clamp(random.betweenF(0.1, 1.0) * static_cast<float>(near), 0.001f, 1.0e4f);
        }
        const std::vector<ShapeId> found = m_world.overlap(ShapeDef::circle({}, radius), {at, {}});
        const std::set<ShapeId> overlapping(found.begin(), found.end());
        EXPECT_EQ(overlapping.size(), found.size());
        std::size_t known = 0;
        for (const ShapeInfo& shape : m_world.shapes()) {
            const bool overlaps = overlapping.contains(shape.id);
            known += overlaps;
            if (shape.shapeKind() == ShapeKind::ChainSegment) continue;
            const oracle::Outline outline =
                outlineOf(shape, m_world.motions()[*m_world.find(shape.body)]);
            const double apart =
                oracle::distanceToPoint(outline, {wide(at.x), wide(at.y)}) - wide(radius);
            if (std::abs(apart) < 1e-3 + 1e-6 * (sizeOf(shape) + wide(radius))) continue;
            EXPECT_EQ(overlaps, apart < 0.0) << "shape " << shape.id << ", " << apart;
        }
        EXPECT_EQ(known, found.size());
    }
}

TEST_P(OddWorlds, AnswerForRaysAsDistancesInDoubleDo) {
    Random random(602);
    SCOPED_TRACE(random.trace());
    for (int tick = 0; tick < 10; ++tick) step();
    const Vec2 far{1.0e6f, 1.0e6f};
    for (const RayHit& hit : m_world.castRay(-far, far)) EXPECT_TRUE(isFinite(hit.point));
    if (m_world.shapes().empty()) return;
    for (int trial = 0; trial < 40; ++trial) {
        const ShapeInfo& aim = m_world.shapes()[random.below(m_world.shapes().size())];
        const double near = 2.0 * sizeOf(aim);
        const Vec2 middle = m_world.motions()[*m_world.find(aim.body)].position;
        const Vec2 from = middle + random.point(-near, near);
        const Vec2 to = middle + random.point(-near, near);
        std::map<ShapeId, double> met;
        for (const RayHit& hit : m_world.castRay(from, to)) met[hit.shape] = wide(hit.fraction);
        const double whole = length(wide(to) - wide(from));
        for (const ShapeInfo& shape : m_world.shapes()) {
            if (shape.shapeKind() == ShapeKind::ChainSegment) continue;
            const oracle::Outline outline =
                outlineOf(shape, m_world.motions()[*m_world.find(shape.body)]);
            const auto apart = [&](double t) {
                const Vec2T<double> p = wide(from) + t * (wide(to) - wide(from));
                return oracle::distanceToPoint(outline, {p.x, p.y});
            };
            const double slack = 1e-4 + 1e-6 * (sizeOf(shape) + whole);
            // The distance from a convex set is convex along a line: least where thirds close in.
            double low = 0.0, high = 1.0;
            for (int i = 0; i < 60; ++i) {
                const double first = low + (high - low) / 3.0;
                const double second = high - (high - low) / 3.0;
                (apart(first) < apart(second) ? high : low) =
                    apart(first) < apart(second) ? second : first;
            }
            const double least = apart(low);
            if (std::abs(apart(0.0)) < slack || std::abs(least) < slack) continue;  // grazes
            const bool meets = apart(0.0) > 0.0 && least < 0.0;
            ASSERT_EQ(met.contains(shape.id), meets) << "shape " << shape.id << ", " << least;
            if (!meets) continue;
            EXPECT_LT(std::abs(apart(met.at(shape.id))), 5.0 * slack) << "on its surface";
            EXPECT_LT(met.at(shape.id), low + 1e-3) << "where it enters";
        }
    }
}

}  // namespace
}  // namespace huestep::test
