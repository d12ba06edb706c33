/// Islands as a walk over a world's contacts and joints finds them: from what anybody may ask of a
/// world, sharing no code with core/graph.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "tests/core/support.h"

namespace huestep::test {

/// What hangs together: bodies that can be pushed, and what is between them and anything.
struct Walk {
    struct Island {
        BodyId lowest = 0;
        std::vector<std::uint32_t> bodies;  ///< places
        std::uint32_t contacts = 0;
        std::uint32_t joints = 0;
        bool touchesFixed = false;  ///< a static or kinematic body is at one of its links
    };
    std::vector<Island> islands;          ///< by lowest body, those of one body included
    std::vector<std::uint32_t> islandOf;  ///< body → place in `islands`; `nowhere`: not dynamic
    std::vector<std::uint32_t> movingOf;  ///< body → links to bodies that can be pushed
    std::vector<std::uint32_t> fixedOf;   ///< body → links to others
    static constexpr std::uint32_t nowhere = 0xffffffffu;
};

inline Walk walkOver(const World& world) {
    struct Between {
        std::uint32_t a, b;
        bool joint;
    };
    std::map<ShapeId, BodyId> bodyOf;
    for (const ShapeInfo& shape : world.shapes()) bodyOf[shape.id] = shape.body;
    std::vector<Between> links;
    for (const JointInfo& joint : world.joints())
        links.push_back({*world.find(joint.bodyA), *world.find(joint.bodyB), true});
    for (const ContactState& contact : world.contacts())
        links.push_back({*world.find(bodyOf.at(contact.shapeA)),
                         *world.find(bodyOf.at(contact.shapeB)), false});

    const std::size_t count = world.bodies().size();
    Walk walk;
    walk.islandOf.assign(count, Walk::nowhere);
    walk.movingOf.assign(count, 0);
    walk.fixedOf.assign(count, 0);
    std::vector<std::vector<std::uint32_t>> next(count);
    for (const Between& link : links) {
        const bool both = world.bodies()[link.a].dynamic() && world.bodies()[link.b].dynamic();
        for (const std::uint32_t body : {link.a, link.b})
            ++(both ? walk.movingOf : walk.fixedOf)[body];
        if (!both) continue;
        next[link.a].push_back(link.b);
        next[link.b].push_back(link.a);
    }
    for (std::uint32_t start = 0; start < count; ++start) {
        if (!world.bodies()[start].dynamic() || walk.islandOf[start] != Walk::nowhere) continue;
        const auto at = static_cast<std::uint32_t>(walk.islands.size());
        Walk::Island& island = walk.islands.emplace_back();
        island.lowest = world.bodies()[start].id;
        island.bodies.push_back(start);
        walk.islandOf[start] = at;
        for (std::size_t i = 0; i < island.bodies.size(); ++i) {
            for (const std::uint32_t body : next[island.bodies[i]]) {
                if (walk.islandOf[body] != Walk::nowhere) continue;
                walk.islandOf[body] = at;
                island.bodies.push_back(body);
            }
        }
    }
    for (const Between& link : links) {
        const bool first = walk.islandOf[link.a] != Walk::nowhere;
        const std::uint32_t at = walk.islandOf[first ? link.a : link.b];
        if (at == Walk::nowhere) continue;
        ++(link.joint ? walk.islands[at].joints : walk.islands[at].contacts);
        walk.islands[at].touchesFixed |= !first || walk.islandOf[link.b] == Walk::nowhere;
    }
    return walk;
}

}  // namespace huestep::test
