#include "tools/chart/stability.h"

#include <cstdio>

#include "tools/interrupt.h"
#include "tools/stability/report.h"
#include "tools/stability/suite.h"

namespace huestep::tools::chart {

Result<bool> measureStability(Extent extent, Json& rows) {
    std::vector<stability::Configured> all;
    for (const Contender& contender : allContenders(std::span(&standardSubsteps, 1))) {
        const bool ours = contender.engine == "huestep";
        // What the product does without planning is no method of its own.
        if (ours && contender.method == Method::SoftStep && !contender.product()) continue;
        StabilityOptions options;
        options.configuration = {contender.engine, contender.name(), contender.substeps};
        options.effort = StabilityEffort::Quick;
        options.frontier = extent != Extent::Quick && ours;
        if (extent == Extent::Smoke) options.rows = {9, 23};
        Result<StabilityResult> result =
            runStability(options, [](const StabilityVerdict*, double) { return !interrupted(); });
        if (!result) return result.error();
        if (!result->finished) return false;
        all.push_back({options.configuration, std::move(*result)});
        if (extent != Extent::Smoke)
            std::fprintf(stderr, "stability: %s\n", contender.name().c_str());
    }
    rows = stability::asJson(all, true).at("rows");
    return true;
}

}  // namespace huestep::tools::chart
