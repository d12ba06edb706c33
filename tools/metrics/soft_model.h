/// What soft rows do at rest, in closed form (physics page, "What decides accuracy", 1): a row of
/// angular frequency ω = 2πf and effective mass m under the load F is violated by e = F / (m ω²).
#pragma once

#include <numbers>

#include "core/solver/effort.h"
#include "core/state/records.h"

namespace huestep::tools {

/// ω of the soft step's rows, rad/s; ground stands for whatever does not move.
struct SoftOmegas {
    double joint = 0.0;
    double contact = 0.0;
    double ground = 0.0;
};

/// Of a world whose substeps are given.
inline SoftOmegas softOmegas(const WorldInfo& info) {
    const double rate = static_cast<double>(info.substeps) / static_cast<double>(info.stepSeconds);
    const RowFrequency shares = rowFrequency(info.substeps);
    const auto omega = [rate](float share) {
        return 2.0 * std::numbers::pi * static_cast<double>(share) * rate;
    };
    return {omega(shares.joint), omega(shares.contact), 2.0 * omega(shares.contact)};
}

/// By how much a row is violated at rest, m.
inline double floorLaw(double load, double effectiveMass, double omega) {
    return load / (effectiveMass * omega * omega);
}

}  // namespace huestep::tools
