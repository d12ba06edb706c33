// The contact passes: the same bits for every width, and the physics of one row.

#include "core/solver/contact_kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/contact/narrow_phase.h"
#include "core/math/trig.h"
#include "tests/core/hulls.h"

namespace huestep::test {
namespace {

/// Blocks of contacts that share no written body, in any lane, the last one padded.
struct Rows {
    std::vector<SolverBody> bodies;
    std::vector<ContactBlock> blocks;
    std::uint32_t count = 0;
};

float orZero(Random& random, double low, double high) {
    if (random.once(8)) return random.once(2) ? 0.0f : -0.0f;
    return random.betweenF(low, high);
}

Rows randomRows(Random& random) {
    Rows rows;
    rows.count = 1 + random.below(80);
    rows.bodies.resize(1 + 2 * rows.count + 4);  // the world, two a contact, a few kinematic
    for (std::size_t i = 1; i < rows.bodies.size(); ++i) {
        SolverBody& b = rows.bodies[i];
        b.vx = orZero(random, -5.0, 5.0);
        b.vy = orZero(random, -5.0, 5.0);
        b.w = orZero(random, -5.0, 5.0);
        b.dx = orZero(random, -0.1, 0.1);
        b.dy = orZero(random, -0.1, 0.1);
        const double angle = random.between(-0.2, 0.2);
        b.dc = static_cast<float>(std::cos(angle));
        b.ds = static_cast<float>(std::sin(angle));
    }
    std::vector<BodyPlace> own;
    for (std::uint32_t i = 0; i < 2 * rows.count; ++i) own.push_back(static_cast<BodyPlace>(i + 1));
    for (std::size_t i = own.size(); i > 1; --i) std::swap(own[i - 1], own[random.below(i)]);

    rows.blocks.resize((rows.count + blockLanes - 1) / blockLanes);
    for (ContactBlock& block : rows.blocks) {
        std::memset(static_cast<void*>(&block), 0, sizeof block);
        std::fill(block.bodyA, block.bodyA + blockLanes, fixedWorld);
        std::fill(block.bodyB, block.bodyB + blockLanes, fixedWorld);
        block.mayHit = -1;
    }
    for (std::uint32_t i = 0; i < rows.count; ++i) {
        ContactBlock& block = rows.blocks[i / blockLanes];
        const std::uint32_t lane = i % blockLanes;
        block.bodyA[lane] = own[2 * i];
        block.bodyB[lane] = own[2 * i + 1];
        const bool still = random.once(3);
        const auto kinematic = static_cast<BodyPlace>(1 + 2 * rows.count + random.below(4));
        if (still)
            (random.once(2) ? block.bodyA : block.bodyB)[lane] =
                random.once(2) ? fixedWorld : ~kinematic;
        const auto inverse = [&](BodyPlace p) { return p < 0 ? 0.0f : random.betweenF(0.1, 4.0); };
        for (const BodyPlace body : {block.bodyA[lane], block.bodyB[lane]}) {
            if (body >= 0) rows.bodies[static_cast<std::size_t>(body)].inverseMass = inverse(body);
        }
        block.inverseInertiaA[lane] = inverse(block.bodyA[lane]);
        block.inverseInertiaB[lane] = random.once(4) ? 0.0f : inverse(block.bodyB[lane]);
        const double angle = random.between(-3.1, 3.1);
        block.normalX[lane] = static_cast<float>(std::cos(angle));
        block.normalY[lane] = static_cast<float>(std::sin(angle));
        block.friction[lane] = orZero(random, 0.0, 1.5);
        block.restitution[lane] = orZero(random, 0.0, 1.0);
        block.tangentSpeed[lane] = orZero(random, -2.0, 2.0);
        block.rollingResistance[lane] = orZero(random, 0.0, 0.2);
        block.rollingMass[lane] = random.betweenF(0.1, 2.0);
        block.rollingImpulse[lane] = orZero(random, -0.1, 0.1);
        for (ContactPointRows& p : block.points) {
            if (&p == &block.points[1] && random.once(3)) continue;  // a single point
            p.anchorAx[lane] = orZero(random, -1.0, 1.0);
            p.anchorAy[lane] = orZero(random, -1.0, 1.0);
            p.anchorBx[lane] = orZero(random, -1.0, 1.0);
            p.anchorBy[lane] = orZero(random, -1.0, 1.0);
            p.separation[lane] = orZero(random, -0.05, 0.02);
            p.normalMass[lane] = random.betweenF(0.1, 2.0);
            p.tangentMass[lane] = random.betweenF(0.1, 2.0);
            p.normalImpulse[lane] = std::max(orZero(random, -0.5, 1.0), 0.0f);
            p.tangentImpulse[lane] = orZero(random, -0.3, 0.3);
            p.maxNormalImpulse[lane] = p.normalImpulse[lane];
            p.approach[lane] = orZero(random, -5.0, 2.0);
        }
    }
    return rows;
}

/// A whole substep and a bounce.
void runAll(Rows& rows, const ContactKernels& kernels, const ContactPass& pass) {
    for (const ContactKernel kernel :
         {kernels.warmStart, kernels.solve, kernels.relax, kernels.restitute}) {
        kernel(rows.bodies.data(), rows.blocks.data(), rows.count, pass);
    }
}

ContactPass passOf(Random& random) {
    ContactPass pass;
    const float h = 1.0f / 240.0f;
    pass.soft = softness(30.0f, 10.0f, h);
    pass.inverseH = 240.0f;
    pass.pushSpeed = 3.0f;
    pass.features = {random.once(2), random.once(2), random.once(2), random.once(2)};
    return pass;
}

TEST(ContactKernels, KeepTheManifoldsThatTheNarrowPhaseKeeps) {
    Random random(114);
    SCOPED_TRACE(random.trace());
    constexpr std::uint32_t pairs = 64;
    std::uint32_t kept = 0, others = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<Hull> hulls;
        std::vector<BodyMotion> motions(2 * pairs);
        std::vector<Bounds> bounds(2 * pairs);
        std::vector<Contact> contacts(pairs);
        for (std::uint32_t i = 0; i < pairs; ++i) {
            for (std::uint32_t k = 0; k < 2; ++k) {
                hulls.push_back(hullOfDef<float>(randomShapeDef(random)));
            }
            Contact& c = contacts[i];
            c.bodyA = c.placeA = 2 * i;
            c.bodyB = c.placeB = 2 * i + 1;
            c.row.slack = random.betweenF(0.0, 0.05);
            c.row.reach = random.betweenF(0.0, 1.0);
            c.row.roundness = std::max(hulls[2 * i].radius, hulls[2 * i + 1].radius);
            motions[2 * i].position = random.point(-50.0, 50.0);
            motions[2 * i].rotation = rotationOf(random.betweenF(-3.1, 3.1));
            motions[2 * i + 1].position = motions[2 * i].position + random.point(-1.2, 1.2);
            motions[2 * i + 1].rotation = rotationOf(random.betweenF(-3.1, 3.1));
        }
        const auto look = [&] {
            for (std::uint32_t i = 0; i < 2 * pairs; ++i) {
                bounds[i] =
                    grown(boundsOf(hulls[i], motions[i].pose()), 0.5f * speculativeDistance);
            }
            return NarrowPhaseInput{motions, hulls, bounds};
        };
        NarrowPhaseInput in = look();
        for (Contact& c : contacts) renewContact(c, in);
        // Apart from each other a little, and all together anywhere.
        for (std::uint32_t i = 0; i < pairs; ++i) {
            const Rotation turn = rotationOf(random.betweenF(-0.25, 0.25));
            const Vec2 far = random.point(-5.0, 5.0);
            for (std::uint32_t k = 0; k < 2; ++k) {
                BodyMotion& m = motions[2 * i + k];
                m.position = rotate(turn, m.position) + far + random.point(-0.02, 0.02);
                m.rotation = normalized(
                    compose(compose(turn, rotationOf(random.betweenF(-0.02, 0.02))), m.rotation));
            }
        }
        in = look();
        std::vector<ContactBlock> blocks(pairs / blockLanes);
        for (ContactBlock& block : blocks) std::memset(static_cast<void*>(&block), 0, sizeof block);
        for (std::uint32_t i = 0; i < pairs; ++i) {
            ContactBlock& block = blocks[i / blockLanes];
            const std::uint32_t lane = i % blockLanes;
            const ContactFields<float>& row = contacts[i].row;
            block.motionA[lane] = block.boundsA[lane] = static_cast<std::int32_t>(2 * i);
            block.motionB[lane] = block.boundsB[lane] = static_cast<std::int32_t>(2 * i + 1);
            block.cosineA[lane] = row.cosineA;
            block.sineA[lane] = row.sineA;
            block.cosineB[lane] = row.cosineB;
            block.sineB[lane] = row.sineB;
            block.relativeX[lane] = row.relativeX;
            block.relativeY[lane] = row.relativeY;
            block.relativeC[lane] = row.relativeC;
            block.relativeS[lane] = row.relativeS;
            block.reach[lane] = row.reach;
            block.roundness[lane] = row.roundness;
            block.slack[lane] = row.slack;
        }
        for (const Simd simd : availableSimd()) {
            std::vector<ContactBlock> rows = blocks;
            contactKernels(simd).check(motions.data(), bounds.data(), rows.data(),
                                       static_cast<std::uint32_t>(rows.size()));
            for (std::uint32_t i = 0; i < pairs; ++i) {
                if (contacts[i].pointCount == 0) continue;
                Contact alone = contacts[i];
                const bool stays = updateContact(alone, in) == ContactUpdate::Recycled;
                ASSERT_EQ(rows[i / blockLanes].kept[i % blockLanes], stays ? -1 : 0)
                    << nameOf(simd) << " lane " << i << " of trial " << trial;
                ++(stays ? kept : others);
            }
        }
    }
    EXPECT_GT(kept, 1'000u);
    EXPECT_GT(others, 1'000u);
}

TEST(ContactKernels, StartBodiesAgainThatDoNotCarryTheirImpulsesAndNoOthers) {
    Random random(116);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 200; ++trial) {
        Rows start = randomRows(random);
        const ContactPass pass = passOf(random);
        std::vector<bool> carries(start.bodies.size());
        for (std::size_t i = 0; i < carries.size(); ++i) carries[i] = random.once(2);
        for (ContactBlock& block : start.blocks) {
            const auto warm = [&](BodyPlace place) {
                return place >= 0 && carries[static_cast<std::size_t>(place)] ? ~place : place;
            };
            for (int lane = 0; lane < blockLanes; ++lane) {
                block.warmA[lane] = warm(block.bodyA[lane]);
                block.warmB[lane] = warm(block.bodyB[lane]);
                if (block.warmA[lane] >= 0 || block.warmB[lane] >= 0) block.anyWarm = -1;
            }
        }
        for (const Simd simd : availableSimd()) {
            Rows first = start, again = start;
            contactKernels(simd).warmStart(first.bodies.data(), first.blocks.data(), first.count,
                                           pass);
            contactKernels(simd).warmStartAgain(again.bodies.data(), again.blocks.data(),
                                                again.count, pass);
            for (std::size_t i = 0; i < carries.size(); ++i) {
                const SolverBody& expected = carries[i] ? start.bodies[i] : first.bodies[i];
                ASSERT_EQ(std::memcmp(&again.bodies[i], &expected, sizeof expected), 0)
                    << nameOf(simd) << " body " << i << " of trial " << trial;
            }
        }
    }
}

TEST(ContactKernels, SettleImpulsesAsStateHoldsThemAndMarkHits) {
    Random random(115);
    SCOPED_TRACE(random.trace());
    const float inf = std::numeric_limits<float>::infinity();
    const float odd[] = {inf, -inf, std::numeric_limits<float>::quiet_NaN(), -0.0f, 1e-42f};
    for (int trial = 0; trial < 200; ++trial) {
        Rows start = randomRows(random);
        for (ContactBlock& block : start.blocks) {
            for (int lane = 0; lane < blockLanes; ++lane) {
                if (random.once(3)) block.rollingImpulse[lane] = odd[random.below(5)];
                for (ContactPointRows& p : block.points) {
                    if (random.once(3)) p.normalImpulse[lane] = odd[random.below(5)];
                    if (random.once(3)) p.tangentImpulse[lane] = odd[random.below(5)];
                }
            }
        }
        for (const Simd simd : availableSimd()) {
            Rows rows = start;
            bool any = false;
            for (std::size_t b = 0; b < rows.blocks.size(); ++b) {
                const ContactBlock& was = start.blocks[b];
                for (int lane = 0; lane < blockLanes; ++lane) {
                    for (const ContactPointRows& p : was.points) {
                        any = any || (p.approach[lane] < -1.0f && p.maxNormalImpulse[lane] > 0.0f);
                    }
                }
            }
            ASSERT_EQ(contactKernels(simd).settle(rows.blocks.data(),
                                                  static_cast<std::uint32_t>(rows.blocks.size())),
                      any);
            for (std::size_t b = 0; b < rows.blocks.size(); ++b) {
                const ContactBlock& was = start.blocks[b];
                const ContactBlock& is = rows.blocks[b];
                const auto fits = [](float before, float after) {
                    const float whole = std::isfinite(before) ? before : 0.0f;
                    return after == whole && (after != 0.0f || !std::signbit(after));
                };
                for (int lane = 0; lane < blockLanes; ++lane) {
                    ASSERT_TRUE(fits(was.rollingImpulse[lane], is.rollingImpulse[lane]));
                    bool hit = false;
                    for (std::size_t i = 0; i < 2; ++i) {
                        const ContactPointRows& p = was.points[i];
                        ASSERT_TRUE(fits(p.normalImpulse[lane], is.points[i].normalImpulse[lane]));
                        ASSERT_TRUE(
                            fits(p.tangentImpulse[lane], is.points[i].tangentImpulse[lane]));
                        hit = hit || (p.approach[lane] < -1.0f && p.maxNormalImpulse[lane] > 0.0f);
                    }
                    ASSERT_EQ(is.hit[lane], hit ? -1 : 0);
                }
            }
        }
    }
}

TEST(ContactKernels, OfEveryWidthGiveTheBitsOfTheScalarOnes) {
    Random random(111);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 400; ++trial) {
        const Rows start = randomRows(random);
        const ContactPass pass = passOf(random);
        Rows scalar = start;
        runAll(scalar, contactKernels(Simd::Scalar), pass);
        for (const Simd simd : availableSimd()) {
            Rows wideRows = start;
            runAll(wideRows, contactKernels(simd), pass);
            for (std::size_t i = 0; i < scalar.bodies.size(); ++i) {
                ASSERT_EQ(std::memcmp(&wideRows.bodies[i], &scalar.bodies[i], sizeof(SolverBody)),
                          0)
                    << nameOf(simd) << ", body " << i << ", trial " << trial;
            }
            for (std::size_t i = 0; i < scalar.blocks.size(); ++i) {
                const ContactBlock& a = wideRows.blocks[i];
                const ContactBlock& b = scalar.blocks[i];
                for (std::size_t k = 0; k < 2; ++k) {
                    for (std::size_t lane = 0; lane < blockLanes; ++lane) {
                        if (i * blockLanes + lane >= start.count) break;  // padding is nobody's
                        const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
                        ASSERT_EQ(bits(a.points[k].normalImpulse[lane]),
                                  bits(b.points[k].normalImpulse[lane]));
                        ASSERT_EQ(bits(a.points[k].tangentImpulse[lane]),
                                  bits(b.points[k].tangentImpulse[lane]));
                        ASSERT_EQ(bits(a.points[k].maxNormalImpulse[lane]),
                                  bits(b.points[k].maxNormalImpulse[lane]));
                        ASSERT_EQ(bits(a.rollingImpulse[lane]), bits(b.rollingImpulse[lane]));
                    }
                }
            }
        }
    }
}

/// Where bodies are, and how they were turned when the manifolds of `rows` were made.
std::vector<SolverPose> randomPoses(Random& random, Rows& rows) {
    const auto turn = [&](float& c, float& s) {
        const double angle = random.between(-3.1, 3.1);
        c = static_cast<float>(std::cos(angle));
        s = static_cast<float>(std::sin(angle));
    };
    std::vector<SolverPose> poses(rows.bodies.size());
    for (SolverPose& pose : poses) {
        pose.x = random.betweenF(-20.0, 20.0);
        pose.y = random.betweenF(-20.0, 20.0);
        turn(pose.c, pose.s);
    }
    for (ContactBlock& block : rows.blocks) {
        for (std::size_t lane = 0; lane < blockLanes; ++lane) {
            turn(block.cosineA[lane], block.sineA[lane]);
            turn(block.cosineB[lane], block.sineB[lane]);
            for (ContactPointRows& p : block.points) {
                p.madeSeparation[lane] = random.betweenF(-0.05, 0.02);
            }
        }
    }
    return poses;
}

struct Point {
    double x = 0, y = 0;
};

double wide(float v) {
    return static_cast<double>(v);
}

/// An anchor now: turned with its body from how it was when the manifold was made. In double.
Point anchorNow(const SolverPose& pose, float cosine, float sine, double x, double y) {
    const double by = std::atan2(wide(pose.s), wide(pose.c)) - std::atan2(wide(sine), wide(cosine));
    return {wide(pose.x) + std::cos(by) * x - std::sin(by) * y,
            wide(pose.y) + std::sin(by) * x + std::cos(by) * y};
}

TEST(ContactKernels, RefreshFollowsTheBodiesFromWhereTheManifoldWasMadeAtEveryWidth) {
    Random random(113);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 100 && !HasFatalFailure(); ++trial) {
        Rows start = randomRows(random);
        const std::vector<SolverPose> poses = randomPoses(random, start);
        const auto count = static_cast<std::uint32_t>(start.blocks.size());
        Rows scalar = start;
        contactKernels(Simd::Scalar)
            .refresh(scalar.bodies.data(), poses.data(), scalar.blocks.data(), count);
        for (const Simd simd : availableSimd()) {
            Rows lanes = start;
            contactKernels(simd).refresh(lanes.bodies.data(), poses.data(), lanes.blocks.data(),
                                         count);
            ASSERT_EQ(std::memcmp(lanes.blocks.data(), scalar.blocks.data(),
                                  count * sizeof(ContactBlock)),
                      0)
                << nameOf(simd);
        }
        for (std::uint32_t i = 0; i < start.count; ++i) {
            const ContactBlock& block = scalar.blocks[i / blockLanes];
            const std::size_t lane = i % blockLanes;
            const auto a = static_cast<std::size_t>(readPlace(block.bodyA[lane]));
            const auto b = static_cast<std::size_t>(readPlace(block.bodyB[lane]));
            const double nx = wide(block.normalX[lane]), ny = wide(block.normalY[lane]);
            const SolverBody& u = scalar.bodies[a];
            const SolverBody& v = scalar.bodies[b];
            for (const ContactPointRows& p : block.points) {
                const double ax = wide(p.anchorAx[lane]), ay = wide(p.anchorAy[lane]);
                const double bx = wide(p.anchorBx[lane]), by = wide(p.anchorBy[lane]);
                const Point onA =
                    anchorNow(poses[a], block.cosineA[lane], block.sineA[lane], ax, ay);
                const Point onB =
                    anchorNow(poses[b], block.cosineB[lane], block.sineB[lane], bx, by);
                const double apart = nx * (onB.x - onA.x) + ny * (onB.y - onA.y);
                const double met = nx * (bx - ax) + ny * (by - ay);
                ASSERT_NEAR(wide(p.separation[lane]), wide(p.madeSeparation[lane]) + apart - met,
                            3e-5);
                const double vx = (wide(v.vx) - wide(v.w) * by) - (wide(u.vx) - wide(u.w) * ay);
                const double vy = (wide(v.vy) + wide(v.w) * bx) - (wide(u.vy) + wide(u.w) * ax);
                ASSERT_NEAR(wide(p.approach[lane]), nx * vx + ny * vy, 3e-5);
                ASSERT_EQ(p.maxNormalImpulse[lane], 0.0f);
            }
        }
    }
}

TEST(ContactKernels, NeverWriteTheWorldNorKinematicBodiesNorPositions) {
    Random random(112);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 100; ++trial) {
        const Rows start = randomRows(random);
        for (const Simd simd : availableSimd()) {
            Rows rows = start;
            runAll(rows, contactKernels(simd), passOf(random));
            for (std::size_t i = 0; i < rows.bodies.size(); ++i) {
                const SolverBody& a = rows.bodies[i];
                const SolverBody& b = start.bodies[i];
                ASSERT_TRUE(a.dx == b.dx && a.dy == b.dy && a.dc == b.dc && a.ds == b.ds);
                if (i != 0 && i < 1 + 2 * start.count) continue;
                ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0) << nameOf(simd) << ", body " << i;
            }
        }
    }
}

TEST(ContactKernels, KeepImpulsesWithinTheirCones) {
    Random random(113);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 200; ++trial) {
        Rows rows = randomRows(random);
        ContactPass pass = passOf(random);
        pass.features = {true, true, true, false};
        const ContactKernels& kernels = contactKernels(Simd::Auto);
        kernels.warmStart(rows.bodies.data(), rows.blocks.data(), rows.count, pass);
        kernels.solve(rows.bodies.data(), rows.blocks.data(), rows.count, pass);
        kernels.relax(rows.bodies.data(), rows.blocks.data(), rows.count, pass);
        for (std::uint32_t i = 0; i < rows.count; ++i) {
            const ContactBlock& block = rows.blocks[i / blockLanes];
            const std::uint32_t lane = i % blockLanes;
            float load = 0.0f;
            for (const ContactPointRows& p : block.points) {
                ASSERT_GE(p.normalImpulse[lane], 0.0f);
                ASSERT_GE(p.maxNormalImpulse[lane], p.normalImpulse[lane]);
                ASSERT_LE(std::abs(p.tangentImpulse[lane]),
                          block.friction[lane] * p.normalImpulse[lane]);
                load += p.normalImpulse[lane];
            }
            ASSERT_LE(std::abs(block.rollingImpulse[lane]),
                      block.rollingResistance[lane] * load * 1.000001f);
        }
    }
}

TEST(ContactKernels, OneRowStopsTwoDiscsAsAnInelasticCollisionDoesAndRestitutionBouncesThem) {
    Rows rows;
    rows.count = 1;
    rows.bodies.resize(3);
    rows.blocks.resize(1);
    ContactBlock& block = rows.blocks[0];
    std::memset(static_cast<void*>(&block), 0, sizeof block);
    std::fill(block.bodyA, block.bodyA + blockLanes, fixedWorld);
    std::fill(block.bodyB, block.bodyB + blockLanes, fixedWorld);
    rows.bodies[1].vx = 3.0f;   // 2 kg
    rows.bodies[2].vx = -1.0f;  // 0.5 kg
    block.bodyA[0] = 1;
    block.bodyB[0] = 2;
    rows.bodies[1].inverseMass = 0.5f;
    rows.bodies[2].inverseMass = 2.0f;
    block.mayHit = -1;
    block.normalX[0] = 1.0f;
    block.restitution[0] = 0.5f;
    block.points[0].normalMass[0] = 1.0f / 2.5f;
    block.points[0].approach[0] = -4.0f;
    ContactPass pass;
    pass.soft = softness(30.0f, 10.0f, 1.0f / 240.0f);
    pass.inverseH = 240.0f;
    pass.pushSpeed = 3.0f;
    pass.features.restitution = true;
    const ContactKernels& kernels = contactKernels(Simd::Scalar);
    kernels.relax(rows.bodies.data(), rows.blocks.data(), 1, pass);
    const double common = (2.0 * 3.0 - 0.5) / 2.5;
    EXPECT_NEAR(wide(rows.bodies[1].vx), common, 1e-6);
    EXPECT_NEAR(wide(rows.bodies[2].vx), common, 1e-6);
    kernels.restitute(rows.bodies.data(), rows.blocks.data(), 1, pass);
    EXPECT_NEAR(wide(rows.bodies[2].vx - rows.bodies[1].vx), 0.5 * 4.0, 1e-5);
    EXPECT_NEAR(2.0 * wide(rows.bodies[1].vx) + 0.5 * wide(rows.bodies[2].vx), 5.5, 1e-5);
}

TEST(Simd, NamesReadBackAndScalarIsAlwaysThere) {
    const std::vector<Simd> all = availableSimd();
    ASSERT_FALSE(all.empty());
    EXPECT_EQ(all.front(), Simd::Scalar);
    for (const Simd simd : all) EXPECT_EQ(simdFromName(nameOf(simd)), simd);
    EXPECT_EQ(simdFromName("auto"), Simd::Auto);
    EXPECT_FALSE(simdFromName("mmx"));
}

TEST(Simd, EveryProcessorOfAFamilyHasFourLanes) {
    const std::vector<Simd> all = availableSimd();
#if defined(__x86_64__)
    ASSERT_GE(all.size(), 2u);
    EXPECT_EQ(all[1], Simd::Sse2);
#elif defined(__aarch64__)
    EXPECT_EQ(all, (std::vector{Simd::Scalar, Simd::Neon}));
#endif
}

}  // namespace
}  // namespace huestep::test
