/// The dice of bots: of a player's own, never of the world. Thread rule: a plain value.
#pragma once

#include <cstdint>
#include <random>

namespace huestep::client {

/// The standard's engine, whose numbers it fixes; not its distributions, which differ by library.
class Dice {
 public:
    explicit Dice(std::uint64_t seed) : m_engine(seed) {}
    std::uint64_t roll() { return m_engine(); }
    /// In [low, high).
    float between(float low, float high) {
        return low + (high - low) * (static_cast<float>(roll() >> 40) * 0x1.0p-24f);
    }
    bool once(std::uint64_t in) { return roll() % in == 0; }

 private:
    std::mt19937_64 m_engine;
};

}  // namespace huestep::client
