/// Randomness of a test: one seed, printed, and nothing else.
#pragma once

#include <cstddef>
#include <cstdint>

namespace huestep::test {

class Dice {
 public:
    explicit Dice(std::uint64_t seed) : m_state(seed) {}
    std::uint64_t roll() {
        std::uint64_t z = (m_state += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    /// In [low, high], both included.
    std::uint64_t between(std::uint64_t low, std::uint64_t high) {
        return low + roll() % (high - low + 1);
    }
    /// True once in so many times on average; never for 0.
    bool once(std::uint64_t in) { return in != 0 && roll() % in == 0; }

 private:
    std::uint64_t m_state;
};

}  // namespace huestep::test
