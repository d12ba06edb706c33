#include "tools/stability/ladder.h"

namespace huestep::tools::stability {

std::vector<LadderFault> faultsOf(const LadderGrid& grid) {
    // A way from any place to one above it goes by such steps, so steps are all that need a look.
    std::vector<LadderFault> faults;
    for (std::size_t rate = 0; rate < grid.rates; ++rate)
        for (std::size_t effort = 0; effort < grid.efforts; ++effort) {
            if (grid.at(rate, effort)) continue;
            if (effort > 0 && grid.at(rate, effort - 1))
                faults.push_back({rate, effort, rate, effort - 1});
            if (rate > 0 && grid.at(rate - 1, effort))
                faults.push_back({rate, effort, rate - 1, effort});
        }
    return faults;
}

}  // namespace huestep::tools::stability
