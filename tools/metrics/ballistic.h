/// A7 of the physics page: bodies in free flight against the parabola x₀ + v₀ t + g t²/2.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/world/world.h"

namespace huestep::tools {

struct BallisticResult {
    double seconds = 0.0;   ///< s after the start
    double maxError = 0.0;  ///< m, over the bodies
};

/// Watches the first second of a scene in which nothing but gravity moves a body. Holds no
/// reference to a world after a call.
class Ballistic {
 public:
    /// None if the scene has a joint, a damped or a sleeping dynamic body, or no dynamic body.
    static std::optional<Ballistic> find(const World& start);

    /// After each step; `touching`: whether there is any contact, which ends the flight.
    void watch(std::span<const BodyMotion> motions, bool touching);

    /// After one second, or of a shorter run; none once a body has touched another before.
    [[nodiscard]] std::optional<BallisticResult> result() const;

 private:
    struct Body {
        std::size_t place = 0;
        Vec2T<double> position;
        Vec2T<double> velocity;
        Vec2T<double> gravity;
    };
    Ballistic() = default;
    std::vector<Body> m_bodies;
    double m_step = 0.0;  ///< s a tick
    double m_seconds = 0.0;
    bool m_touched = false;
    BallisticResult m_result;
};

}  // namespace huestep::tools
