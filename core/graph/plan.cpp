#include "core/graph/plan.h"

#include <algorithm>
#include <array>

#include "core/state/effort.h"

namespace huestep {

namespace {

/// Working memory of one call.
struct Builder {
    Plan& plan;
    PlanLimits limits;
    PlanDemand demand;

    std::vector<std::uint8_t> moves;         // by body: whether it is awake
    std::vector<std::uint32_t> batchOf;      // island representative → batch
    std::vector<std::uint8_t> effortOf;      // island representative → level
    std::vector<std::uint8_t> rampOfIsland;  // island representative → steps
    std::vector<std::uint32_t> batchOfLink;
    std::vector<std::uint32_t> linkOrder;  // links by batch, key order within
    std::vector<std::uint32_t> linkStart;  // batch → first in linkOrder
    std::vector<BodyPlace> placeOf;        // body → solver place, in the batch at hand

    [[nodiscard]] std::uint32_t islandOf(const Link& link) const {
        return plan.islandOf[moves[link.a] ? link.a : link.b];
    }

    void findAllIslands();
    void packBatches();
    void sortLinks();
    void placeBodies(std::uint32_t batch);
    void colourBatch(std::uint32_t batch);
    void layOut(std::uint32_t batch, std::span<const ConstraintBodies> places,
                std::span<const std::uint8_t> colours, std::span<const HubRun> hubs);
    void layOutHubs(std::uint32_t batch, std::uint8_t colour,
                    std::span<const ConstraintBodies> places, std::span<const HubRun> hubs);
};

void Builder::findAllIslands() {
    const auto count = static_cast<std::uint32_t>(moves.size());
    UnionFind sets;
    findIslands(plan.links, moves, sets);
    plan.islandOf.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) plan.islandOf[i] = sets.find(i);
    plan.constraintsOf.assign(count, 0);
    plan.jointsOf.assign(count, 0);
    plan.bodiesOf.assign(count, 0);
    for (const std::uint32_t body : plan.awake) ++plan.bodiesOf[plan.islandOf[body]];
    for (std::uint32_t i = 0; i < plan.links.size(); ++i) {
        const std::uint32_t island = islandOf(plan.links[i]);
        ++plan.constraintsOf[island];
        plan.jointsOf[island] += i < plan.jointLinks ? 1u : 0u;
    }
    effortOf.assign(count, 0);
    if (demand.efforts.empty()) return;
    rampOfIsland.assign(count, 0);
    for (const std::uint32_t body : plan.awake) {
        // The highest level of its bodies; it is gentle if they all are.
        std::uint8_t& island = effortOf[plan.islandOf[body]];
        const std::uint8_t effort = demand.efforts[body];
        if (plan.islandOf[body] == body) island = effort;
        const bool gentle = gentleAt(island) && gentleAt(effort);
        const bool trees = treesAt(island) || treesAt(effort);
        const bool recovers = recoversAt(island) || recoversAt(effort);
        const std::uint8_t level = std::max(levelOf(island), levelOf(effort));
        island = EffortPlan{level, 0, gentle, trees, recovers}.packed();
        std::uint8_t& ramp = rampOfIsland[plan.islandOf[body]];
        if (demand.substeps == 0) ramp = std::max(ramp, demand.ramps[body]);
    }
}

/// Islands in the order of their lowest body fill batches of their effort; one that is larger than
/// a batch gets one to itself. Sizes alone decide.
void Builder::packBatches() {
    batchOf.assign(plan.constraintsOf.size(), none);
    plan.batches.clear();
    plan.freeBodies.clear();
    plan.islands = 0;
    // By ramp, rest and level: the batch that small islands still go to.
    constexpr std::uint32_t levels = highestEffort + 1;
    std::array<std::uint32_t, (highestRamp + 1) * 16 * levels> openOf{};
    openOf.fill(none);
    for (const std::uint32_t body : plan.awake) {
        if (plan.islandOf[body] != body) continue;
        const std::uint32_t size = plan.constraintsOf[body];
        if (size == 0) {
            plan.freeBodies.push_back(body);
            continue;
        }
        ++plan.islands;
        const bool giant = size > limits.batchSize;
        const bool planned = demand.substeps == 0;
        const std::uint8_t effort =
            planned ? std::min(levelOf(effortOf[body]), affordableEffort(size)) : std::uint8_t{0};
        const bool gentle = planned && gentleAt(effortOf[body]);
        const std::uint8_t ramp = planned ? rampOfIsland[body] : std::uint8_t{0};
        const bool trees =
            demand.trees || (planned && mayHaveTrees(plan, body) && treesAt(effortOf[body]));
        const bool recovers = !(trees && plan.jointsOf[body] > 0) && size <= mostRecovering &&
                              recoversAt(effortOf[body]);
        const std::uint32_t kind = (gentle ? 1u : 0u) + (trees ? 2u : 0u) + (recovers ? 4u : 0u) +
                                   (isLarge(size) ? 8u : 0u);
        std::uint32_t& open = openOf[(ramp * 16u + kind) * levels + effort];
        if (giant || open == none || plan.batches[open].constraints + size > limits.batchSize) {
            const auto fresh = static_cast<std::uint32_t>(plan.batches.size());
            Batch batch;
            batch.giant = giant;
            batch.effort = effort;
            batch.ramp = ramp;
            batch.gentle = gentle;
            batch.substeps = planned ? substepsOf(effort) : demand.substeps;
            batch.trees = trees;
            batch.recovers = recovers;
            batch.large = isLarge(size);
            plan.batches.push_back(batch);
            batchOf[body] = fresh;
            if (!giant) open = fresh;
        } else {
            batchOf[body] = open;
        }
        plan.batches[batchOf[body]].constraints += size;
    }
}

void Builder::sortLinks() {
    linkStart.assign(plan.batches.size() + 1, 0);
    batchOfLink.resize(plan.links.size());
    for (std::size_t i = 0; i < plan.links.size(); ++i) {
        batchOfLink[i] = batchOf[islandOf(plan.links[i])];
        ++linkStart[batchOfLink[i] + 1];
    }
    for (std::size_t i = 1; i < linkStart.size(); ++i) linkStart[i] += linkStart[i - 1];
    std::vector<std::uint32_t> next(linkStart.begin(), linkStart.end() - 1);
    linkOrder.resize(plan.links.size());
    for (std::uint32_t i = 0; i < plan.links.size(); ++i) {
        linkOrder[next[batchOfLink[i]]++] = i;
    }
}

/// The batch's solver bodies: copies of the static and kinematic ones it touches, then its own.
/// (`plan.bodyOfPlace` holds the own bodies of all batches before; see makePlan.)
void Builder::placeBodies(std::uint32_t batch) {
    Batch& b = plan.batches[batch];
    b.firstPlace = static_cast<std::uint32_t>(plan.bodyOfPlace.size());
    const auto place = [&](std::uint32_t body) {
        placeOf[body] = static_cast<BodyPlace>(plan.bodyOfPlace.size());
        plan.bodyOfPlace.push_back(body);
    };
    for (std::uint32_t i = linkStart[batch]; i < linkStart[batch + 1]; ++i) {
        const Link& link = plan.links[linkOrder[i]];
        for (const std::uint32_t body : {link.a, link.b}) {
            if (moves[body]) continue;
            const BodyPlace known = placeOf[body];
            if (known == fixedWorld || static_cast<std::uint32_t>(known) < b.firstPlace) {
                place(body);
            }
        }
    }
}

void Builder::colourBatch(std::uint32_t batch) {
    const Batch& b = plan.batches[batch];
    std::vector<ConstraintBodies> places;
    std::vector<ConstraintBodies> local;  // counted from the batch's first body
    const auto first = static_cast<BodyPlace>(b.firstPlace);
    for (std::uint32_t i = linkStart[batch]; i < linkStart[batch + 1]; ++i) {
        const Link& link = plan.links[linkOrder[i]];
        const auto placeFor = [&](std::uint32_t body) -> BodyPlace {
            return moves[body] ? placeOf[body] : ~placeOf[body];
        };
        const ConstraintBodies c{placeFor(link.a), placeFor(link.b)};
        places.push_back(c);
        local.push_back({c.a >= 0 ? c.a - first : fixedWorld, c.b >= 0 ? c.b - first : fixedWorld});
    }
    // The batch's contacts come after its joints.
    const auto begin = linkOrder.begin() + linkStart[batch];
    const auto joints = static_cast<std::uint32_t>(
        std::lower_bound(begin, begin + static_cast<std::ptrdiff_t>(local.size()),
                         plan.jointLinks) -
        begin);
    std::vector<HubRun> hubs;
    std::vector<std::uint8_t> colours(local.size(), 0);
    if (!demand.colours) {
        for (std::size_t i = 0; i < local.size(); ++i) {
            const bool moving = local[i].a >= 0 && local[i].b >= 0;
            colours[i] = moving ? overflowColour : fixedOverflowColour;
        }
        layOut(batch, places, colours, hubs);
        return;
    }
    if (demand.hubs) {
        hubs = findHubs(std::span<const ConstraintBodies>(local).subspan(joints),
                        b.endPlace - b.firstPlace, limits.hubDegree);
    }
    for (HubRun& run : hubs) {
        run.hub += first;
        for (std::uint32_t& i : run.constraints) {
            i += joints;
            colours[i] = run.fixed ? fixedHubColour : hubColour;
        }
    }
    color(local, b.endPlace - b.firstPlace, colours);
    layOut(batch, places, colours, hubs);
}

/// Lanes of one kind of constraint: which constraint is in which, block by block of 16.
struct LaneList {
    std::vector<std::uint32_t>& sourceOf;
    std::vector<ConstraintBodies>& places;

    [[nodiscard]] std::uint32_t blocks() const {
        return static_cast<std::uint32_t>(sourceOf.size()) / blockLanes;
    }
    /// Adds whole blocks for `count` constraints; the rest of the last one is padding.
    void grow(std::uint32_t count) {
        const std::uint32_t lanes = blocksOf(count) * blockLanes;
        sourceOf.resize(sourceOf.size() + lanes, none);
        places.resize(sourceOf.size());
    }
};

/// Runs of the batch in solving order; within a colour joints come first, then joints in lanes,
/// then contacts, each in key order. The overflow is solved one by one in key order, so its joints
/// stay together. A hub has a run for each of `hubs`.
void Builder::layOut(std::uint32_t batch, std::span<const ConstraintBodies> places,
                     std::span<const std::uint8_t> colours, std::span<const HubRun> hubs) {
    enum Kind : std::uint8_t { Joint, RevoluteLane, ContactLane };
    const std::uint32_t begin = linkStart[batch];
    const auto kindOf = [&](std::uint32_t link, std::uint8_t colour) {
        if (link >= plan.jointLinks) return ContactLane;
        const bool lanes = (demand.pinLanes || !isSerial(colour)) && !plan.batches[batch].trees;
        return plan.links[link].revolute && lanes ? RevoluteLane : Joint;
    };
    std::array<std::array<std::uint32_t, 3>, colourCount> counts{};
    for (std::uint32_t i = 0; i < colours.size(); ++i) {
        const std::uint32_t link = linkOrder[begin + i];
        plan.colourOfLink[link] = colours[i];
        ++counts[colours[i]][kindOf(link, colours[i])];
    }
    LaneList contacts{plan.contactOfLane, plan.lanePlaces};
    LaneList revolutes{plan.revoluteOfLane, plan.revolutePlaces};
    Batch& b = plan.batches[batch];
    b.firstColour = static_cast<std::uint32_t>(plan.runs.size());
    b.firstBlock = contacts.blocks();
    b.firstRevoluteBlock = revolutes.blocks();
    b.firstJoint = static_cast<std::uint32_t>(plan.jointOrder.size());
    std::array<std::array<std::uint32_t, 3>, colourCount> next{};
    std::uint32_t used = 0;
    for (std::size_t c = 0; c < colourCount; ++c) {
        const auto& count = counts[c];
        if (count[Joint] + count[RevoluteLane] + count[ContactLane] == 0) continue;
        ++used;
        if (isHub(static_cast<std::uint8_t>(c))) {
            layOutHubs(batch, static_cast<std::uint8_t>(c), places, hubs);
            continue;
        }
        ColourRun run;
        run.colour = static_cast<std::uint8_t>(c);
        run.firstBlock = contacts.blocks();
        run.contactCount = count[ContactLane];
        run.firstJoint = static_cast<std::uint32_t>(plan.jointOrder.size());
        run.jointCount = count[Joint];
        run.firstRevoluteBlock = revolutes.blocks();
        run.revoluteCount = count[RevoluteLane];
        plan.runs.push_back(run);
        next[c] = {run.firstJoint, run.firstRevoluteBlock * blockLanes,
                   run.firstBlock * blockLanes};
        contacts.grow(count[ContactLane]);
        revolutes.grow(count[RevoluteLane]);
        plan.jointOrder.resize(plan.jointOrder.size() + count[Joint]);
        plan.jointPlaces.resize(plan.jointOrder.size());
        if (isSerial(run.colour)) {
            plan.overflow += count[Joint] + count[RevoluteLane] + count[ContactLane];
        }
    }
    b.endColour = static_cast<std::uint32_t>(plan.runs.size());
    b.endBlock = contacts.blocks();
    b.endRevoluteBlock = revolutes.blocks();
    b.endJoint = static_cast<std::uint32_t>(plan.jointOrder.size());
    plan.colours = std::max(plan.colours, used);
    for (std::uint32_t i = 0; i < colours.size(); ++i) {
        if (isHub(colours[i])) continue;
        const std::uint32_t link = linkOrder[begin + i];
        const Kind kind = kindOf(link, colours[i]);
        const std::uint32_t at = next[colours[i]][kind]++;
        const std::uint32_t source = plan.links[link].source;
        if (kind == Joint) {
            plan.jointOrder[at] = source;
            plan.jointPlaces[at] = places[i];
        } else {
            const LaneList& lanes = kind == RevoluteLane ? revolutes : contacts;
            lanes.sourceOf[at] = source;
            lanes.places[at] = places[i];
        }
        std::vector<std::uint8_t>& touched = kind == ContactLane ? plan.hasContact : plan.hasJoint;
        for (const BodyPlace place : {places[i].a, places[i].b}) {
            touched[static_cast<std::size_t>(readPlace(place))] = 1;
        }
    }
    // A copy starts warm as its hub does.
    for (std::uint32_t r = b.firstColour; r < b.endColour; ++r) {
        const ColourRun& run = plan.runs[r];
        if (!isHub(run.colour)) continue;
        std::fill_n(plan.hasJoint.begin() + run.firstCopy, blockLanes, plan.hasJoint[run.hub]);
    }
}

/// The runs of hubs of one of the two colours: every lane's hub is a copy.
void Builder::layOutHubs(std::uint32_t batch, std::uint8_t colour,
                         std::span<const ConstraintBodies> places, std::span<const HubRun> hubs) {
    LaneList contacts{plan.contactOfLane, plan.lanePlaces};
    std::uint32_t hub = 0, firstCopy = 0;
    for (const HubRun& of : hubs) {
        if (of.fixed != (colour == fixedHubColour)) continue;
        if (static_cast<std::uint32_t>(of.hub) != hub) {
            hub = static_cast<std::uint32_t>(of.hub);
            firstCopy = static_cast<std::uint32_t>(plan.bodyOfPlace.size());
            plan.bodyOfPlace.insert(plan.bodyOfPlace.end(), blockLanes, plan.bodyOfPlace[hub]);
            plan.isCopy.resize(plan.bodyOfPlace.size(), 1);
            plan.hasContact.resize(plan.bodyOfPlace.size(), 1);
            plan.hasJoint.resize(plan.bodyOfPlace.size(), 0);
            plan.hasContact[hub] = 1;
        }
        ColourRun run;
        run.colour = colour;
        run.firstBlock = contacts.blocks();
        run.contactCount = static_cast<std::uint32_t>(of.constraints.size());
        run.firstJoint = static_cast<std::uint32_t>(plan.jointOrder.size());
        run.firstRevoluteBlock =
            static_cast<std::uint32_t>(plan.revoluteOfLane.size()) / blockLanes;
        run.hub = hub;
        run.firstCopy = firstCopy;
        plan.runs.push_back(run);
        plan.inBuckets += run.contactCount;
        contacts.grow(run.contactCount);
        for (std::uint32_t k = 0; k < run.contactCount; ++k) {
            const std::uint32_t i = of.constraints[k];
            const auto copy = static_cast<BodyPlace>(firstCopy + k % blockLanes);
            const std::uint32_t lane = run.firstBlock * blockLanes + k;
            ConstraintBodies c = places[i];
            (c.a == of.hub ? c.a : c.b) = copy;
            contacts.sourceOf[lane] = plan.links[linkOrder[linkStart[batch] + i]].source;
            contacts.places[lane] = c;
            const BodyPlace other = c.a == copy ? c.b : c.a;
            plan.hasContact[static_cast<std::size_t>(readPlace(other))] = 1;
        }
    }
}

}  // namespace

void makePlan(Plan& plan, std::vector<Link>&& links, std::uint32_t jointLinks,
              std::vector<std::uint32_t>&& awake, std::uint32_t bodyCount, PlanLimits limits,
              PlanDemand demand) {
    plan.links = std::move(links);
    plan.jointLinks = jointLinks;
    plan.awake = std::move(awake);
    plan.runs.clear();
    plan.contactOfLane.clear();
    plan.lanePlaces.clear();
    plan.jointOrder.clear();
    plan.jointPlaces.clear();
    plan.revoluteOfLane.clear();
    plan.revolutePlaces.clear();
    plan.colourOfLink.assign(plan.links.size(), 0);
    plan.colours = plan.overflow = plan.inBuckets = 0;
    plan.sharedFrom = limits.sharedFrom;

    Builder builder{plan, limits, demand, {}, {}, {}, {}, {}, {}, {}, {}};
    builder.moves.assign(bodyCount, 0);
    for (const std::uint32_t body : plan.awake) builder.moves[body] = 1;
    builder.findAllIslands();
    builder.packBatches();
    builder.sortLinks();
    builder.placeOf.assign(bodyCount, fixedWorld);
    plan.bodyOfPlace.assign(1, none);
    plan.isCopy.assign(1, 0);
    plan.hasContact.assign(1, 0);
    plan.hasJoint.assign(1, 0);

    // Own bodies of every batch, by id: one walk over the awake bodies into buckets.
    std::vector<std::vector<std::uint32_t>> own(plan.batches.size());
    for (const std::uint32_t body : plan.awake) {
        const std::uint32_t batch = builder.batchOf[plan.islandOf[body]];
        if (batch != none) own[batch].push_back(body);
    }
    for (std::uint32_t batch = 0; batch < plan.batches.size(); ++batch) {
        builder.placeBodies(batch);
        for (const std::uint32_t body : own[batch]) {
            builder.placeOf[body] = static_cast<BodyPlace>(plan.bodyOfPlace.size());
            plan.bodyOfPlace.push_back(body);
        }
        plan.batches[batch].endPlace = static_cast<std::uint32_t>(plan.bodyOfPlace.size());
        plan.isCopy.resize(plan.bodyOfPlace.size(), 0);
        plan.hasContact.resize(plan.bodyOfPlace.size(), 0);
        plan.hasJoint.resize(plan.bodyOfPlace.size(), 0);
        builder.colourBatch(batch);
        plan.batches[batch].endCopy = static_cast<std::uint32_t>(plan.bodyOfPlace.size());
    }
    plan.incidence = {};
    if (demand.incidence) {
        plan.incidence = incidenceOf(plan.jointPlaces, plan.revolutePlaces, plan.lanePlaces,
                                     static_cast<std::uint32_t>(plan.bodyOfPlace.size()));
    }
}

}  // namespace huestep
