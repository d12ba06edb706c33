/// A line made longer: to see over loopback what a session is like over a network.
///
/// Holds messages of one direction back, in order, as TCP does. Sans-I/O: time is an argument.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <utility>

#include "client/statistics.h"
#include "protocol/messages.h"

namespace huestep::client {

struct LagRules {
    Instant delay = 0;   ///< ns, each way
    Instant jitter = 0;  ///< ns, at most so much more, drawn for each message
    std::uint64_t seed = 1;
    [[nodiscard]] bool any() const { return delay != 0 || jitter != 0; }
};

class Lag {
 public:
    explicit Lag(const LagRules& rules) : m_rules(rules), m_dice(rules.seed) {}

    void put(protocol::Message message, Instant now) {
        const Instant more = m_rules.jitter == 0 ? 0 : m_dice() % (m_rules.jitter + 1);
        m_last = std::max(m_last, now + m_rules.delay + more);
        m_held.emplace_back(m_last, std::move(message));
    }
    /// The next message whose time has come.
    std::optional<protocol::Message> take(Instant now) {
        if (m_held.empty() || m_held.front().first > now) return std::nullopt;
        protocol::Message message = std::move(m_held.front().second);
        m_held.pop_front();
        return message;
    }
    /// The line broke: what was on it is gone.
    void clear() { m_held.clear(); }

 private:
    LagRules m_rules;
    std::mt19937_64 m_dice;
    Instant m_last = 0;
    std::deque<std::pair<Instant, protocol::Message>> m_held;
};

}  // namespace huestep::client
