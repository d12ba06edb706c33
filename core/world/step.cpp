// One step. `World::Data::step` is the table of contents; each stage names what it reads and
// writes. Serial unless said; parallel stages write place i for index i alone.

#include <algorithm>

#include "core/parallel/over_range.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

constexpr std::uint32_t bodyGrain = 256;
constexpr float travelTicks = 2.0f;  // how far ahead fat bounds look

}  // namespace

void World::Data::step(std::span<const Command> commands, const StepResources& with) {
    ++stamp;
    events = {};
    report = {};
    forces.clear();
    StageTimer timer(with.clock, report);

    applyCommands(commands);  // state, commands, rules → bodies, shapes, joints
    timer.done(Stage::Commands);

    const PlanLimits limits = limitsOf(with.shareAll);
    accelerators.linksStale |= with.shareAll != accelerators.planSharesAll;
    accelerators.planSharesAll = with.shareAll;
    const bool small = state.shapes.size() + state.joints.size() < limits.parallelFrom;
    Executor* executor = small ? nullptr : with.executor;
    followDefinitions(executor);  // bodies, shapes, joints → what follows from them, places
    findPairs(executor);          // motions → bounds, candidate pairs by key
    timer.done(Stage::Pairs);

    collideAll(with.simd, executor);  // motions, hulls → manifolds, matched impulses
    timer.done(Stage::Collide);

    updatePlan(limits, executor);  // contacts, joints → islands, batches, colours
    timer.done(Stage::Colour);

    const SolverWorld world{state.bodies,
                            state.motions,
                            forces,
                            accelerators.shapes.kinematic,
                            accelerators.shapes.strides,
                            state.joints,
                            accelerators.shapes.jointBodies,
                            state.jointImpulses,
                            state.shapes,
                            accelerators.contacts,
                            accelerators.rowsHold,
                            state.info().gravity,
                            state.info().stepSeconds,
                            state.info().planned(),
                            {state.info().penetrationNeed, state.info().jointNeed},
                            accelerators.shapes.reach};
    Rows& rows = accelerators.rows;
    const Plan& plan = accelerators.plan;
    // Contacts, joints, motions → rows → impulses, hits; times are kept by stage within.
    solve(rows, plan, world, traitsOf(state.info().solver()), with.simd, executor, events.hits,
          timer);
    if (!accelerators.rowsHold) accelerators.rowStamps.assign(rows.blockCount(), stamp);
    for (const std::uint32_t contact : begun) accelerators.contacts[contact].began = 0;
    begun.clear();
    const Moved moved = finish(rows, plan, world, executor);  // rows → motions
    planEfforts(executor);  // rows → levels of effort, impulses that fit them
    for (const std::uint32_t body : moved.broken) {
        events.quarantined.push_back(state.bodies[body].id);
    }
    accelerators.rowsHold = true;
    timer.done(Stage::Finish);

    stopLeaps(moved, executor);  // fast bodies' motions, bounds, hulls → their motions
    timer.done(Stage::Continuous);

    settleIslands();  // motions, islands → sleep
    timer.done(Stage::Sleep);

    ++state.info().tick;
    contactsInState = false;
    if (rules != nullptr) afterRules();  // motions, events → the state of the rules
}

namespace {

/// Who takes part in this step.
std::uint8_t activityOf(const BodyInfo& info, const BodyMotion& motion) {
    switch (info.type()) {
        case BodyType::Dynamic:
            if (!motion.asleep()) return movesNow;
            return motion.rest == BodyMotion::asleepBit ? sleepsNow | newToSleep : sleepsNow;
        case BodyType::Kinematic:
            return motion.velocity == Vec2{} && motion.angularVelocity == 0.0f ? restsNow
                                                                               : drivesNow;
        case BodyType::Static:
            break;
    }
    return restsNow;
}

}  // namespace

PlanLimits World::Data::limitsOf(bool shareAll) const {
    if (!shareAll) return planLimits;
    return {.batchSize = 0, .hubDegree = planLimits.hubDegree, .sharedFrom = 1, .parallelFrom = 0};
}

void World::Data::findPairs(Executor* executor) {
    Accelerators& acc = accelerators;
    const Shapes& shapes = acc.shapes;
    const bool fresh = !acc.candidatesValid;  // nobody has looked yet
    acc.tight.resize(shapes.hulls.size());
    acc.travel.resize(shapes.hulls.size());

    // Bodies that may have moved since the last look: those that take part now or did last time.
    struct Findings {
        std::vector<std::uint32_t> left;  // shapes that have left their fat box
        bool anyAsleep = false;
        bool othersMove = false;
    };
    const float ahead = travelTicks * state.info().stepSeconds;
    auto findings = perBlock<Findings>(state.bodies.size(), bodyGrain);
    overRange(
        executor, state.bodies.size(), bodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
            Findings& mine = findings[begin / bodyGrain];
            for (std::uint32_t body = begin; body < end; ++body) {
                const BodyMotion& motion = state.motions[body];
                const std::uint8_t before = activity[body];
                const std::uint8_t now = activityOf(state.bodies[body], motion);
                activity[body] = now;
                mine.anyAsleep |= isAsleep(now);
                mine.othersMove |= (now == movesNow) != (before == movesNow);
                if (!isActive(before | now) && before != neverSeen) continue;
                for (std::uint32_t s = shapes.first[body]; s < shapes.first[body + 1]; ++s) {
                    if (shapes.proxies[s].alone) continue;
                    acc.tight[s] =
                        grown(boundsOf(shapes.hulls[s], motion.pose()), 0.5f * speculativeDistance);
                    acc.travel[s] = ahead * motion.velocity;
                    if (!acc.broadPhase.holds(s, acc.tight[s])) mine.left.push_back(s);
                }
            }
        });
    std::vector<std::uint32_t> left;
    anyAsleep = false;
    for (const Findings& f : findings) {
        left.insert(left.end(), f.left.begin(), f.left.end());
        anyAsleep |= f.anyAsleep;
        acc.linksStale |= f.othersMove;
    }
    const bool changed = acc.broadPhase.update(acc.tight, acc.travel, left, shapes.proxies,
                                               shapes.forbidden, executor);
    if (fresh || !left.empty()) acc.broadPhaseStamp = stamp;
    if (changed || fresh) layOutCandidates(executor);
}

/// Makes the plan again where contacts, joints or who moves have changed; otherwise plan and rows
/// stay, but for the rows of new manifolds.
void World::Data::updatePlan(const PlanLimits& limits, Executor* executor) {
    Accelerators& acc = accelerators;
    Plan& plan = acc.plan;
    if (acc.linksStale) {
        if (acc.rowsHold) fetchImpulses(Lanes::Kept, executor);
        acc.rowsHold = false;
        acc.linksStale = false;
        std::vector<Link> links;
        links.reserve(plan.links.size());
        const auto moves = [&](std::uint32_t body) { return activity[body] == movesNow; };
        for (std::uint32_t i = 0; i < acc.shapes.jointBodies.size(); ++i) {
            const ConstraintPlaces& j = acc.shapes.jointBodies[i];
            if (!moves(j.a) && !moves(j.b)) continue;
            links.push_back({j.a, j.b, i, state.joints[i].kind() == JointKind::Revolute});
        }
        const auto jointLinks = static_cast<std::uint32_t>(links.size());
        acc.inLanes.assign(acc.contacts.size(), 0);
        for (const Candidate& candidate : acc.candidates) {
            if (candidate.contact == none) continue;
            const std::uint32_t a = acc.shapes.proxies[candidate.pair.a].body;
            const std::uint32_t b = acc.shapes.proxies[candidate.pair.b].body;
            if (!moves(a) && !moves(b)) continue;
            links.push_back({a, b, candidate.contact});
            acc.inLanes[candidate.contact] = 1;
        }
        std::vector<std::uint32_t> awake;
        for (std::uint32_t body = 0; body < state.bodies.size(); ++body) {
            if (moves(body)) awake.push_back(body);
        }
        std::vector<std::uint8_t> efforts, ramps;
        std::uint32_t substeps = state.info().substeps;
        if (substeps == 0 && !state.info().planned()) substeps = substepsOf(standardEffort);
        if (recovers()) efforts = effortsNow();
        if (state.info().planned()) {
            ramps.reserve(state.motions.size());
            for (const BodyMotion& motion : state.motions) ramps.push_back(rampOf(motion.calm));
        }
        PlanDemand demand = demandOf(traitsOf(state.info().solver()), substeps);
        demand.efforts = efforts;
        demand.ramps = ramps;
        makePlan(plan, std::move(links), jointLinks, std::move(awake),
                 static_cast<std::uint32_t>(state.bodies.size()), limits, demand);
        acc.planStamp = stamp;
    } else {
        for (const std::uint32_t lane : acc.freshLanes) {
            acc.rowStamps[lane / blockLanes] = stamp;
            acc.rows.writeRow(lane, acc.contacts[plan.contactOfLane[lane]]);
        }
    }
    report.contacts = static_cast<std::uint32_t>(acc.contacts.size() - acc.freeContacts.size());
    report.awakeBodies = static_cast<std::uint32_t>(plan.awake.size());
    report.joints = plan.jointLinks;
    report.islands = plan.islands;
    report.batches = static_cast<std::uint32_t>(plan.batches.size());
    report.colours = plan.colours;
    report.overflow = plan.overflow;
    report.inBuckets = plan.inBuckets;
}

}  // namespace huestep
