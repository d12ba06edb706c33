#include "protocol/drawing.h"

#include <algorithm>
#include <vector>

#include "protocol/codec.h"

namespace huestep::protocol {

namespace {

constexpr std::uint8_t asleepFlag = 1;
constexpr int typeShift = 1;
constexpr std::uint8_t playersFlag = 8;

std::uint8_t flagsOf(const BodyInfo& body, const BodyMotion& motion, bool players) {
    unsigned flags = static_cast<unsigned>(body.type()) << typeShift;
    if (motion.asleep()) flags |= asleepFlag;
    if (players) flags |= playersFlag;
    return static_cast<std::uint8_t>(flags);
}

void addShapes(const World& world, std::size_t most, View& view) {
    for (const ShapeInfo& shape : world.shapes()) {
        const std::optional<std::uint32_t> place = world.find(shape.body);
        if (!place || *place >= view.poses.size()) continue;
        if (view.shapes.size() == most) return;
        View::Shape drawn;
        drawn.body = *place;
        drawn.kind = shape.shapeKind();
        drawn.radius = shape.radius;
        const auto end = shape.vertices.begin() + shape.vertexCount();
        const bool ghosts = shape.shapeKind() == ShapeKind::ChainSegment;  // not drawn
        drawn.vertices.assign(shape.vertices.begin() + ghosts, end - ghosts);
        view.shapes.push_back(std::move(drawn));
    }
}

void addContacts(const World& world, std::size_t most, View& view) {
    for (const ContactView& contact : world.contactViews()) {
        if (contact.colour < 0) continue;  // asleep
        for (int i = 0; i < contact.pointCount; ++i) {
            if (view.contacts.size() == most) return;
            view.contacts.push_back({contact.point[static_cast<std::size_t>(i)],
                                     static_cast<std::uint8_t>(std::min(contact.colour, 255))});
        }
    }
}

void addJoints(const World& world, std::size_t most, View& view) {
    const auto motions = world.motions();
    for (const JointInfo& joint : world.joints()) {
        if (view.joints.size() == most) return;
        const bool mouse = joint.kind() == JointKind::Mouse;  // it has no body A
        const std::optional<std::uint32_t> a = world.find(mouse ? joint.bodyB : joint.bodyA);
        const std::optional<std::uint32_t> b = world.find(joint.bodyB);
        if (!a || !b) continue;
        const Vec2 first = mouse ? joint.target : transform(motions[*a].pose(), joint.anchorA);
        view.joints.push_back({first, transform(motions[*b].pose(), joint.anchorB)});
    }
}

}  // namespace

bool DefinitionsMark::note(const World& world) {
    const WorldInfo& info = world.info();
    // Ids are never reused, so counters and counts together change with every coming and going.
    const std::array<std::uint64_t, 4> mark{info.nextBody, info.nextShape, world.bodies().size(),
                                            world.shapes().size()};
    if (mark == m_mark) return false;
    m_mark = mark;
    return true;
}

View drawingOf(const World& world, bool withShapes, std::size_t most) {
    View view;
    view.tick = world.tick();
    view.root = world.motionRoot();
    view.score = world.score().substr(0, maxScoreText);

    std::vector<BodyId> owned;
    for (const PlayerRecord& player : world.players()) {
        if (player.id != 0 && player.body != 0) owned.push_back(player.body);
    }
    const auto bodies = world.bodies();
    const auto motions = world.motions();
    const std::size_t drawn = std::min(bodies.size(), most);
    view.poses.reserve(drawn);
    view.flags.reserve(drawn);
    for (std::size_t i = 0; i < drawn; ++i) {
        const bool players = bodies[i].owner != 0 ||
                             std::find(owned.begin(), owned.end(), bodies[i].id) != owned.end();
        view.poses.push_back(motions[i].pose());
        view.flags.push_back(flagsOf(bodies[i], motions[i], players));
        if (withShapes) view.bodies.push_back(bodies[i].id);
    }
    if (withShapes) addShapes(world, most, view);
    addContacts(world, most, view);
    addJoints(world, most, view);
    return view;
}

}  // namespace huestep::protocol
