// Bodies, shapes and joints have come or gone: what is derived from them follows.
//
// What is derived of a body that stays is kept, under its new place. Places stay in order when
// gaps close, so lists that are sorted by place stay sorted; newcomers come behind all others. Made
// from nothing instead, as after a restore, the derived data is the same but for the boxes of the
// broad phase and the places of contacts in their pool, which no result depends on.

#include <algorithm>
#include <cassert>
#include <iterator>

#include "core/parallel/over_range.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

constexpr std::uint32_t contactGrain = 2048;

/// Old place → new one, or `none`.
std::vector<std::uint32_t> placesAfter(std::span<const std::uint32_t> kept, std::size_t before) {
    std::vector<std::uint32_t> place(before, none);
    for (std::uint32_t i = 0; i < kept.size() && kept[i] < before; ++i) place[kept[i]] = i;
    return place;
}

}  // namespace

/// Brings the derived data in line with what the commands of this step did to the definitions, or
/// makes it from nothing where there is none.
void World::Data::followDefinitions(Executor* executor) {
    if (accelerators.definitionsStale) {
        assert(contactsInState);
        accelerators = {};
        accelerators.definitionsStale = false;
        completeShapes();
        activity.assign(state.bodies.size(), neverSeen);
    } else if (edited) {
        carryOver(executor);
    } else {
        return;
    }
    accelerators.shapesStamp = stamp;
    edited = false;
    kept = {};
}

/// What of the accelerators belongs to bodies that stay goes to their new places. Contacts keep
/// their manifolds, so nobody reads them from the state again.
void World::Data::carryOver(Executor* executor) {
    Accelerators& acc = accelerators;
    Shapes& shapes = acc.shapes;
    if (acc.rowsHold) fetchImpulses(Lanes::All, executor);
    contactsInState = false;
    acc.rowsHold = false;
    acc.linksStale = true;
    acc.inLanes.assign(acc.contacts.size(), 0);
    acc.broadPhaseStamp = acc.candidatesStamp = stamp;
    std::vector<std::uint32_t> bodyPlace, shapePlace;  // empty: as before
    if (!kept.all) {
        bodyPlace = placesAfter(kept.bodies, shapes.reach.size());
        shapePlace = placesAfter(kept.shapes, shapes.hulls.size());
        renumberAccelerators(bodyPlace, shapePlace, executor);
    }
    const std::vector<ShapeProxy> proxies = shapes.proxies;
    const std::vector<ShapePair> forbidden = shapes.forbidden;
    completeShapes();
    activity.resize(state.bodies.size(), neverSeen);
    // Whether a shape is alone follows from the filters of all others.
    const bool sameAlone =
        std::equal(proxies.begin(), proxies.end(), shapes.proxies.begin(),
                   [](const ShapeProxy& p, const ShapeProxy& q) { return p.alone == q.alone; });
    if (sameAlone) {
        acc.broadPhase.renumber(shapePlace, shapes.proxies);
        lookAgainAtFreed(forbidden);
    } else {
        acc.broadPhase.clear();
        activity.assign(state.bodies.size(), neverSeen);
    }
}

/// Bodies between which joints forbade contact before, and do no longer, are paired anew. None
/// forbids what was allowed: joints come with their bodies.
void World::Data::lookAgainAtFreed(std::span<const ShapePair> forbidden) {
    Accelerators& acc = accelerators;
    const Shapes& shapes = acc.shapes;
    std::vector<ShapePair> freed;
    std::set_difference(forbidden.begin(), forbidden.end(), shapes.forbidden.begin(),
                        shapes.forbidden.end(), std::back_inserter(freed));
    for (const ShapePair& bodies : freed) {
        for (const std::uint32_t body : {bodies.a, bodies.b}) {
            activity[body] = neverSeen;
            for (std::uint32_t s = shapes.first[body]; s < shapes.first[body + 1]; ++s) {
                acc.broadPhase.letGo(s);
            }
        }
    }
}

/// Drops what belongs to bodies that are gone, and gives the others their new places.
void World::Data::renumberAccelerators(std::span<const std::uint32_t> bodyPlace,
                                       std::span<const std::uint32_t> shapePlace,
                                       Executor* executor) {
    Accelerators& acc = accelerators;
    Shapes& shapes = acc.shapes;
    keep(shapes.hulls, kept.shapes);
    keep(shapes.sizes, kept.shapes);
    keep(shapes.thickness, kept.shapes);
    keep(shapes.proxies, kept.shapes);
    keep(acc.tight, kept.shapes);
    keep(acc.travel, kept.shapes);
    keep(shapes.strides, kept.bodies);
    keep(shapes.reach, kept.bodies);
    keep(activity, kept.bodies);
    keep(shapes.jointBodies, kept.joints);
    for (ShapeProxy& proxy : shapes.proxies) proxy.body = bodyPlace[proxy.body];
    for (ConstraintPlaces& j : shapes.jointBodies) j = {bodyPlace[j.a], bodyPlace[j.b]};
    renumberPairs(shapes.forbidden, bodyPlace);
    const auto move = [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t place = begin; place < end; ++place) {
            Contact& c = acc.contacts[place];
            if (c.pointCount == 0) continue;
            acc.contactStamps[place] = stamp;
            c.bodyA = bodyPlace[c.bodyA];
            c.bodyB = bodyPlace[c.bodyB];
            c.placeA = shapePlace[c.placeA];
            c.placeB = shapePlace[c.placeB];
        }
    };
    overRange(executor, acc.contacts.size(), contactGrain, move);
    auto to = acc.candidates.begin();
    for (const Candidate& candidate : acc.candidates) {
        const ShapePair pair{shapePlace[candidate.pair.a], shapePlace[candidate.pair.b]};
        if (pair.a != none && pair.b != none) *to++ = {pair, candidate.contact};
    }
    acc.candidates.erase(to, acc.candidates.end());
}

}  // namespace huestep
