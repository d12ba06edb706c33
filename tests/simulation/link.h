/// One direction of a TCP connection in virtual time: bytes in order, late, in other pieces.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "dice.h"

namespace huestep::test {

using Instant = std::uint64_t;
inline constexpr Instant ms = 1'000'000;

struct LinkWeather {
    Instant delay = 20 * ms;
    Instant jitter = 15 * ms;
    std::uint64_t corruptOnceIn = 0;  ///< pieces; 0: never
    /// Pieces; a lost one is sent again by TCP after `resendAfter`, and all behind it wait.
    std::uint64_t loseOnceIn = 0;
    Instant resendAfter = 200 * ms;
};

class Link {
 public:
    void send(std::span<const std::byte> bytes, Instant now, const LinkWeather& weather,
              Dice& dice) {
        if (bytes.empty()) return;
        Instant due = now + weather.delay + dice.between(0, weather.jitter);
        while (dice.once(weather.loseOnceIn)) due += weather.resendAfter;
        m_lastDue = std::max(m_lastDue, due);  // TCP keeps the order
        m_flying.push_back({{bytes.begin(), bytes.end()}, m_lastDue});
        m_unsent += bytes.size();
    }

    /// What has arrived by now, at most `room` bytes, joined and split at random places.
    std::vector<std::vector<std::byte>> receive(Instant now, std::size_t room,
                                                const LinkWeather& weather, Dice& dice) {
        std::vector<std::byte> all;
        while (!m_flying.empty() && m_flying.front().due <= now && all.size() < room) {
            std::vector<std::byte>& bytes = m_flying.front().bytes;
            const std::size_t count = std::min(room - all.size(), bytes.size());
            const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(count);
            all.insert(all.end(), bytes.begin(), end);
            bytes.erase(bytes.begin(), end);
            if (bytes.empty()) m_flying.pop_front();
        }
        m_unsent -= all.size();
        std::vector<std::vector<std::byte>> pieces;
        for (std::size_t at = 0; at < all.size();) {
            const std::size_t longest = dice.once(3) ? 24 : 20'000;
            const std::size_t count = std::min(dice.between(1, longest), all.size() - at);
            const auto from = all.begin() + static_cast<std::ptrdiff_t>(at);
            pieces.emplace_back(from, from + static_cast<std::ptrdiff_t>(count));
            if (dice.once(weather.corruptOnceIn)) {
                pieces.back()[dice.roll() % count] ^= std::byte(1u << (dice.roll() % 8));
            }
            at += count;
        }
        return pieces;
    }

    /// Bytes sent and not yet received: what the sender's transport still holds.
    [[nodiscard]] std::size_t unsent() const { return m_unsent; }

 private:
    struct Piece {
        std::vector<std::byte> bytes;
        Instant due = 0;
    };
    std::deque<Piece> m_flying;
    Instant m_lastDue = 0;
    std::size_t m_unsent = 0;
};

}  // namespace huestep::test
