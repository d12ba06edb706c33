// One contact from step to step: recycling, matching by feature, and the same bits after a drop.

#include "core/contact/narrow_phase.h"

#include <cmath>
#include <cstring>

#include "core/math/trig.h"
#include "tests/core/hulls.h"

namespace huestep::test {
namespace {

/// Shape 0 on body 0 and shape 1 on body 1, and what the collide stage reads of them.
class PairOfShapes {
 public:
    PairOfShapes(const ShapeDef& a, const ShapeDef& b)
        : m_hulls{hullOfDef<float>(a), hullOfDef<float>(b)} {
        contact.bodyB = contact.placeB = 1;
        contact.row.slack = 0.05f;
        for (const Hull& hull : m_hulls) {
            contact.row.roundness = maxOf(contact.row.roundness, hull.radius);
            for (std::size_t i = 0; i < static_cast<std::size_t>(hull.count); ++i) {
                contact.row.reach =
                    maxOf(contact.row.reach, length(hull.vertices[i]) + hull.radius);
            }
        }
        for (BodyMotion& m : motions) m.rotation = {1.0f, 0.0f};
    }

    ContactUpdate update() { return updateContact(contact, input()); }
    void forgetAllButTheState() {
        const ContactState kept = state();
        Contact bare;
        bare.bodyB = bare.placeB = 1;
        bare.row.slack = contact.row.slack;
        bare.row.reach = contact.row.reach;
        bare.row.roundness = contact.row.roundness;
        bare.turn = kept.turn;
        setImpulses(bare, {kept.normalImpulse, kept.tangentImpulse, kept.rollingImpulse});
        contact = bare;
        remakeManifold(contact, kept.relative, input());
    }
    [[nodiscard]] ContactState state() const { return stateOf(contact, 1, 2, impulsesOf(contact)); }

    std::vector<BodyMotion> motions{2};
    Contact contact{};

 private:
    NarrowPhaseInput input() {
        for (std::size_t i = 0; i < 2; ++i) {
            m_bounds[i] =
                grown(boundsOf(m_hulls[i], motions[i].pose()), 0.5f * speculativeDistance);
        }
        return {motions, m_hulls, m_bounds};
    }
    std::vector<Hull> m_hulls;
    std::vector<Bounds> m_bounds{2};
};

PairOfShapes boxOnBox() {
    PairOfShapes pair(ShapeDef::box(0.5f, 0.5f), ShapeDef::box(0.5f, 0.5f));
    pair.motions[1].position = {0.0f, 0.995f};
    EXPECT_EQ(pair.update(), ContactUpdate::Fresh);
    EXPECT_EQ(pair.contact.pointCount, 2);
    return pair;
}

TEST(NarrowPhase, KeepsAManifoldWhileTheBodiesHardlyMoveAgainstEachOther) {
    PairOfShapes pair = boxOnBox();
    const Pose made = pair.contact.relative();
    pair.motions[1].position.x = 0.04f;
    EXPECT_EQ(pair.update(), ContactUpdate::Recycled);
    EXPECT_EQ(pair.contact.relative(), made) << "still the one of when it was made";
    // Both together may go anywhere.
    for (BodyMotion& m : pair.motions) m.position += Vec2{30.0f, -7.0f};
    EXPECT_EQ(pair.update(), ContactUpdate::Recycled);
    pair.motions[1].position.x += 0.02f;
    EXPECT_EQ(pair.update(), ContactUpdate::Fresh) << "6 cm from where it was made";
    EXPECT_NE(pair.contact.relative(), made);
}

TEST(NarrowPhase, MakesANewManifoldOnceEitherBodyHasTurned) {
    PairOfShapes pair = boxOnBox();
    // Both turn as one about the origin: no motion against each other, but the normal is old.
    const auto turnBoth = [&](float angle) {
        const Rotation q = rotationOf(angle);
        pair.motions[0].rotation = pair.motions[1].rotation = q;
        pair.motions[1].position = rotate(q, Vec2{0.0f, 0.995f});
    };
    turnBoth(0.19f);
    EXPECT_EQ(pair.update(), ContactUpdate::Recycled) << "11 degrees";
    turnBoth(0.21f);
    EXPECT_EQ(pair.update(), ContactUpdate::Fresh) << "12 degrees";
    EXPECT_NEAR(wide(pair.contact.normal().x), -std::sin(0.21), 1e-6) << "in the world";
}

TEST(NarrowPhase, NeverKeepsASinglePoint) {
    PairOfShapes pair(ShapeDef::box(0.5f, 0.5f), ShapeDef::circle({}, 0.5f));
    pair.motions[1].position = {0.0f, 0.995f};
    EXPECT_EQ(pair.update(), ContactUpdate::Fresh);
    ASSERT_EQ(pair.contact.pointCount, 1);
    EXPECT_EQ(pair.update(), ContactUpdate::Fresh);
}

TEST(NarrowPhase, HandsImpulsesOnByFeature) {
    PairOfShapes pair = boxOnBox();
    setImpulses(pair.contact, {{3.0f, 5.0f}, {0.5f, -0.5f}, 0.25f});
    const std::uint16_t first = pair.contact.feature[0];
    pair.motions[1].position.x = 0.3f;
    ASSERT_EQ(pair.update(), ContactUpdate::Fresh);
    ASSERT_EQ(pair.contact.pointCount, 2);
    const std::size_t same = pair.contact.feature[0] == first ? 0 : 1;
    EXPECT_EQ(pair.state().normalImpulse[same], 3.0f);
    EXPECT_EQ(pair.state().normalImpulse[1 - same], 5.0f);
    EXPECT_EQ(pair.state().tangentImpulse[same], 0.5f);
    EXPECT_EQ(pair.state().rollingImpulse, 0.25f);
    // Past the edge the pair of vertices is another: no impulse to start from.
    pair.motions[1].position = {0.999f, 0.999f};
    pair.motions[1].rotation = rotationOf(0.7853982f);
    pair.motions[1].position = {0.2f, 1.2f};
    ASSERT_EQ(pair.update(), ContactUpdate::Fresh);
    ASSERT_EQ(pair.contact.pointCount, 1);
    EXPECT_EQ(pair.state().normalImpulse[1], 0.0f) << "what is not there holds nothing";
}

TEST(NarrowPhase, DropsAContactWhoseBoundsAreApartAndStartsColdAfterwards) {
    PairOfShapes pair = boxOnBox();
    setImpulses(pair.contact, {{3.0f, 5.0f}, {}, 1.0f});
    pair.motions[1].position.y = 1.5f;
    EXPECT_EQ(pair.update(), ContactUpdate::Apart);
    EXPECT_EQ(pair.contact.pointCount, 0);
    pair.motions[1].position.y = 0.995f;
    EXPECT_EQ(pair.update(), ContactUpdate::Fresh);
    EXPECT_EQ(pair.contact.pointCount, 2);
    EXPECT_EQ(pair.state().normalImpulse[0], 0.0f);
    EXPECT_EQ(pair.state().rollingImpulse, 0.0f);
}

TEST(NarrowPhase, RemakesADroppedManifoldToTheSameBits) {
    Random random(91);
    SCOPED_TRACE(random.trace());
    int compared = 0;
    for (int trial = 0; trial < 20'000; ++trial) {
        PairOfShapes pair(randomShapeDef(random), randomShapeDef(random));
        pair.motions[0].position = random.point(-50.0, 50.0);
        pair.motions[0].rotation = rotationOf(random.betweenF(-3.1, 3.1));
        pair.motions[1].position = pair.motions[0].position + random.point(-1.2, 1.2);
        pair.motions[1].rotation = rotationOf(random.betweenF(-3.1, 3.1));
        if (pair.update() != ContactUpdate::Fresh) continue;
        ++compared;
        const Contact before = pair.contact;
        pair.forgetAllButTheState();
        const Contact& after = pair.contact;
        ASSERT_EQ(after.pointCount, before.pointCount);
        for (std::size_t i = 0; i < before.pointCount; ++i) {
            ASSERT_EQ(after.feature[i], before.feature[i]);
        }
        ASSERT_EQ(after.turn, before.turn);
        ASSERT_EQ(std::memcmp(&after.row, &before.row, sizeof after.row), 0);
        ASSERT_EQ(std::memcmp(&after.points, &before.points, sizeof after.points), 0);
        // Anchors from both centres meet at one point of the world.
        const Vec2 gap = (pair.motions[1].position + before.anchorB(0)) -
                         (pair.motions[0].position + before.anchorA(0));
        ASSERT_LT(length(gap), 2e-5f);
    }
    EXPECT_GT(compared, 5'000);
}

TEST(NarrowPhase, OfAClaimedContactThatIsNoneHasNoPoints) {
    PairOfShapes pair = boxOnBox();
    pair.contact.row.relativeX = pair.contact.row.relativeY = 50.0f;
    setImpulses(pair.contact, {{1.0f, 1.0f}, {}, 0.0f});
    pair.forgetAllButTheState();
    EXPECT_EQ(pair.contact.pointCount, 0);
}

}  // namespace
}  // namespace huestep::test
