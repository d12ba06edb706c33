/// At which tick a client's world is to be now, and for which tick its commands are to ask.
///
/// A frame of the server closes on time, so a command must be there before its tick closes, and
/// what the player sees at once must run ahead of what the server has said by a round trip. Both
/// follow from one measured number: how far the server is along when what leaves now reaches it.
/// A Ping that leaves at `now` and whose answer says at which tick the server was then gives it,
/// with no assumption that both ways take as long. Of the newest answers a high quantile counts, so
/// that jitter makes few commands late; what time it was here and there never matters.
///
/// From there the clock of the predicted world is steered: it runs at the session's rate, up to a
/// tenth faster or slower as long as it is behind or ahead, and no tick is skipped. Only the first
/// measurement sets it.
///
/// Input delay is the part of the way that a player feels instead of seeing it predicted: each
/// tick of it makes the predicted world run a tick less ahead. It is fixed, or adapts within the
/// bounds of Welcome so that no more than `wantedLead` ticks need be predicted.
///
/// All positions are in ticks since the session began. Sans-I/O; one thread.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "client/statistics.h"
#include "protocol/messages.h"

namespace huestep::client {

struct PacerRules {
    std::uint32_t mostAhead = 60;  ///< ticks beyond the confirmed world, at most `Timeline`'s
    std::uint32_t wantedLead = 6;  ///< ticks; an adaptive input delay takes what is needed beyond
    std::optional<std::uint32_t> inputDelay;  ///< ticks, ≤ 60; none: as Welcome says
    /// Share of the newest answers within whose delay commands are to arrive, (0, 1).
    double inTime = 0.95;
    double slack = 0.5;  ///< ticks to spare
};

class Pacer {
 public:
    explicit Pacer(const PacerRules& rules) : m_rules(rules) {}

    /// A connection plays from now on: forgets what was measured.
    void start(const protocol::Welcome& welcome, Instant now);

    /// The Ping to send now, if one is due.
    std::optional<protocol::Ping> ask(Instant now);
    /// Takes an answer; one that was not asked for is let go.
    void answered(const protocol::Ping& reply, Instant now);

    /// Lets time pass, with so many ticks confirmed.
    void advance(Instant now, std::uint64_t confirmed);

    /// Whether the way to the server is known; until then nothing is predicted.
    [[nodiscard]] bool measured() const { return !m_answers.empty(); }
    /// Where the predicted world is to be: whole ticks to have been stepped, and the part of the
    /// next that has gone by.
    [[nodiscard]] double position() const { return m_position; }
    [[nodiscard]] std::uint64_t head() const {
        return static_cast<std::uint64_t>(m_position < 0x1p62 ? m_position : 0x1p62);
    }
    /// When the position reaches this tick, if nothing new is heard.
    [[nodiscard]] Instant timeOf(std::uint64_t tick) const;

    /// For which tick a command that is given now is to ask, the world being at `head`: not before
    /// the input delay, nor before it can be there. 0: not known yet.
    [[nodiscard]] std::uint64_t commandTick(std::uint64_t head) const;

    [[nodiscard]] std::uint32_t inputDelay() const { return m_delay; }
    /// Of the newest answers, the middle one: s.
    [[nodiscard]] double roundTrip() const { return m_roundTrip; }
    /// What the slow ones take more on their way to the server than the middle one: s.
    [[nodiscard]] double jitter() const { return (m_offset - m_middleOffset) / m_rate; }
    /// Of the clock, against the session's rate: [0.9, 1.1].
    [[nodiscard]] double speed() const { return m_speed; }

 private:
    struct Asked {
        std::uint64_t nonce = 0;
        Instant at = 0;
    };
    struct Answer {
        Instant at = 0;
        double offset = 0.0;     ///< ticks, of the server at arrival from `local` at sending
        double roundTrip = 0.0;  ///< s
    };
    [[nodiscard]] double local(Instant now) const;
    [[nodiscard]] double arrival(Instant now) const;
    void summarize(Instant now);
    void adaptDelay(Instant now);

    PacerRules m_rules;
    double m_rate = 60.0;  ///< ticks a second
    std::uint32_t m_leastDelay = 0;
    std::uint32_t m_mostDelay = 0;
    Instant m_start = 0;
    Instant m_now = 0;
    double m_position = 0.0;
    double m_speed = 1.0;
    bool m_set = false;  ///< the position has been, by the first answer
    std::uint64_t m_lastNonce = 0;
    Instant m_askAt = 0;
    std::deque<Asked> m_asked;
    std::deque<Answer> m_answers;  ///< newest last
    double m_offset = 0.0;         ///< of the answers': of those `inTime` the last
    double m_middleOffset = 0.0;
    double m_roundTrip = 0.0;
    std::uint32_t m_delay = 0;
    Instant m_delayAt = 0;  ///< when it was last wanted as large as it is
};

}  // namespace huestep::client
