/// Effort planned by need against fixed numbers of substeps: is the need met, and in what time?
#pragma once

#include <string>
#include <vector>

#include "tools/chart/run.h"

namespace huestep::tools::chart {

/// A scene with so many substeps, or with as many as Huestep plans (0).
struct EffortRow {
    Run run;
    bool benchmark = false;    ///< of the scenes that speed is measured on
    double need = 0.0;         ///< m: "visual", 5 mm or a hundredth of the smallest body
    double penetration = 0.0;  ///< m, largest of the second half of the run
    double jointError = 0.0;   ///< m, likewise

    [[nodiscard]] bool planned() const { return run.contender.substeps == 0; }
    [[nodiscard]] bool met() const { return penetration <= need && jointError <= need; }
};

/// m: the need of a scene that states none.
double visualNeed(const Scene& scene);

/// False: interrupted.
Result<bool> measureEffort(Extent extent, std::vector<EffortRow>& rows);

/// What the rows of one scene say.
struct EffortAnswer {
    std::string scene;
    bool benchmark = false;
    std::uint32_t leastFixed = 0;  ///< smallest fixed number that meets the need; 0: none does
    double leastFixedTime = 0.0;   ///< µs a step
    double standardTime = 0.0;     ///< µs a step, of the standard number
    bool plannedMet = false;
    double plannedTime = 0.0;  ///< µs a step
};
std::vector<EffortAnswer> answersOf(std::span<const EffortRow> rows);

Json asJson(const EffortRow& row);
Json asJson(const EffortAnswer& answer);

}  // namespace huestep::tools::chart
