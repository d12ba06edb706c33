#include "core/scene/placement.h"

#include <algorithm>
#include <limits>

#include "core/math/trig.h"
#include "core/scene/in_double.h"
#include "core/scene/scenes.h"

namespace huestep {

namespace {

using Vec2d = Vec2T<double>;

constexpr float nudge = 1.0e-3f;        // m, rad, m/s and rad/s
constexpr float thicknessShare = 0.1f;  // of a body, that it is moved by at most
constexpr double metresPerKilometre = 1000.0;

Vec2 rounded(Vec2d v) {
    return canonicalZero(Vec2{static_cast<float>(v.x), static_cast<float>(v.y)});
}

Rotation rounded(RotationT<double> q) {
    return canonicalZero(Rotation{static_cast<float>(q.c), static_cast<float>(q.s)});
}

/// m: the least width of the shape over the normals of its edges.
float thicknessOf(const ShapeDef& shape) {
    float least = 2.0f * shape.radius;
    if (shape.kind != ShapeKind::Polygon) return least;
    least = std::numeric_limits<float>::max();
    const std::size_t count = shape.vertexCount;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2 start = shape.vertices[i];
        const Vec2 normal = normalized(perpRight(shape.vertices[(i + 1) % count] - start));
        float deepest = 0.0f;
        for (std::size_t j = 0; j < count; ++j)
            deepest = std::max(deepest, -dot(normal, shape.vertices[j] - start));
        least = std::min(least, deepest);
    }
    return least + 2.0f * shape.radius;
}

float nudgeOf(const BodyDef& body) {
    float most = nudge;
    for (const ShapeDef& shape : body.shapes)
        most = std::min(most, thicknessShare * thicknessOf(shape));
    return most;
}

/// Draws five numbers a dynamic body whatever it does with them, so that a joint more or less
/// leaves the others alone.
void disturb(Scene& scene, std::uint64_t seed) {
    std::vector<bool> jointed(scene.bodies.size(), false);
    for (const JointDef& joint : scene.joints) jointed[joint.bodyA] = jointed[joint.bodyB] = true;
    scenes::Sequence draw(seed);
    const auto next = [&draw] { return draw.between(-1.0f, 1.0f); };
    next();  // the first number of a small seed is small
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        BodyDef& body = scene.bodies[i];
        if (body.type != BodyType::Dynamic) continue;
        const Vec2 aside{next(), next()};
        const float turned = nudge * next();
        if (!jointed[i]) {
            body.position += nudgeOf(body) * aside;
            body.rotation = normalized(compose(cayley(0.5f * turned), body.rotation));
        } else if (!body.asleep) {
            body.velocity += nudge * aside;
            body.angularVelocity += turned;
        }
    }
}

/// Turns and moves what has to do with the frame.
struct Mover {
    PoseT<double> frame;

    [[nodiscard]] Vec2 direction(Vec2 v) const { return rounded(rotate(frame.q, inDouble(v))); }
    [[nodiscard]] Vec2 point(Vec2 p) const { return rounded(transform(frame, inDouble(p))); }
    [[nodiscard]] Rotation rotation(Rotation q) const {
        return rounded(compose(frame.q, inDouble(q)));
    }
    void move(BodyDef& body) const {
        body.position = point(body.position);
        body.rotation = rotation(body.rotation);
        body.velocity = direction(body.velocity);
    }
    void move(JointDef& joint) const {
        if (joint.kind == JointKind::Mouse) joint.target = point(joint.target);
    }

    void operator()(ApplyImpulse& action) const {
        action.impulse = direction(action.impulse);
        action.point = point(action.point);
    }
    void operator()(ApplyForce& action) const {
        action.force = direction(action.force);
        action.point = point(action.point);
    }
    void operator()(Grab& action) const {
        action.point = point(action.point);
        action.target = point(action.target);
    }
    void operator()(MoveGrab& action) const { action.target = point(action.target); }
    void operator()(Spawn& action) const {
        for (BodyDef& body : action.bodies) move(body);
        for (JointDef& joint : action.joints) move(joint);
    }
    void operator()(SetVelocity& action) const { action.velocity = direction(action.velocity); }
    void operator()(SetTarget& action) const {
        action.position = point(action.position);
        action.rotation = rotation(action.rotation);
    }
    /// Players come and go, bodies and joints go, motors turn: without a frame.
    template <class Other>
    void operator()(Other&) const {}
};

bool moves(const Placement& placement) {
    return placement.turn != 0.0 || placement.far != 0.0;
}

}  // namespace

PoseT<double> frameOf(const Placement& placement) {
    const double metres = metresPerKilometre * placement.far;
    return {{0.8 * metres, -0.6 * metres}, rotationOf(placement.turn * pi / 180.0)};
}

void place(Scene& scene, const Placement& placement) {
    if (placement.seed != 0) disturb(scene, placement.seed);
    if (!moves(placement)) return;
    const Mover mover{frameOf(placement)};
    scene.gravity = mover.direction(scene.gravity);
    for (BodyDef& body : scene.bodies) mover.move(body);
    for (JointDef& joint : scene.joints) mover.move(joint);
    if (!scene.players) return;
    for (Vec2& point : scene.players->spawnPoints) point = mover.point(point);
    if (!scene.players->body) return;
    BodyDef& body = *scene.players->body;
    body.rotation = mover.rotation(body.rotation);
    body.velocity = mover.direction(body.velocity);
}

void place(Action& action, const Placement& placement) {
    if (moves(placement)) std::visit(Mover{frameOf(placement)}, action);
}

}  // namespace huestep
