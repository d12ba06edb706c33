#include "tools/metrics/scenes.h"

#include <random>

#include "core/math/trig.h"

namespace huestep::tools {

BodyDef bodyOf(Vec2 position, const ShapeDef& shape) {
    BodyDef body;
    body.type = BodyType::Dynamic;
    body.position = position;
    body.shapes = {shape};
    return body;
}

std::uint32_t add(Scene& scene, BodyDef body) {
    scene.bodies.push_back(std::move(body));
    return static_cast<std::uint32_t>(scene.bodies.size() - 1);
}

void hinge(Scene& scene, std::uint32_t bodyA, std::uint32_t bodyB, Vec2 point) {
    const BodyDef& a = scene.bodies[bodyA];
    const BodyDef& b = scene.bodies[bodyB];
    JointDef joint;
    joint.bodyA = bodyA;
    joint.bodyB = bodyB;
    joint.anchorA = untransform(Pose{a.position, a.rotation}, point);
    joint.anchorB = untransform(Pose{b.position, b.rotation}, point);
    joint.reference = relative(a.rotation, b.rotation);
    scene.joints.push_back(joint);
}

Scene awake(bool floor) {
    Scene scene;
    scene.sleep = false;
    if (floor) {
        BodyDef ground = bodyOf({}, ShapeDef::box(50.0f, 1.0f, {0.0f, -1.0f}));
        ground.type = BodyType::Static;
        add(scene, ground);
    }
    return scene;
}

Scene kickedBodies() {
    Scene scene = awake(false);
    scene.gravity = {};
    std::mt19937 random(20);  // its numbers are the same everywhere, those of distributions are not
    const auto between = [&](float low, float high) {
        return low + (high - low) * (static_cast<float>(random() >> 8) * (1.0f / 16777216.0f));
    };
    for (int i = 0; i < 100; ++i) {
        const Vec2 place{1.5f * static_cast<float>(i % 10) - 6.75f,
                         1.5f * static_cast<float>(i / 10) - 6.75f};
        const float size = between(0.2f, 0.5f);
        BodyDef body =
            bodyOf(place, i % 2 == 0 ? ShapeDef::circle({}, size) : ShapeDef::box(size, size));
        const Vec2 kick{between(-1.0f, 1.0f), between(-1.0f, 1.0f)};
        body.velocity = kick - 0.5f * place + 0.3f * perpLeft(place);
        add(scene, body);
    }
    return scene;
}

Scene bridge(int planks) {
    Scene scene = awake(false);
    const std::uint32_t banks = add(scene, BodyDef{});
    std::uint32_t last = banks;
    ShapeDef plank = ShapeDef::box(0.5f, 0.125f);
    plank.density = 20.0f;
    plank.filter.group = -1;
    for (int i = 0; i < planks; ++i) {
        const auto x = static_cast<float>(i);
        const std::uint32_t next = add(scene, bodyOf({x + 0.5f, 0.0f}, plank));
        hinge(scene, last, next, {x, 0.0f});
        last = next;
    }
    hinge(scene, last, banks, {static_cast<float>(planks), 0.0f});
    return scene;
}

Scene straightStack(int boxes) {
    Scene scene = awake(true);
    for (int i = 0; i < boxes; ++i) {
        add(scene, bodyOf({0.0f, static_cast<float>(i) + 0.5f}, ShapeDef::box(0.5f, 0.5f)));
    }
    return scene;
}

Scene tippingBox() {
    Scene scene = awake(true);
    scene.bodies[0].shapes[0].material.friction = 2.0f;
    const Rotation lean = rotationOf(static_cast<float>(20.0 * pi / 180.0));
    BodyDef box = bodyOf({}, ShapeDef::box(0.5f, 0.5f));
    box.shapes[0].material.friction = 2.0f;
    box.rotation = lean;
    box.position = rotate(lean, Vec2{0.5f, 0.5f});  // its lower left corner at the origin
    add(scene, box);
    return scene;
}

Scene seesaw() {
    Scene scene = awake(false);
    const std::uint32_t post = add(scene, BodyDef{});
    const std::uint32_t bar = add(scene, bodyOf({}, ShapeDef::box(2.0f, 0.1f)));
    hinge(scene, post, bar, {});
    for (const float side : {-1.0f, 1.0f}) {
        BodyDef box = bodyOf({1.2f * side, 0.35f}, ShapeDef::box(0.25f, 0.25f));
        box.shapes[0].density = side < 0.0f ? 1.0f : 3.0f;
        box.shapes[0].material.friction = 0.15f;
        add(scene, box);
    }
    return scene;
}

Scene meetingPendulums() {
    Scene scene = awake(false);
    ShapeDef ball = ShapeDef::circle({}, 0.4f);
    ball.material.restitution = 0.5f;
    ball.material.friction = 0.0f;  // with friction, and hinges, laws of impact differ
    const std::uint32_t above = add(scene, BodyDef{});
    hinge(scene, above, add(scene, bodyOf({0.0f, -2.0f}, ball)), {0.0f, 0.0f});
    // Its arm leans by 45 degrees.
    hinge(scene, above, add(scene, bodyOf({-2.3142136f, -1.4142136f}, ball)), {-0.9f, 0.0f});
    return scene;
}

Scene headOn(float restitution) {
    Scene scene = awake(false);
    scene.gravity = {};
    for (const float side : {-1.0f, 1.0f}) {
        BodyDef disc = bodyOf({2.0f * side, 0.0f}, ShapeDef::circle({}, 0.5f));
        disc.shapes[0].material.restitution = restitution;
        disc.shapes[0].density = side < 0.0f ? 1.0f : 3.0f;
        disc.velocity = {side < 0.0f ? 4.0f : -2.0f, 0.0f};
        add(scene, disc);
    }
    return scene;
}

}  // namespace huestep::tools
