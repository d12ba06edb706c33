#include "tools/stability/criterion.h"

#include <limits>

namespace huestep::tools::stability {

namespace {

// Seconds are sums of ticks: a window's end counts although it was not met to the last bit.
constexpr double slack = 1.0e-9;  // s

}  // namespace

void Watch::look(const Moment& moment, std::uint64_t tick) {
    if (moment.seconds < m_criterion.from - slack || moment.seconds > m_criterion.to + slack)
        return;
    if (looked() && moment.seconds < m_next - slack) return;
    m_next = moment.seconds + m_criterion.every;
    m_values.add(m_criterion.measure(moment));
    // A mean may come back; and what never came to its window is infinite for want of a look.
    const bool counts = m_criterion.fold == Fold::Most && !std::isinf(value());
    if (m_brokenAt == 0 && counts && !holds()) m_brokenAt = tick;
}

bool Watch::holds() const {
    return m_criterion.mayReach ? value() <= m_criterion.limit : value() < m_criterion.limit;
}

double Watch::share() const {
    if (m_criterion.limit > 0.0) return value() / m_criterion.limit;
    return holds() ? 0.0 : std::numeric_limits<double>::infinity();
}

}  // namespace huestep::tools::stability
