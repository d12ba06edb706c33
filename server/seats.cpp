#include "server/seats.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace huestep::server {

namespace {

/// A token has 16 bits for it; the last one goes out again and again.
constexpr std::uint16_t lastIssue = 0xfffe;

}  // namespace

Seats::Seats(std::string session, std::uint32_t epoch, const ResumeKey& key, const Limits& limits)
    : m_session(std::move(session)), m_epoch(epoch), m_key(key), m_limits(limits) {}

void Seats::recover(const World& world, Instant now) {
    for (const PlayerRecord& player : world.players()) {
        if (player.id == 0) continue;
        Seat seat;
        seat.emptySince = now;
        seat.heardAt = world.tick();
        m_seats.emplace(player.id, seat);
    }
}

std::optional<JoinId> Seats::join(std::string holder) {
    const auto coming = std::count_if(m_joins.begin(), m_joins.end(),
                                      [](const auto& join) { return join.second.player == 0; });
    if (m_seats.size() + static_cast<std::size_t>(coming) >= m_limits.seats) return std::nullopt;
    m_joins[++m_lastJoin].holder = std::move(holder);
    return m_lastJoin;
}

bool Seats::joining(const std::string& holder) const {
    return std::any_of(m_joins.begin(), m_joins.end(),
                       [&](const auto& join) { return join.second.holder == holder; });
}

Seats::Outcome Seats::outcome(JoinId join, Instant now) {
    const auto found = m_joins.find(join);
    if (found == m_joins.end()) return {Outcome::Kind::Refused, 0, "no such join"};
    if (!found->second.refusal.empty()) {
        Outcome refused{Outcome::Kind::Refused, 0, found->second.refusal};
        m_joins.erase(found);
        return refused;
    }
    const PlayerId player = found->second.player;
    if (player == 0 || m_committed < found->second.committedAt) return {};
    m_joins.erase(found);
    const auto seat = m_seats.find(player);
    if (seat == m_seats.end()) return {Outcome::Kind::Refused, 0, "the seat is gone"};
    seat->second.connected = true;
    seat->second.emptySince = now;
    seat->second.heardAt = m_tick;
    return {Outcome::Kind::Seated, player, {}};
}

void Seats::abandon(JoinId join) {
    const auto found = m_joins.find(join);
    if (found == m_joins.end()) return;
    const auto seat = m_seats.find(found->second.player);
    if (seat != m_seats.end()) seat->second.leaving = true;
    m_joins.erase(found);
}

Result<Seats::Resumed> Seats::resume(const protocol::ResumeToken& token, Instant now) {
    const std::optional<ResumeClaim> claim = readToken(m_key, m_session, token);
    if (!claim) return Error{"this token is not of this session"};
    const auto seat = m_seats.find(claim->player);
    if (seat == m_seats.end() || seat->second.leaving) {
        return Error{"the seat of player " + std::to_string(claim->player) + " is given up"};
    }
    const std::uint16_t issued = seat->second.issued;
    const bool thisEpoch = claim->epoch == static_cast<std::uint16_t>(m_epoch);
    const bool current =
        thisEpoch && issued > 0 && (claim->issue == issued || claim->issue + 1 == issued);
    const bool carriedOver = !thisEpoch && issued <= 1;
    if (!current && !carriedOver) return Error{"this token was used already"};
    // Whoever shows the newest token has got it. The one before says that its successor may have
    // been lost on the way: then that goes out again, or a second loss would cost the seat.
    seat->second.next = !thisEpoch ? 1 : std::min(claim->issue, lastIssue) + 1;
    seat->second.connected = true;
    seat->second.emptySince = now;
    seat->second.heardAt = m_tick;
    return Resumed{claim->player, thisEpoch};
}

PlayerId Seats::reclaim(const std::string& holder, Instant now) {
    const auto seat = std::find_if(m_seats.begin(), m_seats.end(), [&](const auto& each) {
        return each.second.holder == holder && !each.second.leaving;
    });
    if (seat == m_seats.end()) return 0;
    // The tokens that went out before are somebody's who had the ticket before: none holds now.
    seat->second.next = std::min<int>(seat->second.issued, lastIssue - 2) + 2;
    seat->second.connected = true;
    seat->second.emptySince = now;
    seat->second.heardAt = m_tick;
    return seat->first;
}

protocol::ResumeToken Seats::issue(PlayerId player) {
    Seat& seat = m_seats[player];
    seat.issued = static_cast<std::uint16_t>(seat.next);
    return makeToken(m_key, m_session, {player, static_cast<std::uint16_t>(m_epoch), seat.issued});
}

void Seats::vacate(PlayerId player, bool forGood, Instant now) {
    const auto seat = m_seats.find(player);
    if (seat == m_seats.end()) return;
    seat->second.connected = false;
    seat->second.emptySince = now;
    if (forGood) seat->second.leaving = true;
}

void Seats::heard(PlayerId player, std::uint64_t tick) {
    const auto seat = m_seats.find(player);
    if (seat != m_seats.end()) seat->second.heardAt = tick;
}

std::vector<Command> Seats::commandsFor(const World& world, std::uint64_t sequence, Instant now) {
    std::vector<Command> out;
    for (auto& [player, seat] : m_seats) {
        const bool expired = !seat.connected && now > seat.emptySince + m_limits.seatKept;
        const bool owed = std::any_of(m_joins.begin(), m_joins.end(),
                                      [p = player](const auto& j) { return j.second.player == p; });
        if ((seat.leaving || (expired && !owed)) && out.size() < m_limits.joinsPerFrame) {
            seat.leaving = true;
            out.push_back({0, ++sequence, RemovePlayer{player}});
        }
    }
    PlayerId next = world.info().joinedPlayers + 1;
    std::uint32_t added = 0;
    for (auto& [id, join] : m_joins) {
        if (join.player != 0 || !join.refusal.empty()) continue;
        if (added++ == m_limits.joinsPerFrame) break;
        join.asked = true;
        out.push_back({0, ++sequence, AddPlayer{next++}});
    }
    return out;
}

void Seats::applied(const World& world, std::uint64_t tick) {
    m_tick = tick;
    std::vector<PlayerId> arrived;
    std::vector<std::string> refused;
    for (const CommandOutcome& outcome : world.events().commands) {
        if (outcome.author != 0 || outcome.reason == Rejection::None) continue;
        refused.emplace_back(describe(outcome.reason));
    }
    for (const PlayerRecord& player : world.players()) {
        if (player.id != 0 && !m_seats.contains(player.id)) arrived.push_back(player.id);
    }
    std::erase_if(m_seats, [&](const auto& seat) {
        const auto players = world.players();
        return std::none_of(players.begin(), players.end(),
                            [&](const PlayerRecord& p) { return p.id == seat.first; });
    });
    // Joins and the players that arrived are both in the order of the AddPlayers.
    std::size_t place = 0;
    for (auto& [id, join] : m_joins) {
        if (!join.asked || join.player != 0 || !join.refusal.empty()) continue;
        if (place == arrived.size()) {
            join.refusal = refused.empty() ? "refused" : refused.back();
            continue;
        }
        join.player = arrived[place++];
        join.committedAt = tick + 1;
        Seat seat;
        seat.holder = join.holder;
        seat.heardAt = tick;
        m_seats.emplace(join.player, std::move(seat));
    }
}

void Seats::committed(std::uint64_t below) {
    m_committed = std::max(m_committed, below);
}

std::vector<PlayerId> Seats::late(std::uint64_t tick) const {
    std::vector<PlayerId> out;
    for (const auto& [player, seat] : m_seats) {
        if (tick > seat.heardAt + m_limits.lateTicks) out.push_back(player);
    }
    return out;
}

std::size_t Seats::connected() const {
    return static_cast<std::size_t>(std::count_if(
        m_seats.begin(), m_seats.end(), [](const auto& seat) { return seat.second.connected; }));
}

}  // namespace huestep::server
