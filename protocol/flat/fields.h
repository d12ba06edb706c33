/// The fields of each message as they lie in a flat segment: one list for reading and writing.
///
/// `Io` is a FlatReader, and then `m` is filled, or a FlatWriter. Places are those that Cap'n
/// Proto gives the fields of protocol/messages.capnp and scene.capnp, as `capnp compile -ocapnp`
/// shows them: numbers at their byte, flags at their bit, pointers at their number. Fields only
/// grow at the end, so a place that stands here stays. What is refused here is what
/// protocol/wire/message_read.cpp refuses; tests/protocol/flat_test.cpp compares the two.
#pragma once

#include "protocol/codec.h"
#include "protocol/flat/flat_reader.h"

namespace huestep::protocol::flat {

// clang-format off
template <class M> inline constexpr Layout layoutOf{};
template <> inline constexpr Layout layoutOf<Hello>{6, 4};
template <> inline constexpr Layout layoutOf<Welcome>{6, 2};
template <> inline constexpr Layout layoutOf<Intent>{4, 1};
template <> inline constexpr Layout layoutOf<Frame>{3, 2};
template <> inline constexpr Layout layoutOf<SnapshotBegin>{3, 0};
template <> inline constexpr Layout layoutOf<SnapshotChunk>{1, 1};
template <> inline constexpr Layout layoutOf<SnapshotEnd>{1, 0};
template <> inline constexpr Layout layoutOf<SnapshotRequest>{1, 0};
template <> inline constexpr Layout layoutOf<HashQuery>{1, 0};
template <> inline constexpr Layout layoutOf<HashNodes>{2, 1};
template <> inline constexpr Layout layoutOf<DesyncReport>{4, 3};
template <> inline constexpr Layout layoutOf<Ping>{3, 0};
template <> inline constexpr Layout layoutOf<Bye>{1, 1};
template <> inline constexpr Layout layoutOf<View>{3, 8};
template <> inline constexpr Layout layoutOf<Command>{5, 1};
template <> inline constexpr Layout layoutOf<Spawn>{0, 2};
template <> inline constexpr Layout layoutOf<BodyDef>{7, 1};
template <> inline constexpr Layout layoutOf<JointDef>{11, 0};
template <> inline constexpr Layout layoutOf<ShapeDef>{5, 1};
template <> inline constexpr Layout layoutOf<Vec2>{1, 0};
template <> inline constexpr Layout layoutOf<View::Shape>{2, 0};
template <> inline constexpr Layout layoutOf<View::Contact>{2, 0};
// clang-format on

// Parts of scenes --------------------------------------------------------------------------------

/// Two numbers that may lie apart: what they are in a union depends on what was there before.
template <class Io, class V>
void point(Io& io, const char* field, std::size_t x, std::size_t y, V& v) {
    io.number(field, x, v.x);
    io.number(field, y, v.y);
}
template <class Io, class V>
void point(Io& io, const char* field, std::size_t x, V& v) {
    point(io, field, x, x + 4, v);
}
/// `standard`: of the cosine.
template <class Io, class R>
void rotation(Io& io, const char* field, std::size_t c, R& r, float standard = 1.0f) {
    io.number(field, c, r.c, standard);
    io.number(field, c + 4, r.s);
}

template <class Io, class S>
void vertices(Io& io, S& shape) {
    const auto each = [&io](auto& vertex) { point(io, "", 0, vertex); };
    if constexpr (Io::reads) {
        std::vector<Vec2> list;
        io.structs("vertices", 0, layoutOf<Vec2>, list, maxPolygonVertices, each);
        shape.vertexCount = static_cast<std::uint8_t>(list.size());
        std::copy(list.begin(), list.end(), shape.vertices.begin());
    } else {
        const auto begin = shape.vertices.begin();
        const std::vector<Vec2> list(begin, begin + shape.vertexCount);
        io.structs("vertices", 0, layoutOf<Vec2>, list, maxPolygonVertices, each);
    }
}

template <class Io, class S>
void shapeFields(Io& io, S& s) {
    io.choice("kind", 0, s.kind, ShapeKind::ChainSegment);
    vertices(io, s);
    io.number("radius", 4, s.radius, 0.5f);
    io.number("density", 8, s.density, 1.0f);
    io.number("friction", 12, s.material.friction, 0.6f);
    io.number("restitution", 16, s.material.restitution);
    io.number("rollingResistance", 20, s.material.rollingResistance);
    io.number("tangentSpeed", 24, s.material.tangentSpeed);
    io.number("category", 28, s.filter.category, 1u);
    io.number("mask", 32, s.filter.mask, 0xffffffffu);
    io.number("group", 36, s.filter.group);
}

template <class Io, class B>
void bodyFields(Io& io, B& b) {
    io.number("id", 0, b.id);
    io.choice("type", 4, b.type, BodyType::Dynamic);
    io.flag(48, b.fixedRotation);
    io.flag(49, b.maySleep, true);
    io.flag(50, b.asleep);
    point(io, "position", 8, b.position);
    rotation(io, "rotation", 16, b.rotation);
    point(io, "velocity", 24, b.velocity);
    io.number("angularVelocity", 32, b.angularVelocity);
    io.number("linearDamping", 36, b.linearDamping);
    io.number("angularDamping", 40, b.angularDamping);
    io.number("gravityScale", 44, b.gravityScale, 1.0f);
    io.number("firstShape", 48, b.firstShape);
    io.structs("shapes", 0, layoutOf<ShapeDef>, b.shapes, maxShapesPerBody,
               [&io](auto& shape) { shapeFields(io, shape); });
}

template <class Io, class J>
void jointFields(Io& io, J& j) {
    io.number("id", 0, j.id);
    io.choice("kind", 4, j.kind, JointKind::Prismatic);
    io.flag(48, j.collideConnected);
    io.flag(49, j.spring.enabled);
    io.flag(50, j.limit.enabled);
    io.flag(51, j.motor.enabled);
    io.number("bodyA", 8, j.bodyA);
    io.number("bodyB", 12, j.bodyB);
    point(io, "anchorA", 16, j.anchorA);
    point(io, "anchorB", 24, j.anchorB);
    rotation(io, "reference", 32, j.reference);
    io.number("length", 40, j.length, 1.0f);
    point(io, "target", 44, j.target);
    io.number("maxForce", 52, j.maxForce);
    io.number("hertz", 56, j.spring.hertz);
    io.number("dampingRatio", 60, j.spring.dampingRatio);
    io.number("lower", 64, j.limit.lower);
    io.number("upper", 68, j.limit.upper);
    io.number("speed", 72, j.motor.speed);
    io.number("maxEffort", 76, j.motor.maxEffort);
    rotation(io, "axis", 80, j.axis);
}

// Commands ---------------------------------------------------------------------------------------

/// The action's own fields, in the order of `Action`, which is the union's.
template <class Io>
struct ActionFields {
    Io& io;

    template <class A>
    void operator()(A& a) const {
        using Kind = std::remove_const_t<A>;
        if constexpr (std::is_same_v<Kind, AddPlayer> || std::is_same_v<Kind, RemovePlayer>) {
            io.number("player", 4, a.player);
        } else if constexpr (std::is_same_v<Kind, RemoveJoint> || std::is_same_v<Kind, SetMotor>) {
            io.number("joint", 4, a.joint);
        } else if constexpr (std::is_same_v<Kind, Custom>) {
            io.number("kind", 4, a.kind);
        } else if constexpr (requires { a.body; }) {
            io.number("body", 4, a.body);
        }
        rest(a);
    }

 private:
    template <class A>
    void rest(A& a) const {
        using Kind = std::remove_const_t<A>;
        if constexpr (std::is_same_v<Kind, ApplyImpulse>) {
            point(io, "impulse", 20, a.impulse);
            point(io, "point", 28, a.point);
        } else if constexpr (std::is_same_v<Kind, ApplyForce>) {
            point(io, "force", 20, 32, a.force);
            point(io, "point", 24, 28, a.point);
        } else if constexpr (std::is_same_v<Kind, Grab>) {
            point(io, "point", 20, 32, a.point);
            point(io, "target", 24, 28, a.target);
        } else if constexpr (std::is_same_v<Kind, MoveGrab>) {
            point(io, "target", 4, 20, a.target);
        } else if constexpr (std::is_same_v<Kind, SetMotor>) {
            io.flag(160, a.enabled);
            io.number("speed", 32, a.speed);
        } else if constexpr (std::is_same_v<Kind, SetVelocity>) {
            point(io, "velocity", 20, 32, a.velocity);
            io.number("angularVelocity", 24, a.angularVelocity);
        } else if constexpr (std::is_same_v<Kind, SetTarget>) {
            point(io, "position", 20, 32, a.position);
            rotation(io, "rotation", 24, a.rotation, 0.0f);
        } else if constexpr (std::is_same_v<Kind, Custom>) {
            io.number("id", 20, a.id);
            io.number("number", 32, a.number);
            point(io, "vector", 24, a.vector);
        } else if constexpr (std::is_same_v<Kind, Spawn>) {
            spawn(a);
        }
    }

    template <class S>
    void spawn(S& s) const {
        io.structure("spawn", 0, layoutOf<Spawn>, [&] {
            io.structs("bodies", 0, layoutOf<BodyDef>, s.bodies, maxSpawnBodies,
                       [&](auto& body) { bodyFields(io, body); });
            io.structs("joints", 1, layoutOf<JointDef>, s.joints, maxSpawnJoints,
                       [&](auto& joint) { jointFields(io, joint); });
        });
    }
};

/// An action of the kind with this number.
template <std::size_t... I>
Action actionOf(std::size_t kind, std::index_sequence<I...>) {
    Action action;
    ((kind == I ? void(action.emplace<I>()) : void()), ...);
    return action;
}

template <class Io, class C>
void commandFields(Io& io, C& c) {
    constexpr std::size_t kinds = std::variant_size_v<Action>;
    io.number("author", 0, c.author);
    io.number("sequence", 8, c.sequence);
    auto kind = static_cast<std::uint16_t>(c.action.index());
    io.number("action", 16, kind);
    io.check("action", kind < kinds, "unknown action " + std::to_string(kind));
    if constexpr (Io::reads) c.action = actionOf(kind, std::make_index_sequence<kinds>{});
    std::visit(ActionFields<Io>{io}, c.action);
}

template <class Io, class List>
void commandList(Io& io, List& commands, std::size_t most) {
    io.structs("commands", 0, layoutOf<Command>, commands, most,
               [&io](auto& command) { commandFields(io, command); });
}

// Messages ---------------------------------------------------------------------------------------

/// A token is 16 bytes, or none where it may be missing.
template <class Io, class Token>
void tokenField(Io& io, std::size_t pointer, Token& token, bool mayMiss) {
    if constexpr (Io::reads) {
        std::vector<std::uint8_t> bytes;
        io.numbers("resume", pointer, bytes, 16);
        io.check("resume", bytes.size() == 16 || (mayMiss && bytes.empty()), "not 16 bytes");
        token.reset();
        if (bytes.size() != 16) return;
        token.emplace();
        std::copy(bytes.begin(), bytes.end(), token->begin());
    } else if (token) {
        io.numbers("resume", pointer, std::vector<std::uint8_t>(token->begin(), token->end()), 16);
    }
}

template <class Io, class Name>
void sessionField(Io& io, Name& session) {
    io.text("session", 0, session, maxSessionName);
    io.check("session", isSessionName(session), "not a name of 1 to 64 of a-z, 0-9, _ and -");
}

template <class Io, class M>
void welcomeFields(Io& io, M& m) {
    sessionField(io, m.session);
    io.number("player", 0, m.player);
    io.number("epoch", 4, m.epoch);
    io.number("tick", 8, m.tick);
    io.number("ticksPerSecond", 16, m.ticksPerSecond);
    io.check("ticksPerSecond", m.ticksPerSecond > 0.0f && m.ticksPerSecond <= maxTicksPerSecond,
             "not above 0 and at most 10000");
    io.number("inputDelay", 20, m.inputDelay);
    io.check("inputDelay", m.inputDelay <= maxInputDelay, "too long");
    io.number("maxInputDelay", 44, m.maxInputDelay);
    io.check("maxInputDelay", m.maxInputDelay <= maxInputDelay, "too long");
    io.number("maxCommandsPerIntent", 24, m.maxCommandsPerIntent);
    io.check("maxCommandsPerIntent",
             m.maxCommandsPerIntent >= 1 && m.maxCommandsPerIntent <= maxCommandsPerIntent,
             "not 1 to 64");
    io.number("maxQueuedCommands", 28, m.maxQueuedCommands, 256u);
    io.check("maxQueuedCommands",
             m.maxQueuedCommands >= 1 && m.maxQueuedCommands <= maxQueuedCommands,
             "not 1 to 65536");
    io.number("lastSequence", 32, m.lastSequence);
    io.number("maxQueuedBytes", 40, m.maxQueuedBytes, 65'536u);
    io.check("maxQueuedBytes",
             m.maxQueuedBytes >= minQueuedBytes && m.maxQueuedBytes <= maxQueuedBytes,
             "not 16384 to 16777216");
    std::optional<ResumeToken> token;
    if constexpr (!Io::reads) token = m.resume;
    tokenField(io, 1, token, false);
    if constexpr (Io::reads) m.resume = token.value_or(ResumeToken{});
}

template <class Io, class Some>
void checkpointFields(Io& io, Some& checkpoint) {
    std::uint16_t which = checkpoint ? 1 : 0;
    io.number("checkpoint", 0, which);
    io.check("checkpoint", which <= 1, "neither none nor some");
    if (which != 1) return;
    if constexpr (Io::reads) checkpoint.emplace();
    io.number("checkpoint.tick", 8, checkpoint->tick);
    io.number("checkpoint.motionRoot", 16, checkpoint->motionRoot);
}

template <class Io, class M>
void reportFields(Io& io, M& m) {
    io.number("tick", 0, m.tick);
    io.number("mine", 8, m.mine);
    io.number("yours", 16, m.yours);
    io.number("body", 24, m.body);
    io.text("field", 0, m.field, maxReportText);
    io.text("here", 1, m.here, maxReportText);
    io.text("there", 2, m.there, maxReportText);
}

template <class Io, class M>
void fields(Io& io, M& m) {
    using Kind = std::remove_const_t<M>;
    if constexpr (std::is_same_v<Kind, Hello>) {
        io.number("version", 0, m.version);
        io.number("fingerprint.scene", 4, m.fingerprint.scene);
        io.number("fingerprint.selfTest", 8, m.fingerprint.selfTest);
        io.number("fingerprint.schema", 16, m.fingerprint.schema);
        sessionField(io, m.session);
        io.choice("role", 24, m.role, Role::Spectator);
        tokenField(io, 1, m.resume, true);
        io.number("haveTick", 32, m.haveTick);
        io.number("haveHash", 40, m.haveHash);
        io.numbers("ticket", 2, m.ticket, maxTicketBytes);
        io.numbers("rules", 3, m.rules, maxRules);
    } else if constexpr (std::is_same_v<Kind, Welcome>) {
        welcomeFields(io, m);
    } else if constexpr (std::is_same_v<Kind, Intent>) {
        commandList(io, m.commands, maxCommandsPerIntent);
        checkpointFields(io, m.checkpoint);
        io.number("tick", 24, m.tick);
    } else if constexpr (std::is_same_v<Kind, Frame>) {
        io.number("tick", 0, m.tick);
        io.number("previousRoot", 8, m.previousRoot);
        io.number("committed", 16, m.committed);
        commandList(io, m.commands, maxCommandsPerFrame);
        io.numbers("substituted", 1, m.substituted, maxSubstituted);
    } else if constexpr (std::is_same_v<Kind, SnapshotBegin>) {
        io.number("tick", 0, m.tick);
        io.number("bytes", 8, m.bytes);
        io.number("hash", 16, m.hash);
        io.check("bytes", m.bytes <= maxSnapshotBytes, "more than a snapshot has");
    } else if constexpr (std::is_same_v<Kind, SnapshotChunk>) {
        io.number("offset", 0, m.offset);
        io.check("offset", m.offset <= maxSnapshotBytes, "beyond where a snapshot ends");
        io.numbers("data", 0, m.data, maxChunkBytes);
    } else if constexpr (std::is_same_v<Kind, HashNodes>) {
        io.number("tick", 0, m.tick);
        io.number("first", 8, m.first);
        io.numbers("leaves", 0, m.leaves, maxLeaves);
    } else if constexpr (std::is_same_v<Kind, DesyncReport>) {
        reportFields(io, m);
    } else if constexpr (std::is_same_v<Kind, Ping>) {
        io.number("nonce", 0, m.nonce);
        io.flag(64, m.reply);
        io.number("sinceClose", 12, m.sinceClose);
        io.number("tick", 16, m.tick);
    } else if constexpr (std::is_same_v<Kind, Bye>) {
        io.choice("reason", 0, m.reason, ByeReason::TicketRefused);
        io.text("text", 0, m.text, maxByeText);
        io.flag(16, m.mayResume);
    } else {  // the end of a snapshot, a request for one or for hashes
        io.number("tick", 0, m.tick);
    }
}

}  // namespace huestep::protocol::flat
