// Scenes whose right answer is known: a parabola, elliptic integrals, an ordinary differential
// equation in minimal coordinates, Coulomb's and Newton's laws, or the closed-form floor of soft
// rows (physics page, A3 to A17).
#include "core/math/trig.h"
#include "core/scene/scenes.h"

namespace huestep::scenes {

namespace {

/// A disc of radius 0.1 whose centre is 1 m from its anchor: I/m = 0.005, L_eff = 1.005 m.
const float bobRadius = 0.1f;

/// No shape of these scenes meets another: only joints are judged.
ShapeDef ghost(ShapeDef shape) {
    shape.filter.group = -1;
    return shape;
}

Rotation degrees(double angle) {
    return rotationOf(static_cast<float>(angle * pi / 180.0));
}

/// A unit box or a disc of radius 0.5 m that stands with its centre half a metre above the floor.
BodyDef slider(bool disc, float friction) {
    BodyDef body = bodyOf(BodyType::Dynamic, {},
                          disc ? ShapeDef::circle({}, 0.5f) : ShapeDef::box(0.5f, 0.5f));
    body.shapes[0].material.friction = friction;
    return body;
}

/// A floor whose surface goes through the origin along `q`, 50 m to either side.
BodyDef floorOf(Rotation q, float friction) {
    BodyDef floor = bodyOf(BodyType::Static, {}, ShapeDef::box(50.0f, 1.0f, {0.0f, -1.0f}));
    floor.shapes[0].material.friction = friction;
    floor.rotation = q;
    return floor;
}

/// Hangs `body` by its point `localAnchor` on the point `hook` of body `holder`, turned by `q`.
std::uint32_t hang(Scene& scene, std::uint32_t holder, Vec2 hook, BodyDef body, Vec2 localAnchor,
                   Rotation q) {
    const BodyDef& above = scene.bodies[holder];
    const Vec2 point = transform(Pose{above.position, above.rotation}, hook);
    body.rotation = q;
    body.position = point - rotate(q, localAnchor);
    JointDef joint;
    joint.bodyA = holder;
    joint.anchorA = hook;
    joint.anchorB = localAnchor;
    joint.reference = relative(above.rotation, q);
    joint.bodyB = add(scene, body);
    scene.joints.push_back(joint);
    return joint.bodyB;
}

}  // namespace

Scene ballistic(Values values) {
    Scene scene;
    scene.sleep = false;
    BodyDef ball = bodyOf(BodyType::Dynamic, {}, ShapeDef::circle({}, 0.5f));
    ball.velocity = {static_cast<float>(values[0]), static_cast<float>(values[1])};
    add(scene, ball);
    return scene;
}

Scene pendulum(Values values) {
    Scene scene;
    scene.sleep = false;
    const std::uint32_t pivot = add(scene, BodyDef{});
    const BodyDef bob = bodyOf(BodyType::Dynamic, {}, ghost(ShapeDef::circle({}, bobRadius)));
    hang(scene, pivot, {}, bob, {0.0f, 1.0f}, degrees(values[0]));
    return scene;
}

Scene doublePendulum(Values) {
    Scene scene;
    scene.sleep = false;
    const Rotation horizontal{0.0f, 1.0f};
    const std::uint32_t pivot = add(scene, BodyDef{});
    const BodyDef bob = bodyOf(BodyType::Dynamic, {}, ghost(ShapeDef::circle({}, bobRadius)));
    const std::uint32_t first = hang(scene, pivot, {}, bob, {0.0f, 1.0f}, horizontal);
    hang(scene, first, {}, bob, {0.0f, 1.0f}, horizontal);
    return scene;
}

Scene chain(Values values) {
    const double ratio = values[0];
    const Rotation q = degrees(values[1]);
    Scene scene;
    scene.sleep = false;
    const std::uint32_t pivot = add(scene, BodyDef{});
    ShapeDef bar = ghost(ShapeDef::box(0.05f, 0.25f));
    bar.density = 20.0f;  // 0.1 m x 0.5 m: 1 kg
    const BodyDef link = bodyOf(BodyType::Dynamic, {}, bar);
    std::uint32_t last = hang(scene, pivot, {}, link, {0.0f, 0.25f}, q);
    for (int i = 1; i < 10; ++i) last = hang(scene, last, {0.0f, -0.25f}, link, {0.0f, 0.25f}, q);
    const float radius = 0.6f;
    ShapeDef disc = ghost(ShapeDef::circle({}, radius));
    disc.density = static_cast<float>(ratio / (0.36 * pi));
    const BodyDef ball = bodyOf(BodyType::Dynamic, {}, disc);
    hang(scene, last, {0.0f, -0.25f}, ball, {0.0f, radius}, q);
    return scene;
}

Scene stack(Values values) {
    const std::uint32_t boxes = count(values[0]);
    Scene scene;
    scene.sleep = false;
    add(scene, bodyOf(BodyType::Static, {0.0f, -1.0f}, ShapeDef::box(20.0f, 1.0f)));
    const ShapeDef box = ShapeDef::box(0.5f, 0.5f);
    for (std::uint32_t i = 0; i < boxes; ++i) {
        const Vec2 position{i % 2 == 0 ? 0.01f : -0.01f, static_cast<float>(i) + 0.5f};
        add(scene, bodyOf(BodyType::Dynamic, position, box));
    }
    return scene;
}

Scene arm(Values values) {
    Scene scene;
    scene.sleep = false;
    scene.gravity = {};
    const std::uint32_t pivot = add(scene, BodyDef{});
    BodyDef bob = bodyOf(BodyType::Dynamic, {}, ghost(ShapeDef::circle({}, bobRadius)));
    bob.angularVelocity = static_cast<float>(values[0]);
    bob.velocity = {0.0f, 5.0f * bob.angularVelocity};
    hang(scene, pivot, {}, bob, {-5.0f, 0.0f}, {});
    return scene;
}

Scene bounce(Values values) {
    Scene scene;
    scene.sleep = false;
    BodyDef ground = floorOf({}, 0.6f);
    BodyDef ball = slider(true, 0.6f);
    ball.position = {0.0f, 0.5f + static_cast<float>(values[1])};
    for (BodyDef* body : {&ground, &ball}) {
        body->shapes[0].material.restitution = static_cast<float>(values[0]);
        add(scene, *body);
    }
    return scene;
}

Scene ramp(Values values) {
    Scene scene;
    scene.sleep = false;
    const Rotation down = degrees(-values[0]);
    const auto friction = static_cast<float>(values[1]);
    add(scene, floorOf(down, friction));
    BodyDef body = slider(values[2] != 0.0, friction);
    body.position = rotate(down, Vec2{0.0f, 0.5f});
    body.rotation = down;
    add(scene, body);
    return scene;
}

Scene slide(Values values) {
    Scene scene;
    scene.sleep = false;
    const auto friction = static_cast<float>(values[1]);
    add(scene, floorOf({}, friction));
    BodyDef body = slider(values[2] != 0.0, friction);
    body.position = {0.0f, 0.5f};
    body.velocity = {static_cast<float>(values[0]), 0.0f};
    add(scene, body);
    return scene;
}

}  // namespace huestep::scenes
