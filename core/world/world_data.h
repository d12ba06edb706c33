/// The inside of a world: its state, what is derived from it, and the steps over both.
///
/// Private to core/world. Everything in `Accelerators` may be thrown away between two steps; a
/// test does so and expects the same hashes.
///
/// Whoever changes a part that has a stamp, stamps it with `World::Data::stamp`: a checkpoint skips
/// what has kept its stamp (carried.cpp).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/collision/broad_phase.h"
#include "core/contact/contact.h"
#include "core/contact/narrow_phase.h"
#include "core/graph/plan.h"
#include "core/solver/effort.h"
#include "core/solver/solve.h"
#include "core/state/roots.h"
#include "core/state/state.h"
#include "core/world/world.h"

namespace huestep {

/// Derived from the definitions; follows when bodies, shapes or joints come or go.
struct Shapes {
    std::vector<Hull> hulls;           // by shape
    std::vector<ShapeProxy> proxies;   // by shape
    std::vector<std::uint32_t> first;  // by body: its first shape; one more at the end
    std::vector<float> sizes;          // by shape, m: from its middle to its farthest point
    std::vector<float> thickness;      // by shape, m: across its narrowest, half; 0: a mere line
    std::vector<Stride> strides;       // by body
    std::vector<float> reach;  // by body, m: farthest point of a shape from the centre; 0: static
    std::vector<ShapePair> forbidden;  // body places that a joint keeps from touching, sorted
    std::vector<ConstraintPlaces> jointBodies;  // by joint
    std::vector<std::uint32_t> kinematic;       // places of kinematic bodies
    std::vector<std::uint8_t> wantsTree;        // by body: its joints are solved at once (effort.h)
    std::vector<std::uint8_t> jointed;          // by body; both are empty without joints
};

/// A pair of shapes that are near each other.
struct Candidate {
    ShapePair pair;
    std::uint32_t contact = none;  ///< place of its contact, or `none` while they do not touch
};

/// Which step last changed something; 0: it is as it was made. Stamps rise and are never given
/// twice in one world, so what has the same stamp in two of its images is the same.
using Stamp = std::uint64_t;

struct Accelerators {
    bool definitionsStale = true;  // `shapes` and all below are empty and must be made
    Shapes shapes;
    std::vector<Bounds> tight;  // by shape, grown by half the speculative margin
    std::vector<Vec2> travel;   // by shape
    BroadPhase broadPhase;
    std::vector<Candidate> candidates;        // by key; those with a contact are the world's
    std::vector<Candidate> candidateScratch;  // of layOutCandidates; means nothing outside
    bool candidatesValid = false;             // else contacts are to be read from `state.contacts`
    std::vector<Contact> contacts;            // touching; places are kept while they touch
    std::vector<std::uint32_t> freeContacts;  // places of `contacts` that none has
    std::vector<std::uint8_t> inLanes;  // by contact: 1: the solver's rows hold it; contacts.cpp
    Plan plan;
    bool linksStale = true;      // contacts, joints or who moves may differ from the plan's
    bool planSharesAll = false;  // the plan was made for `StepResources::shareAll`
    bool rowsHold = false;       // the solver's contact rows are those of this plan
    std::vector<std::uint32_t> freshLanes;  // lanes whose contact has a new manifold
    Rows rows;

    Stamp shapesStamp = 0;
    Stamp broadPhaseStamp = 0;
    Stamp candidatesStamp = 0;
    Stamp planStamp = 0;
    std::vector<Stamp> contactStamps;  // by place in `contacts`
    std::vector<Stamp> rowStamps;      // by block of the solver's contact rows; impulses apart
};

/// How a body takes part in a step: not at all; moved by it; a kinematic body that moves; asleep,
/// and since when: what has slept from its start has contacts that nobody has looked at yet.
enum : std::uint8_t {
    restsNow = 0,
    movesNow = 1,
    drivesNow = 2,
    sleepsNow = 4,
    newToSleep = 8,
    neverSeen = 16,  // before its first step, or its pairs are to be found anew: it may rest
};
constexpr bool isActive(std::uint8_t activity) {
    return (activity & (movesNow | drivesNow)) != 0;
}
constexpr bool isAsleep(std::uint8_t activity) {
    return (activity & sleepsNow) != 0;
}

/// What a world carries from one step to the next; a checkpoint holds an image of it.
struct Carried {
    // The step works on the contacts of `accelerators`. `state.contacts` is current only while
    // `contactsInState`: whoever reads it, or throws the accelerators away, copies it there first.
    mutable WorldState state;
    mutable bool contactsInState = true;
    Accelerators accelerators;
    Events events;
    StepReport report;
    mutable RootCache roots;
    const Rules* rules = nullptr;        // those that `state.rules` names
    std::vector<std::uint8_t> activity;  // by body, in the last step
    Stamp definitionsStamp = 0;          // of bodies, shapes, joints and what players get

    /// Makes this the image of another. `related`: stamps of both mean the same; then only what
    /// differs is copied, and nothing is allocated once all vectors have had the room.
    void become(const Carried& other, bool related);  // carried.cpp
};

/// How much rows give way, of what they may: the most of each kind.
struct RowStrain {
    float contacts = 0;
    float swept = 0;   // joints that sweeps solve
    float direct = 0;  // joints that are solved with their tree, were they not
};

/// What the last step said of an island; of its lowest body.
struct IslandEffort {
    RowStrain strain;
    std::int8_t calm = 0;     // the lowest of its bodies
    float fastest = 0;        // m/s, of any of its points
    bool overlaps = false;    // by more than is allowed; known where it recovers
    bool hit = false;         // a contact of it met hard
    bool sweeps = false;      // a joint of it leaves anything to sweeps; known where trees are
    bool keepsTrees = false;  // joints of it are always solved at once
    EffortPlan next;
};

/// Which records the removals of a step left, by place before them, rising. What stays moves
/// together in this order; what the same step's spawns have added counts from the end.
struct Kept {
    bool all = true;  // else:
    std::vector<std::uint32_t> bodies, shapes, joints;
};

/// How `state.contacts` was last gathered from the accelerators: while candidates and plan are the
/// same, contacts that have kept their manifold are written anew in their impulses alone.
struct Gathered {
    Stamp candidates = 0;  // of when it was laid out; 0: not at all
    Stamp plan = 0;
    std::vector<std::uint32_t> contactOf;     // by record: place in `Accelerators::contacts`
    std::vector<Stamp> stamps;                // by record: of the contact that it shows
    std::vector<std::uint32_t> recordOfLane;  // or `none`
};

struct World::Data : Carried {
    Stamp stamp = 1;  // of the next change; no restore takes it back
    // Whose stamps these are. Another's image, once taken over, makes the world a new one.
    std::shared_ptr<const int> lineage = std::make_shared<const int>(0);

    mutable Gathered gathered;  // of this world's `state.contacts`

    PlanLimits planLimits;  // standard but in tests
    RulesSet knownRules;    // among which those of a delta are looked for

    // Of one step.
    std::vector<BodyForce> forces;  // by body; empty: none
    bool anyAsleep = false;
    bool edited = false;  // bodies, shapes or joints came or went, and accelerators do not know it
    Kept kept;
    std::vector<std::uint8_t> removed;  // by body; empty: none
    std::vector<std::uint8_t> removedJoints;

    std::vector<std::uint32_t> begun;         // contacts, by place
    std::vector<IslandEffort> islandEfforts;  // by body; means nothing but of planned steps

    // access.cpp
    [[nodiscard]] std::optional<std::uint32_t> findBody(BodyId id) const;
    [[nodiscard]] std::optional<std::uint32_t> findJoint(JointId id) const;
    [[nodiscard]] PlayerRecord* findPlayer(PlayerId id);
    [[nodiscard]] const PlayerRecord* findPlayer(PlayerId id) const;
    [[nodiscard]] std::span<const ShapeInfo> shapesOf(BodyId id) const;
    void wake(std::uint32_t body);
    void contactsToState() const;
    void layOutRecords() const;
    /// To be called before bodies, shapes or joints come or go.
    void changeDefinitions() {
        edited = true;
        touchDefinitions();
    }
    /// To be called when the record of a body, shape or joint changes.
    void touchDefinitions() {
        definitionsStamp = stamp;
        roots.definitionsKnown = false;
    }

    // definitions.cpp
    /// Appends bodies and joints that have been checked; returns the first new body's id.
    BodyId add(std::span<const BodyDef> bodies, std::span<const JointDef> joints, PlayerId owner);
    void build(const Scene& scene);
    /// Takes out what was marked, wakes what it touched, reports its contacts as ended.
    void removeMarked();  // removal.cpp
    void markJointsOfRemoved();
    void endContactsOfRemoved();
    void closeGaps();
    void completeShapes();
    void findTrees();

    // carry_over.cpp
    void followDefinitions(Executor* executor);
    void carryOver(Executor* executor);
    void renumberAccelerators(std::span<const std::uint32_t> bodyPlace,
                              std::span<const std::uint32_t> shapePlace, Executor* executor);
    void lookAgainAtFreed(std::span<const ShapePair> forbidden);

    // spawn.cpp
    Rejection judge(const Spawn& spawn, PlayerId author);
    [[nodiscard]] std::size_t spawnedBy(PlayerId player);
    [[nodiscard]] bool crowded(const ShapeInfo& shape, const Pose& pose) const;
    /// Farthest point of the body's shapes from its centre, m. From the state: a body that a
    /// command of this tick added has one too.
    [[nodiscard]] float reachOf(std::uint32_t body) const;

    // commands.cpp
    void applyCommands(std::span<const Command> commands);

    // rules.cpp
    Status beginRules(const Scene& scene);
    /// Finds what `state.rules` names among those known, and lets it judge the state.
    Status bindRules();
    [[nodiscard]] std::span<std::byte> rulesState();
    void afterRules();
    void cleanRulesState();

    // step.cpp
    void step(std::span<const Command> commands, const StepResources& with);
    void findPairs(Executor* executor);
    /// What a step's plan is made by; `shareAll` as in `StepResources`.
    [[nodiscard]] PlanLimits limitsOf(bool shareAll) const;
    void updatePlan(const PlanLimits& limits, Executor* executor);

    // effort.cpp
    /// From the rows of this step, the levels of the next one.
    void planEfforts(Executor* executor);
    [[nodiscard]] bool recovers() const;
    void reportTooStiff();  // too_stiff.cpp
    void nameWorstRow(std::uint32_t island);
    /// By body, those of this step: what the state says, and more where contacts begin.
    [[nodiscard]] std::vector<std::uint8_t> effortsNow() const;

    // continuous.cpp
    /// Puts fast bodies back to where on their way they met a static or kinematic one.
    void stopLeaps(const Moved& moved, Executor* executor);

    // contacts.cpp
    void layOutCandidates(Executor* executor);
    std::uint32_t addContact(const Contact& contact);
    void dropContact(std::uint32_t contact);
    [[nodiscard]] ContactChange changeOf(const Contact& contact) const;
    void collideAll(Simd simd, Executor* executor);
    enum class Lanes : std::uint8_t { Kept, All };
    void fetchImpulses(Lanes which, Executor* executor);

    // sleep.cpp
    bool wakeTouched(bool contactDisturbs);
    void settleIslands();

    [[nodiscard]] NarrowPhaseInput narrowPhaseInput() const {
        return {state.motions, accelerators.shapes.hulls, accelerators.tight};
    }
};

}  // namespace huestep
