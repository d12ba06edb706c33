/// Order statistics of samples.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace huestep::tools {

/// The q-quantile, q in [0, 1], linear between the two nearest samples; 0 of no samples.
double quantile(std::span<const double> samples, double q);

/// Quantiles of any number of samples in 120 kB: samples below 512 are kept as they are, larger
/// ones to within 1/512 of their value.
class Histogram {
 public:
    Histogram();
    void add(std::uint64_t sample);
    /// The q-quantile, q in [0, 1], the lower of the two nearest samples; 0 of no samples.
    [[nodiscard]] double quantile(double q) const;

 private:
    std::vector<std::uint64_t> m_counts;
    std::uint64_t m_samples = 0;
};

}  // namespace huestep::tools
