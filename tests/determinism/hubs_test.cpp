// Hubs: bodies with more joints than there are colours. What is left over is solved one by one in
// key order, on any machine.

#include <cmath>
#include <numbers>

#include "tests/determinism/together.h"

namespace huestep::test {
namespace {

/// A disc pinned to 80 smaller ones around it and hung from the world by 80 more pins.
Scene hubs(std::uint32_t count) {
    constexpr std::uint32_t spokes = 80;
    Scene scene = sceneOf({ground()});
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
            scene.joints.push_back(hinge(0, middle + 0.25f * out, hub, 0.25f * out));
        }
        // Hubs hang together, so that many are one island of many batches' size.
        if (h > 0)
            scene.joints.push_back(hinge(hub - spokes - 1, {6.0f, 0.0f}, hub, {-6.0f, 0.0f}));
    }
    return scene;
}

TEST(Hubs, OfMorePinsThanColoursAreTheSameInEveryConfiguration) {
    for (const std::uint32_t count : {1u, 8u}) {
        const World start = worldOf(hubs(count));
        std::uint32_t overflow = 0;
        runTogether(
            start, 40, [](const World&) { return std::vector<Command>(); }, 5,
            [&](const World& world) { overflow = std::max(overflow, world.report().overflow); });
        EXPECT_GE(overflow, 32 * count) << "the scene has no hub";
        if (HasFatalFailure()) return;
    }
}

}  // namespace
}  // namespace huestep::test
