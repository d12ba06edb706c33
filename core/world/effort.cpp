// How much work the next step gives each island, from how much the rows of this one gave way
// (core/solver/effort.h).

#include <algorithm>
#include <optional>

#include "core/parallel/over_range.h"
#include "core/solver/effort.h"
#include "core/solver/method.h"
#include "core/world/row_strains.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

// Of the fastest point of an island, m/s. Slower than this it may be taken for at rest, twice what
// lets bodies fall asleep; and stays so up to another speed, as softer contacts give way at first.
constexpr float restSpeed = 0.1f;
constexpr float unrestSpeed = 0.5f;
// Slower than this nothing hits anything, and contacts may be stiff. They stay so until something
// does, however fast all move together.
constexpr float gentleSpeed = 1.0f;
// In tolerances, of a large island: what is pressed together by more would heave if its contacts
// were stiffer. A pyramid of 5,050 boxes that is being set up is within it, a pile that has settled
// softly is far beyond.
constexpr float deepPile = 10.0f;

RowStrain atMostOne(const RowStrain& strain) {
    return {minOf(strain.contacts, 1.0f), minOf(strain.swept, 1.0f), minOf(strain.direct, 1.0f)};
}

/// By what helps: substeps, or trees.
IslandStrain byCure(const RowStrain& strain, bool trees, bool mayHaveTrees) {
    if (!trees && mayHaveTrees) return {strain.contacts, strain.swept};
    return {maxOf(strain.contacts, strain.swept), strain.direct};
}

/// How far the shapes of two bodies may overlap where a scene leaves it at *visual*, m.
float visualOf(const World::Data& world, std::uint32_t a, std::uint32_t b) {
    const std::vector<float>& reach = world.accelerators.shapes.reach;
    return allowedError(0.0f, reach[a], reach[b]);
}

/// How far a lane's points overlap at the end of the step, m.
float overlapOf(const ContactBlock& rows, std::size_t lane, std::span<const SolverBody> bodies) {
    const SolverBody& a = bodies[static_cast<std::size_t>(readPlace(rows.bodyA[lane]))];
    const SolverBody& b = bodies[static_cast<std::size_t>(readPlace(rows.bodyB[lane]))];
    const Vec2 normal{rows.normalX[lane], rows.normalY[lane]};
    float overlap = 0.0f;
    for (const ContactPointRows& p : rows.points) {
        if (!(p.normalMass[lane] > 0.0f)) continue;
        const Vec2 rA = rotate(Rotation{a.dc, a.ds}, Vec2{p.anchorAx[lane], p.anchorAy[lane]});
        const Vec2 rB = rotate(Rotation{b.dc, b.ds}, Vec2{p.anchorBx[lane], p.anchorBy[lane]});
        const Vec2 moved = (Vec2{b.dx, b.dy} - Vec2{a.dx, a.dy}) + (rB - rA);
        overlap = maxOf(overlap, -(p.separation[lane] + dot(normal, moved)));
    }
    return overlap;
}

/// The islands of one batch. Batches share none, so those of several may work side by side.
class BatchEffort {
 public:
    BatchEffort(World::Data& world, Batch& batch)
        : m_world(world),
          m_plan(world.accelerators.plan),
          m_rows(world.accelerators.rows),
          m_batch(batch),
          m_strains(world, batch) {}

    /// Writes the levels of the batch's bodies, and makes impulses fit them. Returns whether any
    /// island changes its level.
    bool decide();
    /// Where substeps are fixed: which islands go on to recover.
    bool decideRecovery();

 private:
    template <class F>
    void overBodies(F&& f) const;
    [[nodiscard]] IslandEffort& islandOf(BodyPlace a, BodyPlace b) const;
    [[nodiscard]] float speedOf(std::uint32_t body) const;
    [[nodiscard]] bool wantsTree(std::uint32_t body) const;
    [[nodiscard]] bool mayStiffen(const IslandEffort& now, std::uint8_t most) const;
    [[nodiscard]] EffortRange rangeOf(std::uint32_t island, const IslandEffort& now) const;
    [[nodiscard]] bool hitsAnything() const;
    void gatherSweeps();
    void gatherHits();
    [[nodiscard]] bool stays(const RowStrain& strain);
    void gather(const std::optional<RowStrain>& strain);
    void gatherOverlap();
    void rescale() const;

    World::Data& m_world;
    const Plan& m_plan;
    Rows& m_rows;
    Batch& m_batch;
    RowStrains m_strains;
    bool m_hits = false;  ///< whether any contact met hard
};

template <class F>
void BatchEffort::overBodies(F&& f) const {
    for (std::uint32_t place = m_batch.firstPlace; place < m_batch.endPlace; ++place) {
        const std::uint32_t body = m_plan.bodyOfPlace[place];
        if (m_world.activity[body] == movesNow) f(body);
    }
}

IslandEffort& BatchEffort::islandOf(BodyPlace a, BodyPlace b) const {
    return m_world.islandEfforts[m_strains.islandOf(a, b)];
}

/// Impulses of this step's substeps become those of the next one's.
void BatchEffort::rescale() const {
    const auto factorOf = [&](const IslandEffort& island) {
        return static_cast<float>(m_batch.substeps) /
               static_cast<float>(substepsOf(island.next.level));
    };
    for (std::uint32_t block = m_batch.firstBlock; block < m_batch.endBlock; ++block) {
        ContactBlock& rows = m_rows.blocks[block];
        for (std::uint32_t lane = 0; lane < blockLanes; ++lane) {
            if (m_plan.contactOfLane[block * blockLanes + lane] == none) continue;
            scaleLane(rows, lane, factorOf(islandOf(rows.bodyA[lane], rows.bodyB[lane])));
        }
    }
    const auto scaleJoint = [&](std::uint32_t joint, BodyPlace a, BodyPlace b) {
        scale(m_world.state.jointImpulses[joint], factorOf(islandOf(a, b)));
    };
    for (std::uint32_t at = m_batch.firstRevoluteBlock * blockLanes;
         at < m_batch.endRevoluteBlock * blockLanes; ++at) {
        if (m_plan.revoluteOfLane[at] == none) continue;
        const ConstraintBodies& places = m_plan.revolutePlaces[at];
        scaleJoint(m_plan.revoluteOfLane[at], places.a, places.b);
    }
    for (std::uint32_t i = m_batch.firstJoint; i < m_batch.endJoint; ++i) {
        scaleJoint(m_plan.jointOrder[i], m_rows.joints[i].bodyA, m_rows.joints[i].bodyB);
    }
}

/// A bound on the speed of any point of a body, m/s.
float BatchEffort::speedOf(std::uint32_t body) const {
    const BodyMotion& motion = m_world.state.motions[body];
    const float spin = motion.angularVelocity * m_world.accelerators.shapes.reach[body];
    return length(motion.velocity) + absoluteOf(spin);
}

/// What each island brings into the decision; `strain` where it is known to be that of all.
void BatchEffort::gather(const std::optional<RowStrain>& strain) {
    overBodies([&](std::uint32_t body) {
        IslandEffort& island = m_world.islandEfforts[m_plan.islandOf[body]];
        if (m_plan.islandOf[body] == body) {
            island = {};
            island.strain = strain.value_or(RowStrain{});
            island.calm = calmSteps;
        }
        const BodyMotion& motion = m_world.state.motions[body];
        // A body that was lifted to the batch's level by others has not been calm there.
        const bool there = levelOf(motion.effort) == m_batch.effort;
        const std::int8_t calm = there ? motion.calm : std::min(motion.calm, std::int8_t{0});
        island.calm = std::min(island.calm, calm);
        island.fastest = maxOf(island.fastest, speedOf(body));
        island.keepsTrees = island.keepsTrees || wantsTree(body);
    });
    gatherSweeps();
    if (strain) return;
    m_strains.over([&](BodyPlace a, BodyPlace b, const RowStrain& ofRow) {
        IslandEffort& island = islandOf(a, b);
        island.strain = larger(island.strain, ofRow);
    });
}

/// Of islands whose joints are solved with their trees: whether they leave sweeps anything.
void BatchEffort::gatherSweeps() {
    if (!m_batch.trees) return;
    for (std::uint32_t i = m_batch.firstJoint; i < m_batch.endJoint; ++i) {
        const JointRow& row = m_rows.joints[i];
        if (isSwept(row)) islandOf(row.bodyA, row.bodyB).sweeps = true;
    }
}

bool BatchEffort::wantsTree(std::uint32_t body) const {
    const std::vector<std::uint8_t>& wants = m_world.accelerators.shapes.wantsTree;
    return !wants.empty() && wants[body] != 0;
}

EffortRange BatchEffort::rangeOf(std::uint32_t island, const IslandEffort& now) const {
    const bool jointed = m_plan.jointsOf[island] > 0;
    const float still = m_batch.effort < standardEffort ? unrestSpeed : restSpeed;
    std::uint8_t least = standardEffort;
    if (now.fastest < still && !jointed) least = restingEffort;
    // What hangs at rest on joints that are solved at once needs no substeps at all.
    const bool hangs = jointed && m_batch.trees && !now.sweeps &&
                       m_plan.jointsOf[island] == m_plan.constraintsOf[island];
    if (now.fastest < still && hangs) least = hangingEffort;
    const std::uint8_t most = affordableEffort(m_plan.constraintsOf[island]);
    return {.least = least,
            .most = most,
            .gentle = !now.hit && (m_batch.gentle || mayStiffen(now, most)),
            .jointed = jointed,
            .mayHaveTrees = mayHaveTrees(m_plan, island),
            .keepsTrees = now.keepsTrees};
}

/// Whether contacts that were soft may be stiffer from now on. In an island too large for more
/// substeps that also takes that they are not pressed together by much more than they may: a pile
/// that has settled softly would heave, fall back, be hit and soft again, and so on for good.
bool BatchEffort::mayStiffen(const IslandEffort& now, std::uint8_t most) const {
    if (!(now.fastest < gentleSpeed)) return false;
    return most > standardEffort || !(now.strain.contacts > deepPile);
}

/// Whether a giant that is strained so stays as it is, so that nothing is to be written.
bool BatchEffort::stays(const RowStrain& strain) {
    if (!m_batch.giant || !m_batch.still || m_batch.recovers || m_batch.trees) return false;
    const float enough = m_batch.gentle ? unrestSpeed : gentleSpeed;  // more tells nothing
    float fastest = 0.0f;
    std::uint32_t island = none;
    for (std::uint32_t p = m_batch.firstPlace;
         p < m_batch.endPlace && (island == none || fastest < enough); ++p) {
        const std::uint32_t body = m_plan.bodyOfPlace[p];
        if (m_world.activity[body] != movesNow) continue;
        island = m_plan.islandOf[body];
        fastest = maxOf(fastest, speedOf(body));
    }
    const EffortPlan now{m_batch.effort, 0, m_batch.gentle, m_batch.trees};
    IslandEffort seen;
    seen.fastest = fastest;
    seen.hit = m_hits;
    seen.strain = strain;
    const EffortRange range = rangeOf(island, seen);
    const EffortPlan next = planEffort(now, byCure(strain, now.trees, range.mayHaveTrees), range);
    m_world.islandEfforts[island].strain = strain;
    return next.packed() == now.packed() && next.calm == 0 && m_batch.ramp == 0;
}

bool BatchEffort::decide() {
    const RowStrain most = m_strains.most();
    m_hits = hitsAnything();
    if (stays(most)) return false;
    // Where every island is as calm as the one that is strained most, none needs a closer look.
    const float rows = maxOf(most.contacts, maxOf(most.swept, most.direct));
    const auto isCalmThere = [&](bool gentle) {  // whatever its islands are from now on
        const std::uint8_t highest = m_batch.large ? standardEffort : highestEffort;
        return isCalm(m_batch.effort, rows,
                      {.least = restingEffort, .most = highest, .gentle = gentle});
    };
    const bool alike = m_batch.giant || (m_batch.ramp == 0 && isCalmThere(false) &&
                                         isCalmThere(true) && isCalmTree(rows));
    gather(alike ? std::optional(most) : std::nullopt);
    if (m_hits) gatherHits();
    if (m_batch.recovers) gatherOverlap();
    const EffortPlan now{m_batch.effort, 0, m_batch.gentle, m_batch.trees, m_batch.recovers};
    bool changes = false, scales = false, still = true;
    overBodies([&](std::uint32_t body) {
        IslandEffort& island = m_world.islandEfforts[m_plan.islandOf[body]];
        if (m_plan.islandOf[body] == body) {
            const EffortRange range = rangeOf(body, island);
            const bool trees = now.trees && m_plan.jointsOf[body] > 0;
            RowStrain load = island.strain;
            // What a blow asks for is over before it could be given.
            if (island.hit) load = atMostOne(load);
            const IslandStrain strain = byCure(load, trees, range.mayHaveTrees);
            island.next = planEffort({now.level, island.calm, now.gentle, trees}, strain, range);
            island.next.recovers = now.recovers && island.overlaps;
            scales |= island.next.level != now.level;
            changes |= island.next.packed() != now.packed();
            still = still && island.next.packed() == now.packed() && island.next.calm == 0;
        }
        BodyMotion& motion = m_world.state.motions[body];
        motion.effort = island.next.packed();
        motion.calm = island.next.calm;
    });
    m_batch.still = still;
    if (m_batch.ramp > 0) --m_batch.ramp;
    if (scales) rescale();
    return changes;
}

bool BatchEffort::hitsAnything() const {
    for (std::uint32_t block = m_batch.firstBlock; block < m_batch.endBlock; ++block) {
        const ContactBlock& rows = m_rows.blocks[block];
        if (rows.mayHit != 0 && std::ranges::any_of(rows.hit, [](int h) { return h != 0; })) {
            return true;
        }
    }
    return false;
}

void BatchEffort::gatherHits() {
    for (std::uint32_t block = m_batch.firstBlock; block < m_batch.endBlock; ++block) {
        const ContactBlock& rows = m_rows.blocks[block];
        if (rows.mayHit == 0) continue;
        for (std::uint32_t i = 0; i < blockLanes; ++i) {
            if (rows.hit[i] != 0) islandOf(rows.bodyA[i], rows.bodyB[i]).hit = true;
        }
    }
}

/// Which islands still have a row that overlaps by more than it may.
void BatchEffort::gatherOverlap() {
    for (std::uint32_t block = m_batch.firstBlock; block < m_batch.endBlock; ++block) {
        const ContactBlock& rows = m_rows.blocks[block];
        for (std::uint32_t i = 0; i < blockLanes; ++i) {
            if (m_plan.contactOfLane[block * blockLanes + i] == none) continue;
            IslandEffort& island = islandOf(rows.bodyA[i], rows.bodyB[i]);
            const float allowed = visualOf(m_world, static_cast<std::uint32_t>(rows.motionA[i]),
                                           static_cast<std::uint32_t>(rows.motionB[i]));
            island.overlaps = island.overlaps || overlapOf(rows, i, m_rows.bodies) > allowed;
        }
    }
}

bool BatchEffort::decideRecovery() {
    if (!m_batch.recovers) return false;
    gather(RowStrain{});
    gatherOverlap();
    bool changes = false;
    overBodies([&](std::uint32_t body) {
        const bool overlaps = m_world.islandEfforts[m_plan.islandOf[body]].overlaps;
        EffortPlan next;
        next.recovers = overlaps;
        m_world.state.motions[body].effort = next.packed();
        changes = changes || !overlaps;
    });
    return changes;
}

}  // namespace

/// Whether bodies' efforts are of any use: planned substeps are a matter of such methods alone.
bool World::Data::recovers() const {
    return traitsOf(state.info().solver()).recovers;
}

void World::Data::planEfforts(Executor* executor) {
    if (!recovers()) return;
    const bool planned = state.info().planned();
    Plan& plan = accelerators.plan;
    islandEfforts.resize(state.bodies.size());
    std::vector<std::uint8_t> changes(plan.batches.size(), 0);
    overRange(executor, plan.batches.size(), 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            BatchEffort batch(*this, plan.batches[i]);
            changes[i] = planned ? batch.decide() : batch.decideRecovery();
        }
    });
    for (const std::uint8_t batch : changes) accelerators.linksStale |= batch != 0;
    if (!planned) return;
    reportTooStiff();
    // Who touches nothing starts anew where it lands.
    for (const std::uint32_t body : plan.freeBodies) {
        state.motions[body].effort = standardEffort;
        state.motions[body].calm = 0;
    }
}

}  // namespace huestep
