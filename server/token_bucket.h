/// A token bucket: a steady rate with a burst.
#pragma once

#include <algorithm>

#include "server/limits.h"

namespace huestep::server {

class TokenBucket {
 public:
    TokenBucket(double perSecond, double burst, Instant now)
        : m_perSecond(perSecond), m_burst(burst), m_tokens(burst), m_filled(now) {}

    /// Takes so many tokens; false, and none taken: there are not as many.
    bool take(Instant now, double count = 1.0) {
        const double passed = now > m_filled ? static_cast<double>(now - m_filled) * 1e-9 : 0.0;
        m_tokens = std::min(m_burst, m_tokens + passed * m_perSecond);
        m_filled = std::max(m_filled, now);
        if (m_tokens < count) return false;
        m_tokens -= count;
        return true;
    }

 private:
    double m_perSecond;
    double m_burst;
    double m_tokens;
    Instant m_filled;
};

}  // namespace huestep::server
