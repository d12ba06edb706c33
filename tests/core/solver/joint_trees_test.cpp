// Trees of joints: which joints are in them, and their solution against a dense one in double.
#include "core/solver/joint_trees.h"

#include <algorithm>
#include <cmath>

#include "core/math/trig.h"
#include "core/solver/rows.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

/// Rows of a world's joints in one batch, ready to be solved.
class Bench {
 public:
    explicit Bench(const Scene& scene, float h = 0.004f) : world(worldOf(scene)) {
        std::vector<Link> links;
        std::vector<std::uint32_t> awake;
        for (std::uint32_t i = 0; i < world.joints().size(); ++i) {
            const JointInfo& joint = world.joints()[i];
            const ConstraintPlaces of{*world.find(joint.bodyA), *world.find(joint.bodyB)};
            m_jointBodies.push_back(of);
            links.push_back({of.a, of.b, i, joint.kind() == JointKind::Revolute});
        }
        const auto count = static_cast<std::uint32_t>(world.bodies().size());
        for (std::uint32_t i = 0; i < count; ++i) {
            if (world.bodies()[i].dynamic()) awake.push_back(i);
        }
        const auto joints = static_cast<std::uint32_t>(links.size());
        makePlan(plan, std::move(links), joints, std::move(awake), count, {},
                 {.substeps = 1, .trees = true});
        // As if sweeps touched every body.
        std::fill(plan.hasContact.begin(), plan.hasContact.end(), std::uint8_t{1});
        m_motions.assign(world.motions().begin(), world.motions().end());
        m_impulses.resize(joints);
        SolverWorld of;
        of.bodies = world.bodies();
        of.motions = m_motions;
        of.joints = world.joints();
        of.jointBodies = m_jointBodies;
        of.jointImpulses = m_impulses;
        rows.fit(plan);
        const Batch& batch = plan.batches.at(0);
        rows.prepareBodies(plan, of, h, {batch.firstPlace, batch.endPlace});
        rows.prepareJoints(plan, of, batch, h, {batch.firstJoint, batch.endJoint});
        trees.build(plan, batch, rows);
    }

    /// The row of the joint at that place of the scene.
    [[nodiscard]] const JointRow& rowOf(std::size_t joint) const {
        for (const JointRow& row : rows.joints) {
            if (row.joint == joint) return row;
        }
        ADD_FAILURE() << "no row of joint " << joint;
        return rows.joints.front();
    }
    /// The solver's copy of the body at that place of the scene; of one without joints, nothing.
    SolverBody* body(std::size_t place) {
        const auto at = std::find(plan.bodyOfPlace.begin() + 1, plan.bodyOfPlace.end(), place);
        if (at == plan.bodyOfPlace.end()) return nullptr;
        return &rows.bodies[static_cast<std::size_t>(at - plan.bodyOfPlace.begin())];
    }

    World world;
    Plan plan;
    Rows rows;
    JointTrees trees;

 private:
    std::vector<ConstraintPlaces> m_jointBodies;
    std::vector<BodyMotion> m_motions;
    std::vector<JointImpulses> m_impulses;
};

/// A joint of a random kind that holds, between two bodies that are placed already.
JointDef randomJoint(Random& random, const Scene& scene, std::uint32_t a, std::uint32_t b) {
    constexpr std::array kinds{JointKind::Revolute, JointKind::Weld, JointKind::Distance,
                               JointKind::Prismatic};
    const auto poseOf = [&](std::uint32_t i) {
        return Pose{scene.bodies[i].position, scene.bodies[i].rotation};
    };
    JointDef joint = hinge(a, {}, b, random.point(-1.0, 1.0));
    joint.kind = kinds[random.below(kinds.size())];
    const Vec2 point = transform(poseOf(b), joint.anchorB);
    joint.reference = relative(poseOf(a).q, poseOf(b).q);
    joint.axis = rotationOf(random.betweenF(-3.0, 3.0));
    Vec2 from = point;
    if (joint.kind == JointKind::Prismatic) {
        const Vec2 axis = rotate(poseOf(a).q, Vec2{joint.axis.c, joint.axis.s});
        from = point - random.betweenF(-1.0, 1.0) * axis;
    } else if (joint.kind == JointKind::Distance) {
        joint.length = random.betweenF(0.5, 2.0);
        from = point - joint.length * rotate(rotationOf(random.betweenF(-3.0, 3.0)), {1.0f, 0.0f});
    }
    joint.anchorA = untransform(poseOf(a), from);
    return joint;
}

/// A forest of up to 25 bodies and a wall, of which some trees hang on, some by several joints.
Scene randomForest(Random& random, double lightest, double heaviest) {
    Scene scene = sceneOf({BodyDef{}});
    const std::uint32_t bodies = 1 + random.below(25);
    for (std::uint32_t i = 1; i <= bodies; ++i) {
        ShapeDef box = ShapeDef::box(random.betweenF(0.1, 0.6), random.betweenF(0.1, 0.6));
        box.filter.group = -1;
        box.density =
            static_cast<float>(std::exp(random.between(std::log(lightest), std::log(heaviest))));
        BodyDef body = bodyAt(BodyType::Dynamic, random.point(-4.0, 4.0), box);
        body.rotation = rotationOf(random.betweenF(-3.0, 3.0));
        scene.bodies.push_back(body);
        if (random.once(8)) continue;
        const std::uint32_t other = random.once(3) ? i - 1 : random.below(i);
        const bool turned = random.once(2);
        scene.joints.push_back(turned ? randomJoint(random, scene, i, other)
                                      : randomJoint(random, scene, other, i));
    }
    return scene;
}

using Row = std::vector<double>;

/// J of all joints, three columns a body, from definitions alone.
std::vector<Row> denseJacobian(const Scene& scene) {
    std::vector<Row> all;
    for (const JointDef& joint : scene.joints) {
        const auto armOf = [&](std::uint32_t body, Vec2 anchor) {
            return rotate(RotationT<double>{wide(scene.bodies[body].rotation.c),
                                            wide(scene.bodies[body].rotation.s)},
                          wide(anchor));
        };
        const auto positionOf = [&](std::uint32_t body) {
            return wide(scene.bodies[body].position);
        };
        const Vec2T<double> rA = armOf(joint.bodyA, joint.anchorA);
        const Vec2T<double> rB = armOf(joint.bodyB, joint.anchorB);
        const Vec2T<double> between =
            (positionOf(joint.bodyB) + rB) - (positionOf(joint.bodyA) + rA);
        const auto add = [&](Vec2T<double> n, double armA, double armB) {
            Row row(3 * scene.bodies.size(), 0.0);
            const auto put = [&](std::uint32_t body, double sign, double arm) {
                row[3 * body] += sign * n.x;
                row[3 * body + 1] += sign * n.y;
                row[3 * body + 2] += sign * arm;
            };
            put(joint.bodyA, -1.0, armA);
            put(joint.bodyB, 1.0, armB);
            all.push_back(row);
        };
        const auto addPoint = [&](Vec2T<double> n, Vec2T<double> reach) {
            add(n, cross(reach, n), cross(rB, n));
        };
        switch (joint.kind) {
            case JointKind::Distance:
                addPoint((1.0 / length(between)) * between, rA);
                break;
            case JointKind::Prismatic:
                addPoint(perpLeft(armOf(joint.bodyA, {joint.axis.c, joint.axis.s})), rA + between);
                break;
            default:
                addPoint({1.0, 0.0}, rA);
                addPoint({0.0, 1.0}, rA);
        }
        if (joint.kind == JointKind::Weld || joint.kind == JointKind::Prismatic) {
            add({}, 1.0, 1.0);
        }
    }
    return all;
}

/// Gauss with pivots: a x = b.
Row denseSolve(std::vector<Row> a, Row b) {
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < n; ++i) {
            if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
        }
        std::swap(a[k], a[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double factor = a[i][k] / a[k][k];
            for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
            b[i] -= factor * b[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
    return b;
}

/// v less M⁻¹ Jᵀ (J M⁻¹ Jᵀ)⁻¹ J v: the nearest velocities with which all joints hold.
Row denseProjection(const std::vector<Row>& jacobian, const Row& inverseMass, const Row& v) {
    const std::size_t rows = jacobian.size();
    std::vector<Row> a(rows, Row(rows, 0.0));
    Row rate(rows, 0.0);
    for (std::size_t i = 0; i < rows; ++i) {
        for (std::size_t k = 0; k < v.size(); ++k) {
            rate[i] += jacobian[i][k] * v[k];
            for (std::size_t j = 0; j < rows; ++j) {
                a[i][j] += jacobian[i][k] * inverseMass[k] * jacobian[j][k];
            }
        }
    }
    const Row impulses = denseSolve(a, rate);
    Row projected = v;
    for (std::size_t i = 0; i < rows; ++i) {
        for (std::size_t k = 0; k < v.size(); ++k) {
            projected[k] -= inverseMass[k] * jacobian[i][k] * impulses[i];
        }
    }
    return projected;
}

/// Random velocities into the bench; solves them twice; returns how far the worst body is from the
/// dense solution, of the largest velocity there is.
double projectionError(Random& random, const Scene& scene) {
    Bench bench(scene);
    bench.trees.begin(bench.rows, 0.004f);
    bench.trees.turn(bench.rows);
    Row inverseMass(3 * scene.bodies.size(), 0.0), v(inverseMass);
    for (std::uint32_t i = 1; i < scene.bodies.size(); ++i) {
        const BodyInfo& info = bench.world.bodies()[i];
        inverseMass[3 * i] = inverseMass[3 * i + 1] = 1.0 / wide(info.mass);
        inverseMass[3 * i + 2] = 1.0 / wide(info.inertia);
        if (bench.body(i) == nullptr) continue;
        SolverBody& body = *bench.body(i);
        body.vx = random.betweenF(-5.0, 5.0);
        body.vy = random.betweenF(-5.0, 5.0);
        body.w = random.betweenF(-5.0, 5.0);
        v[3 * i] = wide(body.vx);
        v[3 * i + 1] = wide(body.vy);
        v[3 * i + 2] = wide(body.w);
    }
    const Row exact = denseProjection(denseJacobian(scene), inverseMass, v);
    bench.trees.solveVelocities(bench.rows);
    bench.trees.solveVelocities(bench.rows);
    double worst = 0.0, most = 5.0;
    for (std::uint32_t i = 1; i < scene.bodies.size(); ++i) {
        if (bench.body(i) == nullptr) continue;
        const SolverBody& body = *bench.body(i);
        const std::array<float, 3> now{body.vx, body.vy, body.w};
        for (std::size_t k = 0; k < 3; ++k) {
            worst = std::max(worst, std::abs(wide(now[k]) - exact[3 * i + k]));
            most = std::max(most, std::abs(exact[3 * i + k]));
        }
    }
    return worst / most;
}

TEST(JointTrees, SolveAsADenseSolutionDoes) {
    Random random(71);
    SCOPED_TRACE(random.trace());
    int solved = 0;
    for (int i = 0; i < 200; ++i) {
        const Scene scene = randomForest(random, 0.5, 2.0);
        if (scene.joints.empty()) continue;
        EXPECT_LT(projectionError(random, scene), 1e-4) << "forest " << i;
        ++solved;
    }
    EXPECT_GT(solved, 150);
}

TEST(JointTrees, SolveAsADenseSolutionDoesAtMassRatiosOfAMillion) {
    Random random(72);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 200; ++i) {
        const Scene scene = randomForest(random, 0.01, 1e4);
        if (scene.joints.empty()) continue;
        EXPECT_LT(projectionError(random, scene), 1e-2) << "forest " << i;
    }
}

TEST(JointTrees, ImpulsesAreWhatChangedTheBodies) {
    Random random(73);
    SCOPED_TRACE(random.trace());
    for (int i = 0; i < 100; ++i) {
        const Scene scene = randomForest(random, 0.5, 2.0);
        if (scene.joints.empty()) continue;
        Bench bench(scene);
        for (std::uint32_t k = 1; k < scene.bodies.size(); ++k) {
            if (bench.body(k) == nullptr) continue;
            bench.body(k)->vx = random.betweenF(-0.01, 0.01);
            bench.body(k)->w = random.betweenF(-0.01, 0.01);
        }
        const std::vector<SolverBody> before = bench.rows.bodies;
        bench.trees.begin(bench.rows, 0.004f);
        const std::vector<Row> jacobian = denseJacobian(scene);
        Row pushed(3 * scene.bodies.size(), 0.0);
        std::size_t row = 0;
        for (std::size_t j = 0; j < scene.joints.size(); ++j) {
            const JointRow& of = bench.rowOf(j);
            ASSERT_TRUE(of.direct);
            for (std::uint32_t k = 0; k < rigidRowCount(of); ++k, ++row) {
                for (std::size_t c = 0; c < pushed.size(); ++c) {
                    pushed[c] += jacobian[row][c] * wide(rigidImpulses(of)[k]);
                }
            }
        }
        ASSERT_EQ(row, jacobian.size());
        for (std::uint32_t k = 1; k < scene.bodies.size(); ++k) {
            const BodyInfo& info = bench.world.bodies()[k];
            if (bench.body(k) == nullptr) continue;
            const SolverBody& now = *bench.body(k);
            const auto at = static_cast<std::size_t>(&now - bench.rows.bodies.data());
            const double mass = wide(info.mass), inertia = wide(info.inertia);
            EXPECT_NEAR(mass * wide(now.vx - before[at].vx), pushed[3 * k], 1e-5 * (1 + mass));
            EXPECT_NEAR(mass * wide(now.vy - before[at].vy), pushed[3 * k + 1], 1e-5 * (1 + mass));
            EXPECT_NEAR(inertia * wide(now.w - before[at].w), pushed[3 * k + 2], 1e-5 * (1 + mass));
        }
    }
}

TEST(JointTrees, LeaveTheJointThatClosesALoopToTheSweeps) {
    Scene scene;
    for (int i = 0; i < 9; ++i) scene.bodies.push_back(boxAt({static_cast<float>(i), 0.0f}, 0.2f));
    for (std::uint32_t i = 0; i < 9; ++i) {
        scene.joints.push_back(hinge(i, {0.3f, 0.1f}, (i + 1) % 9, {-0.3f, 0.2f}));
    }
    const Bench bench(scene);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_TRUE(bench.rowOf(i).direct) << i;
    EXPECT_FALSE(bench.rowOf(8).direct) << "the last by id";
    EXPECT_TRUE(bench.trees.leavesWork());
    EXPECT_EQ(bench.trees.size(), 8u);
}

TEST(JointTrees, LeaveANetToTheSweeps) {
    Scene scene;
    for (int i = 0; i < 16; ++i) {
        const Vec2 at{static_cast<float>(i % 4), static_cast<float>(i / 4)};
        scene.bodies.push_back(discAt(at, 0.4f));
    }
    for (std::uint32_t i = 0; i < 16; ++i) {
        if (i % 4 != 3) scene.joints.push_back(hinge(i, {0.5f, 0.0f}, i + 1, {-0.5f, 0.0f}));
        if (i < 12) scene.joints.push_back(hinge(i, {0.0f, 0.5f}, i + 4, {0.0f, -0.5f}));
    }
    const Bench bench(scene);
    EXPECT_EQ(bench.trees.size(), 0u);
}

TEST(JointTrees, LeaveWhatHoldsTheHeldToTheSweeps) {
    // A disc on two pins to the wall, and a bar between two walls that is pinned at both ends.
    Scene scene = sceneOf({BodyDef{}, discAt({0.0f, 0.0f}), boxAt({5.0f, 0.0f})});
    scene.joints = {
        hinge(0, {0.5f, 0.0f}, 1, {0.5f, 0.0f}), hinge(0, {0.0f, 0.5f}, 1, {0.0f, 0.5f}),
        hinge(0, {4.0f, 0.0f}, 2, {-1.0f, 0.0f}), hinge(2, {1.0f, 0.0f}, 0, {6.0f, 0.0f})};
    const Bench bench(scene);
    EXPECT_TRUE(bench.rowOf(0).direct);
    EXPECT_FALSE(bench.rowOf(1).direct);
    EXPECT_TRUE(bench.rowOf(2).direct);
    EXPECT_FALSE(bench.rowOf(3).direct);
}

TEST(JointTrees, HoldABridgeAtBothEnds) {
    Scene scene = sceneOf({BodyDef{}});
    for (int i = 0; i < 3; ++i) scene.bodies.push_back(boxAt({static_cast<float>(i), 0.0f}, 0.4f));
    scene.joints = {
        hinge(0, {-0.5f, 0.0f}, 1, {-0.5f, 0.0f}), hinge(1, {0.5f, 0.0f}, 2, {-0.5f, 0.0f}),
        hinge(2, {0.5f, 0.0f}, 3, {-0.5f, 0.0f}), hinge(3, {0.5f, 0.0f}, 0, {2.5f, 0.0f})};
    const Bench bench(scene);
    EXPECT_EQ(bench.trees.size(), 4u);
    EXPECT_FALSE(bench.trees.leavesWork());
}

TEST(JointTrees, LeaveAnAngleThatNeitherBodyCanTurnToTheSweeps) {
    // A lift on a rail, and two welded bodies of unlike mass, none of which can turn.
    Scene scene = sceneOf(
        {BodyDef{}, boxAt({0.0f, 0.0f}), boxAt({5.0f, 0.0f}, 0.2f), boxAt({6.0f, 0.0f}, 0.7f)});
    scene.sleep = false;
    for (std::size_t i = 1; i < 4; ++i) scene.bodies[i].fixedRotation = true;
    JointDef rail = hinge(0, {}, 1, {});
    rail.kind = JointKind::Prismatic;
    rail.axis = {0.0f, 1.0f};
    JointDef weld = hinge(2, {0.5f, 0.0f}, 3, {-0.5f, 0.0f});
    weld.kind = JointKind::Weld;
    scene.joints = {rail, weld};
    const Bench bench(scene);
    EXPECT_FALSE(bench.rowOf(0).direct);
    EXPECT_FALSE(bench.rowOf(1).direct);
    World world = worldOf(scene);
    run(world, 60);
    EXPECT_TRUE(world.events().quarantined.empty());
    for (std::size_t i = 1; i < 4; ++i) {
        EXPECT_NEAR(wide(world.motions()[i].velocity.y), -10.0, 0.1) << "body " << i;
    }
}

TEST(JointTrees, LeaveSpringsMotorsAndLimitsToTheSweeps) {
    Scene scene = sceneOf({BodyDef{}, boxAt({1.0f, 0.0f})}, {hinge(0, {}, 1, {-1.0f, 0.0f})});
    EXPECT_FALSE(Bench(scene).trees.leavesWork());
    scene.joints[0].motor = {true, 1.0f, 10.0f};
    const Bench bench(scene);
    EXPECT_TRUE(bench.rowOf(0).direct) << "the pin itself";
    EXPECT_TRUE(bench.trees.leavesWork());
}

}  // namespace
}  // namespace huestep::test
