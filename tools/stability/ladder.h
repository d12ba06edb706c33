/// Row 28: going up from less work to more, by rate or by substeps, nothing that passed may fail.
#pragma once

#include <cstddef>
#include <vector>

namespace huestep::tools::stability {

/// Which rates and efforts passed: place rate · efforts + effort, both from least to most.
struct LadderGrid {
    std::size_t rates = 0;
    std::size_t efforts = 0;
    std::vector<bool> passed;
    [[nodiscard]] bool at(std::size_t rate, std::size_t effort) const {
        return passed[rate * efforts + effort];
    }
};

/// A place that fails although one below it, by one step of either kind, passes.
struct LadderFault {
    std::size_t rate = 0, effort = 0;          ///< what fails
    std::size_t lessRate = 0, lessEffort = 0;  ///< what passes
    friend bool operator==(const LadderFault&, const LadderFault&) = default;
};

/// None: wherever some work passes, more of either kind or both passes too. By rate, then effort;
/// less effort is named before a lower rate.
std::vector<LadderFault> faultsOf(const LadderGrid& grid);

}  // namespace huestep::tools::stability
