/// Judges one run of a scene by its criteria, from definitions and motions alone.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene/placement.h"
#include "core/world/world.h"
#include "tools/stability/criterion.h"

namespace huestep::tools::stability {

/// What a run came to.
struct Judgement {
    bool pass = false;
    double value = 0.0;  ///< of the criterion that says most: see `Judge::judgement`
    double limit = 0.0;
    std::string unit;
    std::string what;
    std::string why;  ///< of a failure
    /// Steps after which that criterion, if it must hold all the time, was first broken, or
    /// something was not finite; none: it holds, or only the run as a whole says that it does not.
    std::optional<std::uint64_t> brokenAt;
};

/// Watches one run. Holds no reference to the world it was made from.
class Judge {
 public:
    /// `start`: the world of the placed scene before its first step. The criteria in `own` are the
    /// row's, those in `rules` hold for all rows that do not break them by their set-up.
    Judge(const World& start, const Placement& placement, std::vector<Criterion> own,
          std::vector<Criterion> rules);

    /// After step number `tick`, counted from 1, with these commands.
    void watch(std::uint64_t tick, std::span<const Command> commands,
               std::span<const BodyMotion> motions);

    /// A body that its engine took out of the simulation.
    void lost(std::uint64_t tick, BodyId body);

    /// Whether a criterion that must hold all the time is broken, or something is not finite.
    [[nodiscard]] bool broken() const { return m_broken; }
    /// Whether it is beyond all measure: the rest of the run has nothing more to say.
    [[nodiscard]] bool hopeless() const { return m_hopeless; }

    /// Of the run so far: of criteria that do not hold the one furthest beyond its limit, else the
    /// one nearest to it; the row's own go before the rules.
    [[nodiscard]] Judgement judgement() const;

 private:
    void follow(std::span<const BodyMotion> motions);
    void lose(std::uint64_t tick, const std::string& why);

    Definitions m_definitions;
    Posed m_frame;
    double m_stepSeconds;
    double m_energyScale;
    double m_startEnergy;
    std::vector<Tracked> m_bodies;  ///< that were there at the start and still are
    std::vector<Watch> m_own, m_rules;
    bool m_broken = false;
    std::string m_lost;          ///< what is not finite; empty: nothing
    std::uint64_t m_lostAt = 0;  ///< tick
    bool m_hopeless = false;
};

/// No body may be faster than 100 m/s.
Criterion speedRule();
/// Energy may rise by 1 % of E_scale above that of the start.
Criterion energyRule();

}  // namespace huestep::tools::stability
