/// A scene as a `b2World` of Box2D 2.4, and back.
///
/// What both have is carried over exactly: bodies with damping, gravity scale and sleep, circles,
/// polygons without radius, segments (as two-sided edges), chain segments (as one-sided edges,
/// whose fronts are to the right there too), friction, restitution, filters of 16 bits; revolute
/// and prismatic joints with limit and motor, distance joints with spring and range, welds, mouse
/// joints. The rest is approximated or left out, and said in `notes`, one sentence for each kind of
/// loss:
///  - a polygon's rounded corners are made sharp: its edges are moved out by the radius;
///  - a capsule is two circles and a box; such bodies get the mass of the exact shapes;
///  - rolling resistance, tangent speed, springs of revolute and prismatic joints and motors of
///    distance joints are left out.
/// Box2D keeps polygons apart by a skin of 1 cm each; it stays on, as its users have it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/box2d/notes.h"
#include "core/result.h"
#include "core/scene/engine.h"
#include "core/scene/scene.h"
#include "core/world/command.h"

class b2World;
class b2Body;
class b2Joint;

namespace huestep {

/// Owns the world; the pointers belong to it. Thread rule: see core/box2d/engine.h.
struct B2World {
    B2World();
    B2World(B2World&&) noexcept;
    B2World& operator=(B2World&&) noexcept;
    ~B2World();

    std::unique_ptr<b2World> world;
    std::vector<b2Body*> bodies;     ///< place i: body i of the scene by ascending id
    std::vector<b2Joint*> joints;    ///< place i: joint i of the scene, in the scene's order
    std::vector<std::string> notes;  ///< sentences about what was left out or approximated
};

/// The scene must have passed `check`. Fails, with a path, for polygons that Box2D's hull would
/// weld or flatten (vertices within 2.5 mm, area under 1e-6 m²), for filters beyond 16 bits, and
/// for dynamic bodies whose shapes lie so far from the origin that Box2D, which takes the moment of
/// inertia about the origin in float first, is left with none about the centre of mass (a disc of
/// radius r at more than about 1000 r).
Result<B2World> makeB2World(const Scene& scene, const BuildOrder& order = {});

/// What a spawn added: bodies and joints place by place.
struct B2Spawned {
    std::vector<b2Body*> bodies;
    std::vector<b2Joint*> joints;
};

/// Adds what a spawn says to a world. Fails as `makeB2World` does, and leaves part of it behind.
Result<B2Spawned> spawnInB2World(b2World& world, const Spawn& spawn, Notes& notes);

/// A scene with what a `b2World` holds now, bodies and joints in the order of their creation.
struct B2Import {
    Scene scene;
    std::vector<std::string> notes;  ///< as above
};

/// Chains become chain segments; a static body that only mouse joints hold on to is none; sensors,
/// bullets' extra care and joints of other kinds are left out and noted. Masses are those of the
/// shapes: a body whose mass was set by hand is noted. Fails with the sentence of `check` where the
/// result is no valid scene, as for a body without mass.
Result<B2Import> sceneOfB2World(const b2World& world, float stepSeconds = 1.0f / 60.0f);

}  // namespace huestep
