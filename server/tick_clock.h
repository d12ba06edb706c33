/// When ticks are due: deadlines that do not drift, and a bounded catch-up.
#pragma once

#include <cstdint>

#include "server/limits.h"

namespace huestep::server {

/// Deadline k is `start + k · period`, computed from k each time, so that neither rounding nor a
/// late timer adds up. A process that was held up closes at most `catchUp` late ticks at once and
/// lets the rest of the time go: the session is then later than the wall clock, never overloaded.
class TickClock {
 public:
    /// `ticksPerSecond` > 0. `phase` in [0, 1) of a period staggers sessions.
    TickClock(Instant start, double ticksPerSecond, double phase, std::uint32_t catchUp);

    /// Starts over with deadline 0 at `start` and the phase.
    void restart(Instant start);

    /// How many ticks are to be closed now. Each call counts as having closed them.
    std::uint32_t due(Instant now);

    [[nodiscard]] Instant nextDeadline() const { return deadline(m_next); }
    /// Ticks' worth of time let go so far.
    [[nodiscard]] std::uint64_t letGo() const { return m_letGo; }

 private:
    [[nodiscard]] Instant deadline(std::uint64_t k) const;

    Instant m_start = 0;
    double m_period;  ///< ns
    double m_phase;
    std::uint32_t m_catchUp;
    std::uint64_t m_next = 0;
    std::uint64_t m_letGo = 0;
};

}  // namespace huestep::server
