#include "server/tick_clock.h"

#include <algorithm>
#include <cassert>

namespace huestep::server {

TickClock::TickClock(Instant start, double ticksPerSecond, double phase, std::uint32_t catchUp)
    : m_period(1e9 / ticksPerSecond), m_phase(phase), m_catchUp(std::max(catchUp, 1u)) {
    assert(ticksPerSecond > 0.0);
    restart(start);
}

void TickClock::restart(Instant start) {
    m_start = start + static_cast<Instant>(m_phase * m_period);
    m_next = 0;
}

Instant TickClock::deadline(std::uint64_t k) const {
    // Doubles hold whole nanoseconds up to 2^53, which is 104 days from the start.
    return m_start + static_cast<Instant>(static_cast<double>(k) * m_period);
}

std::uint32_t TickClock::due(Instant now) {
    if (now < nextDeadline()) return 0;
    auto reached = static_cast<std::uint64_t>(static_cast<double>(now - m_start) / m_period);
    // The division may round to either side of a deadline; the deadlines themselves decide.
    while (deadline(reached) > now) --reached;
    while (deadline(reached + 1) <= now) ++reached;
    const std::uint64_t late = reached + 1 - m_next;
    const std::uint64_t closed = std::min<std::uint64_t>(late, m_catchUp);
    m_letGo += late - closed;
    m_next = reached + 1;
    return static_cast<std::uint32_t>(closed);
}

}  // namespace huestep::server
