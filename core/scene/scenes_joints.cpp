// Welds and prismatic joints with every part, among bodies that load them: a cantilever, a rod that
// bends, a compound that falls, a lift, a cart on springs, a telescope in free fall, a slide.
#include "core/math/trig.h"
#include "core/scene/scenes.h"

namespace huestep::scenes {

namespace {

/// A ground between two walls.
void addRoom(Scene& scene) {
    BodyDef room;
    room.shapes = {ShapeDef::box(20.0f, 1.0f, {0.0f, -1.0f}),
                   ShapeDef::box(0.5f, 6.0f, {-19.5f, 6.0f}),
                   ShapeDef::box(0.5f, 6.0f, {19.5f, 6.0f})};
    add(scene, room);
}

/// Boxes welded to the left wall and to each other, with a ball that drops on the last.
void addCantilever(Scene& scene) {
    std::uint32_t last = 0;
    for (std::uint32_t i = 0; i < 5; ++i) {
        const Vec2 position{-18.5f + static_cast<float>(i), 5.0f};
        const std::uint32_t beam =
            add(scene, bodyOf(BodyType::Dynamic, position, ShapeDef::box(0.5f, 0.125f)));
        scene.joints.push_back(weldAt(scene, last, beam, {position.x - 0.5f, 5.0f}));
        last = beam;
    }
    add(scene, bodyOf(BodyType::Dynamic, {-14.6f, 8.0f}, ShapeDef::circle({}, 0.3f)));
}

/// A rod of capsules whose welds are springs, with a ball at its tip; it stands on a turning disc.
void addRod(Scene& scene) {
    BodyDef disc = bodyOf(BodyType::Kinematic, {-9.0f, 0.5f}, ShapeDef::circle({}, 0.4f));
    disc.angularVelocity = 0.2f;
    std::uint32_t last = add(scene, disc);
    for (std::uint32_t i = 0; i < 6; ++i) {
        const float y = 1.1f + 0.5f * static_cast<float>(i);
        const ShapeDef bone = ShapeDef::capsule({0.0f, -0.2f}, {0.0f, 0.2f}, 0.06f);
        const std::uint32_t place = add(scene, bodyOf(BodyType::Dynamic, {-9.0f, y}, bone));
        JointDef joint = weldAt(scene, last, place, {-9.0f, y - 0.25f});
        joint.spring = {true, 40.0f - 4.0f * static_cast<float>(i), 0.3f};
        scene.joints.push_back(joint);
        last = place;
    }
    const std::uint32_t ball =
        add(scene, bodyOf(BodyType::Dynamic, {-9.0f, 4.2f}, ShapeDef::circle({}, 0.2f)));
    scene.joints.push_back(weldAt(scene, last, ball, {-9.0f, 3.95f}));
}

/// A cross of turned boxes, welded at points away from their centres, that falls and comes to rest.
void addCross(Scene& scene) {
    std::uint32_t first = 0;
    for (std::uint32_t i = 0; i < 4; ++i) {
        const Rotation q = rotationOf(0.4f + 1.5707964f * static_cast<float>(i));
        const Vec2 middle{-4.0f, 6.0f};
        BodyDef arm = bodyOf(BodyType::Dynamic, middle + rotate(q, Vec2{0.75f, 0.0f}),
                             ShapeDef::box(0.5f, 0.15f));
        arm.rotation = q;
        arm.angularVelocity = i == 0 ? 6.0f : 0.0f;
        arm.shapes[0].density = 1.0f + static_cast<float>(i);
        const std::uint32_t place = add(scene, arm);
        if (i == 0) {
            first = place;
        } else {
            scene.joints.push_back(weldAt(scene, first, place, middle));
            scene.joints.back().collideConnected = i == 2;
        }
    }
}

/// A platform on a motor between two stops, with boxes on it.
void addLift(Scene& scene) {
    const std::uint32_t platform =
        add(scene, bodyOf(BodyType::Dynamic, {0.0f, 0.4f}, ShapeDef::box(1.2f, 0.15f)));
    JointDef joint = slideAt(scene, 0, platform, {0.0f, 0.4f}, {0.0f, 1.0f});
    joint.limit = {true, 0.0f, 3.0f};
    joint.motor = {true, 0.8f, 400.0f};
    scene.joints.push_back(joint);
    for (std::uint32_t i = 0; i < 6; ++i) {
        const Vec2 position{-0.6f + 0.6f * static_cast<float>(i % 3),
                            0.9f + 0.6f * static_cast<float>(i / 3)};
        add(scene, bodyOf(BodyType::Dynamic, position, ShapeDef::box(0.25f, 0.25f)));
    }
}

/// A cart whose wheels hang on springs with stops; one of them drives.
void addCart(Scene& scene) {
    const std::uint32_t chassis =
        add(scene, bodyOf(BodyType::Dynamic, {5.0f, 1.4f}, ShapeDef::box(1.2f, 0.2f)));
    for (const float side : {-0.8f, 0.8f}) {
        const Vec2 hub{5.0f + side, 0.6f};
        const std::uint32_t strut =
            add(scene, bodyOf(BodyType::Dynamic, hub, ShapeDef::box(0.1f, 0.1f)));
        scene.bodies.back().shapes[0].filter.group = -3;
        JointDef slide = slideAt(scene, chassis, strut, hub, {side, -4.0f});
        slide.spring = {true, 4.0f, 0.5f};
        slide.limit = {true, -0.3f, 0.2f};
        scene.joints.push_back(slide);
        BodyDef wheel = bodyOf(BodyType::Dynamic, hub, ShapeDef::circle({}, 0.4f));
        wheel.shapes[0].filter.group = -3;
        wheel.shapes[0].material.friction = 1.0f;
        const std::uint32_t place = add(scene, wheel);
        JointDef axle = hingeAt(scene, strut, place, hub);
        axle.motor = {side < 0.0f, -6.0f, 4.0f};
        scene.joints.push_back(axle);
    }
}

/// Two tubes that turn in free fall, pushed apart by a motor up to a stop; and a sled on a slope.
void addTelescopeAndSled(Scene& scene) {
    BodyDef outer = bodyOf(BodyType::Dynamic, {11.0f, 9.0f}, ShapeDef::box(0.6f, 0.15f));
    outer.rotation = rotationOf(0.5f);
    outer.angularVelocity = 2.0f;
    outer.velocity = {-1.0f, 4.0f};
    BodyDef inner = outer;
    inner.shapes = {ShapeDef::box(0.5f, 0.08f)};
    const std::uint32_t a = add(scene, outer);
    const std::uint32_t b = add(scene, inner);
    JointDef tube = slideAt(scene, a, b, {11.0f, 9.0f}, rotate(outer.rotation, Vec2{1.0f, 0.0f}));
    tube.limit = {true, 0.0f, 0.9f};
    tube.motor = {true, 2.0f, 15.0f};
    scene.joints.push_back(tube);

    const Rotation slope = rotationOf(-0.5235988f);
    BodyDef sled = bodyOf(BodyType::Dynamic, {13.0f, 5.0f}, ShapeDef::box(0.4f, 0.2f));
    sled.rotation = slope;
    const std::uint32_t place = add(scene, sled);
    JointDef rail = slideAt(scene, 0, place, sled.position, rotate(slope, Vec2{1.0f, 0.0f}));
    rail.limit = {true, -0.5f, 5.0f};
    scene.joints.push_back(rail);
}

}  // namespace

Scene joints(Values) {
    Scene scene;
    addRoom(scene);
    addCantilever(scene);
    addRod(scene);
    addCross(scene);
    addLift(scene);
    addCart(scene);
    addTelescopeAndSled(scene);
    return scene;
}

}  // namespace huestep::scenes
