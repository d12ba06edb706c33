/// Worlds at the edge of what there is. Every stage has to cope with each of them, so the tests of
/// every stage go over them all.
#pragma once

#include <cmath>
#include <numbers>
#include <ostream>

#include "tests/core/support.h"

namespace huestep::test {

struct OddWorld {
    std::string name;
    Scene scene;
};

inline void PrintTo(const OddWorld& odd, std::ostream* out) {
    *out << odd.name;
}
inline std::string nameOfOdd(const testing::TestParamInfo<OddWorld>& info) {
    return info.param.name;
}

inline Scene movedBy(Scene scene, Vec2 by) {
    for (BodyDef& body : scene.bodies) body.position = body.position + by;
    return scene;
}

/// Grounds that overlap each other.
inline Scene allOfType(BodyType type) {
    Scene scene;
    for (int i = 0; i < 30; ++i) {
        BodyDef body = ground();
        body.position.x = 0.3f * static_cast<float>(i);
        body.type = type;
        if (type == BodyType::Kinematic) {
            body.velocity = {1.0f, 0.5f};
            body.angularVelocity = 1.0f;
        }
        scene.bodies.push_back(body);
    }
    return scene;
}

/// A tower of boxes that have never been awake.
inline Scene allAsleep() {
    Scene scene = sceneOf({ground()});
    for (int i = 0; i < 20; ++i) {
        scene.bodies.push_back(boxAt({0.0f, 0.5f + static_cast<float>(i)}));
        scene.bodies.back().asleep = true;
    }
    return scene;
}

/// From a box of 10 km to one of 2 cm that lies on it.
inline Scene huge() {
    return sceneOf({bodyAt(BodyType::Static, {0.0f, -1.0e4f}, ShapeDef::box(1.0e4f, 1.0e4f)),
                    boxAt({0.0f, 5.0e3f}, 5.0e3f), boxAt({0.0f, 1.02e4f}, 0.01f),
                    discAt({9.0e3f, 3.0e3f}, 2.9e3f)});
}

inline Scene tiny() {
    Scene scene = sceneOf({ground()});
    for (int i = 0; i < 20; ++i) {
        scene.bodies.push_back(discAt(
            {0.0021f * static_cast<float>(i % 5), 0.01f + 0.003f * static_cast<float>(i)}, 0.001f));
    }
    return scene;
}

inline Scene onePlace() {
    Scene scene;
    for (int i = 0; i < 40; ++i) scene.bodies.push_back(i % 2 ? boxAt({}) : discAt({}));
    return scene;
}

inline Scene onlyAnchors() {
    BodyDef anchor;
    BodyDef mover;
    mover.type = BodyType::Kinematic;
    mover.velocity = {1.0f, 0.0f};
    return sceneOf({anchor, mover}, {hinge(0, {}, 1, {})});
}

/// Discs, each pinned to 80 smaller ones around it and hung from the world by 80 springs: more than
/// there are colours of either kind. They hang together, so that many are one island.
inline Scene hubsOfJoints(std::uint32_t count) {
    constexpr std::uint32_t spokes = 80;
    Scene scene = sceneOf({BodyDef{}});
    for (std::uint32_t h = 0; h < count; ++h) {
        const auto hub = static_cast<std::uint32_t>(scene.bodies.size());
        const Vec2 middle{12.0f * static_cast<float>(h), 20.0f};
        scene.bodies.push_back(discAt(middle, 2.0f));
        for (std::uint32_t i = 0; i < spokes; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / spokes;
            const Vec2 out{static_cast<float>(4.0 * std::cos(angle)),
                           static_cast<float>(4.0 * std::sin(angle))};
            const auto rim = static_cast<std::uint32_t>(scene.bodies.size());
            scene.bodies.push_back(discAt(middle + out, 0.1f));
            scene.joints.push_back(hinge(hub, 0.5f * out, rim, -0.5f * out));
            JointDef spring = hinge(0, middle + 1.5f * out, hub, 0.25f * out);
            spring.kind = JointKind::Distance;
            spring.length = 5.0f;
            spring.spring = {true, 0.5f, 0.5f};
            scene.joints.push_back(spring);
        }
        if (h > 0)
            scene.joints.push_back(hinge(hub - spokes - 1, {6.0f, 0.0f}, hub, {-6.0f, 0.0f}));
    }
    return scene;
}

/// A plank that carries 100 boxes and lies on a ground of 90 pieces.
inline Scene hubOfContacts() {
    Scene scene;
    for (int i = 0; i < 90; ++i) {
        scene.bodies.push_back(bodyAt(BodyType::Static,
                                      {0.55f * static_cast<float>(i) - 24.5f, -0.5f},
                                      ShapeDef::box(0.275f, 0.5f)));
    }
    scene.bodies.push_back(bodyAt(BodyType::Dynamic, {0.0f, 0.25f}, ShapeDef::box(25.0f, 0.25f)));
    for (int i = 0; i < 100; ++i) {
        scene.bodies.push_back(boxAt({0.45f * static_cast<float>(i) - 22.0f, 0.7f}, 0.2f));
    }
    return scene;
}

/// Two chains of 120 links: one hangs from the world by its end, one flies.
inline Scene chainsOfJoints() {
    Scene scene = sceneOf({ground()});
    for (const bool flies : {false, true}) {
        for (std::uint32_t i = 0; i < 120; ++i) {
            const auto link = static_cast<std::uint32_t>(scene.bodies.size());
            const Vec2 at{0.5f * static_cast<float>(i), flies ? 60.0f : 40.0f};
            scene.bodies.push_back(bodyAt(BodyType::Dynamic, at, ShapeDef::box(0.25f, 0.1f)));
            if (flies) scene.bodies.back().velocity = {0.05f * static_cast<float>(i % 7), 1.0f};
            if (i > 0)
                scene.joints.push_back(hinge(link - 1, {0.25f, 0.0f}, link, {-0.25f, 0.0f}));
            else if (!flies)
                scene.joints.push_back(hinge(0, at + Vec2{-0.25f, 1.0f}, link, {-0.25f, 0.0f}));
        }
    }
    return scene;
}

inline std::vector<OddWorld> oddWorlds() {
    const auto named = [](const char* text) { return *sceneFromCatalog(text); };
    return {{"Empty", Scene{}},
            {"OneBody", sceneOf({discAt({})})},
            {"AllStatic", allOfType(BodyType::Static)},
            {"AllKinematic", allOfType(BodyType::Kinematic)},
            {"AllAsleep", allAsleep()},
            {"FarAway", movedBy(named("hinges:columns=2,rows=4"), {9.0e5f, -9.0e5f})},
            {"Huge", huge()},
            {"Tiny", tiny()},
            {"AllInOnePlace", onePlace()},
            {"AnchorsWithoutShapes", onlyAnchors()},
            {"HubOfJoints", hubsOfJoints(1)},
            {"HubOfContacts", hubOfContacts()},
            {"ChainsOfJoints", chainsOfJoints()},
            {"ChainsOfSegments", named("terrain")}};
}

}  // namespace huestep::test
