#include "protocol/wire/command_wire.h"

#include "protocol/codec.h"
#include "protocol/wire/scene_wire.h"

namespace huestep::protocol::wire {

namespace {

using Out = schema::Command::Action::Builder;
using From = schema::Command::Action::Reader;

void put(Out to, const AddPlayer& action) {
    to.initAddPlayer().setPlayer(action.player);
}
void put(Out to, const RemovePlayer& action) {
    to.initRemovePlayer().setPlayer(action.player);
}

void put(Out to, const ApplyImpulse& action) {
    auto apply = to.initApplyImpulse();
    apply.setBody(action.body);
    putPoint(apply.getImpulse(), action.impulse);
    putPoint(apply.getPoint(), action.point);
}

void put(Out to, const ApplyForce& action) {
    auto apply = to.initApplyForce();
    apply.setBody(action.body);
    putPoint(apply.getForce(), action.force);
    putPoint(apply.getPoint(), action.point);
}

void put(Out to, const Grab& action) {
    auto grab = to.initGrab();
    grab.setBody(action.body);
    putPoint(grab.getPoint(), action.point);
    putPoint(grab.getTarget(), action.target);
}

void put(Out to, const MoveGrab& action) {
    putPoint(to.initMoveGrab().getTarget(), action.target);
}

void put(Out to, const Release&) {
    to.setRelease();
}

void put(Out to, const Spawn& action) {
    auto spawn = to.initSpawn();
    if (!action.bodies.empty()) {
        auto bodies = spawn.initBodies(static_cast<unsigned>(action.bodies.size()));
        for (unsigned i = 0; i < bodies.size(); ++i) wire::put(bodies[i], action.bodies[i]);
    }
    if (!action.joints.empty()) {
        auto joints = spawn.initJoints(static_cast<unsigned>(action.joints.size()));
        for (unsigned i = 0; i < joints.size(); ++i) wire::put(joints[i], action.joints[i]);
    }
}

void put(Out to, const RemoveBody& action) {
    to.initRemoveBody().setBody(action.body);
}
void put(Out to, const RemoveJoint& action) {
    to.initRemoveJoint().setJoint(action.joint);
}

void put(Out to, const SetMotor& action) {
    auto motor = to.initSetMotor();
    motor.setJoint(action.joint);
    motor.setEnabled(action.enabled);
    motor.setSpeed(action.speed);
}

void put(Out to, const SetVelocity& action) {
    auto velocity = to.initSetVelocity();
    velocity.setBody(action.body);
    putPoint(velocity.getVelocity(), action.velocity);
    velocity.setAngularVelocity(action.angularVelocity);
}

void put(Out to, const SetTarget& action) {
    auto target = to.initSetTarget();
    target.setBody(action.body);
    putPoint(target.getPosition(), action.position);
    putRotation(target.getRotation(), action.rotation);
}

void put(Out to, const Custom& action) {
    auto custom = to.initCustom();
    custom.setKind(action.kind);
    custom.setId(action.id);
    custom.setNumber(action.number);
    putPoint(custom.getVector(), action.vector);
}

Action readApplyImpulse(Reading& in, schema::Command::Action::ApplyImpulse::Reader from) {
    return ApplyImpulse{from.getBody(), in.point("impulse", from.getImpulse()),
                        in.point("point", from.getPoint())};
}

Action readApplyForce(Reading& in, schema::Command::Action::ApplyForce::Reader from) {
    return ApplyForce{from.getBody(), in.point("force", from.getForce()),
                      in.point("point", from.getPoint())};
}

Action readGrab(Reading& in, schema::Command::Action::Grab::Reader from) {
    return Grab{from.getBody(), in.point("point", from.getPoint()),
                in.point("target", from.getTarget())};
}

Action readSpawn(Reading& in, schema::Spawn::Reader from) {
    Spawn spawn;
    spawn.bodies = readBodies(in, from.getBodies(), maxSpawnBodies);
    spawn.joints = readJoints(in, from.getJoints(), maxSpawnJoints);
    return spawn;
}

Action readSetVelocity(Reading& in, schema::Command::Action::SetVelocity::Reader from) {
    return SetVelocity{from.getBody(), in.point("velocity", from.getVelocity()),
                       in.real("angularVelocity", from.getAngularVelocity())};
}

Action readSetTarget(Reading& in, schema::Command::Action::SetTarget::Reader from) {
    return SetTarget{from.getBody(), in.point("position", from.getPosition()),
                     in.rotation("rotation", from.getRotation())};
}

Action readCustom(Reading& in, schema::Command::Action::Custom::Reader from) {
    return Custom{from.getKind(), from.getId(), from.getNumber(),
                  in.point("vector", from.getVector())};
}

Action readAction(Reading& in, From from) {
    using Which = schema::Command::Action::Which;
    switch (from.which()) {
        case Which::ADD_PLAYER:
            return AddPlayer{from.getAddPlayer().getPlayer()};
        case Which::REMOVE_PLAYER:
            return RemovePlayer{from.getRemovePlayer().getPlayer()};
        case Which::APPLY_IMPULSE:
            return in.at("applyImpulse",
                         [&] { return readApplyImpulse(in, from.getApplyImpulse()); });
        case Which::APPLY_FORCE:
            return in.at("applyForce", [&] { return readApplyForce(in, from.getApplyForce()); });
        case Which::GRAB:
            return in.at("grab", [&] { return readGrab(in, from.getGrab()); });
        case Which::MOVE_GRAB:
            return in.at("moveGrab", [&]() -> Action {
                return MoveGrab{in.point("target", from.getMoveGrab().getTarget())};
            });
        case Which::RELEASE:
            return Release{};
        case Which::SPAWN:
            return in.at("spawn", [&] { return readSpawn(in, from.getSpawn()); });
        case Which::REMOVE_BODY:
            return RemoveBody{from.getRemoveBody().getBody()};
        case Which::REMOVE_JOINT:
            return RemoveJoint{from.getRemoveJoint().getJoint()};
        case Which::SET_MOTOR:
            return in.at("setMotor", [&]() -> Action {
                const auto motor = from.getSetMotor();
                return SetMotor{motor.getJoint(), motor.getEnabled(),
                                in.real("speed", motor.getSpeed())};
            });
        case Which::SET_VELOCITY:
            return in.at("setVelocity", [&] { return readSetVelocity(in, from.getSetVelocity()); });
        case Which::SET_TARGET:
            return in.at("setTarget", [&] { return readSetTarget(in, from.getSetTarget()); });
        case Which::CUSTOM:
            return in.at("custom", [&] { return readCustom(in, from.getCustom()); });
    }
    in.refuse("unknown action " + std::to_string(static_cast<unsigned>(from.which())));
}

}  // namespace

std::size_t contentWords(const Command& command) {
    const auto* spawn = std::get_if<Spawn>(&command.action);
    if (spawn == nullptr) return 0;
    std::size_t words = structWords<schema::Spawn>() +
                        structListWords<schema::Body>(spawn->bodies.size()) +
                        structListWords<schema::Joint>(spawn->joints.size());
    for (const BodyDef& body : spawn->bodies) words += contentWords(body);
    return words;
}

void put(schema::Command::Builder to, const Command& command) {
    to.setAuthor(command.author);
    to.setSequence(command.sequence);
    std::visit([&](const auto& action) { put(to.getAction(), action); }, command.action);
}

Command readCommand(Reading& in, schema::Command::Reader from) {
    return {from.getAuthor(), from.getSequence(), readAction(in, from.getAction())};
}

}  // namespace huestep::protocol::wire
