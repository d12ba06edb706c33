/// How much the rows of a batch gave way in the last step, where substeps are planned
/// (core/solver/effort.h).
#pragma once

#include <cmath>
#include <cstdint>

#include "core/solver/effort.h"
#include "core/world/world_data.h"

namespace huestep {

inline RowStrain larger(const RowStrain& a, const RowStrain& b) {
    return {maxOf(a.contacts, b.contacts), maxOf(a.swept, b.swept), maxOf(a.direct, b.direct)};
}

/// The strains of one batch's rows. Reads alone, so several threads may, of whatever batches.
class RowStrains {
 public:
    RowStrains(const World::Data& world, const Batch& batch);

    /// `f(a, b, strain)` for every row that is strained at all.
    template <class F>
    void over(F&& f) const;

    /// The largest of each kind.
    [[nodiscard]] RowStrain most() const;

    /// The lowest body of the island of a row of two bodies, of which at least one moves.
    [[nodiscard]] std::uint32_t islandOf(BodyPlace a, BodyPlace b) const {
        const auto place = static_cast<std::size_t>(b >= 0 ? b : readPlace(a));
        return m_plan.islandOf[m_plan.bodyOfPlace[place]];
    }

 private:
    [[nodiscard]] RowStrain ofJoint(const JointRow& row) const {
        const float strain = m_jointFloor * row.strain;
        return row.direct ? RowStrain{.direct = strain} : RowStrain{.swept = strain};
    }

    const Plan& m_plan;
    const Rows& m_rows;
    const Batch& m_batch;
    float m_contactFloor;  // m, of 1 m/s a substep
    float m_jointFloor;
};

template <class F>
void RowStrains::over(F&& f) const {
    for (std::uint32_t block = m_batch.firstBlock; block < m_batch.endBlock; ++block) {
        const ContactBlock& rows = m_rows.blocks[block];
        for (std::size_t i = 0; i < blockLanes; ++i) {
            if (rows.strain[i] == 0.0f) continue;
            f(rows.bodyA[i], rows.bodyB[i], RowStrain{.contacts = m_contactFloor * rows.strain[i]});
        }
    }
    for (std::uint32_t at = m_batch.firstRevoluteBlock; at < m_batch.endRevoluteBlock; ++at) {
        const RevoluteBlock& rows = m_rows.revolutes[at];
        for (std::size_t i = 0; i < blockLanes; ++i) {
            if (rows.strain[i] == 0.0f) continue;
            f(rows.bodyA[i], rows.bodyB[i],
              RowStrain{.swept = m_jointFloor * std::sqrt(rows.strain[i])});
        }
    }
    for (std::uint32_t i = m_batch.firstJoint; i < m_batch.endJoint; ++i) {
        const JointRow& row = m_rows.joints[i];
        f(row.bodyA, row.bodyB, ofJoint(row));
    }
}

}  // namespace huestep
