#include "tools/reference/reference_world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/collision/manifold.h"
#include "core/scene/in_double.h"
#include "core/solver/effort.h"

namespace huestep::reference {
namespace {

PoseT<double> poseOf(const Body& body) {
    return {body.position, {std::cos(body.angle), std::sin(body.angle)}};
}

double inverse(float v) {
    return v > 0.0f ? 1.0 / static_cast<double>(v) : 0.0;
}

/// Why a scene is not one for this solver; empty: it is.
std::string unknownIn(const World& start, bool soft) {
    for (std::size_t i = 0; i < start.bodies().size(); ++i) {
        const BodyInfo& body = start.bodies()[i];
        if (body.dynamic() && (body.linearDamping > 0.0f || body.angularDamping > 0.0f))
            return "damped bodies";
        if (body.type() == BodyType::Kinematic) return "kinematic bodies";
    }
    for (const ShapeInfo& shape : start.shapes()) {
        if (shape.shapeKind() == ShapeKind::ChainSegment) return "chains";
        if (soft && shape.restitution > 0.0f) return "restitution of soft rows";
        if (shape.rollingResistance > 0.0f) return "rolling resistance";
        if (shape.tangentSpeed > 0.0f || shape.tangentSpeed < 0.0f) return "conveyors";
    }
    for (const JointInfo& joint : start.joints()) {
        const std::uint32_t parts = JointInfo::spring | JointInfo::limit | JointInfo::motor;
        if (joint.kind() != JointKind::Revolute || joint.has(parts))
            return "joints other than plain hinges";
    }
    return {};
}

constexpr std::uint16_t parted = 0xffff;  // feature of a point that does not push: no vertex has it

constexpr double restitutionThreshold = 1.0;  // m/s of approach

}  // namespace

SoftRows SoftRows::ofProduct(const WorldInfo& info) {
    const double rate = static_cast<double>(info.substeps) / static_cast<double>(info.stepSeconds);
    const RowFrequency shares = rowFrequency(info.substeps);
    SoftRows rows;
    rows.contactHertz = static_cast<double>(shares.contact) * rate;
    rows.groundHertz = 2.0 * rows.contactHertz;
    rows.jointHertz = static_cast<double>(shares.joint) * rate;
    return rows;
}

Result<ReferenceWorld> ReferenceWorld::create(const World& start, const Accuracy& accuracy) {
    if (const std::string unknown = unknownIn(start, accuracy.soft.has_value()); !unknown.empty())
        return Error{"the reference solver knows no " + unknown};
    ReferenceWorld world;
    world.m_tick = static_cast<double>(start.info().stepSeconds);
    world.m_accuracy = accuracy;
    for (std::size_t i = 0; i < start.bodies().size(); ++i) {
        const BodyInfo& info = start.bodies()[i];
        const BodyMotion& motion = start.motions()[i];
        Body body;
        body.position = inDouble(motion.position);
        body.angle = std::atan2(static_cast<double>(motion.rotation.s),
                                static_cast<double>(motion.rotation.c));
        body.velocity = inDouble(motion.velocity);
        body.spin = static_cast<double>(motion.angularVelocity);
        if (info.dynamic()) {
            body.inverseMass = inverse(info.mass);
            body.inverseInertia = inverse(info.inertia);
            body.gravity = static_cast<double>(info.gravityScale) * inDouble(start.info().gravity);
        }
        world.m_bodies.push_back(body);
    }
    for (const ShapeInfo& shape : start.shapes()) {
        world.m_shapes.push_back({*start.find(shape.body), hullOf<double>(shape),
                                  static_cast<double>(shape.friction),
                                  static_cast<double>(shape.restitution), shape.filter()});
    }
    for (const JointInfo& joint : start.joints()) {
        Hinge hinge;
        hinge.a = *start.find(joint.bodyA);
        hinge.b = *start.find(joint.bodyB);
        hinge.anchorA = inDouble(joint.anchorA);
        hinge.anchorB = inDouble(joint.anchorB);
        hinge.collides = joint.has(JointInfo::collideConnected);
        world.m_hinges.push_back(hinge);
    }
    return world;
}

bool ReferenceWorld::linked(std::size_t a, std::size_t b) const {
    return std::any_of(m_hinges.begin(), m_hinges.end(), [&](const Hinge& h) {
        return !h.collides && ((h.a == a && h.b == b) || (h.a == b && h.b == a));
    });
}

/// Every pair of shapes, without any broad phase.
void ReferenceWorld::collide() {
    m_points.clear();
    for (std::size_t i = 0; i < m_shapes.size(); ++i) {
        for (std::size_t j = i + 1; j < m_shapes.size(); ++j) {
            const Shape& a = m_shapes[i];
            const Shape& b = m_shapes[j];
            const bool fixed = m_bodies[a.body].inverseMass + m_bodies[b.body].inverseMass <= 0.0;
            if (a.body == b.body || fixed || !mayTouch(a.filter, b.filter)) continue;
            if (!linked(a.body, b.body)) addPoints(i, j);
        }
    }
}

void ReferenceWorld::addPoints(std::size_t shapeA, std::size_t shapeB) {
    const Shape& a = m_shapes[shapeA];
    const Shape& b = m_shapes[shapeB];
    constexpr double margin = 0.05;  // m: nothing here goes as far within a substep
    const Body& bodyA = m_bodies[a.body];
    const Body& bodyB = m_bodies[b.body];
    const PoseT<double> poseA = poseOf(bodyA);
    const PoseT<double> seen = relative(poseA, poseOf(bodyB));
    const ManifoldT<double> manifold = huestep::collide(a.hull, b.hull, seen, margin);
    for (int i = 0; i < manifold.count; ++i) {
        Point p;
        p.a = a.body;
        p.b = b.body;
        p.shapeA = shapeA;
        p.shapeB = shapeB;
        p.feature = manifold.points[i].feature;
        p.normal = rotate(poseA.q, manifold.normal);
        const Vec2d at = transform(poseA, manifold.points[i].point);
        p.rA = at - bodyA.position;
        p.rB = at - bodyB.position;
        p.separation = manifold.points[i].separation;
        p.friction = std::sqrt(a.friction * b.friction);
        p.restitution = std::max(a.restitution, b.restitution);
        p.ground = bodyA.inverseMass <= 0.0 || bodyB.inverseMass <= 0.0;
        p.approach = dot(p.normal, relativeVelocity(p));
        const auto mass = [&](Vec2d along) {
            const double armA = cross(p.rA, along);
            const double armB = cross(p.rB, along);
            return 1.0 / (bodyA.inverseMass + bodyB.inverseMass +
                          bodyA.inverseInertia * armA * armA + bodyB.inverseInertia * armB * armB);
        };
        p.normalMass = mass(p.normal);
        p.tangentMass = mass(perpRight(p.normal));
        m_points.push_back(p);
    }
}

Vec2d ReferenceWorld::relativeVelocity(const Point& p) const {
    const Body& a = m_bodies[p.a];
    const Body& b = m_bodies[p.b];
    return (b.velocity + crossScalar(b.spin, p.rB)) - (a.velocity + crossScalar(a.spin, p.rA));
}

Vec2d ReferenceWorld::hingeError(const Hinge& hinge) const {
    return transform(poseOf(m_bodies[hinge.b]), hinge.anchorB) -
           transform(poseOf(m_bodies[hinge.a]), hinge.anchorA);
}

void ReferenceWorld::prepareHinges() {
    for (Hinge& h : m_hinges) {
        const Body& a = m_bodies[h.a];
        const Body& b = m_bodies[h.b];
        h.rA = rotate(poseOf(a).q, h.anchorA);
        h.rB = rotate(poseOf(b).q, h.anchorB);
        h.error = hingeError(h);
        const double m = a.inverseMass + b.inverseMass;
        h.k11 = m + a.inverseInertia * h.rA.y * h.rA.y + b.inverseInertia * h.rB.y * h.rB.y;
        h.k12 = -a.inverseInertia * h.rA.x * h.rA.y - b.inverseInertia * h.rB.x * h.rB.y;
        h.k22 = m + a.inverseInertia * h.rA.x * h.rA.x + b.inverseInertia * h.rB.x * h.rB.x;
    }
}

void ReferenceWorld::guess(const Impulses& last) {
    for (std::size_t i = 0; i < m_hinges.size(); ++i) {
        Hinge& h = m_hinges[i];
        h.impulse = last.hinges.empty() ? Vec2d{} : last.hinges[i].impulse;
        push(h.a, h.b, h.rA, h.rB, h.impulse);
    }
    for (Point& p : m_points) {
        const auto found =
            std::find_if(last.points.begin(), last.points.end(), [&](const Point& before) {
                return before.shapeA == p.shapeA && before.shapeB == p.shapeB &&
                       before.feature == p.feature;
            });
        const bool known = found != last.points.end();
        p.normalImpulse = known ? found->normalImpulse : 0.0;
        p.tangentImpulse = known ? found->tangentImpulse : 0.0;
        push(p.a, p.b, p.rA, p.rB,
             p.normalImpulse * p.normal + p.tangentImpulse * perpRight(p.normal));
    }
}

void ReferenceWorld::accelerate(double h) {
    for (Body& body : m_bodies) body.velocity += h * body.gravity;
}

void ReferenceWorld::move(double h) {
    for (Body& body : m_bodies) {
        body.position += h * body.velocity;
        body.angle += h * body.spin;
    }
}

void ReferenceWorld::push(std::size_t a, std::size_t b, Vec2d rA, Vec2d rB, Vec2d impulse) {
    Body& bodyA = m_bodies[a];
    Body& bodyB = m_bodies[b];
    bodyA.velocity -= bodyA.inverseMass * impulse;
    bodyA.spin -= bodyA.inverseInertia * cross(rA, impulse);
    bodyB.velocity += bodyB.inverseMass * impulse;
    bodyB.spin += bodyB.inverseInertia * cross(rB, impulse);
}

/// Each solver of a row returns how much it changed the row's velocity, m/s.
double ReferenceWorld::solveHinge(Hinge& h, Vec2d target, const Soft& soft) {
    const Body& a = m_bodies[h.a];
    const Body& b = m_bodies[h.b];
    const Vec2d velocity =
        (b.velocity + crossScalar(b.spin, h.rB)) - (a.velocity + crossScalar(a.spin, h.rA));
    const Vec2d off = velocity - target;
    const double determinant = h.k11 * h.k22 - h.k12 * h.k12;
    const Vec2d rigid{(h.k22 * off.x - h.k12 * off.y) / determinant,
                      (h.k11 * off.y - h.k12 * off.x) / determinant};
    const Vec2d change = -(soft.massScale * rigid) - soft.impulseScale * h.impulse;
    h.impulse += change;
    push(h.a, h.b, h.rA, h.rB, change);
    return length(Vec2d{h.k11 * change.x + h.k12 * change.y, h.k12 * change.x + h.k22 * change.y});
}

double ReferenceWorld::solveNormal(Point& p, double target, const Soft& soft) {
    const double off = dot(p.normal, relativeVelocity(p)) - target;
    const double wanted =
        p.normalImpulse - p.normalMass * soft.massScale * off - soft.impulseScale * p.normalImpulse;
    const double change = std::max(wanted, 0.0) - p.normalImpulse;
    p.normalImpulse += change;
    push(p.a, p.b, p.rA, p.rB, change * p.normal);
    return std::abs(change) / p.normalMass;
}

double ReferenceWorld::solveFriction(Point& p) {
    const Vec2d tangent = perpRight(p.normal);
    const double most = p.friction * p.normalImpulse;
    const double wanted = p.tangentImpulse - p.tangentMass * dot(tangent, relativeVelocity(p));
    const double change = std::clamp(wanted, -most, most) - p.tangentImpulse;
    p.tangentImpulse += change;
    push(p.a, p.b, p.rA, p.rB, change * tangent);
    return std::abs(change) / p.tangentMass;
}

/// Sweeps until no row changes its velocity by more than the residual. `pass` solves all rows once
/// and returns the largest change.
template <class Pass>
void ReferenceWorld::sweep(Pass pass) {
    double change = 0.0;
    for (int i = 0; i < m_accuracy.sweeps; ++i) {
        change = pass();
        if (change < m_accuracy.residual) break;
    }
    m_residual = std::max(m_residual, change);
}

void ReferenceWorld::rigidSubstep(double h) {
    const Soft rigid;
    // To the end of the motion: anchors meet there, points touch there and no sooner.
    accelerate(0.5 * h);
    collide();
    prepareHinges();
    const std::vector<Body> from = m_bodies;
    guess(m_first);
    std::vector<Vec2d> bends(m_hinges.size());  // m/s, what turning anchors do beyond first order
    for (int round = 0; round < 20; ++round) {
        sweep([&] {
            double change = 0.0;
            for (std::size_t i = 0; i < m_hinges.size(); ++i) {
                const Vec2d target = (-1.0 / h) * m_hinges[i].error - bends[i];
                change = std::max(change, solveHinge(m_hinges[i], target, rigid));
            }
            for (Point& p : m_points) {
                // A gap may close; an overlap, of rounding, is undone by and by.
                const double pace = p.separation > 0.0 ? 1.0 : 0.2;
                change = std::max(change, solveNormal(p, -pace * p.separation / h, rigid));
                change = std::max(change, solveFriction(p));
            }
            return change;
        });
        double open = 0.0;
        move(h);
        for (std::size_t i = 0; i < m_hinges.size(); ++i) {
            const Vec2d error = hingeError(m_hinges[i]);
            open = std::max(open, length(error));
            bends[i] += (1.0 / h) * error;
        }
        if (open < 1e-13 || round == 19) break;
        for (std::size_t i = 0; i < from.size(); ++i) {
            m_bodies[i].position = from[i].position;
            m_bodies[i].angle = from[i].angle;
        }
    }
    // At the end: velocities along the constraints as they are there.
    m_first = impulses();
    const std::vector<Point>& met = m_first.points;
    accelerate(0.5 * h);
    prepareHinges();
    for (std::size_t i = 0; i < m_points.size(); ++i) {
        if (met[i].normalImpulse <= 0.0) m_points[i].feature = parted;
    }
    guess(m_second);
    sweep([&] {
        double change = 0.0;
        for (Hinge& hinge : m_hinges) change = std::max(change, solveHinge(hinge, {}, rigid));
        for (std::size_t i = 0; i < m_points.size(); ++i) {
            if (m_points[i].feature == parted) continue;
            const bool bounces =
                met[i].restitution > 0.0 && met[i].approach < -restitutionThreshold;
            const double target = bounces ? -met[i].restitution * met[i].approach : 0.0;
            change = std::max(change, solveNormal(m_points[i], target, rigid));
            change = std::max(change, solveFriction(m_points[i]));
        }
        return change;
    });
    m_second = impulses();
}

ReferenceWorld::Soft ReferenceWorld::softnessOf(double hertz, double damping, double h) {
    const double omega = 2.0 * std::numbers::pi * hertz;
    const double a1 = 2.0 * damping + h * omega;
    const double a2 = h * omega * a1;
    return {omega / a1, a2 / (1.0 + a2), 1.0 / (1.0 + a2)};
}

void ReferenceWorld::softSubstep(double h) {
    const SoftRows& rows = *m_accuracy.soft;
    const Soft rigid;
    const Soft contact = softnessOf(rows.contactHertz, rows.contactDamping, h);
    const Soft ground = softnessOf(rows.groundHertz, rows.contactDamping, h);
    const Soft joint = softnessOf(rows.jointHertz, rows.jointDamping, h);
    const auto bounded = [&](double bias) { return std::min(bias, rows.pushSpeed); };
    accelerate(h);
    collide();
    prepareHinges();
    guess(m_first);
    sweep([&] {
        double change = 0.0;
        for (Hinge& hinge : m_hinges)
            change = std::max(change, solveHinge(hinge, -joint.biasRate * hinge.error, joint));
        for (Point& p : m_points) {
            const Soft& soft = p.ground ? ground : contact;
            const double step = p.separation > 0.0
                                    ? solveNormal(p, -p.separation / h, rigid)
                                    : solveNormal(p, bounded(-soft.biasRate * p.separation), soft);
            change = std::max(change, step);
        }
        return change;
    });
    m_first = impulses();
    move(h);
    for (Point& p : m_points) p.separation += h * dot(p.normal, relativeVelocity(p));
    prepareHinges();
    sweep([&] {
        double change = 0.0;
        for (Hinge& hinge : m_hinges) change = std::max(change, solveHinge(hinge, {}, rigid));
        for (Point& p : m_points) {
            change = std::max(change, solveNormal(p, -std::max(p.separation, 0.0) / h, rigid));
            change = std::max(change, solveFriction(p));
        }
        return change;
    });
}

void ReferenceWorld::step() {
    const double h = m_tick / m_accuracy.substeps;
    for (int i = 0; i < m_accuracy.substeps; ++i) {
        if (m_accuracy.soft)
            softSubstep(h);
        else
            rigidSubstep(h);
    }
}

namespace {

Result<Trajectory> followOnce(const World& start, std::uint64_t ticks, const Accuracy& accuracy) {
    Result<ReferenceWorld> world = ReferenceWorld::create(start, accuracy);
    if (!world) return world.error();
    Trajectory trajectory;
    const auto keep = [&] {
        trajectory.ticks.emplace_back(world->bodies().begin(), world->bodies().end());
    };
    keep();
    for (std::uint64_t tick = 0; tick < ticks; ++tick) {
        world->step();
        keep();
    }
    trajectory.residual = world->residual();
    return trajectory;
}

}  // namespace

Result<Trajectory> follow(const World& start, std::uint64_t ticks, const Accuracy& accuracy) {
    Result<Trajectory> coarse = followOnce(start, ticks, accuracy);
    if (!coarse || accuracy.soft) return coarse;
    Accuracy twice = accuracy;
    twice.substeps = 2 * accuracy.substeps;
    Result<Trajectory> fine = followOnce(start, ticks, twice);
    if (!fine) return fine;
    for (std::size_t tick = 0; tick < fine->ticks.size(); ++tick) {
        for (std::size_t i = 0; i < fine->ticks[tick].size(); ++i) {
            const Vec2d moved = fine->ticks[tick][i].position - coarse->ticks[tick][i].position;
            fine->uncertainty = std::max(fine->uncertainty, length(moved));
        }
    }
    return fine;
}

}  // namespace huestep::reference
