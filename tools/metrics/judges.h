/// What most judges are made of: a measure of each frame, folded over a window of ticks.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/scene/in_double.h"
#include "core/scene/measure.h"
#include "core/world/world.h"
#include "tools/fold.h"
#include "tools/metrics/metric.h"

namespace huestep::tools {

using Vec2d = Vec2T<double>;

inline constexpr double failed = std::numeric_limits<double>::infinity();

/// A tick as a judge sees it.
struct Frame {
    std::uint64_t tick = 0;  ///< counted from 1
    double seconds = 0.0;    ///< since the start
    std::span<const BodyMotion> motions;
};

/// How far a frame is from the truth, in the case's unit.
using Measure = std::function<double(const Frame& frame)>;

/// Ticks that count, both ends included.
struct Window {
    std::uint64_t first = 1;
    std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
};

/// A judge that folds a measure over a window. Its error is infinite where a measure is not finite,
/// where a body came or went, and before the window's first tick.
std::unique_ptr<Judge> folded(const World& start, Fold fold, Window window, Measure measure);

/// What a world is before its first step, kept for judging.
struct Start {
    explicit Start(const World& world);
    WorldInfo info;
    std::vector<BodyInfo> bodies;
    std::vector<ShapeInfo> shapes;
    std::vector<JointInfo> joints;
    std::vector<BodyMotion> motions;

    [[nodiscard]] Measures measured(std::span<const BodyMotion> now) const;
    [[nodiscard]] double kinetic(std::span<const BodyMotion> now) const;  ///< J, of dynamic bodies
    [[nodiscard]] Vec2d gravity() const { return inDouble(info.gravity); }
};

inline Vec2d positionOf(const Frame& frame, std::size_t place) {
    return inDouble(frame.motions[place].position);
}

/// Every 60th of a second is a tick in all cases.
constexpr std::uint64_t ticksIn(double seconds) {
    return static_cast<std::uint64_t>(60.0 * seconds + 0.5);
}

}  // namespace huestep::tools
