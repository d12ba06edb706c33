#include "protocol/flat/flat_codec.h"

#include <utility>

#include "protocol/by_type.h"
#include "protocol/flat/fields.h"
#include "protocol/flat/flat_writer.h"

namespace huestep::protocol::flat {

namespace {

std::vector<float> numbersOf(const std::vector<Pose>& poses) {
    std::vector<float> numbers;
    numbers.reserve(4 * poses.size());
    for (const Pose& pose : poses) {
        numbers.insert(numbers.end(), {pose.p.x, pose.p.y, pose.q.c, pose.q.s});
    }
    return numbers;
}

std::vector<float> numbersOf(const std::vector<View::Joint>& joints) {
    std::vector<float> numbers;
    numbers.reserve(4 * joints.size());
    for (const View::Joint& joint : joints) {
        numbers.insert(numbers.end(), {joint.a.x, joint.a.y, joint.b.x, joint.b.y});
    }
    return numbers;
}

std::vector<float> verticesOf(const std::vector<View::Shape>& shapes) {
    std::vector<float> numbers;
    for (const View::Shape& shape : shapes) {
        for (const Vec2& vertex : shape.vertices)
            numbers.insert(numbers.end(), {vertex.x, vertex.y});
    }
    return numbers;
}

void viewFields(FlatWriter& io, const View& m) {
    io.number("tick", 0, m.tick);
    io.number("root", 8, m.root);
    io.number("players", 16, m.players);
    io.number("definitions", 20, m.definitions);
    io.numbers("poses", 0, numbersOf(m.poses), 4 * maxViewBodies);
    io.numbers("flags", 1, m.flags, maxViewBodies);
    io.structs("contacts", 2, layoutOf<View::Contact>, m.contacts, maxViewContacts,
               [&io](const View::Contact& contact) {
                   point(io, "point", 0, contact.point);
                   io.number("colour", 8, contact.colour);
               });
    io.numbers("bodies", 3, m.bodies, maxViewBodies);
    io.structs("shapes", 4, layoutOf<View::Shape>, m.shapes, maxViewShapes,
               [&io](const View::Shape& shape) {
                   io.number("body", 0, shape.body);
                   io.number("radius", 4, shape.radius);
                   io.choice("kind", 8, shape.kind, ShapeKind::ChainSegment);
                   io.number("vertexCount", 10, static_cast<std::uint8_t>(shape.vertices.size()));
               });
    io.numbers("vertices", 5, verticesOf(m.shapes), 2 * maxPolygonVertices * maxViewShapes);
    io.numbers("joints", 6, numbersOf(m.joints), 4 * maxViewJoints);
    io.text("score", 7, m.score, maxScoreText);
}

struct Flat {
    template <class M>
    static std::vector<std::byte> encode(const M& message) {
        FlatWriter writer(headerBytes);
        writer.root(layoutOf<M>, [&] {
            if constexpr (std::is_same_v<M, View>) {
                viewFields(writer, message);
            } else {
                fields(writer, message);
            }
        });
        return writer.take();
    }
    template <class M>
    static Result<Message> decode(MessageType type, std::span<const std::byte> payload) {
        if constexpr (std::is_same_v<M, View>) {
            return Error{"View: is for pages to read"};
        } else {
            FlatReader reader(nameOf(type), payload);
            M message{};
            if (!reader.error()) reader.root(layoutOf<M>, [&] { fields(reader, message); });
            if (reader.error()) return *reader.error();
            return Message(std::move(message));
        }
    }
};

}  // namespace

std::vector<std::byte> encode(const Message& message) {
    return encodeBy<Flat>(message);
}

Result<Message> decode(MessageType type, std::span<const std::byte> payload) {
    return decodeBy<Flat>(type, payload);
}

std::size_t commandBytes(const Command& command) {
    FlatWriter writer(0);
    writer.root(layoutOf<Command>, [&] { commandFields(writer, command); });
    return writer.take().size() - 8;  // but for the pointer to it
}

}  // namespace huestep::protocol::flat
