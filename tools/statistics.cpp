#include "tools/statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace huestep::tools {
namespace {

// A sample of more than nine bits keeps its highest nine; the first of them is 1 and says nothing,
// so each number of bits dropped has 256 places.
constexpr unsigned keptBits = 9;
constexpr std::uint64_t exactBelow = std::uint64_t{1} << keptBits;
constexpr std::uint64_t half = exactBelow / 2;
constexpr std::uint64_t places = exactBelow + (64 - keptBits) * half;

std::uint64_t placeOf(std::uint64_t sample) {
    if (sample < exactBelow) return sample;
    const auto dropped = static_cast<unsigned>(std::bit_width(sample)) - keptBits;
    return exactBelow + (dropped - 1) * half + ((sample >> dropped) - half);
}

/// The middle of the samples that share a place.
double sampleAt(std::uint64_t place) {
    if (place < exactBelow) return static_cast<double>(place);
    const std::uint64_t dropped = (place - exactBelow) / half + 1;
    const std::uint64_t kept = (place - exactBelow) % half + half;
    return std::ldexp(static_cast<double>(kept) + 0.5, static_cast<int>(dropped));
}

}  // namespace

double quantile(std::span<const double> samples, double q) {
    if (samples.empty()) return 0.0;
    std::vector<double> sorted(samples.begin(), samples.end());
    std::sort(sorted.begin(), sorted.end());
    const double place = q * static_cast<double>(sorted.size() - 1);
    const auto low = static_cast<std::size_t>(place);
    const std::size_t high = std::min(low + 1, sorted.size() - 1);
    return sorted[low] + (place - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

Histogram::Histogram() : m_counts(places, 0) {}

void Histogram::add(std::uint64_t sample) {
    ++m_counts[placeOf(sample)];
    ++m_samples;
}

double Histogram::quantile(double q) const {
    if (m_samples == 0) return 0.0;
    const auto rank = static_cast<std::uint64_t>(q * static_cast<double>(m_samples - 1));
    std::uint64_t below = 0;
    std::uint64_t place = 0;
    while (below + m_counts[place] <= rank) below += m_counts[place++];
    return sampleAt(place);
}

}  // namespace huestep::tools
