/// The plan of a step: which constraints are solved where and in which order.
///
/// A pure function of the links and of which bodies move. It is kept from step to step and made
/// again whenever the links differ.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/graph/coloring.h"
#include "core/graph/hubs.h"
#include "core/graph/incidence.h"
#include "core/graph/islands.h"
#include "core/state/effort.h"
#include "core/state/records.h"

namespace huestep {

inline constexpr std::uint32_t none = 0xffffffffu;

/// Constraints of one colour of one batch, or of one of a hub's runs: contact blocks, revolute
/// blocks and other joints.
struct ColourRun {
    std::uint32_t firstBlock = 0;
    std::uint32_t contactCount = 0;
    std::uint32_t firstJoint = 0;
    std::uint32_t jointCount = 0;
    std::uint32_t firstRevoluteBlock = 0;
    std::uint32_t revoluteCount = 0;
    std::uint8_t colour = 0;
    // Of a hub's run, which has contacts only: solver places.
    std::uint32_t hub = 0;
    std::uint32_t firstCopy = 0;  ///< of `blockLanes`
};

/// Whole islands that one thread solves through all substeps without a barrier, or one island that
/// is larger than a batch and is solved by all threads, a barrier a colour.
struct Batch {
    std::uint32_t firstPlace = 0, endPlace = 0;  ///< solver bodies
    std::uint32_t endCopy = 0;                   ///< from `endPlace` on: the lanes' copies of hubs
    std::uint32_t firstColour = 0, endColour = 0;  ///< runs
    std::uint32_t firstBlock = 0, endBlock = 0;    ///< of contacts
    std::uint32_t firstJoint = 0, endJoint = 0;    ///< in solving order
    std::uint32_t firstRevoluteBlock = 0, endRevoluteBlock = 0;
    std::uint32_t constraints = 0;
    std::uint32_t substeps = 1;
    std::uint8_t effort = 0;  ///< of planned substeps: their level
    bool gentle = false;      ///< likewise
    std::uint8_t ramp = 0;    ///< see `rampOf`
    bool still = false;       ///< whether its bodies are known to be at that level, and not calm
    bool giant = false;
    bool trees = false;     ///< its joint trees are solved at once, so its joints are not in lanes
    bool recovers = false;  ///< bodies that began deep inside each other come apart
    bool large = false;     ///< its island may have no more than the standard effort
};

/// Constraints that a batch may have: about 150 kB of rows, which a core's second-level cache
/// holds.
inline constexpr std::uint32_t standardBatchSize = 1024;

struct Plan {
    std::vector<Link> links;           ///< made from; joints first
    std::uint32_t jointLinks = 0;      ///< how many of them are joints
    std::vector<std::uint32_t> awake;  ///< places of awake dynamic bodies, rising; made from

    std::vector<std::uint32_t> bodyOfPlace;  ///< solver place → body; place 0: none
    std::vector<std::uint8_t> isCopy;  ///< solver place → whether it is a lane's copy of a hub
    std::vector<std::uint8_t> hasContact;  ///< solver place → whether a contact row touches it
    std::vector<std::uint8_t> hasJoint;    ///< solver place → whether a joint row touches it
    std::vector<Batch> batches;
    std::vector<ColourRun> runs;
    std::vector<std::uint32_t> contactOfLane;  ///< block · 16 + lane → contact, or `none`
    std::vector<ConstraintBodies> lanePlaces;  ///< likewise → solver places
    std::vector<std::uint32_t> jointOrder;     ///< in solver order → joint
    std::vector<ConstraintBodies> jointPlaces;
    std::vector<std::uint32_t> revoluteOfLane;     ///< block · 16 + lane → joint, or `none`
    std::vector<ConstraintBodies> revolutePlaces;  ///< likewise → solver places
    std::vector<std::uint32_t> freeBodies;         ///< awake bodies without a constraint
    std::vector<std::uint32_t> islandOf;           ///< body → lowest body of its island
    std::vector<std::uint32_t> constraintsOf;      ///< lowest body of an island → constraints
    std::vector<std::uint32_t> jointsOf;           ///< likewise → joints
    std::vector<std::uint32_t> bodiesOf;           ///< likewise → bodies
    std::vector<std::uint8_t> colourOfLink;
    Incidence incidence;  ///< where `PlanDemand` asks for it
    std::uint32_t islands = 0;
    std::uint32_t colours = 0;     ///< most in any batch; all runs of hubs have two
    std::uint32_t overflow = 0;    ///< constraints in overflow
    std::uint32_t sharedFrom = 0;  ///< see `PlanLimits`
    std::uint32_t inBuckets = 0;   ///< contacts of hubs
};

/// Whether an island's joints may be solved with their trees: they are few enough for one thread,
/// and hardly any of them closes a loop.
inline bool mayHaveTrees(const Plan& plan, std::uint32_t island) {
    return plan.jointsOf[island] > 0 && plan.constraintsOf[island] <= mostWithTrees &&
           plan.jointsOf[island] <= plan.bodiesOf[island] + 4;
}

/// What may differ from the standard in tests only. No result depends on any but `hubDegree`.
struct PlanLimits {
    std::uint32_t batchSize = standardBatchSize;
    std::uint32_t hubDegree = standardHubDegree;
    /// Contacts of a giant's colour that are worth a barrier: one costs as much as a pass over some
    /// hundred of them.
    std::uint32_t sharedFrom = 192;
    /// Shapes and joints of a scene that is stepped by more than the caller's thread: waking a
    /// second one and meeting it at barriers costs more than it saves. Definitions alone decide.
    std::uint32_t parallelFrom = 512;
};

/// What a step asks of its plan.
struct PlanDemand {
    std::uint32_t substeps = 4;  ///< of every island; 0: of each the highest effort of its bodies
    bool colours = true;         ///< else key order alone: all goes to the overflow
    std::span<const std::uint8_t> efforts{};  ///< by body; where `substeps` is 0 with their levels
    std::span<const std::uint8_t> ramps{};    ///< by body, where `substeps` is 0
    bool hubs = true;       ///< buckets for them; else what finds no colour goes to the overflow
    bool pinLanes = false;  ///< revolutes fill lanes in the overflow too
    bool incidence = false;
    bool trees = false;  ///< whether joint trees are solved at once, in every batch
};

/// Makes the plan. `links` and `awake` are moved in; bodies that are not awake are read by the
/// solver and never written.
void makePlan(Plan& plan, std::vector<Link>&& links, std::uint32_t jointLinks,
              std::vector<std::uint32_t>&& awake, std::uint32_t bodyCount, PlanLimits limits = {},
              PlanDemand demand = {});

}  // namespace huestep
