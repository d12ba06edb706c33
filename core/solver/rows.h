/// The rows of a step: contacts, joints and bodies as a method goes over them.
///
/// Every method works on the same rows (method.h); they are made from contacts, joints and motions
/// before it, and give their impulses back after it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/contact/contact.h"
#include "core/graph/plan.h"
#include "core/joint/joint_row.h"
#include "core/joint/revolute_block.h"
#include "core/solver/contact_block.h"
#include "core/solver/joint_trees.h"
#include "core/solver/simd.h"
#include "core/solver/solver_world.h"
#include "core/world/event.h"

namespace huestep {

/// What passes need of a body beside its `SolverBody`.
struct BodySource {
    float inverseInertia = 0;
    Vec2 acceleration;                          ///< m/s²
    float angularAcceleration = 0;              ///< rad/s²
    float linearFactor = 1, angularFactor = 1;  ///< of damping, a substep
    /// Whether the impulses of one substep start the next one by what they did to its velocity.
    bool carries = false;
    std::uint8_t effort = 0;  ///< that its impulses are of, where substeps are planned
    Vec2 lag;  ///< m/s, by how much the mean velocity of a substep is behind that at its end
};

/// What methods need beside the rows, each its own part: sized by `MethodTraits::fit`, holding
/// nothing from step to step.
struct MethodMemory {
    struct alignas(16) Change {
        float vx = 0, vy = 0, w = 0;  ///< m/s, rad/s
        float unused = 0;
    };
    std::vector<Change> changes;  ///< by slot of the plan's incidence: what a row does to a body
    std::vector<float> shares;    ///< by place: among how many rows a body is divided
    std::vector<std::uint32_t> locks;  ///< by place; 0: free
};

/// Rows of a step. Contact rows stay for the next one where plan and manifold do, and hold the
/// contacts' impulses then; all others stay for their memory alone. Arrays of bodies go by solver
/// place.
///
/// A lane is block · 16 + place in the block, as in `Plan::contactOfLane`. Thread rule: calls on
/// ranges that share no place may run side by side.
class Rows {
 public:
    struct Range {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };
    struct Velocity {
        float x = 0, y = 0;  ///< m/s
        float w = 0;         ///< rad/s
    };

    std::vector<SolverBody> bodies;
    std::vector<SolverPose> poses;
    std::vector<Velocity> pushed;  ///< the soft step's: before the impulses of the last substep
    std::vector<BodySource> sources;
    std::vector<ContactBlock> blocks;
    std::vector<ContactFeatures> blockFeatures;  ///< by block
    std::vector<JointRow> joints;                ///< in solving order
    std::vector<RevoluteBlock> revolutes;
    std::vector<JointTrees> trees;  ///< by batch; of those that have any to solve
    MethodMemory memory;

    /// Room for all rows of a plan, and the fixed world.
    void fit(const Plan& plan);
    /// From the world, for substeps of `h` seconds. `features` gets what the blocks use.
    void prepareBodies(const Plan& plan, const SolverWorld& world, float h, Range places);
    void prepareJoints(const Plan& plan, const SolverWorld& world, const Batch& batch, float h,
                       Range range);
    void prepareRevolutes(const Plan& plan, const SolverWorld& world, const Batch& batch, float h,
                          Range range);
    void prepareContacts(const Plan& plan, const SolverWorld& world, const Batch& batch,
                         const ContactKernels& kernels, Range range, ContactFeatures& features);
    /// Back into the world. Contacts' impulses stay in their rows, fit for state; `hits` gets
    /// contacts that met hard. Where substeps are planned, rows also get their strain.
    void settleContacts(const Plan& plan, const SolverWorld& world, const ContactKernels& kernels,
                        Range range, std::vector<ContactHit>& hits);
    void storeJoints(const SolverWorld& world, Range range);
    void storeRevolutes(const Plan& plan, const SolverWorld& world, const RevoluteKernels& kernels,
                        Range range);

    [[nodiscard]] std::uint32_t blockCount() const {
        return static_cast<std::uint32_t>(blocks.size());
    }
    /// Finds out whose manifolds are kept, for whole blocks.
    void check(std::span<const BodyMotion> motions, std::span<const Bounds> bounds, Simd simd,
               Range range);
    /// Whether every lane of a block is one that is kept, padding aside or not.
    [[nodiscard]] bool allKept(std::uint32_t block) const;
    [[nodiscard]] bool isKept(std::uint32_t lane) const {
        return blocks[lane / blockLanes].kept[lane % blockLanes] != 0;
    }
    /// Places in the world of the bodies of a lane that is no padding.
    [[nodiscard]] ConstraintPlaces bodiesOf(std::uint32_t lane) const {
        const ContactBlock& rows = blocks[lane / blockLanes];
        return {static_cast<std::uint32_t>(rows.motionA[lane % blockLanes]),
                static_cast<std::uint32_t>(rows.motionB[lane % blockLanes])};
    }
    void dropLane(std::uint32_t lane) { blocks[lane / blockLanes].kept[lane % blockLanes] = 0; }
    [[nodiscard]] ContactImpulses impulses(std::uint32_t lane) const {
        const ContactBlock& rows = blocks[lane / blockLanes];
        const std::uint32_t at = lane % blockLanes;
        return {{rows.points[0].normalImpulse[at], rows.points[1].normalImpulse[at]},
                {rows.points[0].tangentImpulse[at], rows.points[1].tangentImpulse[at]},
                rows.rollingImpulse[at]};
    }
    /// The impulses of a block's lanes into their records; `none`: into none.
    void storeImpulses(std::uint32_t block, std::span<const std::uint32_t> recordOfLane,
                       std::span<ContactState> records) const;
    /// Writes a contact's row to its lane, whose bodies stay.
    void writeRow(std::uint32_t lane, const Contact& contact);

    /// Takes over what another holds for its next step. Blocks for which `same(block)` differ in
    /// their impulses alone. Allocates only where there are more blocks than ever before.
    template <class Same>
    void copyRows(const Rows& other, Same&& same) {
        blockFeatures = other.blockFeatures;
        blocks.resize(other.blocks.size());
        for (std::uint32_t block = 0; block < blocks.size(); ++block) {
            if (same(block)) {
                copyImpulses(other.blocks[block], blocks[block]);
            } else {
                blocks[block] = other.blocks[block];
            }
        }
    }

    /// Bytes of all rows and bodies that a step goes over and of what its method keeps beside them,
    /// but for what joint trees make of theirs.
    [[nodiscard]] std::uint64_t bytes() const;

 private:
    static void prefetchContacts(const Plan& plan, const SolverWorld& world, std::uint32_t block);
    void makeBlock(const Plan& plan, const SolverWorld& world, std::uint32_t block);
    void fitToEffort(const Plan& plan, const SolverWorld& world, const Batch& batch,
                     std::uint32_t block);
    [[nodiscard]] JointRow jointRow(const SolverWorld& world, const Batch& batch,
                                    std::uint32_t joint, const ConstraintBodies& places,
                                    float h) const;
    [[nodiscard]] std::uint8_t effortOf(const ConstraintBodies& places) const;
};

}  // namespace huestep
