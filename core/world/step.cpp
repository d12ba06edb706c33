// One step. `World::Data::step` is the table of contents; each stage names what it reads and
// writes. Serial unless said; parallel stages write place i for index i alone.

#include <algorithm>

#include "core/parallel/over_range.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

// A scene of fewer shapes and joints is stepped by the caller alone: waking a second thread and
// meeting it at barriers costs more than it saves. Definitions alone decide.
constexpr std::size_t parallelFrom = 512;
constexpr std::uint32_t shapeGrain = 512;
constexpr float travelTicks = 2.0f;  // how far ahead fat bounds look

}  // namespace

void World::Data::step(std::span<const Command> commands, const StepResources& with) {
    events = {};
    report = {};
    forces.clear();
    StageTimer timer(with.clock, report);

    applyCommands(commands);  // state, commands → bodies, shapes, joints
    timer.done(Stage::Commands);

    if (accelerators.definitionsStale) rebuildShapes();
    const bool small = state.shapes.size() + state.joints.size() < parallelFrom;
    Executor* executor = small ? nullptr : with.executor;
    findPairs(executor);  // motions → bounds, candidate pairs by key
    timer.done(Stage::Pairs);

    collideAll(executor);  // motions, hulls → manifolds, matched impulses
    timer.done(Stage::Collide);

    updatePlan();  // contacts, joints → islands, batches, colours
    timer.done(Stage::Colour);

    const SolverWorld world{state.bodies,
                            state.motions,
                            forces,
                            accelerators.shapes.kinematic,
                            state.joints,
                            accelerators.shapes.jointBodies,
                            state.jointImpulses,
                            accelerators.contacts,
                            accelerators.rowsHold
                                ? std::span<const std::uint8_t>(accelerators.recycled)
                                : std::span<const std::uint8_t>(),
                            state.info().gravity,
                            state.info().stepSeconds,
                            state.info().substeps};
    SoftStep& solver = accelerators.solver;
    const Plan& plan = accelerators.plan;
    // Contacts, joints, motions → rows → impulses, hits; times are kept by stage within.
    solver.solve(plan, world, with.simd, executor, events.hits, timer);
    std::vector<std::uint32_t> broken;
    solver.finish(plan, world, executor, broken);  // rows → motions
    for (const std::uint32_t body : broken) events.quarantined.push_back(state.bodies[body].id);
    accelerators.rowsHold = true;
    timer.done(Stage::Finish);

    settleIslands();  // motions, islands → sleep
    timer.done(Stage::Sleep);

    ++state.info().tick;
    contactsInState = false;
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

void World::Data::findPairs(Executor* executor) {
    Accelerators& acc = accelerators;
    const Shapes& shapes = acc.shapes;
    const bool fresh = acc.tight.size() != shapes.hulls.size();
    acc.tight.resize(shapes.hulls.size());
    acc.travel.resize(shapes.hulls.size());
    activity.resize(state.bodies.size());
    anyAsleep = false;

    // Bodies that may have moved since the last look: those that take part now or did last time.
    std::vector<std::uint32_t> bodies = std::move(acc.lastActive);
    acc.lastActive.clear();
    if (fresh) bodies.clear();
    std::vector<std::uint8_t> known(state.bodies.size(), 0);
    for (const std::uint32_t body : bodies) known[body] = 1;
    for (std::uint32_t body = 0; body < state.bodies.size(); ++body) {
        activity[body] = activityOf(state.bodies[body], state.motions[body]);
        anyAsleep = anyAsleep || isAsleep(activity[body]);
        if (isActive(activity[body])) acc.lastActive.push_back(body);
        if (fresh || (isActive(activity[body]) && !known[body])) bodies.push_back(body);
    }
    std::sort(bodies.begin(), bodies.end());

    std::vector<std::uint32_t> active;
    for (const std::uint32_t body : bodies) {
        for (std::uint32_t s = shapes.first[body]; s < shapes.first[body + 1]; ++s) {
            if (!shapes.proxies[s].alone) active.push_back(s);
        }
    }
    const float ahead = travelTicks * state.info().stepSeconds;
    overRange(executor, active.size(), shapeGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t s = active[i];
            const BodyMotion& motion = state.motions[shapes.proxies[s].body];
            acc.tight[s] =
                grown(boundsOf(shapes.hulls[s], motion.pose()), 0.5f * speculativeDistance);
            acc.travel[s] = ahead * motion.velocity;
        }
    });
    const bool changed = acc.broadPhase.update(acc.tight, acc.travel, active, shapes.proxies,
                                               shapes.forbidden, executor);
    if (changed || fresh) layOutContacts();
}

void World::Data::updatePlan() {
    Accelerators& acc = accelerators;
    std::vector<Link> links;
    links.reserve(acc.plan.links.size());
    const auto moves = [&](std::uint32_t body) { return activity[body] == movesNow; };
    for (std::uint32_t i = 0; i < acc.shapes.jointBodies.size(); ++i) {
        const ConstraintPlaces& j = acc.shapes.jointBodies[i];
        if (!moves(j.a) && !moves(j.b)) continue;
        links.push_back({j.a, j.b, i, isPin(state.joints[i], state.jointImpulses[i])});
    }
    const auto jointLinks = static_cast<std::uint32_t>(links.size());
    for (std::uint32_t i = 0; i < acc.contacts.size(); ++i) {
        const Contact& c = acc.contacts[i];
        if (c.pointCount == 0) continue;
        ++report.contacts;
        if (moves(c.bodyA) || moves(c.bodyB)) links.push_back({c.bodyA, c.bodyB, i});
    }
    std::vector<std::uint32_t> awake;
    for (std::uint32_t body = 0; body < state.bodies.size(); ++body) {
        if (moves(body)) awake.push_back(body);
    }
    Plan& plan = acc.plan;
    if (!acc.planValid || jointLinks != plan.jointLinks || links != plan.links ||
        awake != plan.awake) {
        makePlan(plan, std::move(links), jointLinks, std::move(awake),
                 static_cast<std::uint32_t>(state.bodies.size()));
        acc.planValid = true;
        acc.rowsHold = false;
    }
    report.awakeBodies = static_cast<std::uint32_t>(plan.awake.size());
    report.joints = jointLinks;
    report.islands = plan.islands;
    report.batches = static_cast<std::uint32_t>(plan.batches.size());
    report.colours = plan.colours;
    report.overflow = plan.overflow;
}

}  // namespace huestep
