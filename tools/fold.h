/// How what was measured in the course of a run becomes one value.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace huestep::tools {

enum class Fold : std::uint8_t {
    Last,  ///< the last value
    Most,  ///< the largest
    Rms    ///< the root of the mean square
};

/// Folds values as they come. What is not a number is as bad as can be: infinite.
class Folding {
 public:
    explicit Folding(Fold fold) : m_fold(fold) {}

    void add(double value) {
        const double safe = std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
        m_last = safe;
        m_most = m_count == 0 ? safe : std::max(m_most, safe);
        m_squares += safe * safe;
        ++m_count;
    }

    [[nodiscard]] std::uint64_t count() const { return m_count; }
    /// So far; infinite before the first.
    [[nodiscard]] double value() const {
        if (m_count == 0) return std::numeric_limits<double>::infinity();
        if (m_fold == Fold::Rms) return std::sqrt(m_squares / static_cast<double>(m_count));
        return m_fold == Fold::Most ? m_most : m_last;
    }

 private:
    Fold m_fold;
    double m_last = 0.0, m_most = 0.0, m_squares = 0.0;
    std::uint64_t m_count = 0;
};

}  // namespace huestep::tools
