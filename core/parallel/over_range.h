/// A range of work in blocks: in the caller, or on a team if there is one.
#pragma once

#include "core/parallel/executor.h"

namespace huestep {

/// Calls `f(begin, end)` until [0, count) is covered; never for an empty range.
template <class F>
void overRange(Executor* executor, std::size_t count, std::uint32_t grain, F&& f) {
    const auto n = static_cast<std::uint32_t>(count);
    if (executor != nullptr && executor->threads() > 1) {
        executor->forBlocks(n, grain, f);
    } else if (n > 0) {
        f(0u, n);
    }
}

/// The same, block by block in the caller too: `f` gets at most `grain` indices at a time.
template <class F>
void overBlocks(Executor* executor, std::size_t count, std::uint32_t grain, F&& f) {
    const auto n = static_cast<std::uint32_t>(count);
    if (executor != nullptr && executor->threads() > 1) {
        executor->forBlocks(n, grain, f);
    } else {
        for (std::uint32_t begin = 0; begin < n; begin += grain) {
            f(begin, n - begin < grain ? n : begin + grain);
        }
    }
}

/// A place for the findings of each block of a range, so that none waits for another: the block
/// that begins at `begin` owns place `begin / grain`.
template <class T>
std::vector<T> perBlock(std::size_t count, std::uint32_t grain) {
    return std::vector<T>((count + grain - 1) / grain);
}

}  // namespace huestep
