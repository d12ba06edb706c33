/// A5 of the physics page: a swinging body against the closed form
/// T = 2π √(L/g) / agm(1, cos(θ₀/2)), where L = (I/m + d²)/d is the equivalent length of a body
/// whose centre of mass is d from the pivot.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/world/world.h"

namespace huestep::tools {

struct PendulumResult {
    double period = 0.0;      ///< s, mean over whole swings
    double exact = 0.0;       ///< s
    double phase = 0.0;       ///< rad, by how much it lags at its last passage; < 0: leads
    double energyLoss = 0.0;  ///< share of the energy above the lowest point; < 0: gained
};

/// Watches a pendulum swing. Holds no reference to a world after a call.
class Pendulum {
 public:
    /// The pendulum of a world before its first step: two bodies, of which one is dynamic, undamped
    /// and at rest, on one plain revolute joint to the other, static one. None: the scene is none.
    static std::optional<Pendulum> find(const World& start);

    /// After each step.
    void watch(std::span<const BodyMotion> motions);

    /// None before the first whole swing.
    [[nodiscard]] std::optional<PendulumResult> result(std::span<const BodyMotion> last) const;

 private:
    Pendulum() = default;
    [[nodiscard]] double angle(const BodyMotion& bob) const;   ///< rad from hanging
    [[nodiscard]] double rate(const BodyMotion& bob) const;    ///< rad/s, of that angle
    [[nodiscard]] double energy(const BodyMotion& bob) const;  ///< J above hanging at rest

    std::size_t m_bob = 0;  ///< place of the body that swings
    double m_step = 0.0;    ///< s a tick
    double m_mass = 0.0;    ///< kg
    double m_inertia = 0.0;
    double m_length = 0.0;   ///< m, pivot to centre of mass
    double m_gravity = 0.0;  ///< m/s²
    double m_exact = 0.0;    ///< s
    double m_startEnergy = 0.0;
    Vec2T<double> m_pivot;
    Vec2T<double> m_down;  ///< unit vector
    double m_seconds = 0.0;
    double m_lastAngle = 0.0;
    double m_lastRate = 0.0;
    std::vector<double> m_crossings;  ///< s, when it passed the lowest point
};

}  // namespace huestep::tools
