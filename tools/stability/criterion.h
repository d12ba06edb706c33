/// What a scene of the suite must hold, as values: a measure of every tick, folded over a window of
/// time, against a limit.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/math/vec.h"
#include "tools/definitions.h"
#include "tools/fold.h"

namespace huestep::tools::stability {

using Vec2d = Vec2T<double>;
using Posed = PoseT<double>;

/// A body in its scene's own frame, in which "up" is up wherever and however the scene is placed.
struct Tracked {
    BodyId id = 0;
    bool dynamic = false;
    double mass = 0.0;     ///< kg
    double inertia = 0.0;  ///< kg·m²
    Posed start, now;      ///< of the centre of mass
    Vec2d startVelocity, velocity;
    double startSpin = 0.0, spin = 0.0;  ///< rad/s
};

/// A tick as criteria see it.
struct Moment {
    double seconds = 0.0;                      ///< since the start, of the scene's time
    std::span<const Tracked> bodies;           ///< those of the start that are still there, by id
    const Definitions* definitions = nullptr;  ///< of all that are there
    std::span<const BodyMotion> motions;       ///< of the same, as the engine gives them
    double energyGain = 0.0;                   ///< (E − E₀) / E_scale
};

/// ≥ 0 where it is a size; a larger one is worse.
using Measure = std::function<double(const Moment& moment)>;

struct Criterion {
    std::string what;  ///< what the value is: "farthest that a body moved"
    std::string unit;
    double limit = 0.0;
    Measure measure;
    Fold fold = Fold::Most;
    double from = 0.0;  ///< s: the window in which it is looked at, both ends included
    double to = std::numeric_limits<double>::infinity();
    double every = 0.0;     ///< s between two looks; 0: every tick
    bool mayReach = false;  ///< of counts: the limit itself passes
};

/// Follows one criterion through a run.
class Watch {
 public:
    explicit Watch(Criterion criterion)
        : m_criterion(std::move(criterion)), m_values(m_criterion.fold) {}

    /// After step number `tick`, counted from 1.
    void look(const Moment& moment, std::uint64_t tick);

    [[nodiscard]] const Criterion& criterion() const { return m_criterion; }
    [[nodiscard]] bool looked() const { return m_values.count() > 0; }
    /// The tick after which it first did not hold; 0: never, or only the run as a whole says so.
    [[nodiscard]] std::uint64_t brokenAt() const { return m_brokenAt; }
    /// So far; infinite before the first look.
    [[nodiscard]] double value() const { return m_values.value(); }
    [[nodiscard]] bool holds() const;
    /// Value over limit: 1 is at the limit. Of a limit of 0: infinite, or 0 where it holds.
    [[nodiscard]] double share() const;

 private:
    Criterion m_criterion;
    Folding m_values;
    double m_next = 0.0;           ///< s, when to look again
    std::uint64_t m_brokenAt = 0;  ///< tick
};

}  // namespace huestep::tools::stability
