#include "protocol/wire/command_wire.h"
#include "protocol/wire/message_wire.h"
#include "protocol/wire/scene_wire.h"

namespace huestep::protocol::wire {

namespace {

::kj::StringPtr textOf(const std::string& text) {
    return {text.c_str(), text.size()};
}

template <class Byte>
::capnp::Data::Reader dataOf(const Byte* bytes, std::size_t size) {
    static_assert(sizeof(Byte) == 1);
    return {reinterpret_cast<const ::kj::byte*>(bytes), size};
}

std::size_t contentWords(const std::vector<Command>& commands) {
    std::size_t words = structListWords<schema::Command>(commands.size());
    for (const Command& command : commands) words += wire::contentWords(command);
    return words;
}

template <class Root>
void putCommands(Root to, const std::vector<Command>& commands) {
    if (commands.empty()) return;
    auto list = to.initCommands(static_cast<unsigned>(commands.size()));
    for (unsigned i = 0; i < list.size(); ++i) wire::put(list[i], commands[i]);
}

std::size_t vertexFloats(const View& view) {
    std::size_t floats = 0;
    for (const View::Shape& shape : view.shapes) floats += 2 * shape.vertices.size();
    return floats;
}

void putDefinitions(schema::View::Builder to, const View& view) {
    if (!view.bodies.empty()) {
        auto bodies = to.initBodies(static_cast<unsigned>(view.bodies.size()));
        for (unsigned i = 0; i < bodies.size(); ++i) bodies.set(i, view.bodies[i]);
    }
    if (view.shapes.empty()) return;
    auto shapes = to.initShapes(static_cast<unsigned>(view.shapes.size()));
    auto vertices = to.initVertices(static_cast<unsigned>(vertexFloats(view)));
    unsigned at = 0;
    for (unsigned i = 0; i < shapes.size(); ++i) {
        const View::Shape& shape = view.shapes[i];
        shapes[i].setBody(shape.body);
        shapes[i].setRadius(shape.radius);
        shapes[i].setKind(static_cast<schema::ShapeKind>(shape.kind));
        shapes[i].setVertexCount(static_cast<std::uint8_t>(shape.vertices.size()));
        for (const Vec2& vertex : shape.vertices) {
            vertices.set(at++, vertex.x);
            vertices.set(at++, vertex.y);
        }
    }
}

}  // namespace

std::size_t contentWords(const Hello& message) {
    return textWords(message.session) + (message.resume ? byteWords(message.resume->size()) : 0) +
           byteWords(message.ticket.size()) + message.rules.size();
}
std::size_t contentWords(const Welcome& message) {
    return textWords(message.session) + byteWords(message.resume.size());
}
std::size_t contentWords(const Intent& message) {
    return contentWords(message.commands);
}
std::size_t contentWords(const Frame& message) {
    return contentWords(message.commands) + byteWords(4 * message.substituted.size());
}
std::size_t contentWords(const SnapshotChunk& message) {
    return byteWords(message.data.size());
}
std::size_t contentWords(const HashNodes& message) {
    return message.leaves.size();
}
std::size_t contentWords(const DesyncReport& message) {
    return textWords(message.field) + textWords(message.here) + textWords(message.there);
}
std::size_t contentWords(const Bye& message) {
    return textWords(message.text);
}
std::size_t contentWords(const View& message) {
    return 2 * message.poses.size() + byteWords(message.flags.size()) +
           structListWords<schema::View::Contact>(message.contacts.size()) +
           byteWords(4 * message.bodies.size()) + 2 * message.joints.size() +
           structListWords<schema::View::Shape>(message.shapes.size()) +
           byteWords(4 * vertexFloats(message)) + textWords(message.score);
}

void put(schema::Hello::Builder to, const Hello& message) {
    to.setVersion(message.version);
    auto fingerprint = to.getFingerprint();
    fingerprint.setSelfTest(message.fingerprint.selfTest);
    fingerprint.setSchema(message.fingerprint.schema);
    fingerprint.setScene(message.fingerprint.scene);
    if (!message.session.empty()) to.setSession(textOf(message.session));
    to.setRole(static_cast<schema::Role>(message.role));
    if (message.resume) to.setResume(dataOf(message.resume->data(), message.resume->size()));
    to.setHaveTick(message.haveTick);
    to.setHaveHash(message.haveHash);
    if (!message.ticket.empty()) to.setTicket(dataOf(message.ticket.data(), message.ticket.size()));
    if (message.rules.empty()) return;
    auto rules = to.initRules(static_cast<unsigned>(message.rules.size()));
    for (unsigned i = 0; i < rules.size(); ++i) rules.set(i, message.rules[i]);
}

void put(schema::Welcome::Builder to, const Welcome& message) {
    if (!message.session.empty()) to.setSession(textOf(message.session));
    to.setPlayer(message.player);
    to.setEpoch(message.epoch);
    to.setTick(message.tick);
    to.setTicksPerSecond(message.ticksPerSecond);
    to.setInputDelay(message.inputDelay);
    to.setMaxCommandsPerIntent(message.maxCommandsPerIntent);
    to.setLastSequence(message.lastSequence);
    to.setMaxQueuedCommands(message.maxQueuedCommands);
    to.setMaxQueuedBytes(message.maxQueuedBytes);
    to.setMaxInputDelay(message.maxInputDelay);
    to.setResume(dataOf(message.resume.data(), message.resume.size()));
}

void put(schema::Intent::Builder to, const Intent& message) {
    putCommands(to, message.commands);
    to.setTick(message.tick);
    if (!message.checkpoint) return;
    auto some = to.getCheckpoint().initSome();
    some.setTick(message.checkpoint->tick);
    some.setMotionRoot(message.checkpoint->motionRoot);
}

void put(schema::Frame::Builder to, const Frame& message) {
    to.setTick(message.tick);
    putCommands(to, message.commands);
    if (!message.substituted.empty()) {
        auto list = to.initSubstituted(static_cast<unsigned>(message.substituted.size()));
        for (unsigned i = 0; i < list.size(); ++i) list.set(i, message.substituted[i]);
    }
    to.setPreviousRoot(message.previousRoot);
    to.setCommitted(message.committed);
}

void put(schema::SnapshotBegin::Builder to, const SnapshotBegin& message) {
    to.setTick(message.tick);
    to.setBytes(message.bytes);
    to.setHash(message.hash);
}

void put(schema::SnapshotChunk::Builder to, const SnapshotChunk& message) {
    to.setOffset(message.offset);
    if (!message.data.empty()) to.setData(dataOf(message.data.data(), message.data.size()));
}

void put(schema::SnapshotEnd::Builder to, const SnapshotEnd& message) {
    to.setTick(message.tick);
}

void put(schema::SnapshotRequest::Builder to, const SnapshotRequest& message) {
    to.setTick(message.tick);
}

void put(schema::HashQuery::Builder to, const HashQuery& message) {
    to.setTick(message.tick);
}

void put(schema::HashNodes::Builder to, const HashNodes& message) {
    to.setTick(message.tick);
    if (!message.leaves.empty()) {
        auto list = to.initLeaves(static_cast<unsigned>(message.leaves.size()));
        for (unsigned i = 0; i < list.size(); ++i) list.set(i, message.leaves[i]);
    }
    to.setFirst(message.first);
}

void put(schema::DesyncReport::Builder to, const DesyncReport& message) {
    to.setTick(message.tick);
    to.setMine(message.mine);
    to.setYours(message.yours);
    to.setBody(message.body);
    if (!message.field.empty()) to.setField(textOf(message.field));
    if (!message.here.empty()) to.setHere(textOf(message.here));
    if (!message.there.empty()) to.setThere(textOf(message.there));
}

void put(schema::Ping::Builder to, const Ping& message) {
    to.setNonce(message.nonce);
    to.setReply(message.reply);
    to.setTick(message.tick);
    to.setSinceClose(message.sinceClose);
}

void put(schema::Bye::Builder to, const Bye& message) {
    to.setReason(static_cast<std::uint16_t>(message.reason));
    if (!message.text.empty()) to.setText(textOf(message.text));
    to.setMayResume(message.mayResume);
}

void put(schema::View::Builder to, const View& message) {
    to.setTick(message.tick);
    to.setRoot(message.root);
    to.setPlayers(message.players);
    to.setDefinitions(message.definitions);
    if (!message.poses.empty()) {
        auto poses = to.initPoses(static_cast<unsigned>(4 * message.poses.size()));
        unsigned at = 0;
        for (const Pose& pose : message.poses) {
            poses.set(at++, pose.p.x);
            poses.set(at++, pose.p.y);
            poses.set(at++, pose.q.c);
            poses.set(at++, pose.q.s);
        }
    }
    if (!message.flags.empty()) to.setFlags(dataOf(message.flags.data(), message.flags.size()));
    if (!message.contacts.empty()) {
        auto contacts = to.initContacts(static_cast<unsigned>(message.contacts.size()));
        for (unsigned i = 0; i < contacts.size(); ++i) {
            putPoint(contacts[i], message.contacts[i].point);
            contacts[i].setColour(message.contacts[i].colour);
        }
    }
    putDefinitions(to, message);
    if (!message.joints.empty()) {
        auto joints = to.initJoints(static_cast<unsigned>(4 * message.joints.size()));
        unsigned at = 0;
        for (const View::Joint& joint : message.joints) {
            joints.set(at++, joint.a.x);
            joints.set(at++, joint.a.y);
            joints.set(at++, joint.b.x);
            joints.set(at++, joint.b.y);
        }
    }
    if (!message.score.empty()) to.setScore(textOf(message.score));
}

}  // namespace huestep::protocol::wire
