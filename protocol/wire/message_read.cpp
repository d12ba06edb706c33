#include <algorithm>

#include "protocol/codec.h"
#include "protocol/wire/command_wire.h"
#include "protocol/wire/message_wire.h"
#include "protocol/wire/scene_wire.h"

namespace huestep::protocol::wire {

namespace {

std::string sessionName(Reading& in, ::capnp::Text::Reader name) {
    const std::string_view text(name.begin(), name.size());
    if (!isSessionName(text)) {
        in.refuse("session", "not a name of 1 to 64 of a-z, 0-9, _ and -");
    }
    return std::string(text);
}

ResumeToken resumeToken(Reading& in, ::capnp::Data::Reader data) {
    ResumeToken token{};
    if (data.size() != token.size()) {
        in.refuse("resume", std::to_string(data.size()) + " bytes instead of 16");
    }
    std::copy(data.begin(), data.end(), token.begin());
    return token;
}

std::string text(Reading& in, const char* field, ::capnp::Text::Reader value, std::size_t most) {
    return in.text(field, {value.begin(), value.size()}, most);
}

void refuseAbove(Reading& in, const char* field, std::uint64_t value, std::uint64_t most) {
    if (value <= most) return;
    in.refuse(field, std::to_string(value) + " is above " + std::to_string(most));
}

void refuseOutside(Reading& in, const char* field, std::uint64_t value, std::uint64_t least,
                   std::uint64_t most) {
    if (value < least) {
        in.refuse(field, std::to_string(value) + " is below " + std::to_string(least));
    }
    refuseAbove(in, field, value, most);
}

std::vector<Command> readCommands(Reading& in, ::capnp::List<schema::Command>::Reader from,
                                  std::size_t most) {
    const std::size_t count = in.sizeOf("commands", from, most, structBytes<schema::Command>());
    std::vector<Command> commands;
    commands.reserve(count);
    for (unsigned i = 0; i < count; ++i) {
        commands.push_back(in.at("commands", i, [&] { return readCommand(in, from[i]); }));
    }
    return commands;
}

/// The numbers of a list whose size has been checked.
template <class T, class List>
std::vector<T> numbers(const List& list) {
    std::vector<T> values(list.size());
    for (unsigned i = 0; i < list.size(); ++i) values[i] = list[i];
    return values;
}

std::vector<Pose> readPoses(Reading& in, ::capnp::List<float>::Reader from) {
    const std::size_t size = in.sizeOf("poses", from, 4 * maxViewBodies, 4);
    if (size % 4 != 0) in.refuse("poses", "not four numbers a body");
    std::vector<Pose> poses(size / 4);
    for (unsigned i = 0; i < poses.size(); ++i) {
        poses[i] = in.at("poses", i, [&] {
            return Pose{{in.real("x", from[4 * i]), in.real("y", from[4 * i + 1])},
                        {in.real("c", from[4 * i + 2]), in.real("s", from[4 * i + 3])}};
        });
    }
    return poses;
}

std::vector<View::Contact> readContacts(Reading& in,
                                        ::capnp::List<schema::View::Contact>::Reader from) {
    const std::size_t count =
        in.sizeOf("contacts", from, maxViewContacts, structBytes<schema::View::Contact>());
    std::vector<View::Contact> contacts(count);
    for (unsigned i = 0; i < count; ++i) {
        contacts[i] = in.at("contacts", i, [&] {
            return View::Contact{{in.real("x", from[i].getX()), in.real("y", from[i].getY())},
                                 from[i].getColour()};
        });
    }
    return contacts;
}

std::vector<View::Joint> readJoints(Reading& in, ::capnp::List<float>::Reader from) {
    const std::size_t size = in.sizeOf("joints", from, 4 * maxViewJoints, 4);
    if (size % 4 != 0) in.refuse("joints", "not four numbers a joint");
    std::vector<View::Joint> joints(size / 4);
    for (unsigned i = 0; i < joints.size(); ++i) {
        joints[i] = in.at("joints", i, [&] {
            return View::Joint{{in.real("a.x", from[4 * i]), in.real("a.y", from[4 * i + 1])},
                               {in.real("b.x", from[4 * i + 2]), in.real("b.y", from[4 * i + 3])}};
        });
    }
    return joints;
}

/// Shapes own consecutive runs of one list of vertices, which they must use up exactly.
std::vector<View::Shape> readShapes(Reading& in, schema::View::Reader from, std::size_t bodies) {
    const auto list = from.getShapes();
    const auto vertices = from.getVertices();
    const std::size_t count =
        in.sizeOf("shapes", list, maxViewShapes, structBytes<schema::View::Shape>());
    const std::size_t floats =
        in.sizeOf("vertices", vertices, 2 * maxPolygonVertices * maxViewShapes, 4);
    std::vector<View::Shape> shapes;
    shapes.reserve(count);
    std::size_t used = 0;
    for (unsigned i = 0; i < count; ++i) {
        shapes.push_back(in.at("shapes", i, [&] {
            const auto shape = list[i];
            if (shape.getBody() >= bodies) in.refuse("body", "no such body");
            const std::size_t own = shape.getVertexCount();
            if (own < 1 || own > maxPolygonVertices || used + 2 * own > floats) {
                in.refuse("vertexCount", std::to_string(own) + " do not fit");
            }
            View::Shape read{shape.getBody(),
                             in.choice("kind", shape.getKind(), ShapeKind::ChainSegment),
                             in.real("radius", shape.getRadius()),
                             {}};
            for (std::size_t end = used + 2 * own; used < end; used += 2) {
                const auto at = static_cast<unsigned>(used);
                read.vertices.push_back(
                    {in.real("vertices", vertices[at]), in.real("vertices", vertices[at + 1])});
            }
            return read;
        }));
    }
    if (used != floats) in.refuse("vertices", "more than the shapes have");
    return shapes;
}

}  // namespace

Hello read(Reading& in, schema::Hello::Reader from) {
    Hello message;
    message.version = from.getVersion();
    const auto fingerprint = from.getFingerprint();
    message.fingerprint = {fingerprint.getSelfTest(), fingerprint.getSchema(),
                           fingerprint.getScene()};
    message.session = sessionName(in, from.getSession());
    message.role = in.choice("role", from.getRole(), Role::Spectator);
    const auto resume = from.getResume();
    if (resume.size() > 0) message.resume = resumeToken(in, resume);
    message.haveTick = from.getHaveTick();
    message.haveHash = from.getHaveHash();
    const auto ticket = from.getTicket();
    in.sizeOf("ticket", ticket, maxTicketBytes, 1);
    const auto bytes = std::as_bytes(std::span(ticket.begin(), ticket.size()));
    message.ticket.assign(bytes.begin(), bytes.end());
    const auto rules = from.getRules();
    in.sizeOf("rules", rules, maxRules, 8);
    message.rules = numbers<std::uint64_t>(rules);
    return message;
}

Welcome read(Reading& in, schema::Welcome::Reader from) {
    Welcome message;
    message.session = sessionName(in, from.getSession());
    message.player = from.getPlayer();
    message.epoch = from.getEpoch();
    message.tick = from.getTick();
    message.ticksPerSecond = in.real("ticksPerSecond", from.getTicksPerSecond());
    if (!(message.ticksPerSecond > 0.0f && message.ticksPerSecond <= maxTicksPerSecond)) {
        in.refuse("ticksPerSecond", "not above 0 and at most 10000");
    }
    message.inputDelay = from.getInputDelay();
    refuseAbove(in, "inputDelay", message.inputDelay, maxInputDelay);
    message.maxCommandsPerIntent = from.getMaxCommandsPerIntent();
    refuseOutside(in, "maxCommandsPerIntent", message.maxCommandsPerIntent, 1,
                  maxCommandsPerIntent);
    message.lastSequence = from.getLastSequence();
    message.resume = resumeToken(in, from.getResume());
    message.maxQueuedCommands = from.getMaxQueuedCommands();
    refuseOutside(in, "maxQueuedCommands", message.maxQueuedCommands, 1, maxQueuedCommands);
    message.maxQueuedBytes = from.getMaxQueuedBytes();
    refuseOutside(in, "maxQueuedBytes", message.maxQueuedBytes, minQueuedBytes, maxQueuedBytes);
    message.maxInputDelay = from.getMaxInputDelay();
    refuseAbove(in, "maxInputDelay", message.maxInputDelay, maxInputDelay);
    return message;
}

Intent read(Reading& in, schema::Intent::Reader from) {
    Intent message;
    message.commands = readCommands(in, from.getCommands(), maxCommandsPerIntent);
    message.tick = from.getTick();
    const auto checkpoint = from.getCheckpoint();
    switch (checkpoint.which()) {
        case schema::Intent::Checkpoint::NONE:
            return message;
        case schema::Intent::Checkpoint::SOME:
            message.checkpoint = {checkpoint.getSome().getTick(),
                                  checkpoint.getSome().getMotionRoot()};
            return message;
    }
    in.refuse("checkpoint", "neither none nor some");
}

Frame read(Reading& in, schema::Frame::Reader from) {
    Frame message;
    message.tick = from.getTick();
    message.commands = readCommands(in, from.getCommands(), maxCommandsPerFrame);
    const auto substituted = from.getSubstituted();
    in.sizeOf("substituted", substituted, maxSubstituted, 4);
    message.substituted = numbers<PlayerId>(substituted);
    message.previousRoot = from.getPreviousRoot();
    message.committed = from.getCommitted();
    return message;
}

SnapshotBegin read(Reading& in, schema::SnapshotBegin::Reader from) {
    refuseAbove(in, "bytes", from.getBytes(), maxSnapshotBytes);
    return {from.getTick(), from.getBytes(), from.getHash()};
}

SnapshotChunk read(Reading& in, schema::SnapshotChunk::Reader from) {
    SnapshotChunk message;
    message.offset = from.getOffset();
    refuseAbove(in, "offset", message.offset, maxSnapshotBytes);
    const auto data = from.getData();
    in.sizeOf("data", data, maxChunkBytes, 1);
    const auto bytes = std::as_bytes(std::span(data.begin(), data.size()));
    message.data.assign(bytes.begin(), bytes.end());
    return message;
}

SnapshotEnd read(Reading&, schema::SnapshotEnd::Reader from) {
    return {from.getTick()};
}
SnapshotRequest read(Reading&, schema::SnapshotRequest::Reader from) {
    return {from.getTick()};
}
HashQuery read(Reading&, schema::HashQuery::Reader from) {
    return {from.getTick()};
}

HashNodes read(Reading& in, schema::HashNodes::Reader from) {
    HashNodes message;
    message.tick = from.getTick();
    const auto leaves = from.getLeaves();
    in.sizeOf("leaves", leaves, maxLeaves, 8);
    message.leaves = numbers<std::uint64_t>(leaves);
    message.first = from.getFirst();
    return message;
}

DesyncReport read(Reading& in, schema::DesyncReport::Reader from) {
    return {from.getTick(),
            from.getMine(),
            from.getYours(),
            from.getBody(),
            text(in, "field", from.getField(), maxReportText),
            text(in, "here", from.getHere(), maxReportText),
            text(in, "there", from.getThere(), maxReportText)};
}

Ping read(Reading&, schema::Ping::Reader from) {
    return {from.getNonce(), from.getReply(), from.getTick(), from.getSinceClose()};
}

Bye read(Reading& in, schema::Bye::Reader from) {
    return {in.choice("reason", from.getReason(), ByeReason::TicketRefused),
            text(in, "text", from.getText(), maxByeText), from.getMayResume()};
}

View read(Reading& in, schema::View::Reader from) {
    View message;
    message.tick = from.getTick();
    message.root = from.getRoot();
    message.players = from.getPlayers();
    message.definitions = from.getDefinitions();
    message.poses = readPoses(in, from.getPoses());
    const auto flags = from.getFlags();
    in.sizeOf("flags", flags, maxViewBodies, 1);
    if (flags.size() != message.poses.size()) {
        in.refuse("flags", "not one byte a body");
    }
    message.flags.assign(flags.begin(), flags.end());
    message.contacts = readContacts(in, from.getContacts());
    const auto bodies = from.getBodies();
    const std::size_t count = in.sizeOf("bodies", bodies, maxViewBodies, 4);
    if (count != 0 && count != message.poses.size()) {
        in.refuse("bodies", "not one id a body");
    }
    message.bodies = numbers<BodyId>(bodies);
    message.shapes = readShapes(in, from, message.poses.size());
    message.joints = readJoints(in, from.getJoints());
    message.score = text(in, "score", from.getScore(), maxScoreText);
    return message;
}

}  // namespace huestep::protocol::wire
