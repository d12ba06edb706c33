/// The builders behind the catalog, and the few verbs they are written with. Internal to
/// core/scene: everyone else asks `sceneFromCatalog`.
///
/// Each builder takes the values of its catalog entry's parameters, in order and within range.
#pragma once

#include <cstdint>
#include <span>

#include "core/scene/catalog.h"
#include "core/scene/scene.h"
#include "core/world/command.h"

namespace huestep::scenes {

using Values = std::span<const double>;

// Benchmarks, as the performance page sets them up.
Scene pyramid(Values values);
Scene manyPyramids(Values values);
Scene jointGrid(Values values);
Scene tumbler(Values values);
Scene spinner(Values values);
Scene smash(Values values);
Scene compounds(Values values);
Scene washer(Values values);
Scene junkyard(Values values);
Scene rain(Values values);

// What their hosts do, as `Script::Rule`.
void junkyardHost(Values values, std::uint64_t tick, std::vector<Action>& actions);
void rainHost(Values values, std::uint64_t tick, std::vector<Action>& actions);
Scene small(Values values);

// Accuracy: closed forms or reference solutions are known.
Scene ballistic(Values values);
Scene pendulum(Values values);
Scene doublePendulum(Values values);
Scene chain(Values values);
Scene stack(Values values);
Scene arm(Values values);
Scene bounce(Values values);
Scene ramp(Values values);
Scene slide(Values values);

// Stability: scenes that solvers fall over (physics page, "Stability suite").
Scene arch(Values values);
Scene ballAndChain(Values values);
Scene bigBox(Values values);
Scene bridge(Values values);
Scene bullet(Values values);
Scene cardHouse(Values values);
Scene confined(Values values);
Scene dominoes(Values values);
Scene droppedStack(Values values);
Scene heavyPyramids(Values values);
Scene heavyTop(Values values);
Scene hub(Values values);
Scene overlap(Values values);
Scene release(Values values);
Scene stretchedChain(Values values);
Scene tower(Values values);
Scene whirlingRod(Values values);
void dominoesHost(Values values, std::uint64_t tick, std::vector<Action>& actions);
void hubHost(Values values, std::uint64_t tick, std::vector<Action>& actions);
void releaseHost(Values values, std::uint64_t tick, std::vector<Action>& actions);
/// Their entries, in any order.
std::vector<CatalogEntry> stabilityCatalog();

// Everything at once.
Scene hinges(Values values);
Scene joints(Values values);
Scene mixed(Values values);
Scene sandbox(Values values);
Scene terrain(Values values);

// By the rules of a game (core/games).
Scene ball(Values values);
Scene building(Values values);

/// An empty scene in which nothing sleeps, so that what rests does so by itself.
Scene awake();

/// Adds a thick floor whose surface is y = 0.
void addFloor(Scene& scene, float halfWidth, float friction = 0.6f);

/// Adds a body and returns its place.
std::uint32_t add(Scene& scene, const BodyDef& body);

/// A body of one shape.
BodyDef bodyOf(BodyType type, Vec2 position, const ShapeDef& shape);

/// Adds static bodies at the origin that hold the shapes, `staticShapes` to a body: fewer than it
/// may have, as how many bodies there are is part of every result.
inline constexpr std::size_t staticShapes = 256;
void addStatic(Scene& scene, std::span<const ShapeDef> shapes);

/// Boxes, a metre each and a little longer so that no gap is between them, that make a floor from
/// −`halfWidth` to `halfWidth` at y = 0 and a wall of `height` boxes upon either end.
void addTrough(std::vector<ShapeDef>& shapes, std::uint32_t halfWidth, std::uint32_t height);

/// A revolute joint of two bodies of the scene about a point of the world; its coordinate is 0 as
/// the bodies stand, and their shapes do not touch each other.
JointDef hingeAt(const Scene& scene, std::uint32_t bodyA, std::uint32_t bodyB, Vec2 point);

/// A weld of two bodies at a point of the world, as they stand.
JointDef weldAt(const Scene& scene, std::uint32_t bodyA, std::uint32_t bodyB, Vec2 point);

/// A prismatic joint through a point of the world along a direction of the world, which needs no
/// unit length; its coordinate is 0 as the bodies stand.
JointDef slideAt(const Scene& scene, std::uint32_t bodyA, std::uint32_t bodyB, Vec2 point,
                 Vec2 along);

/// A distance joint between the points `localA` and `localB`, as long as the bodies stand apart.
JointDef rodBetween(const Scene& scene, std::uint32_t bodyA, Vec2 localA, std::uint32_t bodyB,
                    Vec2 localB);

/// A regular polygon of `sides` corners on a circle of `circumradius`.
ShapeDef regularPolygon(int sides, float circumradius, float radius = 0.0f);

/// Raises the scene's limits where it holds more than the standard ones allow.
void fitLimits(Scene& scene);

/// Small differences between bodies from a fixed sequence: 64-bit linear congruential generator
/// (Knuth's MMIX constants), upper bits only.
class Sequence {
 public:
    explicit Sequence(std::uint64_t seed) : m_state(seed) {}
    /// In [low, high).
    float between(float low, float high) {
        m_state = m_state * 6364136223846793005u + 1442695040888963407u;
        const float unit = static_cast<float>(m_state >> 40) * (1.0f / 16777216.0f);
        return low + (high - low) * unit;
    }

 private:
    std::uint64_t m_state;
};

/// A parameter that counts something.
inline std::uint32_t count(double value) {
    return static_cast<std::uint32_t>(value);
}

}  // namespace huestep::scenes
