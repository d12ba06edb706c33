/// What a run's bodies, shapes and joints are, followed through its commands beside any engine.
#pragma once

#include <span>
#include <vector>

#include "core/world/world.h"

namespace huestep::tools {

/// Lists like those of a `World`, by ascending id; only what motions are judged by is kept right
/// (a motor's speed is not). Commands are taken as ones that a world applies.
class Definitions {
 public:
    explicit Definitions(const World& start);

    /// What a step's commands make of them.
    void apply(std::span<const Command> commands);

    [[nodiscard]] const WorldInfo& info() const { return m_info; }
    [[nodiscard]] std::span<const BodyInfo> bodies() const { return m_bodies; }
    [[nodiscard]] std::span<const ShapeInfo> shapes() const { return m_shapes; }
    [[nodiscard]] std::span<const JointInfo> joints() const { return m_joints; }
    /// Whether a body or joint ever came or went.
    [[nodiscard]] bool changed() const { return m_changed; }

 private:
    void spawn(const Spawn& spawn);

    WorldInfo m_info;  ///< its counters go on, its tick does not
    std::vector<BodyInfo> m_bodies;
    std::vector<ShapeInfo> m_shapes;
    std::vector<JointInfo> m_joints;
    bool m_changed = false;
};

}  // namespace huestep::tools
