#include "client/pacer.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace huestep::client {

namespace {

constexpr Instant millisecond = 1'000'000;
constexpr Instant askEvery = 100 * millisecond;
constexpr Instant askAtFirst = 25 * millisecond;  // the first few, so that one odd one tells little
constexpr std::uint64_t firstOnes = 8;
constexpr std::size_t mostAsked = 64;    // under way
constexpr std::size_t mostAnswers = 64;  // kept: some 6 s
constexpr Instant answersKept = 8'000 * millisecond;
constexpr double mostSteering = 0.1;     // of the rate
constexpr double steeringSeconds = 0.5;  // in which a small error is steered away
constexpr Instant delayKept = 1'000 * millisecond;
constexpr std::uint32_t mostOwnDelay = 60;
/// Nonces of this kind are ours; a connection that asks whether its server lives counts from 1.
constexpr std::uint64_t nonceMark = std::uint64_t{1} << 63;

double quantile(std::vector<double> values, double share) {
    const auto last = static_cast<double>(values.size() - 1);
    const auto place = static_cast<std::ptrdiff_t>(std::ceil(last * share));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<std::size_t>(place)];
}

}  // namespace

void Pacer::start(const protocol::Welcome& welcome, Instant now) {
    m_rate = static_cast<double>(welcome.ticksPerSecond);
    const bool own = m_rules.inputDelay.has_value();
    m_leastDelay = std::min(own ? *m_rules.inputDelay : welcome.inputDelay, mostOwnDelay);
    m_mostDelay =
        own ? m_leastDelay : std::clamp(welcome.maxInputDelay, m_leastDelay, mostOwnDelay);
    m_start = m_now = m_askAt = m_delayAt = now;
    m_position = 0.0;
    m_speed = 1.0;
    m_set = false;
    m_asked.clear();
    m_answers.clear();
    m_delay = m_leastDelay;
}

std::optional<protocol::Ping> Pacer::ask(Instant now) {
    if (now < m_askAt) return std::nullopt;
    m_askAt = now + (m_answers.size() < firstOnes ? askAtFirst : askEvery);
    if (m_asked.size() == mostAsked) m_asked.pop_front();
    m_asked.push_back({nonceMark | ++m_lastNonce, now});
    return protocol::Ping{m_asked.back().nonce, false};
}

void Pacer::answered(const protocol::Ping& reply, Instant now) {
    const auto asked = std::find_if(m_asked.begin(), m_asked.end(),
                                    [&](const Asked& a) { return a.nonce == reply.nonce; });
    if (asked == m_asked.end() || reply.tick == 0) return;
    // A tick that is late to close is still the one that is next.
    const double since = std::min(1e-6 * static_cast<double>(reply.sinceClose) * m_rate, 1.0);
    Answer answer;
    answer.at = now;
    answer.offset = static_cast<double>(reply.tick) + since - local(asked->at);
    answer.roundTrip = 1e-9 * static_cast<double>(now - asked->at);
    m_asked.erase(asked);
    m_answers.push_back(answer);
    summarize(now);
    adaptDelay(now);
}

void Pacer::summarize(Instant now) {
    if (m_answers.size() > mostAnswers) m_answers.pop_front();
    while (m_answers.size() > 1 && m_answers.front().at + answersKept < now) m_answers.pop_front();
    std::vector<double> offsets, roundTrips;
    for (const Answer& answer : m_answers) {
        offsets.push_back(answer.offset);
        roundTrips.push_back(answer.roundTrip);
    }
    m_offset = quantile(offsets, m_rules.inTime);
    m_middleOffset = quantile(std::move(offsets), 0.5);
    m_roundTrip = quantile(std::move(roundTrips), 0.5);
}

/// More delay at once, for every late command is seen; less by a tick a second.
void Pacer::adaptDelay(Instant now) {
    const double lead = (m_roundTrip + jitter()) * m_rate + m_rules.slack;
    const double beyond = std::ceil(lead - static_cast<double>(m_rules.wantedLead));
    const auto wanted = static_cast<std::uint32_t>(
        std::clamp(beyond, static_cast<double>(m_leastDelay), static_cast<double>(m_mostDelay)));
    if (wanted < m_delay && now < m_delayAt + delayKept) return;
    if (wanted < m_delay) {
        --m_delay;
    } else {
        m_delay = wanted;
    }
    m_delayAt = now;
}

double Pacer::local(Instant now) const {
    return 1e-9 * static_cast<double>(now - m_start) * m_rate;
}

/// How far the server will be when what leaves now is surely there.
double Pacer::arrival(Instant now) const {
    return local(now) + m_offset + m_rules.slack;
}

void Pacer::advance(Instant now, std::uint64_t confirmed) {
    const double seconds = now > m_now ? 1e-9 * static_cast<double>(now - m_now) : 0.0;
    m_now = std::max(now, m_now);
    const auto least = static_cast<double>(confirmed);
    if (!measured()) {
        m_position = least;
        return;
    }
    const double goal = arrival(m_now) - static_cast<double>(m_delay);
    if (!m_set) {
        m_set = true;
        m_position = goal;
    } else {
        const double behind = goal - (m_position + seconds * m_rate);
        const double steering =
            std::clamp(behind / (steeringSeconds * m_rate), -mostSteering, mostSteering);
        m_speed = 1.0 + steering;
        m_position += seconds * m_rate * m_speed;
    }
    // Never behind what is known, and where the server says nothing the world waits for it.
    m_position = std::clamp(m_position, least, least + m_rules.mostAhead + 0.999);
}

Instant Pacer::timeOf(std::uint64_t tick) const {
    const double ticks = static_cast<double>(tick) - m_position;
    if (!(ticks > 0.0)) return m_now;
    return m_now + static_cast<Instant>(std::ceil(1e9 * ticks / (m_rate * m_speed)));
}

std::uint64_t Pacer::commandTick(std::uint64_t head) const {
    if (!measured()) return 0;
    const std::uint64_t felt = head + m_delay;
    // The world may be further behind than it should: while its clock is steered, and where it may
    // not run so far ahead. What a server says does not take commands further than this.
    const double there = std::min(arrival(m_now), static_cast<double>(felt + mostOwnDelay));
    return std::max(felt, static_cast<std::uint64_t>(std::max(there, 0.0)));
}

}  // namespace huestep::client
