/// What the tests of the core share: seeded randomness, scenes put together by hand, worlds of
/// them.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/scene/catalog.h"
#include "core/world/world.h"

namespace huestep::test {

/// The seed of a test, or the one in HUESTEP_SEED: a failing run is repeated by setting it.
inline std::uint64_t seedOr(std::uint64_t standard) {
    const char* text = std::getenv("HUESTEP_SEED");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : standard;
}

/// Splitmix64: the same numbers on every machine. Put `trace()` into a SCOPED_TRACE.
class Random {
 public:
    explicit Random(std::uint64_t standardSeed) : m_seed(seedOr(standardSeed)), m_state(m_seed) {}
    [[nodiscard]] std::string trace() const { return "HUESTEP_SEED=" + std::to_string(m_seed); }

    std::uint64_t roll() {
        std::uint64_t z = (m_state += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    std::uint32_t below(std::size_t count) { return static_cast<std::uint32_t>(roll() % count); }
    bool once(std::uint32_t in) { return below(in) == 0; }
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(roll() >> 11) * 0x1p-53);
    }
    float betweenF(double low, double high) { return static_cast<float>(between(low, high)); }
    Vec2 point(double low, double high) {
        const float x = betweenF(low, high);
        return {x, betweenF(low, high)};
    }

 private:
    std::uint64_t m_seed;
    std::uint64_t m_state;
};

inline double wide(float v) {
    return static_cast<double>(v);
}
inline Vec2T<double> wide(Vec2 v) {
    return {wide(v.x), wide(v.y)};
}

inline BodyDef bodyAt(BodyType type, Vec2 position, const ShapeDef& shape) {
    BodyDef body;
    body.type = type;
    body.position = position;
    body.shapes = {shape};
    return body;
}
inline BodyDef boxAt(Vec2 position, float half = 0.5f) {
    return bodyAt(BodyType::Dynamic, position, ShapeDef::box(half, half));
}
inline BodyDef discAt(Vec2 position, float radius = 0.5f) {
    return bodyAt(BodyType::Dynamic, position, ShapeDef::circle({}, radius));
}

/// A ground 200 m wide whose surface is y = 0.
inline BodyDef ground() {
    return bodyAt(BodyType::Static, {0.0f, -1.0f}, ShapeDef::box(100.0f, 1.0f));
}

inline Scene sceneOf(std::vector<BodyDef> bodies, std::vector<JointDef> joints = {}) {
    Scene scene;
    scene.bodies = std::move(bodies);
    scene.joints = std::move(joints);
    return scene;
}

inline JointDef hinge(std::uint32_t a, Vec2 anchorA, std::uint32_t b, Vec2 anchorB) {
    JointDef joint;
    joint.bodyA = a;
    joint.bodyB = b;
    joint.anchorA = anchorA;
    joint.anchorB = anchorB;
    return joint;
}

/// The world of a scene that is known to be valid.
inline World worldOf(const Scene& scene) {
    Result<World> world = World::create(scene);
    if (!world.ok()) {
        ADD_FAILURE() << world.error().message;
        std::abort();
    }
    return std::move(world).value();
}
inline World worldOf(const std::string& catalogText) {
    const Result<Scene> scene = sceneFromCatalog(catalogText);
    if (!scene.ok()) {
        ADD_FAILURE() << scene.error().message;
        std::abort();
    }
    return worldOf(*scene);
}

inline World restored(const World& world) {
    Result<World> copy = World::restore(world.save());
    if (!copy.ok()) {
        ADD_FAILURE() << copy.error().message;
        std::abort();
    }
    return std::move(copy).value();
}

inline void run(World& world, int ticks, const StepResources& with = {}) {
    for (int i = 0; i < ticks; ++i) world.step({}, with);
}

/// Motion of the body with the id; the test fails where there is none.
inline BodyMotion motionOf(const World& world, BodyId id) {
    const auto place = world.find(id);
    EXPECT_TRUE(place.has_value()) << "body " << id;
    return place ? world.motions()[*place] : BodyMotion{};
}

/// Why two worlds are not equal; empty if they are.
inline std::string differenceOf(const World& left, const World& right) {
    const auto difference = firstDifference(left, right);
    return difference ? difference->sentence() : std::string();
}

}  // namespace huestep::test
