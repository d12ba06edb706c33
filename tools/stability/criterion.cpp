#include "tools/stability/criterion.h"

#include <algorithm>
#include <cmath>

namespace huestep::tools::stability {

namespace {

// Seconds are sums of ticks: a window's end counts although it was not met to the last bit.
constexpr double slack = 1.0e-9;  // s

}  // namespace

void Watch::look(const Moment& moment) {
    if (moment.seconds < m_criterion.from - slack || moment.seconds > m_criterion.to + slack)
        return;
    if (m_looks > 0 && moment.seconds < m_next - slack) return;
    m_next = moment.seconds + m_criterion.every;
    const double value = m_criterion.measure(moment);
    // Whatever is not a number is as bad as can be.
    const double safe = std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
    m_most = m_looks == 0 ? safe : std::max(m_most, safe);
    m_squares += safe * safe;
    ++m_looks;
}

double Watch::value() const {
    if (m_looks == 0) return std::numeric_limits<double>::infinity();
    if (m_criterion.fold == Fold::Most) return m_most;
    return std::sqrt(m_squares / static_cast<double>(m_looks));
}

bool Watch::holds() const {
    return m_criterion.mayReach ? value() <= m_criterion.limit : value() < m_criterion.limit;
}

double Watch::share() const {
    if (m_criterion.limit > 0.0) return value() / m_criterion.limit;
    return holds() ? 0.0 : std::numeric_limits<double>::infinity();
}

}  // namespace huestep::tools::stability
