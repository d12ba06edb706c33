/// Rows that work on copies of their bodies: a block's lanes, or a joint, get bodies of their own.
#pragma once

#include <array>

#include "core/solver/contact_block.h"

namespace huestep {

/// A place of a copy that is written if the body itself is.
constexpr BodyPlace copyPlace(BodyPlace of, std::uint32_t copy) {
    const auto place = static_cast<BodyPlace>(copy);
    return of < 0 ? ~place : place;
}

/// Copies for one block: lane i has A at i and B at 16 + i. For one joint: A at 0, B at 1.
using LaneCopies = std::array<SolverBody, 2 * blockLanes>;

/// Makes a block's places those of copies. `Block`: of contacts or of revolutes.
template <class Block>
void placeOnCopies(Block& block) {
    for (std::uint32_t i = 0; i < blockLanes; ++i) {
        block.bodyA[i] = copyPlace(block.bodyA[i], i);
        block.bodyB[i] = copyPlace(block.bodyB[i], blockLanes + i);
    }
}

}  // namespace huestep
