#include "server/ticket_desk.h"

#include <algorithm>

namespace huestep::server {

namespace {

std::string nameOf(protocol::Role role) {
    return role == protocol::Role::Player ? "a player" : "a spectator";
}

}  // namespace

TicketDesk::TicketDesk(TicketRules rules, const Limits& limits)
    : m_rules(std::move(rules)),
      m_most(limits.ticketsUsed),
      m_started(m_rules.wallMilliseconds()),
      m_now(m_started) {}

TicketDesk::Answer TicketDesk::take(std::span<const std::byte> sealed, const std::string& session,
                                    protocol::Role role) {
    if (sealed.empty()) {
        return {Verdict::Missing, "this server asks for a ticket, and there is none in the Hello"};
    }
    const Result<protocol::Ticket> ticket =
        protocol::openTicket(sealed, m_rules.verifying, m_rules.sealing);
    if (!ticket) return {Verdict::Forged, ticket.error().message};
    m_now = std::max(m_now, m_rules.wallMilliseconds());
    const Answer answer = check(*ticket, session, role);
    if (answer.verdict != Verdict::Taken) return answer;
    while (!m_used.empty() && m_used.begin()->first < m_now) m_used.erase(m_used.begin());
    if (m_used.contains({ticket->expires, ticket->id})) {
        return {Verdict::Used, "this ticket was used already"};
    }
    // To forget one that may come again would let it in twice.
    if (m_used.size() >= m_most) {
        return {Verdict::TooMany, "more tickets are in use here than can be remembered"};
    }
    m_used.emplace(ticket->expires, ticket->id);
    return answer;
}

TicketDesk::Answer TicketDesk::check(const protocol::Ticket& ticket, const std::string& session,
                                     protocol::Role role) const {
    if (ticket.session != session) {
        return {Verdict::Misplaced, "this ticket is for another session, " + ticket.session};
    }
    if (ticket.role != role) {
        return {Verdict::Misplaced,
                "this ticket is for " + nameOf(ticket.role) + ", not for " + nameOf(role)};
    }
    if (m_now > ticket.expires) {
        return {Verdict::Expired, "this ticket expired " +
                                      std::to_string((m_now - ticket.expires) / 1'000) + " s ago"};
    }
    if (ticket.issued > m_now + clockSkew) {
        return {Verdict::Expired, "this ticket is of a time to come: the issuer's clock is ahead"};
    }
    if (ticket.issued < m_started) {
        return {Verdict::Expired, "this ticket was issued before this server started; get another"};
    }
    return {Verdict::Taken, {}, ticket.player};
}

}  // namespace huestep::server
