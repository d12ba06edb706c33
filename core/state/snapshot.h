/// Snapshots: the state's bytes with a table of contents and checksums.
///
///   offset 0   "HUESNAP1"
///          8   u32 version, u32 number of arrays
///          16  an entry an array: u32 bytes a record, u32 records
///          …   the arrays' records, in the order of `forEachArray`, without gaps
///          …   XXH3-64 of every 1,024 bytes of all that is above, the last piece shorter
///          end u64 XXH3-64 of the checksums themselves
///
/// A changed byte is found in its piece of 1,024. All little-endian.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/result.h"
#include "core/state/state.h"

namespace huestep {

/// Of the records' fields, too: who changes one gives the layout a new version.
inline constexpr std::uint32_t snapshotVersion = 2;
/// Of a world with rules: the same arrays and two more.
inline constexpr std::uint32_t rulesSnapshotVersion = 3;
inline constexpr std::size_t snapshotPiece = 1024;

std::vector<std::byte> writeSnapshot(const WorldState& state);

/// Reads and checks everything: checksums, counts, and every record by `validate`.
Result<WorldState> readSnapshot(std::span<const std::byte> bytes);

}  // namespace huestep
