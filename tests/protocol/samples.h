/// Messages and scenes to test with: one fixed sample of each type, and random ones from a seed.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "protocol/codec.h"
#include "protocol/messages.h"

namespace huestep::protocol::samples {

/// What a decoder says of bytes.
inline std::string reasonOf(const Result<Message>& result) {
    return result.ok() ? "accepted" : result.error().message;
}

/// Draws values from a seed. `std::uniform_*` differ between libraries, so ranges are our own.
class Draw {
 public:
    explicit Draw(std::uint64_t seed) : m_engine(seed) {}
    std::uint64_t bits() { return m_engine(); }
    std::uint32_t word() { return static_cast<std::uint32_t>(m_engine() >> 32); }
    /// In [0, end).
    std::size_t below(std::size_t end) { return static_cast<std::size_t>(m_engine() % end); }
    bool coin() { return (m_engine() >> 40 & 1u) != 0; }
    /// Any finite float, now and then a zero, a subnormal or the largest.
    float real() {
        switch (below(8)) {
            case 0:
                return 0.0f;
            case 1:
                return 1.0e-40f;
            case 2:
                return 3.0e38f;
            default:
                break;
        }
        const auto span = static_cast<double>(word()) / 4294967296.0 * 2.0 - 1.0;
        return static_cast<float>(span * 1000.0);
    }
    Vec2 point() {
        const float x = real();
        return {x, real()};
    }
    std::string text(std::size_t most) {
        std::string value;
        const std::size_t size = below(most + 1);
        while (value.size() < size) value += static_cast<char>(' ' + below(95));
        return value;
    }
    std::string name() {
        std::string value = "a";
        const std::size_t size = 1 + below(maxSessionName);
        while (value.size() < size) value += "abcxyz0189_-"[below(12)];
        return value;
    }

 private:
    std::mt19937_64 m_engine;
};

inline ShapeDef randomShape(Draw& draw) {
    ShapeDef shape;
    shape.kind = static_cast<ShapeKind>(draw.below(5));
    shape.vertexCount = static_cast<std::uint8_t>(1 + draw.below(maxPolygonVertices));
    for (std::size_t i = 0; i < shape.vertexCount; ++i) shape.vertices[i] = draw.point();
    shape.radius = draw.real();
    shape.density = draw.real();
    shape.material = {draw.real(), draw.real(), draw.real(), draw.real()};
    shape.filter = {draw.word(), draw.word(), static_cast<std::int32_t>(draw.word())};
    return shape;
}

inline BodyDef randomBody(Draw& draw, std::size_t mostShapes = 3) {
    BodyDef body;
    body.id = draw.word();
    body.firstShape = draw.word();
    body.type = static_cast<BodyType>(draw.below(3));
    body.fixedRotation = draw.coin();
    body.maySleep = draw.coin();
    body.asleep = draw.coin();
    body.position = draw.point();
    body.rotation = {draw.real(), draw.real()};
    body.velocity = draw.point();
    body.angularVelocity = draw.real();
    body.linearDamping = draw.real();
    body.angularDamping = draw.real();
    body.gravityScale = draw.real();
    const std::size_t shapes = draw.below(mostShapes + 1);
    for (std::size_t i = 0; i < shapes; ++i) body.shapes.push_back(randomShape(draw));
    return body;
}

inline JointDef randomJoint(Draw& draw) {
    JointDef joint;
    joint.id = draw.word();
    joint.kind = static_cast<JointKind>(draw.below(5));
    joint.collideConnected = draw.coin();
    joint.bodyA = draw.word();
    joint.bodyB = draw.word();
    joint.anchorA = draw.point();
    joint.anchorB = draw.point();
    joint.reference = {draw.real(), draw.real()};
    joint.axis = {draw.real(), draw.real()};
    joint.length = draw.real();
    joint.target = draw.point();
    joint.maxForce = draw.real();
    joint.spring = {draw.coin(), draw.real(), draw.real()};
    joint.limit = {draw.coin(), draw.real(), draw.real()};
    joint.motor = {draw.coin(), draw.real(), draw.real()};
    return joint;
}

inline Action randomAction(Draw& draw, std::size_t kind) {
    switch (kind) {
        case 0:
            return AddPlayer{draw.word()};
        case 1:
            return RemovePlayer{draw.word()};
        case 2:
            return ApplyImpulse{draw.word(), draw.point(), draw.point()};
        case 3:
            return ApplyForce{draw.word(), draw.point(), draw.point()};
        case 4:
            return Grab{draw.word(), draw.point(), draw.point()};
        case 5:
            return MoveGrab{draw.point()};
        case 6:
            return Release{};
        case 7: {
            Spawn spawn;
            for (std::size_t i = draw.below(4); i > 0; --i)
                spawn.bodies.push_back(randomBody(draw));
            for (std::size_t i = draw.below(3); i > 0; --i) {
                spawn.joints.push_back(randomJoint(draw));
            }
            return spawn;
        }
        case 8:
            return RemoveBody{draw.word()};
        case 9:
            return RemoveJoint{draw.word()};
        case 10:
            return SetMotor{draw.word(), draw.coin(), draw.real()};
        case 11:
            return SetVelocity{draw.word(), draw.point(), draw.real()};
        case 12:
            return SetTarget{draw.word(), draw.point(), {draw.real(), draw.real()}};
        default:
            return Custom{draw.word(), draw.word(), static_cast<std::int32_t>(draw.word()),
                          draw.point()};
    }
}
inline constexpr std::size_t actionKinds = std::variant_size_v<Action>;

inline std::vector<Command> randomCommands(Draw& draw, std::size_t most) {
    std::vector<Command> commands;
    for (std::size_t i = draw.below(most + 1); i > 0; --i) {
        commands.push_back({draw.word(), draw.bits(), randomAction(draw, draw.below(actionKinds))});
    }
    return commands;
}

inline View randomView(Draw& draw) {
    View view;
    view.tick = draw.bits();
    view.root = draw.bits();
    view.players = draw.word();
    view.definitions = draw.word();
    const std::size_t bodies = draw.below(20);
    for (std::size_t i = 0; i < bodies; ++i) {
        view.poses.push_back({draw.point(), {draw.real(), draw.real()}});
        view.flags.push_back(static_cast<std::uint8_t>(draw.below(256)));
    }
    for (std::size_t i = draw.below(10); i > 0; --i) {
        view.contacts.push_back({draw.point(), static_cast<std::uint8_t>(draw.below(256))});
    }
    for (std::size_t i = draw.below(6); i > 0; --i) {
        view.joints.push_back({draw.point(), draw.point()});
    }
    view.score = draw.text(maxScoreText);
    if (bodies == 0 || draw.coin()) return view;
    for (std::size_t i = 0; i < bodies; ++i) view.bodies.push_back(draw.word());
    for (std::size_t i = draw.below(20); i > 0; --i) {
        View::Shape shape{static_cast<std::uint32_t>(draw.below(bodies)),
                          static_cast<ShapeKind>(draw.below(5)),
                          draw.real(),
                          {}};
        for (std::size_t k = 1 + draw.below(8); k > 0; --k) shape.vertices.push_back(draw.point());
        view.shapes.push_back(shape);
    }
    return view;
}

inline ResumeToken randomToken(Draw& draw) {
    ResumeToken token{};
    for (auto& byte : token) byte = static_cast<std::uint8_t>(draw.below(256));
    return token;
}

inline Hello randomHello(Draw& draw) {
    Hello hello;
    hello.version = draw.word();
    hello.fingerprint = {draw.bits(), draw.bits(), draw.word()};
    hello.session = draw.name();
    hello.role = draw.coin() ? Role::Player : Role::Spectator;
    if (draw.coin()) hello.resume = randomToken(draw);
    hello.haveTick = draw.bits();
    hello.haveHash = draw.bits();
    hello.ticket.resize(draw.coin() ? draw.below(maxTicketBytes + 1) : 0);
    for (std::byte& byte : hello.ticket) byte = static_cast<std::byte>(draw.below(256));
    for (std::size_t i = draw.below(4); i > 0; --i) hello.rules.push_back(draw.bits());
    return hello;
}

inline Message randomMessage(Draw& draw, MessageType type) {
    switch (type) {
        case MessageType::Hello:
            return randomHello(draw);
        case MessageType::Welcome:
            return Welcome{draw.name(),
                           draw.word(),
                           draw.word(),
                           draw.bits(),
                           1.0f + static_cast<float>(draw.below(1000)),
                           static_cast<std::uint32_t>(draw.below(maxInputDelay + 1)),
                           static_cast<std::uint32_t>(1 + draw.below(maxCommandsPerIntent)),
                           draw.bits(),
                           randomToken(draw),
                           static_cast<std::uint32_t>(1 + draw.below(maxQueuedCommands)),
                           static_cast<std::uint32_t>(
                               minQueuedBytes + draw.below(maxQueuedBytes - minQueuedBytes + 1)),
                           static_cast<std::uint32_t>(draw.below(maxInputDelay + 1))};
        case MessageType::Intent: {
            Intent intent{randomCommands(draw, 6), {}, draw.coin() ? draw.bits() : 0};
            if (draw.coin()) intent.checkpoint = Checkpoint{draw.bits(), draw.bits()};
            return intent;
        }
        case MessageType::Frame: {
            Frame frame{draw.bits(), randomCommands(draw, 12), {}, draw.bits(), draw.bits()};
            for (std::size_t i = draw.below(5); i > 0; --i) {
                frame.substituted.push_back(draw.word());
            }
            return frame;
        }
        case MessageType::SnapshotBegin:
            return SnapshotBegin{draw.bits(), draw.below(maxSnapshotBytes + 1), draw.bits()};
        case MessageType::SnapshotChunk: {
            SnapshotChunk chunk{draw.below(maxSnapshotBytes + 1), {}};
            chunk.data.resize(draw.below(300));
            for (auto& byte : chunk.data) byte = static_cast<std::byte>(draw.below(256));
            return chunk;
        }
        case MessageType::SnapshotEnd:
            return SnapshotEnd{draw.bits()};
        case MessageType::SnapshotRequest:
            return SnapshotRequest{draw.bits()};
        case MessageType::HashQuery:
            return HashQuery{draw.bits()};
        case MessageType::HashNodes: {
            HashNodes nodes{draw.bits(), {}, draw.word()};
            for (std::size_t i = draw.below(50); i > 0; --i) nodes.leaves.push_back(draw.bits());
            return nodes;
        }
        case MessageType::DesyncReport:
            return DesyncReport{draw.bits(),
                                draw.bits(),
                                draw.bits(),
                                draw.word(),
                                draw.text(maxReportText),
                                draw.text(maxReportText),
                                draw.text(maxReportText)};
        case MessageType::Ping:
            return Ping{draw.bits(), draw.coin(), draw.bits(), draw.word()};
        case MessageType::Bye:
            return Bye{static_cast<ByeReason>(draw.below(12)), draw.text(maxByeText), draw.coin()};
        default:
            return randomView(draw);
    }
}

inline constexpr std::size_t messageTypes = std::variant_size_v<Message>;

/// A spawn with a value in every field that a player may set.
inline Spawn sampleSpawn() {
    BodyDef box;
    box.type = BodyType::Dynamic;
    box.position = {1.5f, 2.25f};
    box.rotation = {0.0f, 1.0f};
    box.velocity = {-3.0f, 0.5f};
    box.angularVelocity = 0.25f;
    ShapeDef shape;
    shape.kind = ShapeKind::Polygon;
    shape.vertexCount = 4;
    shape.vertices = {Vec2{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}};
    shape.radius = 0.01f;
    shape.material.friction = 0.3f;
    shape.filter.group = -2;
    box.shapes.push_back(shape);
    BodyDef ball = box;
    ball.position = {3.0f, 2.25f};
    ball.shapes[0] = ShapeDef{};
    ball.shapes[0].vertices[0] = {0.125f, 0.0f};
    JointDef joint;
    joint.kind = JointKind::Distance;
    joint.bodyB = 1;
    joint.anchorA = {0.5f, 0.0f};
    joint.length = 1.0f;
    joint.spring = {true, 4.0f, 0.7f};
    return {{box, ball}, {joint}};
}

/// One fixed message of each type. Their bytes are kept in tests/protocol/corpus: values here may
/// not change, new fields keep their defaults.
inline std::vector<Message> sampleMessages() {
    const ResumeToken token{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
    Hello hello;
    hello.fingerprint = {0x1122334455667788u, 0x99aabbccddeeff00u, 1};
    hello.session = "sandbox";
    hello.resume = token;
    hello.haveTick = 600;
    hello.haveHash = 0xfeedfacecafebeefu;
    const Welcome welcome{"sandbox", 7, 3, 601, 60.0f, 2, 16, 42, token};
    std::vector<Command> commands{
        {7, 43, ApplyImpulse{9, {2.0f, 0.0f}, {1.0f, -1.0f}}},
        {7, 44, ApplyForce{9, {0.0f, 5.0f}, {0.0f, 0.25f}}},
        {7, 45, Grab{9, {1.0f, 1.0f}, {2.0f, 2.0f}}},
        {7, 46, MoveGrab{{2.5f, 2.0f}}},
        {7, 47, Release{}},
        {7, 48, sampleSpawn()},
        {7, 49, RemoveBody{12}},
        {7, 50, SetMotor{4, true, -1.5f}},
    };
    const Intent intent{commands, Checkpoint{600, 0xfeedfacecafebeefu}};
    std::vector<Command> all{{0, 11, AddPlayer{7}},
                             {0, 12, RemovePlayer{6}},
                             {0, 13, RemoveJoint{3}},
                             {0, 14, SetVelocity{2, {1.0f, 0.0f}, -0.5f}}};
    all.insert(all.end(), commands.begin(), commands.end());
    const Frame frame{601, all, {5, 6}, 0xfeedfacecafebeefu, 599};
    SnapshotChunk chunk{120'000, {}};
    for (int i = 0; i < 37; ++i) chunk.data.push_back(static_cast<std::byte>(7 * i));
    const View view{600,
                    0xfeedfacecafebeefu,
                    4,
                    2,
                    {{0, ShapeKind::Circle, 0.5f, {{0.0f, 0.0f}}},
                     {1, ShapeKind::Segment, 0.0f, {{-1.0f, 0.0f}, {1.0f, 0.0f}}}},
                    {3, 4},
                    {{{1.0f, 2.0f}, {1.0f, 0.0f}}, {{-1.0f, 0.5f}, {0.0f, 1.0f}}},
                    {5, 0},
                    {{{0.25f, 0.75f}, 3}, {{0.5f, 0.75f}, 255}},
                    {},
                    {}};
    return {hello,
            welcome,
            intent,
            frame,
            SnapshotBegin{600, 220'000, 0x0123456789abcdefu},
            chunk,
            SnapshotEnd{600},
            SnapshotRequest{599},
            HashQuery{600},
            HashNodes{600, {1, 2, 0xffffffffffffffffu}, 64},
            DesyncReport{600, 1, 2, 17, "velocity.x", "1.25", "1.5"},
            Ping{99, true},
            Bye{ByeReason::ServerStops, "the server stops; \xc3\xa0 bient\xc3\xb4t", true},
            view};
}

}  // namespace huestep::protocol::samples
