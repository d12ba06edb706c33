/// Scenes of metrics that nobody would want to `run`; the others are built in.
#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace huestep::tools {

/// A dynamic body of one shape at a place.
BodyDef bodyOf(Vec2 position, const ShapeDef& shape);

/// Adds a body and returns its place.
std::uint32_t add(Scene& scene, BodyDef body);

/// A revolute joint of two bodies at a point of the world.
void hinge(Scene& scene, std::uint32_t bodyA, std::uint32_t bodyB, Vec2 point);

/// A scene without sleep; with a floor whose surface is y = 0, 100 m wide, if asked for.
Scene awake(bool floor);

/// A hundred discs and boxes without gravity, driven towards the middle and around it.
Scene kickedBodies();

/// Planks of 1 m × 0.25 m and 5 kg, hinged end to end and to both banks.
Scene bridge(int planks);

/// Unit boxes exactly upon each other on a floor.
Scene straightStack(int boxes);

/// A unit box that stands on a corner, leaning by 20 degrees, on a floor that it does not slip on.
Scene tippingBox();

/// A bar hinged at its middle, with a box on either end, the right one three times as heavy.
Scene seesaw();

/// Two discs of 0.4 m radius on arms of 2 m: one hangs still, one comes down on it from 45 degrees
/// and meets it without friction and with restitution 0.5.
Scene meetingPendulums();

/// Two discs of 0.5 m radius that meet head on without gravity, the right one three times as heavy.
Scene headOn(float restitution);

}  // namespace huestep::tools
