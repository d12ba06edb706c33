/// The soft step: substeps of warm start, biased solve, motion and relaxation over the plan.
///
/// Source: the physics page, "Starting point"; the scheme is the one known as Soft Step (Catto,
/// "Solver2D", 2024): h = Δt/n; a substep integrates velocities, applies the last impulses, solves
/// normals and joints with a soft bias, moves, and solves again without bias ("relax"), where
/// friction and rolling resistance are solved too. Restitution comes once, at the end.
#pragma once

#include <span>
#include <vector>

#include "core/contact/contact.h"
#include "core/graph/plan.h"
#include "core/joint/joint_row.h"
#include "core/joint/revolute_block.h"
#include "core/parallel/executor.h"
#include "core/solver/contact_block.h"
#include "core/world/event.h"
#include "core/world/stage_timer.h"

namespace huestep {

/// An external force of one tick.
struct BodyForce {
    Vec2 force;           ///< N
    float torque = 0.0f;  ///< N·m
};

/// Places of a joint's bodies in the world's arrays. A mouse joint has body B in both.
struct ConstraintPlaces {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
};

/// How far a body may go in a step before it could pass something unseen.
struct Stride {
    float most = 0;   ///< m, that no point of it may move by; half of its thickness
    float reach = 0;  ///< m, farthest vertex of its shapes from its centre
};

/// A body that went somewhere, and where it was before. Places of the world.
struct Leap {
    std::uint32_t body = 0;
    Pose from;
};

/// What became of the bodies of a step.
struct Moved {
    std::vector<std::uint32_t> broken;  ///< turned non-finite or left the world; sorted
    std::vector<Leap> leaps;            ///< went beyond their stride; in no order that matters
    std::vector<Leap> driven;           ///< kinematic bodies that moved; sorted
};

/// Whether a colour of a giant island is worth a barrier: by its size alone, whoever runs it.
bool isShared(const Plan& plan, const ColourRun& run);

/// What the solver reads and writes of the world.
struct SolverWorld {
    std::span<const BodyInfo> bodies;
    std::span<BodyMotion> motions;
    std::span<const BodyForce> forces;         ///< by body; empty: none
    std::span<const std::uint32_t> kinematic;  ///< places of kinematic bodies
    std::span<const Stride> strides;           ///< by body
    std::span<const JointInfo> joints;
    std::span<const ConstraintPlaces> jointBodies;  ///< places of each joint's two bodies
    std::span<JointImpulses> jointImpulses;
    std::span<const ShapeInfo> shapes;
    std::span<const Contact> contacts;
    bool rowsHold = false;  ///< contact rows are those of the last solve, which had this very plan
    Vec2 gravity;
    float stepSeconds = 0;
    std::uint32_t substeps = 4;
};

/// Solves a plan. Holds the rows of a step: contact rows stay for the next one where plan and
/// manifold do, and hold the contacts' impulses then; all others stay for their memory alone.
///
/// A lane is block · 16 + place in the block, as in `Plan::contactOfLane`.
class SoftStep {
 public:
    struct Range {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };

    /// How many blocks of contact rows there are.
    [[nodiscard]] std::uint32_t blockCount() const {
        return static_cast<std::uint32_t>(m_blocks.size());
    }
    /// Finds out whose manifolds are kept, for whole blocks.
    void check(std::span<const BodyMotion> motions, std::span<const Bounds> bounds, Simd simd,
               Range blocks);
    /// Whether every lane of a block is one that is kept, padding aside or not.
    [[nodiscard]] bool allKept(std::uint32_t block) const;
    [[nodiscard]] bool isKept(std::uint32_t lane) const {
        return m_blocks[lane / blockLanes].kept[lane % blockLanes] != 0;
    }
    /// Places in the world of the bodies of a lane that is no padding.
    [[nodiscard]] ConstraintPlaces bodiesOf(std::uint32_t lane) const {
        const ContactBlock& rows = m_blocks[lane / blockLanes];
        return {static_cast<std::uint32_t>(rows.motionA[lane % blockLanes]),
                static_cast<std::uint32_t>(rows.motionB[lane % blockLanes])};
    }
    void dropLane(std::uint32_t lane) { m_blocks[lane / blockLanes].kept[lane % blockLanes] = 0; }
    [[nodiscard]] ContactImpulses impulses(std::uint32_t lane) const {
        const ContactBlock& rows = m_blocks[lane / blockLanes];
        const std::uint32_t at = lane % blockLanes;
        return {{rows.points[0].normalImpulse[at], rows.points[1].normalImpulse[at]},
                {rows.points[0].tangentImpulse[at], rows.points[1].tangentImpulse[at]},
                rows.rollingImpulse[at]};
    }
    /// Writes a contact's row to its lane, whose bodies stay.
    void writeRow(std::uint32_t lane, const Contact& contact);

    /// Takes over what another holds for its next step. Blocks for which `same(block)` differ in
    /// their impulses alone. Allocates only where there are more blocks than ever before.
    template <class Same>
    void copyRows(const SoftStep& other, Same&& same) {
        m_blockFeatures = other.m_blockFeatures;
        m_blocks.resize(other.m_blocks.size());
        for (std::uint32_t block = 0; block < m_blocks.size(); ++block) {
            if (same(block)) {
                copyImpulses(other.m_blocks[block], m_blocks[block]);
            } else {
                m_blocks[block] = other.m_blocks[block];
            }
        }
    }

    /// Bytes of all rows and bodies that `solve` goes over.
    [[nodiscard]] std::uint64_t bytes() const;

    /// Rows from contacts, joints and motions; all substeps; joints' impulses back into joints;
    /// contacts' stay in their rows. A giant batch goes through each stage on all threads; any
    /// other goes through all of them on one thread, while its rows are in that core's cache.
    /// `hits` gets contacts that met hard, by key.
    void solve(const Plan& plan, const SolverWorld& world, Simd simd, Executor* executor,
               std::vector<ContactHit>& hits, StageTimer& timer);

    /// Poses and velocities back into motions, free flight included. Bodies that turned non-finite
    /// or left the world stay where they were, at rest.
    Moved finish(const Plan& plan, const SolverWorld& world, Executor* executor);

 private:
    /// What rows and passes need of a body beside its `SolverBody`, by solver place.
    struct Source {
        float inverseInertia = 0;
        Vec2 acceleration;                          // m/s²
        float angularAcceleration = 0;              // rad/s²
        float linearFactor = 1, angularFactor = 1;  // of damping, a substep
        // Whether the impulses of one substep start the next one by what they did to its velocity.
        bool carries = false;
        Vec2 lag;  // m/s, by how much the mean velocity of a substep is behind that at its end
    };
    struct Velocity {
        float x = 0, y = 0;  // m/s
        float w = 0;         // rad/s
    };
    struct Pass;
    struct Sweep;
    static const Sweep warmStartSweep, warmStartAgainSweep, solveSweep, relaxSweep, restituteSweep;

    // rows.cpp
    void prepareBodies(const Plan& plan, const SolverWorld& world, Range places);
    void prepareJoints(const Plan& plan, const SolverWorld& world, Range joints);
    void prepareBlocks(const Plan& plan, const SolverWorld& world, const ContactKernels& kernels,
                       Range blocks, ContactFeatures& features);
    static void prefetchContacts(const Plan& plan, const SolverWorld& world, std::uint32_t block);
    void makeBlock(const Plan& plan, const SolverWorld& world, std::uint32_t block);
    void settleBlocks(const Plan& plan, const SolverWorld& world, const ContactKernels& kernels,
                      Range blocks, std::vector<ContactHit>& hits);
    void storeJoints(const SolverWorld& world, Range joints) const;
    [[nodiscard]] JointRow jointRow(const SolverWorld& world, std::uint32_t joint,
                                    const ConstraintBodies& places) const;
    void prepareRevolutes(const Plan& plan, const SolverWorld& world, Range blocks);
    void storeRevolutes(const Plan& plan, const SolverWorld& world, Range blocks) const;

    // soft_step.cpp
    static Pass makePass(const SolverWorld& world, Simd simd);
    void solveGiant(const Plan& plan, const SolverWorld& world, const Batch& batch, Pass pass,
                    Executor* executor, std::vector<ContactHit>& hits, StageTimer& timer);
    void sweepHub(const ColourRun& run, ContactKernel kernel, const ContactKernels& kernels,
                  const ContactPass& pass);
    void sweepColour(const ColourRun& run, const Sweep& sweep, const JointPass& joint,
                     const Pass& pass, int worker, int workers);
    void substeps(const Plan& plan, const Batch& batch, const Pass& pass, int worker, int workers,
                  Executor* executor);

    std::vector<SolverBody> m_bodies;  // by solver place
    std::vector<SolverPose> m_poses;   // by solver place
    std::vector<Velocity> m_pushed;    // by solver place: before the impulses of the last substep
    std::vector<Source> m_sources;     // by solver place
    std::vector<ContactBlock> m_blocks;
    std::vector<ContactFeatures> m_blockFeatures;  // by block
    std::vector<JointRow> m_joints;                // in solving order
    std::vector<RevoluteBlock> m_revolutes;
};

}  // namespace huestep
