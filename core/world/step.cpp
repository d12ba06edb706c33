// One step. `World::Data::step` is the table of contents; each stage names what it reads and
// writes. Serial unless said; parallel stages write place i for index i alone.

#include <algorithm>

#include "core/parallel/over_range.h"
#include "core/solver/contact_kernels.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

// Below this many candidate pairs and joints a scene is stepped by the caller alone: waking a
// second thread and meeting it at barriers costs more than it saves. A function of the scene.
constexpr std::size_t parallelFrom = 1024;
constexpr std::uint32_t contactGrain = 256;
constexpr std::uint32_t shapeGrain = 512;
constexpr float travelTicks = 4.0f;  // how far ahead fat bounds look

// Sleep: an island whose bodies have all been slower than this for half a second.
constexpr float sleepSpeed = 0.05f;  // m/s, of any point of the body
constexpr float sleepSeconds = 0.5f;

bool keyBefore(const ContactChange& a, const ContactChange& b) {
    return a.shapeA != b.shapeA ? a.shapeA < b.shapeA : a.shapeB < b.shapeB;
}

}  // namespace

void World::Data::step(std::span<const Command> commands, const StepResources& with) {
    events = {};
    report = {};
    forces.clear();
    StageTimer timer(with.clock, report);

    applyCommands(commands);  // state, commands → bodies, shapes, joints
    timer.done(Stage::Commands);

    if (accelerators.definitionsStale) rebuildShapes();
    Executor* executor = with.executor;
    findPairs(executor);  // motions → bounds, candidate pairs by key
    if (accelerators.contacts.size() + state.joints.size() < parallelFrom) executor = nullptr;
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
                            state.info().gravity,
                            state.info().stepSeconds,
                            state.info().substeps};
    SoftStep& solver = accelerators.solver;
    const Plan& plan = accelerators.plan;
    // Contacts, joints, motions → rows → impulses, hits; times are kept by stage within.
    solver.solve(plan, world, contactKernels(with.simd), executor, events.hits, timer);
    std::vector<std::uint32_t> broken;
    solver.finish(plan, world, executor, broken);  // rows → motions
    for (const std::uint32_t body : broken) events.quarantined.push_back(state.bodies[body].id);
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
            return motion.asleep() ? sleepsNow : movesNow;
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
        anyAsleep = anyAsleep || activity[body] == sleepsNow;
        if (isActive(activity[body])) acc.lastActive.push_back(body);
        if (fresh || (isActive(activity[body]) && !known[body])) bodies.push_back(body);
    }
    std::sort(bodies.begin(), bodies.end());

    std::vector<std::uint32_t> active;
    for (const std::uint32_t body : bodies) {
        for (std::uint32_t s = shapes.first[body]; s < shapes.first[body + 1]; ++s) {
            active.push_back(s);
        }
    }
    const float ahead = travelTicks * state.info().stepSeconds;
    overRange(active.size() < parallelFrom ? nullptr : executor, active.size(), shapeGrain,
              [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::uint32_t i = begin; i < end; ++i) {
                      const std::uint32_t s = active[i];
                      const BodyMotion& motion = state.motions[shapes.proxies[s].body];
                      acc.tight[s] = grown(boundsOf(shapes.hulls[s], motion.pose()),
                                           0.5f * speculativeDistance);
                      acc.travel[s] = ahead * motion.velocity;
                  }
              });
    const bool changed = acc.broadPhase.update(acc.tight, acc.travel, active, shapes.proxies,
                                               shapes.forbidden, executor);
    if (changed || fresh) layOutContacts();
}

namespace {

/// What of a contact follows from its two shapes.
Contact contactOf(const ShapePair& pair, const Shapes& known, std::span<const ShapeInfo> shapes) {
    const ShapeInfo& a = shapes[pair.a];
    const ShapeInfo& b = shapes[pair.b];
    Contact c{};
    c.state.shapeA = a.id;
    c.state.shapeB = b.id;
    c.placeA = pair.a;
    c.placeB = pair.b;
    c.bodyA = known.proxies[pair.a].body;
    c.bodyB = known.proxies[pair.b].body;
    c.reach = maxOf(known.reach[c.bodyA], known.reach[c.bodyB]);
    c.roundness = maxOf(a.radius, b.radius);
    c.friction = std::sqrt(a.friction * b.friction);
    c.restitution = maxOf(a.restitution, b.restitution);
    c.rollingResistance = maxOf(a.rollingResistance, b.rollingResistance) * c.roundness;
    c.tangentSpeed = a.tangentSpeed + b.tangentSpeed;
    return c;
}

}  // namespace

/// Brings the contacts in line with the pairs: old ones keep their place in key order with all they
/// hold, new ones begin apart, and those whose pair is gone end.
void World::Data::layOutContacts() {
    Accelerators& acc = accelerators;
    const Shapes& shapes = acc.shapes;
    std::vector<Contact> old = std::move(acc.contacts);
    if (!acc.contactsValid) {
        // After a restore or a change of definitions the contacts are in the state alone.
        for (const ContactState& c : state.contacts) {
            const auto placeOf = [&](ShapeId id) {
                return static_cast<std::uint32_t>(
                    std::lower_bound(state.shapes.begin(), state.shapes.end(), id,
                                     [](const ShapeInfo& s, ShapeId k) { return s.id < k; }) -
                    state.shapes.begin());
            };
            Contact contact =
                contactOf({placeOf(c.shapeA), placeOf(c.shapeB)}, shapes, state.shapes);
            contact.state = c;
            contact.pointCount = 2;  // until the manifold is made again
            remakeManifold(contact, narrowPhaseInput());
            old.push_back(contact);
        }
        acc.contactsValid = true;
    }
    acc.contacts.clear();
    acc.contacts.reserve(acc.broadPhase.pairs().size());
    auto from = old.begin();
    const auto dropBefore = [&](const ShapePair* pair) {
        for (; from != old.end() && (!pair || ShapePair{from->placeA, from->placeB} < *pair);
             ++from) {
            if (from->pointCount == 0) continue;
            // A contact at rest stays as it is, whatever the bounds say: nobody looks at it.
            if (!isActive(activity[from->bodyA] | activity[from->bodyB])) {
                acc.contacts.push_back(*from);
            } else {
                events.ends.push_back({from->state.shapeA, from->state.shapeB});
            }
        }
    };
    for (const ShapePair& pair : acc.broadPhase.pairs()) {
        dropBefore(&pair);
        if (from != old.end() && ShapePair{from->placeA, from->placeB} == pair) {
            acc.contacts.push_back(*from++);
        } else {
            acc.contacts.push_back(contactOf(pair, shapes, state.shapes));
        }
    }
    dropBefore(nullptr);
}

void World::Data::collideAll(Executor* executor) {
    const NarrowPhaseInput in = narrowPhaseInput();
    const std::size_t count = accelerators.contacts.size();
    // What one block of contacts found: how many, which began or ended, and whether any sleeper is
    // touched by what is awake.
    struct Findings {
        std::uint32_t pairs = 0, recycled = 0;
        std::vector<std::uint32_t> changed;
        bool disturbs = false;
    };
    std::vector<std::uint8_t> looked(anyAsleep ? count : 0, 0);
    bool woke = false;
    do {
        auto findings = perBlock<Findings>(count, contactGrain);
        overRange(executor, count, contactGrain, [&](std::uint32_t begin, std::uint32_t end) {
            Findings& mine = findings[begin / contactGrain];
            for (std::uint32_t i = begin; i < end; ++i) {
                Contact& contact = accelerators.contacts[i];
                const auto both =
                    static_cast<std::uint8_t>(activity[contact.bodyA] | activity[contact.bodyB]);
                if (!isActive(both)) continue;
                if (anyAsleep) {
                    if (looked[i]) continue;
                    looked[i] = 1;
                }
                const bool touched = contact.pointCount > 0;
                const ContactUpdate update = updateContact(contact, in);
                const bool touching = contact.pointCount > 0;
                mine.pairs += update != ContactUpdate::Apart;
                mine.recycled += update == ContactUpdate::Recycled;
                if (touched != touching) mine.changed.push_back(i);
                mine.disturbs |= touching && (both & sleepsNow) != 0;
            }
        });
        bool disturbs = false;
        for (const Findings& f : findings) {
            report.pairs += f.pairs;
            report.recycled += f.recycled;
            disturbs |= f.disturbs;
            for (const std::uint32_t i : f.changed) {
                const Contact& contact = accelerators.contacts[i];
                (contact.pointCount > 0 ? events.begins : events.ends)
                    .push_back({contact.state.shapeA, contact.state.shapeB});
            }
        }
        woke = anyAsleep && wakeTouched(disturbs);
    } while (woke);
    std::sort(events.begins.begin(), events.begins.end(), keyBefore);
    std::sort(events.ends.begin(), events.ends.end(), keyBefore);
}

/// Wakes every sleeping island that something active touches (a contact has been found that does,
/// if `contactDisturbs`) or is jointed to. Returns whether any body woke: its contacts have to be
/// looked at then.
bool World::Data::wakeTouched(bool contactDisturbs) {
    const Shapes& shapes = accelerators.shapes;
    const auto disturbs = [&](std::uint32_t a, std::uint32_t b) {
        return (isActive(activity[a]) && activity[b] == sleepsNow) ||
               (isActive(activity[b]) && activity[a] == sleepsNow);
    };
    bool any = contactDisturbs;
    for (const ConstraintPlaces& j : shapes.jointBodies) any = any || disturbs(j.a, j.b);
    if (!any) return false;

    // Rare, so from scratch: islands of all dynamic bodies, asleep or not.
    std::vector<std::uint8_t> dynamic(state.bodies.size());
    for (std::size_t i = 0; i < dynamic.size(); ++i) dynamic[i] = state.bodies[i].dynamic();
    std::vector<Link> links;
    for (const ConstraintPlaces& j : shapes.jointBodies) links.push_back({j.a, j.b, 0});
    for (const Contact& c : accelerators.contacts) {
        if (c.pointCount > 0) links.push_back({c.bodyA, c.bodyB, 0});
    }
    UnionFind sets;
    findIslands(links, dynamic, sets);
    std::vector<std::uint8_t> wakes(state.bodies.size(), 0);
    for (const Link& link : links) {
        if (!disturbs(link.a, link.b)) continue;
        for (const std::uint32_t body : {link.a, link.b}) {
            if (dynamic[body]) wakes[sets.find(body)] = 1;
        }
    }
    bool woke = false;
    for (std::uint32_t body = 0; body < dynamic.size(); ++body) {
        if (activity[body] != sleepsNow || !wakes[sets.find(body)]) continue;
        wake(body);
        activity[body] = movesNow;
        accelerators.lastActive.push_back(body);
        woke = true;
    }
    return woke;
}

void World::Data::updatePlan() {
    Accelerators& acc = accelerators;
    std::vector<Link> links;
    links.reserve(acc.plan.links.size());
    const auto moves = [&](std::uint32_t body) { return activity[body] == movesNow; };
    for (std::uint32_t i = 0; i < acc.shapes.jointBodies.size(); ++i) {
        const ConstraintPlaces& j = acc.shapes.jointBodies[i];
        if (moves(j.a) || moves(j.b)) links.push_back({j.a, j.b, i});
    }
    const auto jointLinks = static_cast<std::uint32_t>(links.size());
    for (std::uint32_t i = 0; i < acc.contacts.size(); ++i) {
        const Contact& c = acc.contacts[i];
        if (c.pointCount == 0) continue;
        ++report.contacts;
        if (moves(c.bodyA) || moves(c.bodyB)) links.push_back({c.bodyA, c.bodyB, i});
    }
    std::vector<std::uint32_t> awake;
    std::vector<std::uint8_t> moving(state.bodies.size(), 0);
    for (std::uint32_t body = 0; body < state.bodies.size(); ++body) {
        if (!moves(body)) continue;
        moving[body] = 1;
        awake.push_back(body);
    }
    Plan& plan = acc.plan;
    if (!acc.planValid || jointLinks != plan.jointLinks || links != plan.links ||
        awake != plan.awake) {
        std::vector<std::uint8_t> kinematic(state.bodies.size(), 0);
        for (const std::uint32_t body : acc.shapes.kinematic) kinematic[body] = 1;
        makePlan(plan, std::move(links), jointLinks, std::move(awake), {moving, kinematic});
        acc.planValid = true;
    }
    report.awakeBodies = static_cast<std::uint32_t>(plan.awake.size());
    report.joints = jointLinks;
    report.islands = plan.islands;
    report.batches = static_cast<std::uint32_t>(plan.batches.size());
    report.colours = plan.colours;
    report.overflow = plan.overflow;
}

/// Counts quiet ticks and puts islands to sleep whose every body has been quiet long enough.
void World::Data::settleIslands() {
    if ((state.info().flags & WorldInfo::sleep) == 0) return;
    const Plan& plan = accelerators.plan;
    const auto ticks = static_cast<std::uint32_t>(sleepSeconds / state.info().stepSeconds + 0.5f);
    // What a moving kinematic body touches is not at rest, however slow it is.
    std::vector<std::uint8_t> driven(state.bodies.size(), 0);
    for (const Link& link : plan.links) {
        if (activity[link.a] == drivesNow) driven[link.b] = 1;
        if (activity[link.b] == drivesNow) driven[link.a] = 1;
    }
    std::vector<std::uint32_t> fewest(state.bodies.size(), ~0u);  // by island
    for (const std::uint32_t body : plan.awake) {
        BodyMotion& motion = state.motions[body];
        const float spin = motion.angularVelocity * accelerators.shapes.reach[body];
        const bool quiet = lengthSquared(motion.velocity) + spin * spin < sleepSpeed * sleepSpeed;
        const bool may = (state.bodies[body].flags & BodyInfo::maySleep) != 0 && !driven[body];
        motion.rest = quiet && may ? std::min(motion.rest + 1, ticks) : 0;
        std::uint32_t& island = fewest[plan.islandOf[body]];
        island = std::min(island, motion.rest);
    }
    for (const std::uint32_t body : plan.awake) {
        if (fewest[plan.islandOf[body]] < ticks) continue;
        BodyMotion& motion = state.motions[body];
        motion.rest = ticks | BodyMotion::asleepBit;
        motion.velocity = {};
        motion.angularVelocity = 0.0f;
    }
}

}  // namespace huestep
