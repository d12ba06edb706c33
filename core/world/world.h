/// The world: bodies, shapes, joints and contacts that step in lockstep.
///
/// A world changes only through `step(commands)`. Its future is a function of its state and the
/// commands: not of thread count, SIMD width, memory, history or time. Thread rule: one thread may
/// step a world while no other reads it; several may read, but for `save`, `fullRoot`, `contacts`,
/// `contactViews`, copies and `firstDifference`, which gather the contacts on first use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/parallel/executor.h"
#include "core/result.h"
#include "core/scene/scene.h"
#include "core/solver/simd.h"
#include "core/state/records.h"
#include "core/world/command.h"
#include "core/world/event.h"

namespace huestep {

/// With what a step is computed. No part of it can reach the result.
struct StepResources {
    Executor* executor = nullptr;  ///< none: the caller's thread alone
    Simd simd = Simd::Auto;
    Clock clock = nullptr;  ///< none: `StepReport` has no times
    /// Shares among the workers also what is too little to be worth it, in this step: to measure
    /// what that costs.
    bool shareAll = false;
};

/// The stages of a step, in order, as measured by `StepReport::nanoseconds`.
enum class Stage : std::uint8_t {
    Commands,
    Pairs,
    Collide,
    Colour,
    Prepare,  ///< of giant islands, as are the next two
    Solve,
    Store,
    Batches,  ///< of all other islands: prepare to store in one go
    Finish,
    Continuous,
    Sleep,
    Count
};
std::string_view nameOf(Stage stage);

/// Islands whose rows give way by more than the scene's need although they have all the substeps
/// that they may take: where substeps are planned.
struct TooStiff {
    std::uint32_t islands = 0;
    // Of the one that lacks most.
    BodyId body = 0;  ///< the lowest of its bodies
    std::uint32_t substeps = 0;
    std::uint32_t neededSubsteps = 0;  ///< at which its worst row would be within the need
    bool joint = false;                ///< whether that row is a joint's, not a contact's
    BodyId bodyA = 0, bodyB = 0;       ///< that it holds; 0: the world
};

/// What the last step did: for people and charts, never state.
struct StepReport {
    std::uint32_t awakeBodies = 0;
    std::uint32_t pairs = 0;      ///< pairs of shapes near each other
    std::uint32_t contacts = 0;   ///< touching
    std::uint32_t recycled = 0;   ///< contacts whose manifold was kept
    std::uint32_t joints = 0;     ///< awake
    std::uint32_t islands = 0;    ///< awake, with at least one constraint
    std::uint32_t batches = 0;    ///< islands packed for one thread, or one giant island
    std::uint32_t colours = 0;    ///< most in any batch
    std::uint32_t overflow = 0;   ///< constraints beyond the last colour
    std::uint32_t inBuckets = 0;  ///< contacts of hubs, solved in buckets
    TooStiff tooStiff;
    std::array<std::uint64_t, static_cast<std::size_t>(Stage::Count)> nanoseconds{};
};

/// A touching contact as a person or a renderer wants it.
struct ContactView {
    ShapeId shapeA = 0;
    ShapeId shapeB = 0;
    Vec2 normal;                           ///< world, from A to B
    int pointCount = 0;                    ///< 1 or 2
    std::array<Vec2, 2> point;             ///< m, world, midway between the surfaces
    std::array<float, 2> separation{};     ///< m, < 0: overlap
    std::array<float, 2> normalImpulse{};  ///< N·s of the last substep
    /// Graph colour in the last step (core/graph/coloring.h), those of hubs' buckets too; −1:
    /// asleep; 255: overflow.
    int colour = -1;
};

/// An island as the last step solved it.
struct IslandView {
    BodyId body = 0;  ///< the lowest of its bodies
    std::uint32_t bodies = 0;
    std::uint32_t contacts = 0;
    std::uint32_t joints = 0;
    std::uint32_t colours = 0;   ///< that its own constraints have
    std::uint32_t overflow = 0;  ///< its constraints beyond the last colour
    /// Larger than a batch: all threads went through it together, a barrier a colour. Otherwise one
    /// thread solved it, together with the other islands of its batch.
    bool giant = false;
    std::uint32_t batch = 0;             ///< its place among the step's batches
    std::uint32_t batchConstraints = 0;  ///< of all islands of the batch
    std::uint32_t substeps = 0;
    // Where substeps are planned:
    bool gentle = false;  ///< nothing in it is faster than 1 m/s: its contacts are stiffer
    bool trees = false;   ///< its joint trees are solved at once
    /// Of what the scene's need allows, how much its worst row gives way at rest; an upper bound
    /// where it is far below 1. 0 after a restored checkpoint until the next step.
    float strain = 0.0f;
    bool strainedJoint = false;  ///< whether that row is a joint's
};

/// How the last step was laid out: what it chose follows from counts alone, never from threads.
struct StepLayout {
    std::vector<IslandView> islands;     ///< by constraints, the largest first, then by body
    std::uint32_t freeBodies = 0;        ///< awake without a constraint: they fly exactly
    std::uint32_t giants = 0;            ///< islands larger than a batch
    std::uint32_t batchConstraints = 0;  ///< that a batch may have
    std::uint32_t sharedColours = 0;     ///< colours of giants that are worth a barrier
    std::uint32_t colours = 0;           ///< of giants in all
    /// Bytes of the records that a step goes over, each counted once however often it is read: the
    /// bodies', their bounds, candidate pairs, contacts' and joints' rows. A lower bound of what is
    /// moved between memory and core; computed from counts and record sizes, not measured.
    std::uint64_t bytesTouched = 0;
};

/// The first field in which two worlds differ, in the order of the state.
struct Difference {
    std::string record;  ///< "body", "contact", "joint", "world", …
    std::string name;    ///< which one: "body 17", "contact 3-9"
    std::string field;   ///< "velocity.x"
    std::string left;    ///< the values, as text that reads back exactly
    std::string right;
    BodyId body = 0;  ///< the body it belongs to, or 0

    /// "body 17 velocity.x: 1.25 here, 1.5 there"
    [[nodiscard]] std::string sentence() const;
};

/// A hit of a ray: fraction of the ray, point and normal on the shape.
struct RayHit {
    ShapeId shape = 0;
    BodyId body = 0;
    float fraction = 0.0f;  ///< [0, 1]
    Vec2 point;
    Vec2 normal;
};

/// An image of a world at a tick within the process, caches included: to go back to that tick, as
/// a prediction does when it was wrong. Made by `World::checkpoint`; a vessel that is used again
/// and again allocates nothing once it has held as much.
///
/// It is a value of its own: worlds may go before it. Thread rule: as of a container.
class Checkpoint {
 public:
    Checkpoint();  ///< holds nothing
    Checkpoint(Checkpoint&&) noexcept;
    Checkpoint& operator=(Checkpoint&&) noexcept;
    ~Checkpoint();

    [[nodiscard]] bool empty() const { return m_data == nullptr; }
    [[nodiscard]] std::uint64_t tick() const;  ///< of the world it holds; not of an empty one

 private:
    friend class World;
    struct Data;
    std::unique_ptr<Data> m_data;
};

class Rules;  // core/rules/rules.h
/// Rules of games that a program knows; they outlive every world.
using RulesSet = std::span<const Rules* const>;
RulesSet builtInRules();  ///< core/games

class World {
 public:
    /// Builds the world of a scene; fails with the sentence of `check(scene)`, or where the scene
    /// names rules that are not known or do not fit it.
    static Result<World> create(const Scene& scene, RulesSet known = builtInRules());

    /// The same state from a snapshot. Every byte is checked: a sentence names what and where.
    static Result<World> restore(std::span<const std::byte> snapshot,
                                 RulesSet known = builtInRules());

    /// The same state from a delta and the world that it was made against, or one in the same
    /// state. Every byte is checked: a sentence names what and where.
    static Result<World> restore(const World& base, std::span<const std::byte> delta);

    World(World&&) noexcept;
    World& operator=(World&&) noexcept;
    World(const World&);
    World& operator=(const World&);
    ~World();

    /// The one door: applies commands in key order and takes one step. Never fails: what cannot be
    /// applied is rejected in `Events::commands`. The events live until the next step.
    const Events& step(std::span<const Command> commands, const StepResources& with = {});

    /// An exact image of the state; see `core/state/snapshot.h` for its layout.
    [[nodiscard]] std::vector<std::byte> save() const;

    /// The same as a difference from another world, which whoever restores it must have too: what
    /// is equal, definitions for one, is not repeated. See `core/state/delta.h`.
    [[nodiscard]] std::vector<std::byte> saveDelta(const World& base) const;

    /// Makes `into` the image of the world as it is, with the caches of its last step. Costs the
    /// copying of what moved, and of what else has changed since `into` was last made from this
    /// world or last restored to it: definitions, pairs and constraints that are as they were then
    /// are left alone. Thread rule: several may read one world so, each with a checkpoint of its
    /// own.
    void checkpoint(Checkpoint& into) const;
    /// Makes this world what it was: its state, events, report and caches, so that the next steps
    /// are those that followed then, to the bit and without anything made again. Costs the same
    /// copying. Any world may take any checkpoint that is not empty; that of another is copied
    /// whole.
    void restore(const Checkpoint& from);

    [[nodiscard]] std::uint64_t tick() const;
    /// XXH3-64 over pose and velocity of every body, tick and counts.
    [[nodiscard]] std::uint64_t motionRoot() const;
    /// XXH3-64 over every state field.
    [[nodiscard]] std::uint64_t fullRoot() const;
    /// The hashes of the blocks of 64 bodies that `motionRoot` is made of, in order.
    [[nodiscard]] std::vector<std::uint64_t> motionLeaves() const;

    // Views of the state, sorted by id, valid until the next step.
    [[nodiscard]] const WorldInfo& info() const;
    [[nodiscard]] std::span<const BodyInfo> bodies() const;
    [[nodiscard]] std::span<const BodyMotion> motions() const;  ///< place i: body i
    [[nodiscard]] std::span<const ShapeInfo> shapes() const;
    [[nodiscard]] std::span<const JointInfo> joints() const;
    [[nodiscard]] std::span<const JointImpulses> jointImpulses() const;  ///< place i: joint i
    [[nodiscard]] std::span<const PlayerRecord> players() const;
    [[nodiscard]] std::vector<ContactState> contacts() const;
    /// Empty after a restore or a copy until the next step: views come from the last step's work.
    [[nodiscard]] std::vector<ContactView> contactViews() const;

    /// The rules that the world is played by, or null.
    [[nodiscard]] const Rules* rules() const;
    /// Their state, see `rulesStateOf`; nothing without rules.
    [[nodiscard]] std::span<const std::byte> rulesState() const;
    /// How the game stands, in a line for people; empty without rules.
    [[nodiscard]] std::string score() const;

    /// How the last step was laid out; empty before the first and after a restore or a copy, but
    /// for a restored checkpoint. Costs a walk over all constraints.
    [[nodiscard]] StepLayout stepLayout() const;

    /// Place of a body in `bodies()`, if it is there.
    [[nodiscard]] std::optional<std::uint32_t> find(BodyId id) const;
    /// Places of a body's shapes in `shapes()`: a contiguous run.
    [[nodiscard]] std::span<const ShapeInfo> shapesOf(BodyId id) const;

    [[nodiscard]] const Events& events() const;
    [[nodiscard]] const StepReport& report() const;

    /// All shapes the ray from `from` to `to` meets, ordered by (fraction, shape id).
    [[nodiscard]] std::vector<RayHit> castRay(Vec2 from, Vec2 to) const;
    /// All shapes that overlap the shape at the pose, by id; none for a shape `check` refuses.
    [[nodiscard]] std::vector<ShapeId> overlap(const ShapeDef& shape, const Pose& pose) const;

    /// Forgets everything that is not state. Only speed changes: a test calls it at random ticks.
    void dropAccelerators();

    struct Data;  ///< opaque

 private:
    explicit World(std::unique_ptr<Data> data);
    std::unique_ptr<Data> m_data;
    friend std::optional<Difference> firstDifference(const World&, const World&);
    friend struct WorldSpoiler;  // tests/core/spoil.h: no product has one
};

/// Where two worlds differ first: the world's own fields, then players, bodies, shapes, joints and
/// contacts by id. None: their states are equal.
std::optional<Difference> firstDifference(const World& left, const World& right);

}  // namespace huestep
