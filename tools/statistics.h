/// Order statistics of samples.
#pragma once

#include <span>

namespace huestep::tools {

/// The q-quantile, q in [0, 1], linear between the two nearest samples; 0 of no samples.
double quantile(std::span<const double> samples, double q);

}  // namespace huestep::tools
