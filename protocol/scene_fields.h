/// The one list of a scene's fields by which scene files are read and written as JSON. Names and
/// nesting are those of scene.capnp; a test compares the two.
///
/// A visitor gets `field(name, member)` for what may be left out, its default then taken from
/// core/scene/scene.h, and `required(name, member)` for what must stand in the file.
#pragma once

#include <array>
#include <string_view>
#include <type_traits>

#include "core/scene/scene.h"

namespace huestep::protocol {

/// Words of enumerants, in the order of their numbers.
template <class Enum>
inline constexpr auto wordsOf = nullptr;
template <>
inline constexpr auto wordsOf<ShapeKind> =
    std::to_array<std::string_view>({"circle", "capsule", "polygon", "segment", "chainSegment"});
template <>
inline constexpr auto wordsOf<BodyType> = std::to_array<std::string_view>({"static", "kinematic",
                                                                           "dynamic"});
template <>
inline constexpr auto wordsOf<JointKind> =
    std::to_array<std::string_view>({"revolute", "distance", "mouse", "weld", "prismatic"});

template <>
inline constexpr auto wordsOf<Method> =
    std::to_array<std::string_view>({"softStep", "sequential", "jacobi", "jacobiSplit", "pgs",
                                     "pgsNgs", "locks", "atomics", "avbd", "direct"});

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<Vec2>) {
    v.required("x", &Vec2::x);
    v.required("y", &Vec2::y);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<Rotation>) {
    v.required("c", &Rotation::c);
    v.required("s", &Rotation::s);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<Material>) {
    v.field("friction", &Material::friction);
    v.field("restitution", &Material::restitution);
    v.field("rollingResistance", &Material::rollingResistance);
    v.field("tangentSpeed", &Material::tangentSpeed);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<Filter>) {
    v.field("category", &Filter::category);
    v.field("mask", &Filter::mask);
    v.field("group", &Filter::group);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<ShapeDef>) {
    v.required("kind", &ShapeDef::kind);
    v.vertices("vertices");  // of fixed room, so unlike any other list
    v.field("radius", &ShapeDef::radius);
    v.field("density", &ShapeDef::density);
    v.field("material", &ShapeDef::material);
    v.field("filter", &ShapeDef::filter);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<BodyDef>) {
    v.field("id", &BodyDef::id);
    v.field("firstShape", &BodyDef::firstShape);
    v.field("type", &BodyDef::type);
    v.field("fixedRotation", &BodyDef::fixedRotation);
    v.field("maySleep", &BodyDef::maySleep);
    v.field("asleep", &BodyDef::asleep);
    v.field("position", &BodyDef::position);
    v.field("rotation", &BodyDef::rotation);
    v.field("velocity", &BodyDef::velocity);
    v.field("angularVelocity", &BodyDef::angularVelocity);
    v.field("linearDamping", &BodyDef::linearDamping);
    v.field("angularDamping", &BodyDef::angularDamping);
    v.field("gravityScale", &BodyDef::gravityScale);
    v.field("shapes", &BodyDef::shapes);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<SpringDef>) {
    v.field("enabled", &SpringDef::enabled);
    v.field("hertz", &SpringDef::hertz);
    v.field("dampingRatio", &SpringDef::dampingRatio);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<LimitDef>) {
    v.field("enabled", &LimitDef::enabled);
    v.field("lower", &LimitDef::lower);
    v.field("upper", &LimitDef::upper);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<MotorDef>) {
    v.field("enabled", &MotorDef::enabled);
    v.field("speed", &MotorDef::speed);
    v.field("maxEffort", &MotorDef::maxEffort);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<JointDef>) {
    v.field("id", &JointDef::id);
    v.required("kind", &JointDef::kind);
    v.field("collideConnected", &JointDef::collideConnected);
    v.required("bodyA", &JointDef::bodyA);
    v.required("bodyB", &JointDef::bodyB);
    v.field("anchorA", &JointDef::anchorA);
    v.field("anchorB", &JointDef::anchorB);
    v.field("reference", &JointDef::reference);
    v.field("axis", &JointDef::axis);
    v.field("length", &JointDef::length);
    v.field("target", &JointDef::target);
    v.field("maxForce", &JointDef::maxForce);
    v.field("spring", &JointDef::spring);
    v.field("limit", &JointDef::limit);
    v.field("motor", &JointDef::motor);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<PlayerDef>) {
    v.field("body", &PlayerDef::body);
    v.field("spawnPoints", &PlayerDef::spawnPoints);
    v.field("maxSpawned", &PlayerDef::maxSpawned);
    v.field("maxImpulse", &PlayerDef::maxImpulse);
    v.field("maxForce", &PlayerDef::maxForce);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<WorldLimits>) {
    v.field("bodies", &WorldLimits::bodies);
    v.field("shapes", &WorldLimits::shapes);
    v.field("joints", &WorldLimits::joints);
    v.field("commandsPerTick", &WorldLimits::commandsPerTick);
    v.field("players", &WorldLimits::players);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<Counters>) {
    v.field("nextBody", &Counters::nextBody);
    v.field("nextShape", &Counters::nextShape);
    v.field("nextJoint", &Counters::nextJoint);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<Need>) {
    v.field("penetration", &Need::penetration);
    v.field("joint", &Need::joint);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<RulesParameter>) {
    v.required("name", &RulesParameter::name);
    v.required("value", &RulesParameter::value);
}

template <class Visitor>
void visitFields(Visitor& v, std::type_identity<RulesDef>) {
    v.required("name", &RulesDef::name);
    v.field("version", &RulesDef::version);
    v.field("seed", &RulesDef::seed);
    v.field("parameters", &RulesDef::parameters);
}

/// After the version, which every file starts with.
template <class Visitor>
void visitFields(Visitor& v, std::type_identity<Scene>) {
    v.field("name", &Scene::name);
    v.field("gravity", &Scene::gravity);
    v.field("stepSeconds", &Scene::stepSeconds);
    v.field("substeps", &Scene::substeps);
    v.field("sleep", &Scene::sleep);
    v.field("bodies", &Scene::bodies);
    v.field("joints", &Scene::joints);
    v.field("players", &Scene::players);
    v.field("limits", &Scene::limits);
    v.field("counters", &Scene::counters);
    v.field("method", &Scene::method);
    v.field("need", &Scene::need);
    v.field("rules", &Scene::rules);
}

}  // namespace huestep::protocol
