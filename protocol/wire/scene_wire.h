/// Bodies, joints and scenes to Cap'n Proto and back. Reading refuses what is not finite, unknown
/// or more than core's caps; core's `check` judges the rest.
#pragma once

#include "core/scene/scene.h"
#include "protocol/scene.capnp.h"
#include "protocol/wire/reading.h"

namespace huestep::protocol::wire {

/// Words of what the struct points to, itself aside.
std::size_t contentWords(const BodyDef& body);
std::size_t contentWords(const Scene& scene);

void put(schema::Body::Builder to, const BodyDef& body);
void put(schema::Joint::Builder to, const JointDef& joint);
void put(schema::Scene::Builder to, const Scene& scene);

BodyDef readBody(Reading& in, schema::Body::Reader from);
JointDef readJoint(Reading& in, schema::Joint::Reader from);
Scene readScene(Reading& in, schema::Scene::Reader from);

/// The lists of a scene or a spawn.
std::vector<BodyDef> readBodies(Reading& in, ::capnp::List<schema::Body>::Reader from,
                                std::size_t most);
std::vector<JointDef> readJoints(Reading& in, ::capnp::List<schema::Joint>::Reader from,
                                 std::size_t most);

template <class Builder>
void putPoint(Builder to, Vec2 point) {
    to.setX(point.x);
    to.setY(point.y);
}
template <class Builder>
void putRotation(Builder to, Rotation rotation) {
    to.setC(rotation.c);
    to.setS(rotation.s);
}

}  // namespace huestep::protocol::wire
