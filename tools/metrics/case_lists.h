/// The cases by area, which `metricCases` puts together. Internal to tools/metrics.
#pragma once

#include <vector>

#include "tools/metrics/metric.h"

namespace huestep::tools {

/// Appends cases, in any order: `metricCases` sorts by metric.
void addConservationCases(std::vector<MetricCase>& cases);  ///< A1, A2, A7
void addJointCases(std::vector<MetricCase>& cases);         ///< A3, A5, A6, A16, A17
void addFrictionCases(std::vector<MetricCase>& cases);      ///< A8 to A13
void addImpactCases(std::vector<MetricCase>& cases);        ///< A14
void addRestCases(std::vector<MetricCase>& cases);          ///< A4, A15, A18
void addFrameCases(std::vector<MetricCase>& cases);         ///< A19
void addTrajectoryCases(std::vector<MetricCase>& cases);    ///< R: beside the reference solver
void addOrderCases(std::vector<MetricCase>& cases);         ///< A20: of the cases so far

/// A built-in scene whose name and parameters are known to be right.
Scene catalogScene(const std::string& text);

/// A case of one run of a built-in scene.
MetricCase caseOf(std::string_view metric, std::string name, const std::string& scene,
                  std::uint64_t ticks);

}  // namespace huestep::tools
