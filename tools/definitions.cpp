#include "tools/definitions.h"

#include <algorithm>

#include "core/world/from_definition.h"

namespace huestep::tools {

Definitions::Definitions(const World& start)
    : m_info(start.info()),
      m_bodies(start.bodies().begin(), start.bodies().end()),
      m_shapes(start.shapes().begin(), start.shapes().end()),
      m_joints(start.joints().begin(), start.joints().end()) {}

void Definitions::apply(std::span<const Command> commands) {
    std::vector<BodyId> bodies;  // that go
    std::vector<JointId> joints;
    for (const Command& command : commands) {
        if (const auto* added = std::get_if<Spawn>(&command.action)) spawn(*added);
        if (const auto* body = std::get_if<RemoveBody>(&command.action))
            bodies.push_back(body->body);
        if (const auto* joint = std::get_if<RemoveJoint>(&command.action))
            joints.push_back(joint->joint);
    }
    if (bodies.empty() && joints.empty()) return;
    m_changed = true;
    std::sort(bodies.begin(), bodies.end());
    std::sort(joints.begin(), joints.end());
    const auto goes = [](const std::vector<std::uint32_t>& ids, std::uint32_t id) {
        return std::binary_search(ids.begin(), ids.end(), id);
    };
    std::erase_if(m_joints, [&](const JointInfo& j) {
        return goes(joints, j.id) || goes(bodies, j.bodyA) || goes(bodies, j.bodyB);
    });
    std::erase_if(m_shapes, [&](const ShapeInfo& s) { return goes(bodies, s.body); });
    std::erase_if(m_bodies, [&](const BodyInfo& b) { return goes(bodies, b.id); });
}

void Definitions::spawn(const Spawn& spawn) {
    m_changed = true;
    const std::size_t first = m_bodies.size();
    for (const BodyDef& def : spawn.bodies) {
        BodyRecords records = recordsOf(def);
        records.info.id = m_info.nextBody++;
        m_bodies.push_back(records.info);
        for (ShapeInfo& shape : records.shapes) {
            shape.id = m_info.nextShape++;
            shape.body = records.info.id;
            m_shapes.push_back(shape);
        }
    }
    for (const JointDef& def : spawn.joints) {
        const bool mouse = def.kind == JointKind::Mouse;
        JointInfo joint = jointInfo(def, mouse ? nullptr : &m_bodies[first + def.bodyA],
                                    m_bodies[first + def.bodyB]);
        joint.id = m_info.nextJoint++;
        m_joints.push_back(joint);
    }
}

}  // namespace huestep::tools
