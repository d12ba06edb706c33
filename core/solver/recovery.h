/// Bodies that begin deep inside each other: apart again, and no faster for it.
///
/// The soft step pushes by velocities and takes back in relax what it may; where many are pushed at
/// once one pass takes back too little, and a heap that was drawn together flies apart. Here what
/// pushes moves places alone: a substep is solved with bias until the push has gone through the
/// heap, bodies move, and velocities and impulses are again what they were before. Relax then knows
/// of loads and friction only (split impulses: Guendelman, Bridson and Fedkiw, "Nonconvex rigid
/// bodies with stacking", SIGGRAPH 2003).
#pragma once

#include <vector>

#include "core/graph/plan.h"
#include "core/solver/rows.h"

namespace huestep {

/// Passes of a substep in islands that recover, by measurement: of 50 boxes with 90 % overlap, with
/// 8 some are still 4 cm inside each other after 3 s, with 16 all are free after 1.5 s.
inline constexpr int recoveryPasses = 16;

/// Velocities and impulses of a batch as they were. One worker's, or each batch's own.
class Recovery {
 public:
    void keep(const Rows& rows, const Batch& batch);
    void restore(Rows& rows, const Batch& batch) const;

 private:
    struct BlockImpulses {
        LaneRow normal[2], tangent[2], rolling;
    };
    std::vector<Rows::Velocity> m_velocities;  ///< by place, from the batch's first
    std::vector<BlockImpulses> m_contacts;     ///< by block, likewise
    std::vector<JointImpulses> m_joints;
    std::vector<RevoluteBlock> m_revolutes;
};

}  // namespace huestep
