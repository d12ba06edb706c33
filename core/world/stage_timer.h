/// Measures the stages of a step by the caller's clock, if it gave one.
#pragma once

#include "core/world/world.h"

namespace huestep {

class StageTimer {
 public:
    StageTimer(Clock clock, StepReport& report)
        : m_clock(clock), m_report(report), m_last(clock ? clock() : 0) {}

    /// Time since the last call, or since the start, belongs to `stage`.
    void done(Stage stage) {
        if (!m_clock) return;
        const std::uint64_t now = m_clock();
        m_report.nanoseconds[static_cast<std::size_t>(stage)] += now - m_last;
        m_last = now;
    }

 private:
    Clock m_clock;
    StepReport& m_report;
    std::uint64_t m_last;
};

}  // namespace huestep
