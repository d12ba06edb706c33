/// The check of tickets (protocol/ticket.h) at the door of a server. Thread rule: one at a time.
///
/// A ticket enters once: its id is remembered until it expires. What a server took before it was
/// started anew is not known to it, so it takes none that was issued before its start.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "protocol/ticket.h"
#include "server/limits.h"

namespace huestep::server {

struct TicketRules {
    protocol::VerifyingKey verifying{};
    protocol::SecretKey sealing;
    std::function<std::uint64_t()> wallMilliseconds;  ///< since 1970-01-01 UTC
};

class TicketDesk {
 public:
    /// An issuer's clock may go before this one by so much, ms.
    static constexpr std::uint64_t clockSkew = 5'000;

    enum class Verdict : std::uint8_t { Taken, Missing, Forged, Misplaced, Expired, Used, TooMany };
    struct Answer {
        Verdict verdict = Verdict::Missing;
        std::string sentence{};  ///< of a refusal, for a person
        std::string player{};    ///< of a ticket that was taken
    };

    TicketDesk(TicketRules rules, const Limits& limits);
    /// Checks a ticket for this session and role and, if it is taken, never takes it again.
    Answer take(std::span<const std::byte> sealed, const std::string& session, protocol::Role role);
    /// Ids that are remembered.
    [[nodiscard]] std::size_t remembered() const { return m_used.size(); }

 private:
    Answer check(const protocol::Ticket& ticket, const std::string& session,
                 protocol::Role role) const;

    TicketRules m_rules;
    std::size_t m_most;
    std::uint64_t m_started;
    std::uint64_t m_now;  ///< never goes back, or what was forgotten could come again
    /// Expiry first, so that the oldest are at the front.
    std::set<std::pair<std::uint64_t, protocol::TicketId>> m_used;
};

}  // namespace huestep::server
