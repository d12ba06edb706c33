/// Chains, bridges and what hangs on them: scenes that trees of joints are judged by (physics page,
/// rows 12 to 16). No shape of them meets another.
#pragma once

#include "core/scene/measure.h"
#include "tests/core/support.h"

namespace huestep::test {

inline ShapeDef ghost(ShapeDef shape, float density = 1.0f) {
    shape.filter.group = -1;
    shape.density = density;
    return shape;
}

/// A scene that starts with a body that does not move, and grows link by link.
class Linkage {
 public:
    Linkage() {
        m_scene.sleep = false;
        m_scene.method = Method::Direct;
        m_scene.bodies.push_back(BodyDef{});
    }
    /// Pins a new body by its point `own` to the point `hook` of another, 0 being the fixed one.
    std::uint32_t hang(std::uint32_t holder, Vec2 hook, const BodyDef& body, Vec2 own) {
        m_scene.bodies.push_back(body);
        const auto place = static_cast<std::uint32_t>(m_scene.bodies.size() - 1);
        m_scene.joints.push_back(hinge(holder, hook, place, own));
        return place;
    }
    void pin(std::uint32_t a, Vec2 hook, std::uint32_t b, Vec2 own) {
        m_scene.joints.push_back(hinge(a, hook, b, own));
    }
    [[nodiscard]] Scene scene(std::uint32_t substeps) const {
        Scene scene = m_scene;
        scene.substeps = substeps;
        return scene;
    }

 private:
    Scene m_scene;
};

/// 40 capsules of 6 kg and a disc of 4,021 kg, released horizontally.
inline Scene ballAndChain(std::uint32_t substeps) {
    Linkage linkage;
    const ShapeDef bar = ghost(ShapeDef::capsule({-0.5f, 0.0f}, {0.5f, 0.0f}, 0.125f), 20.0f);
    std::uint32_t last = 0;
    for (int i = 0; i < 40; ++i) {
        const Vec2 at{0.5f + static_cast<float>(i), 0.0f};
        last = linkage.hang(last, {i == 0 ? 0.0f : 0.5f, 0.0f}, bodyAt(BodyType::Dynamic, at, bar),
                            {-0.5f, 0.0f});
    }
    const ShapeDef disc = ghost(ShapeDef::circle({}, 8.0f), 20.0f);
    linkage.hang(last, {0.5f, 0.0f}, bodyAt(BodyType::Dynamic, {48.0f, 0.0f}, disc), {-8.0f, 0.0f});
    return linkage.scene(substeps);
}

/// 160 planks of 1 m x 0.25 m, pinned at both ends over exactly their length.
inline Scene bridge(std::uint32_t substeps) {
    Linkage linkage;
    std::uint32_t last = 0;
    for (int i = 0; i < 160; ++i) {
        BodyDef plank = bodyAt(BodyType::Dynamic, {-79.5f + static_cast<float>(i), 20.0f},
                               ghost(ShapeDef::box(0.5f, 0.125f), 20.0f));
        plank.linearDamping = plank.angularDamping = 0.1f;
        const Vec2 hook = i == 0 ? Vec2{-80.0f, 20.0f} : Vec2{0.5f, 0.0f};
        last = linkage.hang(last, hook, plank, {-0.5f, 0.0f});
    }
    linkage.pin(last, {0.5f, 0.0f}, 0, {80.0f, 20.0f});
    return linkage.scene(substeps);
}

/// 40 discs on links of 1 m that are placed 2 m apart, hanging but for a millimetre.
inline Scene stretchedChain(std::uint32_t substeps) {
    Linkage linkage;
    std::uint32_t last = 0;
    for (int i = 0; i < 40; ++i) {
        const Vec2 at{0.001f * static_cast<float>(i % 3), -2.0f * static_cast<float>(i + 1)};
        last =
            linkage.hang(last, {}, bodyAt(BodyType::Dynamic, at, ghost(ShapeDef::circle({}, 0.2f))),
                         {0.0f, 1.0f});
    }
    return linkage.scene(substeps);
}

inline Measures measuresOf(const World& world) {
    return measure(world.info(), world.bodies(), world.shapes(), world.joints(), world.motions());
}

/// What a run showed.
struct RunOfTree {
    double peakError = 0.0, endError = 0.0;     ///< m, of joints; end: over the last second
    double energyGain = 0.0, energyLoss = 0.0;  ///< J: most above the start; at the end below it
    double peakSpeed = 0.0;                     ///< m/s
};

inline RunOfTree runOfTree(const Scene& scene, double seconds) {
    World world = worldOf(scene);
    const double start = measuresOf(world).energy;
    RunOfTree seen;
    const auto ticks = static_cast<int>(seconds * 60.0 + 0.5);
    for (int tick = 0; tick < ticks; ++tick) {
        world.step({});
        const Measures now = measuresOf(world);
        seen.peakError = std::max(seen.peakError, now.maxJointError);
        seen.energyGain = std::max(seen.energyGain, now.energy - start);
        seen.energyLoss = start - now.energy;
        if (tick >= ticks - 60) seen.endError = std::max(seen.endError, now.maxJointError);
        for (const BodyMotion& m : world.motions()) {
            seen.peakSpeed = std::max(seen.peakSpeed, wide(length(m.velocity)));
        }
    }
    return seen;
}

}  // namespace huestep::test
