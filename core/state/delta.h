/// Deltas: a state as its difference from another that both sides have.
///
///   offset 0   "HUEDELT1"
///          8   u32 version, u32 number of arrays
///          16  u64 full root of the base, u64 full root of the state
///          32  the arrays in the order of `forEachArray`, each: u32 records, then its runs
///          end u64 XXH3-64 of all that is above
///
/// A run is a u32, kind in bits 0 and 1 and a count above 0 in the others, and goes over as many
/// records, in order: of the base's that are still the same (0), of the base's that have changed
/// (1), that are new (2), of the base's that are gone (3). A changed record is a bit a byte, lowest
/// first, that says which of its bytes have changed, and those bytes; a new one is all its bytes.
/// Little-endian.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/result.h"
#include "core/state/state.h"

namespace huestep {

/// Goes with `snapshotVersion`: both hold the same records.
inline constexpr std::uint32_t deltaVersion = 2;
/// Where one of the two worlds has rules: the same arrays and two more.
inline constexpr std::uint32_t rulesDeltaVersion = 3;

/// The roots are `fullRoot` of the two states.
std::vector<std::byte> writeDelta(const WorldState& base, std::uint64_t baseRoot,
                                  const WorldState& state, std::uint64_t root);

/// The state again, exactly. Checks everything: that the base is the one meant, checksum, runs,
/// every record by `validate`, and the root of what comes out. The sentence of a failure names what
/// is wrong and at which offset.
Result<WorldState> readDelta(const WorldState& base, std::uint64_t baseRoot,
                             std::span<const std::byte> bytes);

}  // namespace huestep
